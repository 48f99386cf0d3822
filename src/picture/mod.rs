//! Still pictures of a mesh, drawn by the processor alone: its curved boundary with the edges of the elements, a section by a plane, the
//! worst elements.
//!
//! Faces are drawn as curved as they are: in as many flat pieces as keep the picture within a tenth of a pixel. The work grows with the
//! boundary, and with a section with the elements that it cuts; the volume is only gone through where its elements are measured.

mod camera;
mod canvas;
mod colour;
mod drawing;
mod lettering;
mod paint;

use glam::DVec3;
use rayon::prelude::*;

use crate::mesh::{Mesh, NodeId};
use crate::scene::{CutPlane, Measures, Patch, Shown, Surface, outer, section};
use camera::Camera;
pub use camera::{VIEWS, View};
use canvas::{Canvas, SAMPLES, Triangle};
use colour::{Colour, INK, MARK};
use drawing::{Piece, Pieces};
use lettering::Paper;
use paint::Paint;

/// What colours say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colouring {
    /// The proven lower bound of `J / J_c` of the element behind each face.
    #[default]
    Quality,
    /// The proven lower bound of its scaled Jacobian.
    Scaled,
    /// The distance to the closest point of the CAD.
    Distance,
    /// Patches.
    Patch,
}

/// What a picture shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// From where; a plane mesh is seen along its normal and all others from the front, the right and above where nothing is said.
    pub view: Option<View>,
    /// What colours say.
    pub colouring: Colouring,
    /// The plane that cuts; what is before it is left out.
    pub cut: Option<CutPlane>,
    /// How many of the elements with the smallest `J / J_c` are marked.
    pub worst: usize,
    /// Pixels across and down.
    pub size: [usize; 2],
    /// The patches that are shown, by name or number; where there is none all but those that stand far round the others.
    pub patches: Vec<String>,
}

/// Pixels across or down, at least and at most.
pub const PIXELS: [usize; 2] = [200, 8000];

/// A picture.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The file: PNG.
    pub png: Vec<u8>,
    /// Names of the patches that are left out as they stand far round the others.
    pub left_out: Vec<String>,
    /// The elements that are marked, worst first, a line each.
    pub worst: Vec<String>,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoPicture {
    /// Nothing that could be seen.
    #[error("it has no faces to draw")]
    NoFaces,
    /// A patch that there is not.
    #[error("it has no patch {wanted:?}; it has {known}")]
    UnknownPatch {
        /// What was asked for.
        wanted: String,
        /// What there is.
        known: String,
    },
    /// A picture cannot be encoded.
    #[error("the picture cannot be encoded: {0}")]
    Encoding(String),
}

/// Distances of points to the CAD.
pub type Distances<'a> = &'a (dyn Fn(&[DVec3]) -> Vec<f64> + Sync);

/// Draws a mesh; `title` stands above it. `linear_corners` as for [`Measures::of`]. Distances are asked for where [`Colouring::Distance`] is; without them they are not known.
///
/// # Errors
/// [`NoPicture`].
pub fn draw(
    mesh: &Mesh,
    linear_corners: Option<&[DVec3]>,
    title: &str,
    settings: &Settings,
    distances: Option<Distances>,
) -> Result<Picture, NoPicture> {
    let surface = Surface::of(mesh);
    if surface.faces.is_empty() {
        return Err(NoPicture::NoFaces);
    }
    let shown = shown(&surface, &settings.patches)?;
    let measured = settings.worst > 0 || matches!(settings.colouring, Colouring::Quality | Colouring::Scaled);
    let measures = if measured { Measures::proven(mesh, linear_corners) } else { Measures::default() };
    let layout = Layout::new(settings);
    let camera = camera(mesh, &surface, &shown, settings, &layout);
    let visible: Vec<bool> =
        surface.patches.iter().zip(&shown).map(|(patch, &shown)| shown || !is_side(mesh, patch)).collect();
    let pieces = Pieces::new(mesh.order());
    let drawn = pieces.of(mesh, &surface.faces, &visible, &camera);
    let values = values(&surface.faces, &drawn, settings.colouring, &measures, distances);
    let cuts = settings.cut.map(|cut| section(mesh, cut)).unwrap_or_default();
    let of_cells: &[f64] =
        if settings.colouring == Colouring::Scaled { &measures.scaled_jacobian } else { &measures.j_over_jc };
    let cut_values = cuts.iter().filter_map(|own| of_cells.get(own.element.index()));
    let all = values.iter().flatten().chain(cut_values).copied();
    let paint = paint(settings.colouring, all, &surface, &visible);
    let triangles = |(piece, values): (&Piece, &Vec<f64>)| {
        let colours: Vec<Colour> = values.iter().map(|&value| paint.of(value)).collect();
        pieces.triangles(piece, &surface.faces, &colours, &camera, settings.cut)
    };
    let mut triangles: Vec<Triangle> = drawn.par_iter().zip(&values).flat_map_iter(triangles).collect();
    triangles.extend(drawing::of_section(&cuts, |e| of_cells.get(e).map_or(colour::NONE, |&x| paint.of(x)), &camera));
    let mut canvas = Canvas::new(settings.size[0], settings.size[1]);
    canvas.draw(&triangles);
    let mut paper = Paper { width: settings.size[0], height: settings.size[1], bytes: canvas.pixels() };
    layout.clear(&mut paper);
    let worst = mark_worst(&mut paper, mesh, &measures, settings.worst, &camera, &layout);
    paper.write(title, [14.0, 24.0], 16.0, INK);
    paint.explain(&mut paper, layout.right + 16, layout.top + 36, (layout.bottom - layout.top - 90).min(460));
    let mut left_out: Vec<String> =
        (0..shown.len()).filter(|&p| !visible[p]).map(|p| surface.patches[p].name.clone()).collect();
    left_out.dedup();
    if !settings.patches.is_empty() {
        left_out.clear(); // it was asked for
    }
    Ok(Picture { png: encoded(&paper)?, left_out, worst })
}

