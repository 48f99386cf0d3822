//! The oracle of edges: points on every edge of every face, asked of that face alone. The edge bounds the face, so no point of it is farther
//! from the face than the edge's tolerance.
//!
//! Three points are asked at each parameter, with a hint and without: that of the edge's curve, that of its pcurve on the surface, and one beside the curve, which
//! may be farther from the face by no more than that. Where the pcurve runs beside the curve by more than the tolerance (files do not always say
//! the truth), the surface's point is allowed that gap, and the edge is told.

use crate::common::{Random, cad_files, fixture_cad, foreign_folders, options, shape};
use cad::{Edge, EdgeId, End, FaceId, Group, Hint, Model, SourceFormat};
use glam::DVec3;
use opencascade_sys as sys;
use std::fmt;
use std::path::Path;

/// Parameters an edge, evenly spread with a random share of a step: none is special.
const POINTS: usize = 20;

/// How many tolerances of the edge or vertex a point of it may be off the face.
const TOLERANCES: f64 = 2.0;

/// Distance that rounding explains, fraction of the diagonal.
const ROUNDING: f64 = 1e-12;

/// How far points beside an edge are off it, fractions of the diagonal.
const BESIDE: [f64; 4] = [1e-10, 1e-7, 1e-4, 0.01];

/// Steps along a curve in the search for its point nearest to one of the pcurve.
const STEPS: usize = 200;

/// Points a direction of each leaf that are held against the leaf's boxes.
const LEAF_POINTS: u32 = 7;

#[derive(Default, Debug)]
struct Tally {
    files: usize,
    faces: usize,
    /// Sides of faces: an edge counts once for each face.
    edges: usize,
    vertices: usize,
    points: usize,
    misses: usize,
    unproven: usize,
    stalled: usize,
    /// Edges whose pcurve is farther off than [`TOLERANCES`] allow.
    gaps: usize,
    leaves: usize,
    /// Leaves that do not hold their own points.
    strays: usize,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.files += other.files;
        self.faces += other.faces;
        self.edges += other.edges;
        self.vertices += other.vertices;
        self.points += other.points;
        self.misses += other.misses;
        self.unproven += other.unproven;
        self.stalled += other.stalled;
        self.gaps += other.gaps;
        self.leaves += other.leaves;
        self.strays += other.strays;
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} faces, {} edges and {} vertices of them, {} points: {} misses, {} not proven, {} stalled; {} pcurves beside their \
             edges; {} leaves, {} do not hold their own points",
            self.faces,
            self.edges,
            self.vertices,
            self.points,
            self.misses,
            self.unproven,
            self.stalled,
            self.gaps,
            self.leaves,
            self.strays
        )
    }
}

/// A point on the boundary of a face.
struct Query {
    what: String,
    x: DVec3,
    /// How far it may be from the face.
    bar: f64,
}

struct Asked<'a> {
    model: &'a Model,
    import: &'a sys::Import,
    random: Random,
    tally: Tally,
}

