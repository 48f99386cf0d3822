//! A mesh as a linkage file speaks of it: by numbers, which may be off by one or another mesh's.

use linkage_schema::{Code, Findings, MeshModel, ModelLinks};

use crate::associate::{Numbering, Part, Side};
use crate::mesh::{Boundary, Mesh, NodeId};

/// Less than this fraction of the linked faces in the mesh: it is another mesh, or the numbers count from elsewhere.
const OTHER: f64 = 0.5;
/// At least this fraction of them in it after all numbers are moved by one: that is what is wrong.
const MOVED: f64 = 0.9;

/// A mesh, and what the numbers of one model of a linkage file mean in it.
#[derive(Clone, Copy)]
pub(super) struct LinkedMesh<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) boundary: &'a Boundary,
    pub(super) sides: &'a [Side],
    numbering: &'a Numbering<'a>,
    /// The zone whose points the model counts.
    part: Part,
    /// What is added to the file's numbers, where they count from another base.
    shift: i64,
}

impl<'a> LinkedMesh<'a> {
    /// Finds out what base the file counts from. `None`, with a finding, where the mesh is another than the file's.
    pub(super) fn new(
        mesh: &'a Mesh,
        boundary: &'a Boundary,
        sides: &'a [Side],
        numbering: &'a Numbering<'a>,
        models: &[&ModelLinks<'_>],
        findings: &mut Findings,
    ) -> Option<LinkedMesh<'a>> {
        let mut linked = LinkedMesh { mesh, boundary, sides, numbering, part: Part::Whole, shift: 0 };
        let Some(first) = models.first() else { return Some(linked) };
        let share = linked.share(models, 0);
        if share >= OTHER {
            return Some(linked);
        }
        if let Some(shift) = [1, -1].into_iter().find(|&shift| linked.share(models, shift) >= MOVED) {
            findings.push(Code::IndexBase, first.model.origin, || {
                let (from, move_by) = if shift > 0 { (0, "larger") } else { (2, "smaller") };
                format!(
                    "the file counts points from {from}: with every index one {move_by}, its faces match those of the mesh"
                )
            });
            linked.shift = shift;
            return Some(linked);
        }
        findings.push(Code::OtherMesh, first.model.origin, || {
            format!(
                "only {:.0} % of the linked faces are boundary faces of the mesh, whose node numbers go up to {}",
                100.0 * share,
                linked.within(first.model).last()
            )
        });
        None
    }

    /// The share of linked faces, or of linked edges where there are no faces, that the boundary has when all indices are shifted; 1 where
    /// nothing is linked.
    fn share(&self, models: &[&ModelLinks<'_>], shift: i64) -> f64 {
        let (mut all, mut found) = (0_usize, 0_usize);
        for links in models {
            let own = self.within(links.model);
            for face in links.sheets.iter().flat_map(|sheet| &sheet.faces).flat_map(|link| link.run.faces()) {
                all += 1;
                found += usize::from(own.face_shifted(face, shift).is_some());
            }
        }
        if all > 0 {
            return found as f64 / all as f64;
        }
        for links in models {
            let own = self.within(links.model);
            for edge in links.strings.iter().flat_map(|string| &string.edges).flat_map(|link| link.run.edges()) {
                all += 1;
                let ends = edge.map(|index| own.node_shifted(index, shift));
                found += usize::from(matches!(ends, [Some(a), Some(b)] if self.boundary.edge([a, b]).is_some()));
            }
        }
        if all == 0 { 1.0 } else { found as f64 / all as f64 }
    }

    /// The same mesh as another model counts it; the models of unknown zones are left out before.
    pub(super) fn within(self, model: &MeshModel) -> LinkedMesh<'a> {
        LinkedMesh { part: self.numbering.part(&model.reference).unwrap_or_default(), ..self }
    }

    /// The largest number of a node.
    pub(super) fn last(&self) -> u64 {
        self.numbering.last(self.part)
    }

    fn node_shifted(&self, index: u32, shift: i64) -> Option<NodeId> {
        self.numbering.node(self.part, u64::try_from(i64::from(index) + shift).ok()?)
    }

    fn face_shifted(&self, face: &[u32], shift: i64) -> Option<usize> {
        let nodes: Option<Vec<NodeId>> = face.iter().map(|&index| self.node_shifted(index, shift)).collect();
        self.boundary.face(&nodes?)
    }

    /// The node of an index.
    pub(super) fn node(&self, index: u32) -> Option<NodeId> {
        self.node_shifted(index, self.shift)
    }

    /// The boundary face with these corners.
    pub(super) fn face(&self, face: &[u32]) -> Option<usize> {
        self.face_shifted(face, self.shift)
    }

    /// The edge of a boundary face with these ends.
    pub(super) fn edge(&self, ends: [u32; 2]) -> Option<usize> {
        match ends.map(|index| self.node(index)) {
            [Some(a), Some(b)] => self.boundary.edge([a, b]),
            _ => None,
        }
    }

    /// The nodes of indices, each once, ascending; those that the mesh lacks are left out.
    pub(super) fn nodes(&self, indices: impl IntoIterator<Item = u32>) -> Vec<NodeId> {
        let mut nodes: Vec<NodeId> = indices.into_iter().filter_map(|index| self.node(index)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The file's number of a node, in messages.
    pub(super) fn tag(&self, node: NodeId) -> u64 {
        self.numbering.index(self.part, node).unwrap_or_else(|| self.mesh.node_tags()[node.index()])
    }
}
