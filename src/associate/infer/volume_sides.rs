//! On which side of each CAD face the volume is.

use std::collections::BTreeMap;

use cad::{EntityId, FaceId};

use crate::associate::joint::normal_at;
use crate::associate::{Candidate, Joints, Side};

/// The volume is on one side of a CAD face if at least this fraction of the faces that show it are there.
const ONE_SIDE: f64 = 0.9;

/// For CAD faces, how many mesh faces have their outward normal against the CAD face's, and how many with it.
#[derive(Debug, Default)]
pub(super) struct VolumeSides {
    told: BTreeMap<FaceId, [usize; 2]>,
}

impl VolumeSides {
    /// What the mesh faces of sheets show.
    pub(super) fn of(sheets: &[Candidate<usize>], joints: &Joints<'_>, sides: &[Side]) -> VolumeSides {
        let mut all = VolumeSides::default();
        for sheet in sheets {
            let [EntityId::Face(id)] = sheet.entities[..] else { continue };
            let Some(group) = joints.face(id) else { continue };
            for side in sheet.items.iter().map(|&face| &sides[face]) {
                if let Some(normal) = normal_at(group, side.middle) {
                    all.tell(id, normal.dot(side.normal) > 0.0);
                }
            }
        }
        all
    }

    /// Adds a mesh face.
    pub(super) fn tell(&mut self, face: FaceId, outward: bool) {
        self.told.entry(face).or_default()[usize::from(outward)] += 1;
    }

    /// Whether mesh faces have their outward normal with the CAD face's; `None` where none shows it, or both kinds are there.
    pub(super) fn outward(&self, face: FaceId) -> Option<bool> {
        told_by_most(*self.told.get(&face)?)
    }
}

/// Whether nearly all are with it, or against; `None` where both kinds are there.
pub(super) fn told_by_most([against, with]: [usize; 2]) -> Option<bool> {
    let share = with as f64 / (against + with) as f64;
    (share >= ONE_SIDE).then_some(true).or((share <= 1.0 - ONE_SIDE).then_some(false))
}