impl Asked<'_> {
    fn rounding(&self) -> f64 {
        ROUNDING * self.model.diagonal()
    }

    fn parameters(&mut self, [a, b]: [f64; 2]) -> Vec<f64> {
        let at = |k: usize, share: f64| a + (b - a) * (k as f64 + share) / POINTS as f64;
        (0..POINTS).map(|k| at(k, self.random.between(0.05, 0.95))).collect()
    }

    /// Distance of a point from an edge by OCCT's evaluation: the best of many steps, refined by bisection. `None` for poles.
    fn off_curve(&self, edge: &Edge, x: DVec3) -> Option<f64> {
        let [a, b] = edge.parameters;
        let distance = |t: f64| Some(self.model.evaluate(edge.id.into(), [t.clamp(a, b), 0.0])?.point().distance(x));
        let mut step = (b - a) / STEPS as f64;
        let samples = (0..=STEPS).map(|k| a + step * k as f64);
        let (mut best, mut at) = samples.filter_map(|t| Some((distance(t)?, t))).min_by(|p, q| p.0.total_cmp(&q.0))?;
        while step > 1e-12 * (b - a) {
            let near = [at - step, at + step].map(|t| (distance(t).unwrap_or(f64::INFINITY), t));
            match near.into_iter().find(|near| near.0 < best) {
                Some(nearer) => (best, at) = nearer,
                None => step *= 0.5,
            }
        }
        Some(best)
    }

    /// Points of the edge's curve, of its pcurve on the surface, and beside.
    fn along(&mut self, face: FaceId, coedge: &sys::Coedge, pcurve: &sys::Pcurve) -> Vec<Query> {
        let Ok(index) = usize::try_from(coedge.edge) else {
            println!("    {face}: an edge of its boundary is not among those of the model");
            return Vec::new();
        };
        let model = self.model;
        let edge = model.edge(EdgeId::new(index)).unwrap();
        let ends = edge.ends.iter().flatten().map(|&id| model.vertex(id).unwrap());
        // a pole: its curve is its vertex
        let pole = ends.clone().next().filter(|_| edge.degenerate).map(|vertex| vertex.point);
        let tolerance =
            if edge.degenerate { ends.map(|v| v.tolerance).fold(edge.tolerance, f64::max) } else { edge.tolerance };
        let bar = TOLERANCES * tolerance + self.rounding();
        let [first, last] = edge.parameters;
        let (mut queries, mut widest) = (Vec::new(), 0.0_f64);
        for (k, t) in self.parameters([first, last]).into_iter().enumerate() {
            let on_curve = pole.or_else(|| Some(model.evaluate(edge.id.into(), [t, 0.0])?.point()));
            let along = coedge.first + (coedge.last - coedge.first) * (t - first) / (last - first);
            let mut jet = [0.0; 4];
            let parameters = pcurve.d1(if edge.degenerate { t } else { along }, &mut jet).map(|()| [jet[0], jet[1]]);
            let on_surface = parameters.ok().and_then(|p| Some(model.evaluate(face.into(), p)?.point()));
            let mut gap = on_curve.zip(on_surface).map_or(0.0, |(a, b)| a.distance(b));
            if let Some(x) = on_surface.filter(|_| gap > bar) {
                gap = self.off_curve(edge, x).map_or(gap, |off| off.min(gap));
            }
            widest = widest.max(gap);
            let query = |what, x: DVec3, bar| Query {
                what: format!("{} at {t:.6} ({what}, tolerance {tolerance:.1e}, pcurve {gap:.1e} beside it)", edge.id),
                x,
                bar,
            };
            queries.extend(on_curve.map(|x| query("curve", x, bar)));
            queries.extend(on_surface.map(|x| query("surface", x, bar.max(gap + self.rounding()))));
            let by = BESIDE[k % BESIDE.len()] * model.diagonal() * self.random.in_box(-DVec3::ONE, DVec3::ONE);
            queries.extend(on_curve.map(|x| query("beside", x + by, bar + by.length())));
        }
        if widest > bar {
            self.tally.gaps += 1;
            println!("    {face} {}: its pcurve is {widest:.3e} beside it, tolerance {tolerance:.1e}", edge.id);
        }
        self.tally.edges += 1;
        queries
    }

    fn queries(&mut self, face: FaceId) -> Vec<Query> {
        let loops = self.import.shape().loops(face.index()).unwrap();
        let mut queries = Vec::new();
        for k in 0..loops.count() {
            queries.extend(self.along(face, &loops.coedge(k).unwrap(), &loops.pcurve(k).unwrap()));
        }
        let model = self.model;
        let edges = model.face(face).unwrap().edges.iter().map(|&edge| model.edge(edge).unwrap());
        let mut corners: Vec<_> = edges.filter(|edge| !edge.degenerate).flat_map(|edge| edge.ends).flatten().collect();
        corners.sort_unstable();
        corners.dedup();
        self.tally.vertices += corners.len();
        queries.extend(corners.into_iter().map(|id| {
            let vertex = model.vertex(id).unwrap();
            let bar = TOLERANCES * vertex.tolerance + self.rounding();
            Query { what: format!("{id} (tolerance {:.1e})", vertex.tolerance), x: vertex.point, bar }
        }));
        queries
    }

    fn ask(&mut self, face: FaceId) {
        let queries = self.queries(face);
        let group = match Group::of_faces(self.model, &[face]) {
            Ok(group) => group,
            Err(error) => return println!("    {face}: {error}"),
        };
        let mut hint = Hint::default();
        for Query { what, x, bar } in &queries {
            let feet = [group.closest(*x, None), group.closest(*x, Some(&mut hint))];
            let distance = feet.iter().map(|foot| foot.map_or(f64::INFINITY, |foot| foot.distance)).fold(0.0, f64::max);
            self.tally.points += 1;
            self.tally.unproven += usize::from(feet.iter().flatten().any(|foot| !foot.is_proven()));
            self.tally.stalled +=
                usize::from(feet.iter().flatten().any(|foot| matches!(foot.end, End::Stalled { .. })));
            if distance > *bar {
                self.tally.misses += 1;
                println!("    MISS: {face} {what}: {distance:.3e} away from {x}: {feet:?}");
            }
        }
        self.tally.faces += 1;
    }
}