/// Whether a patch is one of the boundary, and not of the cells that a mesh of faces shows.
fn is_side(mesh: &Mesh, patch: &Patch) -> bool {
    usize::from(patch.entity.dimension) + 1 == mesh.dimension()
}

/// Which patches are shown; of a plane mesh, which of its boundary's are looked at.
fn shown(surface: &Surface, wanted: &[String]) -> Result<Vec<bool>, NoPicture> {
    let lowest = surface.patches.iter().map(|patch| patch.entity.dimension).min();
    let boundary: Vec<usize> =
        (0..surface.patches.len()).filter(|&p| Some(surface.patches[p].entity.dimension) == lowest).collect();
    let mut shown = vec![false; surface.patches.len()];
    if wanted.is_empty() {
        let own: Vec<Patch> = boundary.iter().map(|&p| surface.patches[p].clone()).collect();
        boundary.iter().zip(outer(&own)).for_each(|(&p, outer)| shown[p] = !outer);
        return Ok(shown);
    }
    for name in wanted {
        let found = surface.named(name).ok_or_else(|| {
            let known: Vec<String> = surface.patches.iter().map(Patch::label).take(20).collect();
            NoPicture::UnknownPatch { wanted: name.clone(), known: known.join(", ") }
        })?;
        found.into_iter().for_each(|p| shown[p] = true);
    }
    Ok(shown)
}

/// Where things stand on the picture, in pixels.
struct Layout {
    top: i64,
    right: i64,
    bottom: i64,
    size: [i64; 2],
}

/// Pixels of a line of the list of the worst elements.
const LINE: i64 = 18;

impl Layout {
    fn new(settings: &Settings) -> Layout {
        let size = settings.size.map(|x| x as i64);
        let listed = settings.worst as i64 * LINE;
        let bottom = size[1] - if listed > 0 { (listed + 10).min(size[1] / 3) } else { 0 };
        Layout { top: 36, right: size[0] - (size[0] / 5).clamp(110, 190), bottom, size }
    }

    /// Clears what is beside the window.
    fn clear(&self, paper: &mut Paper) {
        let [width, height] = self.size;
        for area in [
            [0, 0, width, self.top],
            [self.right, 0, width - self.right, height],
            [0, self.bottom, width, height - self.bottom],
        ] {
            paper.fill(area, colour::WHITE);
        }
    }
}

fn camera(mesh: &Mesh, surface: &Surface, shown: &[bool], settings: &Settings, layout: &Layout) -> Camera {
    let plane = mesh.plane(mesh.points());
    let view = settings.view.unwrap_or(match plane {
        Some(plane) => View::Axis(plane.normal.abs().max_position(), false),
        None => View::Iso,
    });
    let scale = SAMPLES as f64;
    let corner = [0.0, layout.top as f64 * scale];
    let size = [layout.right as f64 * scale, (layout.bottom - layout.top) as f64 * scale];
    let whole = shown.iter().all(|shown| *shown);
    let sides: Vec<NodeId> = if mesh.is_volume() || whole {
        let own = surface.faces.iter().filter(|face| shown[face.patch]);
        own.flat_map(|face| face.nodes.iter().copied()).collect()
    } else {
        let of = |entity| surface.patches.iter().position(|patch| patch.entity == entity).is_some_and(|p| shown[p]);
        mesh.sides().iter().filter(|side| of(side.entity)).flat_map(|side| side.nodes.to_vec()).collect()
    };
    let all: Vec<NodeId> =
        if sides.is_empty() { surface.faces.iter().flat_map(|face| face.nodes.clone()).collect() } else { sides };
    let mut camera = Camera::on(view.frame(), mesh.points_of(&all), corner, size);
    if !whole && (settings.cut.is_some() || plane.is_some()) {
        camera.scale *= 0.7; // what lies round the walls
    }
    camera
}

