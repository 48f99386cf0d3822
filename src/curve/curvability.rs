//! Where the CAD leaves the elements of a linear mesh no room, known before anything is smoothed.
//!
//! * At a corner of a wall face, `q = (T_1 x T_2) . n / |c_1 x c_2|`; at a corner of an element whose three edges (of a plane one: two) all
//!   lie on walls, `q = det [T_1, T_2, T_3] / det [c_1, c_2, c_3]`: `T` the tangents of the edge polynomials at the corner as projected, `c` the chords, `n` the
//!   CAD's normal. Where `q <= 0` the element is invalid whatever the nodes inside the volume do, as long as the wall's nodes stay where they
//!   were projected to; only wall nodes that slide, or leave the CAD, can mend it.
//! * `h / R`, an edge's length over the CAD's least radius of curvature at the corner: beyond 1, one polynomial does not follow the CAD.
//! * `s`, the displacement of a wall face and of the boundary face at the other end of its column of cells, towards each other, over the height of the
//!   column: at 1 nothing is left between them.

use cad::{EntityId, Evaluation, Group};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::level::{Case, Level};
use super::wall::corner::{Arms, FaceCorner, chord, face_corners};
use crate::associate::{Association, Classification, SpotReport, sides};
use crate::mesh::{Element, ElementId, FaceKey, Incidence, NodeId};

/// Corners with a smaller `q` are told.
const LITTLE_ROOM: f64 = 0.3;
/// Columns with a larger `s` are told.
const SQUEEZED: f64 = 0.5;
/// Beyond that so little is left of a column that its cells are as good as impossible.
const TAKEN_UP: f64 = 0.8;
/// Cells of a column that are gone through.
const LONGEST_COLUMN: usize = 1000;

/// What has little room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spot {
    /// A corner of an element all of whose edges there lie on walls.
    ElementCorner {
        /// The element.
        element: ElementId,
        /// The node at the corner.
        node: NodeId,
        /// Room between the tangents, in that between the chords.
        q: f64,
        /// `h / R`.
        bend: f64,
    },
    /// A corner of a wall face.
    FaceCorner {
        /// The face, by index in [`Boundary::faces`](crate::mesh::Boundary::faces).
        face: usize,
        /// The node at the corner.
        node: NodeId,
        /// Room between the tangents, in that between the chords.
        q: f64,
        /// `h / R`.
        bend: f64,
    },
    /// A column of cells over a wall face.
    Column {
        /// The face.
        face: usize,
        /// Displacement over height.
        s: f64,
    },
}

impl Spot {
    /// Whether an element is invalid there as long as the wall's nodes stay where projection put them.
    #[must_use]
    pub fn is_impossible(&self) -> bool {
        match *self {
            Spot::ElementCorner { q, .. } | Spot::FaceCorner { q, .. } => q <= 0.0,
            Spot::Column { s, .. } => s >= 1.0,
        }
    }

    /// The room that is left; 0 and less where none is.
    fn room(&self) -> f64 {
        match *self {
            Spot::ElementCorner { q, .. } | Spot::FaceCorner { q, .. } => q,
            Spot::Column { s, .. } => 1.0 - s,
        }
    }
}

/// The spots of a projected level that is not smoothed yet, those with the least room first.
#[must_use]
pub fn spots(level: &Level) -> Vec<Spot> {
    let survey = Survey { level, arms: Arms::new(level.mesh().order()) };
    let mut spots = survey.face_corners();
    spots.extend(survey.element_corners());
    spots.extend(survey.columns());
    spots.sort_by(|a, b| a.room().total_cmp(&b.room()));
    spots
}

/// The corners with `q <= 0` where projection put the wall.
pub(super) fn impossible_corners(level: &Level) -> Vec<Spot> {
    let survey = Survey { level, arms: Arms::new(level.mesh().order()) };
    let mut spots = survey.face_corners();
    spots.extend(survey.element_corners());
    spots.retain(Spot::is_impossible);
    spots
}

/// Those, and the columns that the wall's displacement takes up.
pub(super) fn impossible(level: &Level) -> Vec<Spot> {
    let mut spots = impossible_corners(level);
    let columns = Survey { level, arms: Arms::new(level.mesh().order()) }.columns();
    spots.extend(columns.into_iter().filter(|spot| spot.room() < 1.0 - TAKEN_UP));
    spots
}

