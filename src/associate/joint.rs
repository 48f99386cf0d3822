//! How two CAD faces meet: smoothly, or in a sharp edge.

use std::collections::BTreeMap;

use cad::{EdgeId, EntityId, Evaluation, FaceId, Group, Model};
use glam::DVec3;

/// Places along an edge at which its angle is measured, as shares of its parameter range.
const STATIONS: [f64; 3] = [0.1, 0.5, 0.9];
/// Length of the step off an edge that decides on which side a face lies; fraction of the edge's bounding-box diagonal.
const STEP: f64 = 1e-3;
/// Faces whose tangent planes turn by more over an edge meet in a sharp edge (radians, 15 degrees).
pub const SHARP: f64 = 0.26;

/// The edges of a model, doubled ones of unsewn faces taken as one.
#[derive(Debug)]
pub struct Joints<'a> {
    model: &'a Model,
    /// The edge that stands for each edge: itself, or the first of its doubles.
    stands: Vec<EdgeId>,
    /// Faces at each edge that stands for itself, with those of its doubles; a seam's face stands once.
    faces: BTreeMap<EdgeId, Vec<FaceId>>,
    single: Vec<Option<Group>>,
}

impl<'a> Joints<'a> {
    /// The joints of a model.
    #[must_use]
    pub fn new(model: &'a Model) -> Joints<'a> {
        let mut stands: Vec<EdgeId> = model.edges().iter().map(|edge| edge.id).collect();
        for set in &model.sewing().merged {
            if let Some(&first) = set.first() {
                set.iter().for_each(|edge| stands[edge.index()] = first);
            }
        }
        let mut faces: BTreeMap<EdgeId, Vec<FaceId>> = BTreeMap::new();
        for edge in model.edges().iter().filter(|edge| !edge.degenerate) {
            let own = faces.entry(stands[edge.id.index()]).or_default();
            own.extend(edge.faces.iter().copied());
            own.sort_unstable();
            own.dedup();
        }
        let single = model.faces().iter().map(|face| Group::of_faces(model, &[face.id]).ok()).collect();
        Joints { model, stands, faces, single }
    }

    /// Edges that stand for themselves and have a curve, with the faces that they bound.
    pub fn edges(&self) -> impl Iterator<Item = (EdgeId, &[FaceId])> {
        self.faces.iter().map(|(&edge, faces)| (edge, &faces[..]))
    }

    /// The edge that stands for this one.
    #[must_use]
    pub fn stands_for(&self, edge: EdgeId) -> EdgeId {
        self.stands.get(edge.index()).copied().unwrap_or(edge)
    }

    /// The faces that an edge bounds, also by its doubles.
    #[must_use]
    pub fn faces_of(&self, edge: EdgeId) -> &[FaceId] {
        self.faces.get(&self.stands_for(edge)).map_or(&[], |faces| faces)
    }

    /// Whether one face has the edge, or its doubles, on two sides.
    #[must_use]
    pub fn is_seam(&self, edge: EdgeId) -> bool {
        let doubles = self.stands.iter().filter(|&&stands| stands == edge).count();
        let own = self.model.edge(edge);
        own.is_some_and(|own| own.seam) || (doubles > 1 && self.faces_of(edge).len() == 1)
    }

    /// A face as a group of its own; `None` where it has no area.
    #[must_use]
    pub fn face(&self, id: FaceId) -> Option<&Group> {
        self.single.get(id.index()).and_then(Option::as_ref)
    }

    /// The largest turn of the tangent plane over an edge, 0 where its two faces go on in one another, pi where they fold back. `None` for an edge that
    /// does not have two faces, or where OCCT gives no normals.
    #[must_use]
    pub fn turn(&self, edge: EdgeId) -> Option<f64> {
        let &[a, b] = self.faces_of(edge) else { return None };
        let own = self.model.edge(self.stands_for(edge))?;
        let step = STEP * own.bounds.diagonal();
        let mut worst: Option<f64> = None;
        for share in STATIONS {
            let [from, to] = own.parameters;
            let Some(Evaluation::Curve(at)) = self.model.evaluate(own.id.into(), [from + share * (to - from), 0.0])
            else {
                continue;
            };
            let tangent = at.tangent?;
            let into = [a, b].map(|face| self.into(face, at.point, tangent, step));
            if let [Some(first), Some(second)] = into {
                let turn = std::f64::consts::PI - first.angle_between(second);
                worst = Some(worst.map_or(turn, |w: f64| w.max(turn)));
            }
        }
        worst
    }

    /// The direction in a face's tangent plane that leads from a point of its edge into the face.
    fn into(&self, face: FaceId, at: DVec3, tangent: DVec3, step: f64) -> Option<DVec3> {
        let group = self.face(face)?;
        let along = normal_at(group, at)?.cross(tangent).try_normalize()?;
        let off = |way: DVec3| group.distance(at + way * step);
        Some(if off(along) <= off(-along) { along } else { -along })
    }
}

/// The normal of a group's surface at its point closest to `x`; `None` at poles, and where the closest point has no surface.
#[must_use]
pub fn normal_at(group: &Group, x: DVec3) -> Option<DVec3> {
    let foot = group.closest(x, None)?;
    match (foot.entity, group.evaluate_at(&foot)?) {
        (EntityId::Face(_), Evaluation::Surface(point)) => point.normal,
        _ => None,
    }
}