/// The value at every point of every piece.
fn values(
    faces: &[Shown],
    pieces: &[Piece],
    colouring: Colouring,
    measures: &Measures,
    distances: Option<Distances>,
) -> Vec<Vec<f64>> {
    let of_cell = |piece: &Piece, values: &[f64]| {
        let value = faces[piece.face].element.and_then(|id| values.get(id.index())).copied();
        vec![value.unwrap_or(f64::NAN); piece.points.len()]
    };
    let value = |piece: &Piece| match colouring {
        Colouring::Quality => of_cell(piece, &measures.j_over_jc),
        Colouring::Scaled => of_cell(piece, &measures.scaled_jacobian),
        Colouring::Patch => vec![faces[piece.face].patch as f64; piece.points.len()],
        Colouring::Distance => match distances {
            Some(distances) => distances(&piece.points),
            None => vec![f64::NAN; piece.points.len()],
        },
    };
    pieces.par_iter().map(value).collect()
}

fn paint(colouring: Colouring, values: impl Iterator<Item = f64>, surface: &Surface, visible: &[bool]) -> Paint {
    match colouring {
        Colouring::Quality => Paint::measure("J/J_c, proven", values),
        Colouring::Scaled => Paint::measure("scaled Jacobian", values),
        Colouring::Distance => Paint::length("distance to CAD", values),
        Colouring::Patch => {
            let mut occurring: Vec<usize> =
                surface.faces.iter().map(|face| face.patch).filter(|&p| visible[p]).collect();
            occurring.sort_unstable();
            occurring.dedup();
            Paint::Patches(occurring.into_iter().map(|p| (p, surface.patches[p].label())).collect())
        }
    }
}

/// Marks the worst elements and lists them below the window; returns the lines.
fn mark_worst(
    paper: &mut Paper,
    mesh: &Mesh,
    measures: &Measures,
    count: usize,
    camera: &Camera,
    layout: &Layout,
) -> Vec<String> {
    let (mut lines, cells) = (Vec::new(), mesh.cells());
    let on_paper = |x: DVec3| {
        let [x, y, _] = camera.see(x);
        [x / SAMPLES as f32, y / SAMPLES as f32]
    };
    let worst = if count > 0 { measures.worst(count) } else { Vec::new() };
    for (place, rank) in worst.into_iter().zip(1..) {
        let own = cells.get(cells.id(place));
        for edge in drawing::edges(mesh, own.cell, own.nodes) {
            edge.windows(2).for_each(|ends| paper.line(on_paper(ends[0]), on_paper(ends[1]), 1.4, MARK));
        }
        let middle = mesh.points_of(own.corners()).sum::<DVec3>() / own.corners().len() as f64;
        let at = on_paper(middle);
        let inside =
            at[0] >= 0.0 && at[0] < layout.right as f32 && at[1] >= layout.top as f32 && at[1] < layout.bottom as f32;
        if inside {
            paper.ring(at, 8.0, 1.8, MARK);
            paper.halo(&rank.to_string(), [at[0] + 10.0, at[1] - 7.0]);
        }
        let value = Paper::figure(measures.j_over_jc[place]);
        let [x, y, z] = middle.to_array().map(Paper::figure);
        let outside = if inside { "" } else { ", outside the picture" };
        let line = format!("{rank:>2}  {} {}: J/J_c {value} at ({x}, {y}, {z}){outside}", own.cell, own.tag);
        let y = layout.bottom + LINE * rank;
        if y < layout.size[1] {
            paper.label(&line, [14.0, y as f32]);
        }
        lines.push(line);
    }
    lines
}

fn encoded(paper: &Paper) -> Result<Vec<u8>, NoPicture> {
    let mut bytes = Vec::new();
    let [width, height] = [paper.width, paper.height].map(|pixels| u32::try_from(pixels).unwrap_or(u32::MAX));
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let failed = |error: png::EncodingError| NoPicture::Encoding(error.to_string());
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&paper.bytes).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}
