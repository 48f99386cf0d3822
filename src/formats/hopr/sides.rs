//! The sides of elements, and who meets whom there.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use crate::element::Cell;
use crate::mesh::{Block, EntityKey, FaceKey, Mesh, NodeId, PhysicalName};

/// Corner loops of an element's sides in HOPR's order, which is that of CGNS; their normals point outward.
pub(super) fn loops(cell: Cell) -> &'static [&'static [u8]] {
    match cell {
        Cell::Tet => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
        Cell::Pyramid => &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]],
        Cell::Prism => &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5], &[0, 2, 1], &[3, 4, 5]],
        Cell::Hex => &[&[0, 3, 2, 1], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[0, 4, 7, 3], &[4, 5, 6, 7]],
        Cell::Point | Cell::Line | Cell::Triangle | Cell::Quad => &[],
    }
}

/// A side of an element.
pub(super) struct Side {
    /// Number of corners.
    pub(super) corners: usize,
    /// The number that both elements know it by, from 1; negative for the second of them.
    pub(super) number: i32,
    /// The neighbour, its side there, both from 1, and which corner of that side the first one here is; 0 for the first of the two.
    pub(super) neighbour: Option<[i32; 3]>,
    /// Place of its boundary condition.
    pub(super) condition: Option<usize>,
}

/// A boundary condition.
pub(super) struct Condition {
    pub(super) name: String,
    /// Type, index of the curve, of the state, of the periodic pair.
    pub(super) kind: [i32; 4],
}

/// All sides of a mesh, element by element, and their conditions.
pub(super) struct Sides {
    pub(super) all: Vec<Side>,
    pub(super) conditions: Vec<Condition>,
}

/// Type of a boundary that is nothing else: a wall, to be set by name in the solver's parameters.
const WALL: i32 = 4;
const PERIODIC: i32 = 1;
/// Type of sides between elements that have a name.
const INNER: i32 = 100;

/// A side that was met before.
struct Met {
    /// Place among all.
    place: usize,
    /// Element and side there, from 1.
    at: [i32; 2],
    corners: Vec<NodeId>,
}

/// The sides of a mesh.
///
/// # Errors
/// What is missing, and the remedy.
pub(super) fn of(mesh: &Mesh) -> Result<Sides, String> {
    let (mut conditions, by_face) = conditions(mesh);
    let images = images(mesh);
    let mut all: Vec<Side> = Vec::new();
    let mut met: FxHashMap<FaceKey, Met> = FxHashMap::default();
    let mut number = 0;
    for (n, cell) in mesh.cells().iter().enumerate() {
        for (m, own) in loops(cell.cell).iter().enumerate() {
            let corners: Vec<NodeId> = own.iter().map(|&corner| cell.nodes[usize::from(corner)]).collect();
            let condition = by_face.get(&FaceKey::new(&corners)).copied();
            // A side of a periodic pair meets the other where its corners' images are.
            let image: Option<Vec<NodeId>> = corners.iter().map(|corner| images.get(corner).copied()).collect();
            let is_pair =
                condition.is_some_and(|place| conditions[place].kind[0] == PERIODIC && conditions[place].kind[3] > 0);
            let meeting = image.filter(|_| is_pair).unwrap_or_else(|| corners.clone());
            let at = [n as i32 + 1, m as i32 + 1];
            let mut side = Side { corners: corners.len(), number: 0, neighbour: None, condition };
            if let Some(first) = met.remove(&FaceKey::new(&meeting)) {
                let flip =
                    first.corners.iter().position(|corner| *corner == meeting[0]).map_or(0, |place| place as i32 + 1);
                side.number = -all[first.place].number;
                side.neighbour = Some([first.at[0], first.at[1], flip]);
                all[first.place].neighbour = Some([at[0], at[1], 0]);
            } else {
                number += 1;
                side.number = number;
                met.insert(FaceKey::new(&meeting), Met { place: all.len(), at, corners: meeting });
            }
            all.push(side);
        }
    }
    complete(&all, &mut conditions)?;
    Ok(Sides { all, conditions })
}

/// Refuses sides without a neighbour and a condition; tells those between elements from those on the boundary.
fn complete(all: &[Side], conditions: &mut [Condition]) -> Result<(), String> {
    let bare = all.iter().filter(|side| side.neighbour.is_none() && side.condition.is_none()).count();
    if bare > 0 {
        return Err(format!("{bare} sides of the skin have no boundary element; --for flexi gives them one"));
    }
    let mut seen = vec![[0usize; 2]; conditions.len()];
    for side in all {
        if let Some(place) = side.condition {
            seen[place][usize::from(side.neighbour.is_some())] += 1;
        }
    }
    for (condition, [outer, inner]) in conditions.iter_mut().zip(seen) {
        let name = &condition.name;
        if condition.kind[0] == PERIODIC {
            if outer > 0 {
                return Err(format!("{outer} sides of the periodic patch {name} have no partner on the other"));
            }
        } else if inner > 0 && outer > 0 {
            return Err(format!(
                "{inner} sides of the patch {name} are between cells, {outer} on the boundary; part it"
            ));
        } else if inner > 0 {
            condition.kind[0] = INNER;
        }
    }
    Ok(())
}

/// The conditions, one a name, and which of them each boundary element has.
fn conditions(mesh: &Mesh) -> (Vec<Condition>, FxHashMap<FaceKey, usize>) {
    let mut conditions: Vec<Condition> = Vec::new();
    let mut by_face = FxHashMap::default();
    let mut pairs: BTreeMap<EntityKey, i32> = BTreeMap::new();
    for (n, link) in mesh.periodic().iter().filter(|link| usize::from(link.slave.dimension) == 2).enumerate() {
        pairs.insert(link.slave, n as i32 + 1);
        pairs.insert(EntityKey { tag: link.master, ..link.slave }, -(n as i32) - 1);
    }
    for block in mesh.side_blocks() {
        let name = name(mesh, block);
        let kind = pairs.get(&block.entity).map_or([WALL, 0, 0, 0], |&pair| [PERIODIC, 0, 0, pair]);
        let known = conditions.iter().position(|own| own.name == name && own.kind == kind);
        let place = known.unwrap_or_else(|| {
            // Both patches of a pair may have one name.
            let taken = conditions.iter().any(|own| own.name == name);
            let name = if taken { format!("{name}_{}", block.entity.tag) } else { name };
            conditions.push(Condition { name, kind });
            conditions.len() - 1
        });
        let corners = block.cell.corner_count();
        by_face.extend(block.elements(mesh.order()).map(|nodes| (FaceKey::new(&nodes[..corners]), place)));
    }
    (conditions, by_face)
}

/// The node that each node of a periodic slave follows.
fn images(mesh: &Mesh) -> FxHashMap<NodeId, NodeId> {
    let links = mesh.periodic().iter().filter(|link| usize::from(link.slave.dimension) == 2);
    links.flat_map(|link| link.pairs.iter().copied()).collect()
}

/// The name of the first group of a block's elements, else of its entity.
fn name(mesh: &Mesh, block: &Block) -> String {
    let tag = block.physical_tags.first().copied().or_else(|| mesh.physical_tags_of(block.entity).first().copied());
    let is =
        |own: &&PhysicalName| own.dimension == block.entity.dimension && Some(own.tag) == tag.map(i32::saturating_abs);
    let known = mesh.physical_names().iter().find(is).map(|own| own.name.clone());
    known.unwrap_or_else(|| block.entity.to_string().replace(' ', "_"))
}
