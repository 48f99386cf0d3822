//! What the point indices of a linkage file mean: MeshLink counts the points of each zone of a mesh file apart.

use rustc_hash::FxHashMap;

use crate::mesh::{Mesh, NodeId, Zone};

/// The points that one mesh model of a linkage file counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    /// All of the mesh, by the file's node numbers.
    #[default]
    Whole,
    /// A zone, by its place in [`Mesh::zones`].
    Zone(usize),
}

/// A mesh model that is called as no zone of the mesh file is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "mesh model {reference:?} is not a zone of the mesh file, which has {zones}; give the model the name of the zone whose points it counts"
)]
pub struct UnknownZone {
    reference: String,
    zones: String,
}

/// Nodes by the numbers that a linkage file gives them, and back.
#[derive(Debug)]
pub struct Numbering<'a> {
    mesh: &'a Mesh,
    by_tag: FxHashMap<u64, NodeId>,
    /// Each zone's own number of its nodes.
    in_zone: Vec<FxHashMap<NodeId, u64>>,
}

impl<'a> Numbering<'a> {
    /// The numbers of a mesh.
    #[must_use]
    pub fn new(mesh: &'a Mesh) -> Numbering<'a> {
        let by_tag =
            mesh.node_tags().iter().zip(0..).filter_map(|(&tag, n)| Some((tag, NodeId::new(n).ok()?))).collect();
        let numbers = |zone: &Zone| {
            let mut numbers = FxHashMap::default();
            zone.nodes.iter().zip(1..).for_each(|(&node, number)| {
                // Of two points that are one node the first stands for both.
                numbers.entry(node).or_insert(number);
            });
            numbers
        };
        Numbering { mesh, by_tag, in_zone: mesh.zones().iter().map(numbers).collect() }
    }

    /// The points that a mesh model of this reference counts: `/Base/zone`, or the zone's name alone.
    ///
    /// # Errors
    /// [`UnknownZone`]. A mesh file that has no zones, or one, leaves nothing to tell apart: any reference will do.
    pub fn part(&self, reference: &str) -> Result<Part, UnknownZone> {
        let zones = self.mesh.zones();
        let last = |path: &str| path.trim().rsplit('/').next().unwrap_or_default().to_owned();
        let whole = zones.iter().position(|zone| zone.name == reference.trim());
        let mut alike = (0..zones.len()).filter(|&z| last(&zones[z].name) == last(reference));
        match (zones.len(), whole.or_else(|| alike.next().filter(|_| alike.next().is_none()))) {
            (0, _) => Ok(Part::Whole),
            (1, _) => Ok(Part::Zone(0)),
            (_, Some(zone)) => Ok(Part::Zone(zone)),
            (_, None) => {
                let zones = zones.iter().map(|zone| &zone.name[..]).collect::<Vec<_>>().join(", ");
                Err(UnknownZone { reference: reference.to_owned(), zones })
            }
        }
    }

    /// The node of an index.
    #[must_use]
    pub fn node(&self, part: Part, index: u64) -> Option<NodeId> {
        match part {
            Part::Whole => self.by_tag.get(&index).copied(),
            Part::Zone(zone) => {
                let place = usize::try_from(index.checked_sub(1)?).ok()?;
                self.mesh.zones()[zone].nodes.get(place).copied()
            }
        }
    }

    /// The index of a node; `None` where it is no node of that zone.
    #[must_use]
    pub fn index(&self, part: Part, node: NodeId) -> Option<u64> {
        match part {
            Part::Whole => Some(self.mesh.node_tags()[node.index()]),
            Part::Zone(zone) => self.in_zone[zone].get(&node).copied(),
        }
    }

    /// The largest index.
    #[must_use]
    pub fn last(&self, part: Part) -> u64 {
        match part {
            Part::Whole => self.mesh.node_tags().iter().copied().max().unwrap_or(0),
            Part::Zone(zone) => self.mesh.zones()[zone].nodes.len() as u64,
        }
    }

    /// The parts that together are the mesh: its zones, or the whole.
    pub fn parts(&self) -> impl Iterator<Item = Part> + use<> {
        let zones = self.mesh.zones().len();
        (0..zones).map(Part::Zone).chain((zones == 0).then_some(Part::Whole))
    }

    /// How a mesh model of a part is called: by its zone, or `volume`.
    #[must_use]
    pub fn reference(&self, part: Part) -> &'a str {
        match part {
            Part::Whole => "volume",
            Part::Zone(zone) => &self.mesh.zones()[zone].name,
        }
    }
}