/// All edges of all faces of a file, and its leaves.
fn ask_file(path: &Path) -> Tally {
    let start = std::time::Instant::now();
    let model = Model::read(path, &options()).unwrap();
    let format = match model.format() {
        SourceFormat::Step => sys::Format::Step,
        SourceFormat::Iges => sys::Format::Iges,
        SourceFormat::Brep => sys::Format::Brep,
    };
    let import = sys::read_file(path.to_str().unwrap(), format, 1.0, false).unwrap();
    let mut asked = Asked { model: &model, import: &import, random: Random(83), tally: Tally::default() };
    for face in model.faces() {
        asked.ask(face.id);
    }
    let mut tally = Tally { files: 1, ..asked.tally };
    let (leaves, strays) = model.strays(LEAF_POINTS, ROUNDING * model.diagonal());
    (tally.leaves, tally.strays) = (leaves, strays.len());
    for stray in strays.iter().take(5) {
        println!("    STRAY: a leaf of {} does not hold its own point: {stray:?}", stray.entity);
    }
    println!("{}: {tally}; {:.1} s", path.display(), start.elapsed().as_secs_f64());
    tally
}

fn ask_files<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Tally {
    let mut all = Tally::default();
    for path in paths {
        all += ask_file(path);
    }
    println!("all {} files: {all}", all.files);
    assert_eq!(
        (all.misses, all.strays),
        (0, 0),
        "points on edges far from their face, or leaves that do not hold their points: {all}"
    );
    all
}

#[test]
#[ignore = "a minute: make oracle"]
fn points_on_edges_are_on_their_faces_everywhere() {
    let mut paths = fixture_cad();
    for folder in foreign_folders() {
        cad_files(&folder, &mut paths);
    }
    ask_files(paths.iter().map(AsRef::as_ref));
}

#[test]
fn points_on_edges_are_on_their_faces() {
    let all = ask_files(fixture_cad().iter().map(AsRef::as_ref));
    assert!(all.faces > 100 && all.points > 10_000, "{all}");
}

/// Faces that reach beyond the knots of their surfaces, where OCCT's polynomials go on, and one with straight, unevenly parametrised sides: points
/// everywhere on them are their own feet.
#[test]
fn points_beyond_the_knots_are_their_own_feet() {
    let model = shape("rims.brep");
    let wide = |[[u0, u1], [v0, v1]]: [[f64; 2]; 2]| u0 < 0.0 || v0 < 0.0 || u1 > 4.0 || v1 > 3.0;
    assert_eq!(model.faces().iter().filter(|face| wide(face.parameters)).count(), 6);
    let mut random = Random(89);
    for face in model.faces() {
        let group = Group::of_faces(&model, &[face.id]).unwrap();
        let [u, v] = face.parameters;
        let mut hint = Hint::default();
        for k in 0..2000 {
            // every other point in the strip beyond, or on the border
            let mut between = |[a, b]: [f64; 2]| {
                let t = a + (b - a) * random.unit();
                if k % 2 == 0 { t } else { [a, b][random.below(2)] + 0.02 * (t - a) * (0.5 - random.unit()) }
                    .clamp(a, b)
            };
            let parameters = [between(u), between(v)];
            let x = model.evaluate(face.id.into(), parameters).unwrap().point();
            for foot in [group.closest(x, None), group.closest(x, Some(&mut hint))] {
                let near = foot.is_some_and(|foot| foot.distance <= ROUNDING * model.diagonal() && foot.is_proven());
                assert!(near, "{} at {parameters:?}: {foot:?}", face.id);
            }
        }
    }
}
