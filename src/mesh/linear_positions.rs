//! The linear mesh that a curved one was made from, matched by node numbers, or where these changed by the order of the cells.

use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::{Mesh, NodeId};
use crate::element::Cell;

/// Why a mesh is not the linear mesh of another.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotItsLinear {
    /// Their elements differ in number.
    #[error("it has {linear} {what}, the curved mesh has {curved}")]
    Count {
        /// Cells, or elements on the boundary.
        what: &'static str,
        /// Number in the linear mesh.
        linear: usize,
        /// Number in the curved mesh.
        curved: usize,
    },
    /// Neither the numbers of nodes nor the order of cells make the corners of the cells correspond.
    #[error("its {0} have other corners, by node numbers and by the order of the cells alike")]
    Corners(Cell),
}

/// Positions by the nodes of the curved mesh: at corners of cells those of the linear mesh's nodes that correspond, else its own.
///
/// # Errors
/// [`NotItsLinear`].
pub fn linear_positions(curved: &Mesh, linear: &Mesh) -> Result<Vec<DVec3>, NotItsLinear> {
    let counts = |mesh: &Mesh| [("cells", mesh.cells().len()), ("elements on the boundary", mesh.sides().len())];
    for ((what, curved), (_, linear)) in counts(curved).into_iter().zip(counts(linear)) {
        if curved != linear {
            return Err(NotItsLinear::Count { what, linear, curved });
        }
    }
    let numbers = by_numbers(curved, linear).ok_or(()).or_else(|()| by_order(curved, linear))?;
    let place = |(own, linear_node): (&DVec3, Option<NodeId>)| linear_node.map_or(*own, |n| linear.points()[n.index()]);
    Ok(curved.points().iter().zip(numbers).map(place).collect())
}

/// The linear mesh's node at each corner of the curved mesh's cells.
type Corresponding = Vec<Option<NodeId>>;

/// By node numbers; `None` where the cells then have not the same corners.
fn by_numbers(curved: &Mesh, linear: &Mesh) -> Option<Corresponding> {
    let of_number = |(node, &tag): (usize, &u64)| Some((tag, NodeId::new(node).ok()?));
    let by_tag: FxHashMap<u64, NodeId> = linear.node_tags().iter().enumerate().filter_map(of_number).collect();
    let cells: FxHashSet<Vec<NodeId>> = linear.cells().iter().map(|cell| sorted(cell.corners().to_vec())).collect();
    let mut corresponding = vec![None; curved.points().len()];
    for cell in curved.cells().iter() {
        let mut corners = Vec::new();
        for corner in cell.corners() {
            let node = *by_tag.get(&curved.node_tags()[corner.index()])?;
            corresponding[corner.index()] = Some(node);
            corners.push(node);
        }
        if !cells.contains(&sorted(corners)) {
            return None;
        }
    }
    Some(corresponding)
}

/// By the order of the cells of each kind, which writers keep that give nodes other numbers: corners correspond if each is the same node in all
/// cells.
fn by_order(curved: &Mesh, linear: &Mesh) -> Result<Corresponding, NotItsLinear> {
    let mut corresponding: Corresponding = vec![None; curved.points().len()];
    for kind in Cell::ALL.into_iter().filter(|kind| kind.dimension() == curved.dimension()) {
        let (ours, theirs) = (curved.elements_of(kind), linear.elements_of(kind));
        if ours.len() != theirs.len() {
            return Err(NotItsLinear::Count { what: kind.name(), linear: theirs.len(), curved: ours.len() });
        }
        for (own, other) in ours.iter().zip(theirs.iter()) {
            for (corner, &node) in own.corners().iter().zip(other.corners()) {
                if *corresponding[corner.index()].get_or_insert(node) != node {
                    return Err(NotItsLinear::Corners(kind));
                }
            }
        }
    }
    Ok(corresponding)
}

fn sorted(mut corners: Vec<NodeId>) -> Vec<NodeId> {
    corners.sort_unstable();
    corners
}
