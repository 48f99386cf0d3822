//! What the first tolerance found, when a wider one is tried: it must not take what runs beside the CAD for the CAD.

use std::collections::BTreeSet;

use cad::EntityId;

use super::volume_sides::VolumeSides;
use crate::associate::{Candidate, Joints, Side};
use crate::mesh::{Boundary, Incidence};

/// What was found with the first tolerance.
pub(super) struct Before {
    /// On which side of CAD faces the volume is.
    pub(super) sides: VolumeSides,
    /// Boundary faces with a place on the CAD.
    faces: BTreeSet<usize>,
    /// The CAD that they lie on.
    hosts: BTreeSet<EntityId>,
}

/// A boundary face that the CAD holds within the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Held {
    /// Not at all, or only some of its corners.
    No,
    /// By this face (in the plane: edge).
    On(EntityId),
    /// By several, or by none of them alone.
    Open,
}

impl Before {
    /// What sheets say.
    pub(super) fn of(sheets: &[Candidate<usize>], joints: &Joints<'_>, sides: &[Side]) -> Before {
        Before {
            sides: VolumeSides::of(sheets, joints, sides),
            faces: sheets.iter().flat_map(|sheet| &sheet.items).copied().collect(),
            hosts: sheets.iter().flat_map(|sheet| &sheet.entities).copied().collect(),
        }
    }

    /// Faces on CAD that others were found on before, which hang together, node by node through faces that the CAD holds, with none of those
    /// and with none on CAD that is new: the outer boundary of thin layers is within the wider tolerance of the wall. Rising.
    pub(super) fn apart(&self, boundary: &Boundary, nodes: usize, held: &[Held]) -> Vec<usize> {
        let corners = boundary.corners.iter().zip(0_u32..);
        let around = Incidence::new(nodes, corners.flat_map(|(own, face)| own.iter().map(move |n| (n.index(), face))));
        let mut reached = vec![false; held.len()];
        let is_new = |held: Held| matches!(held, Held::On(host) if !self.hosts.contains(&host));
        let is_found = |face: usize| is_new(held[face]) || (held[face] != Held::No && self.faces.contains(&face));
        let mut front: Vec<usize> = (0..held.len()).filter(|&face| is_found(face)).collect();
        front.iter().for_each(|&face| reached[face] = true);
        while let Some(face) = front.pop() {
            for &next in boundary.corners[face].iter().flat_map(|n| around.at(n.index())) {
                let next = next as usize;
                if held[next] != Held::No && !std::mem::replace(&mut reached[next], true) {
                    front.push(next);
                }
            }
        }
        let is_taken = |held: Held| match held {
            Held::No => false,
            Held::On(host) => self.hosts.contains(&host),
            Held::Open => !self.hosts.is_empty(),
        };
        (0..held.len()).filter(|&face| !reached[face] && is_taken(held[face])).collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use cad::FaceId;
    use glam::DVec3;

    use super::*;
    use crate::element::Cell;
    use crate::mesh::{EntityKey, Mesh, NodeId, Parts};

    /// Strips of triangles, four on a wall and as many beside it, that share no nodes.
    fn strips() -> Boundary {
        let mut parts = Parts::default();
        for strip in [0.0, 0.1] {
            let first = parts.points.len();
            parts.points.extend((0..6).map(|k| DVec3::new(f64::from(k / 2), f64::from(k % 2), strip)));
            for k in first..first + 4 {
                let nodes = [k, k + 1, k + 2].map(|n| NodeId::new(n).unwrap());
                parts.push(Cell::Triangle, EntityKey::new(2, 1), &nodes);
            }
        }
        Boundary::new(&Mesh::new(parts).unwrap())
    }

    #[test]
    fn what_runs_beside_the_wall_is_apart_and_what_hangs_together_with_it_is_not() {
        let boundary = strips();
        let host: EntityId = FaceId::new(0).into();
        let before = |faces: &[usize]| Before {
            sides: VolumeSides::default(),
            faces: faces.iter().copied().collect(),
            hosts: [host].into(),
        };
        let held = [Held::On(host); 8];
        assert_eq!(before(&[0]).apart(&boundary, 12, &held), [4, 5, 6, 7]);
        // A gap in what the CAD holds parts the wall itself; what one cannot say of is apart as well.
        let mut open = held;
        (open[2], open[5]) = (Held::No, Held::Open);
        assert_eq!(before(&[0]).apart(&boundary, 12, &open), [4, 5, 6, 7]);
        // On CAD on which nothing was found before, all is new; so is what one cannot say of beside it.
        let mut other = [Held::On(FaceId::new(1).into()); 8];
        other[6] = Held::Open;
        assert!(before(&[]).apart(&boundary, 12, &other).is_empty());
    }
}