/// A spot in words and figures.
#[must_use]
pub fn report(level: &Level, spot: &Spot) -> SpotReport {
    let (mesh, Case { boundary, association, .. }) = (level.mesh(), level.case);
    let place = |node: NodeId| (Some(mesh.node_tags()[node.index()]), level.displaced(node.index()).to_array());
    let face = |face: usize| {
        let on = association.faces[face];
        (format!("{} {}", boundary.faces[face].cell, boundary.tag(face, mesh)), label(association, on))
    };
    let (kind, (element, cad), (node, position), measure, remedy) = match *spot {
        Spot::ElementCorner { element, node, q, bend } => {
            let own = mesh.cells().get(element);
            let on = own.nodes[own.cell.corner_count()..].iter().map(|n| level.wall.classification(n.index()));
            let on = on.filter(|on| association.group_of(*on).is_some()).map(|on| label(association, on)).next();
            let named = (format!("{} {}", own.cell, own.tag), on.unwrap_or_default());
            (
                "element corner",
                named,
                place(node),
                (Some(q), Some(bend), None),
                "split the edge that its wall faces share",
            )
        }
        Spot::FaceCorner { face: own, node, q, bend } => {
            let remedy = "split the face from this corner, or refine where the CAD's edges join smoothly";
            ("face corner", face(own), place(node), (Some(q), Some(bend), None), remedy)
        }
        Spot::Column { face: own, s } => {
            let middle = mesh.points_of(&boundary.corners[own]).sum::<DVec3>() / boundary.corners[own].len() as f64;
            let remedy = "refine the wall there, or make the stack of cells higher";
            ("column", face(own), (None, middle.to_array()), (None, None, Some(s)), remedy)
        }
    };
    let (q, bend, squeeze) = measure;
    SpotReport { kind, element, node, position, q, bend, squeeze, impossible: spot.is_impossible(), cad, remedy }
}

fn label(association: &Association, on: Classification) -> String {
    match on {
        Classification::Surface(surface) => association.surfaces[surface].label.clone(),
        Classification::Curve(curve) => association.curves[curve].label.clone(),
        _ => String::new(),
    }
}

struct Survey<'l, 'a> {
    level: &'l Level<'a>,
    arms: Arms,
}

impl Survey<'_, '_> {
    fn at(&self, node: NodeId) -> DVec3 {
        self.level.displaced(node.index())
    }

    /// Whether a node stays where projection put it: on the CAD, and not in a plane, where it goes wherever the volume wants it.
    fn is_held(&self, node: NodeId) -> bool {
        let classification = self.level.wall.classification(node.index());
        classification != Classification::Free && self.level.plane_of(node.index()).is_none()
    }

    fn face_corners(&self) -> Vec<Spot> {
        let (case, mesh) = (self.level.case, self.level.mesh());
        let found = face_corners(case, mesh, &|node| self.at(node), &|node| self.is_held(node), LITTLE_ROOM);
        let spot = |FaceCorner { face, q, arms }: FaceCorner| {
            let nodes = case.boundary.nodes(face, mesh);
            let group = case.association.group_of(case.association.faces[face]);
            let bend = group.map_or(0.0, |group| self.bend(group, nodes, &arms));
            Spot::FaceCorner { face, node: nodes[arms[0][0]], q, bend }
        };
        found.into_iter().map(spot).collect()
    }

    fn element_corners(&self) -> Vec<Spot> {
        let cells = self.level.mesh().cells();
        cells.par_ids().flat_map_iter(|e| self.corners_of(&cells.get(e))).collect()
    }

    /// The corners of an element all of whose edges there lie on walls.
    fn corners_of(&self, own: &Element) -> Vec<Spot> {
        let at = |node: NodeId| self.at(node);
        let dimension = own.cell.dimension();
        if own.corners().iter().filter(|&&node| self.is_held(node)).count() <= dimension {
            return Vec::new(); // three edges on walls have four ends there
        }
        let mut spots = Vec::new();
        for corner in 0..own.cell.corner_count() {
            let arms: Vec<Vec<usize>> = self.arms.at(own.cell, corner).collect();
            let held = |arm: &Vec<usize>| arm.iter().all(|&place| self.is_held(own.nodes[place]));
            if arms.len() != dimension || !arms.iter().all(held) {
                continue;
            }
            let up = self.level.plane().map(|plane| plane.normal);
            let edges = |of: &dyn Fn(&Vec<usize>) -> DVec3| {
                let mut columns = arms.iter().map(of).chain(up);
                let mut next = || columns.next().unwrap_or_default();
                DMat3::from_cols(next(), next(), next())
            };
            let flat = edges(&|arm| chord(arm, own.nodes, &at));
            let bent = edges(&|arm| self.arms.tangent(arm, own.nodes, &at));
            let q = bent.determinant() / flat.determinant();
            if q < LITTLE_ROOM {
                let inner = self.level.wall.classification(own.nodes[arms[0][2]].index());
                let group = self.level.case.association.group_of(inner);
                let bend = group.map_or(0.0, |group| self.bend(group, own.nodes, &arms));
                spots.push(Spot::ElementCorner { element: own.id, node: own.nodes[corner], q, bend });
            }
        }
        spots
    }

    /// The longest of edges over the least radius of curvature of a group where they begin.
    fn bend(&self, group: &Group, nodes: &[NodeId], arms: &[Vec<usize>]) -> f64 {
        let at = |node: NodeId| self.at(node);
        let Some(corner) = arms.first().map(|arm| at(nodes[arm[0]])) else { return 0.0 };
        let length = arms.iter().map(|arm| chord(arm, nodes, &at).length()).fold(0.0, f64::max);
        let foot = group.closest(corner, None);
        let curvature = foot.and_then(|foot| match (foot.entity, group.evaluate_at(&foot)?) {
            (EntityId::Face(_), Evaluation::Surface(at)) => at.curvatures.map(|[a, b]| a.abs().max(b.abs())),
            (_, Evaluation::Curve(at)) => at.curvature,
            _ => None,
        });
        length * curvature.unwrap_or(0.0)
    }

    fn columns(&self) -> Vec<Spot> {
        let Case { boundary, association, .. } = self.level.case;
        let mesh = self.level.mesh();
        let cells = mesh.cells();
        if !cells.blocks().iter().any(|block| block.cell.stacks()) {
            return Vec::new();
        }
        let stacked = cells.iter().filter(|own| own.cell.stacks());
        let corners = stacked.flat_map(|own| own.corners().iter().map(move |n| (n.index(), own.id)));
        let around = Incidence::new(self.level.elevated.linear_nodes, corners);
        let sides = sides(mesh, boundary);
        let moved = |face: usize, inward: DVec3| {
            let nodes = boundary.nodes(face, mesh).iter();
            nodes.map(|n| self.level.wall.displacement(n.index()).dot(inward)).fold(f64::NEG_INFINITY, f64::max)
        };
        let mut spots = Vec::new();
        for face in 0..boundary.faces.len() {
            if association.group_of(association.faces[face]).is_none() {
                continue;
            }
            let Some(end) = self.end_of_column(face, &around) else { continue };
            let inward = -sides[face].normal;
            let height = (sides[end].middle - sides[face].middle).dot(inward);
            let s = (moved(face, inward) + moved(end, -inward).max(0.0)) / height;
            if s > SQUEEZED && height > 0.0 {
                spots.push(Spot::Column { face, s });
            }
        }
        spots
    }

    /// The boundary face at the other end of the cells that stand on a face one on another, each with a side that shares no corner with the
    /// one it stands on.
    fn end_of_column(&self, face: usize, around: &Incidence<ElementId>) -> Option<usize> {
        let boundary = self.level.case.boundary;
        let cells = self.level.mesh().cells();
        let mut side = FaceKey::new(&boundary.corners[face]);
        let mut below: Option<ElementId> = None;
        for _ in 0..LONGEST_COLUMN {
            let first = side.corners().first()?.index();
            let is_next = |e: &&ElementId| Some(**e) != below && cells.get(**e).sides().any(|other| other == side);
            let Some(&next) = around.at(first).iter().find(is_next) else {
                return boundary.face_of(side).filter(|&end| end != face);
            };
            let apart = |other: &FaceKey| other.corners().iter().all(|node| !side.corners().contains(node));
            let opposite = cells.get(next).sides().find(apart)?;
            (side, below) = (opposite, Some(next));
        }
        None
    }
}
