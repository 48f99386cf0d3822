//! The boundary faces of a mesh, by patch, each with the element behind it.

use std::collections::BTreeMap;

use cad::Aabb;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::element::{Cell, side_nodes};
use crate::mesh::{Element, ElementId, EntityKey, FaceKey, Mesh, NodeId};

/// A face that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// Triangle or quadrilateral.
    pub cell: Cell,
    /// Its nodes, in internal order.
    pub nodes: Vec<NodeId>,
    /// The cell behind it, or, in a mesh of faces, itself; nothing for a boundary element that is no side of any cell.
    pub element: Option<ElementId>,
    /// Its patch, by place in [`Surface::patches`].
    pub patch: usize,
}

/// The faces on one entity of the mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// The entity.
    pub entity: EntityKey,
    /// Its physical names, else its dimension and number.
    pub name: String,
    /// How many sides lie on it.
    pub count: usize,
    /// The box of its nodes.
    pub bounds: Aabb,
}

/// The faces that a mesh shows: the sides of its volumes that have a boundary element, of a mesh without any all sides of one cell alone, and
/// of a mesh of faces its cells.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The faces, patch by patch as the file has them.
    pub faces: Vec<Shown>,
    /// What they lie on; of a mesh of faces what its boundary lines lie on comes behind.
    pub patches: Vec<Patch>,
}

impl Patch {
    /// Its name, and its entity where that is another word: several patches may have one name.
    #[must_use]
    pub fn label(&self) -> String {
        let entity = self.entity.to_string();
        if self.name == entity { entity } else { format!("{} ({entity})", self.name) }
    }
}

impl Surface {
    /// The faces of a mesh.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Surface {
        let mut known = BTreeMap::new();
        let mut patches = Vec::new();
        let mut patch = |entity: EntityKey, nodes: &[NodeId]| {
            let place = *known.entry(entity).or_insert(patches.len());
            if place == patches.len() {
                patches.push(Patch { entity, name: mesh.label(entity), count: 0, bounds: Aabb::EMPTY });
            }
            let own: &mut Patch = &mut patches[place];
            own.count += 1;
            mesh.points_of(nodes).for_each(|x| own.bounds = own.bounds.with_point(x));
            place
        };
        let mut show = |own: Element| Shown {
            cell: own.cell,
            nodes: own.nodes.to_vec(),
            element: None,
            patch: patch(own.entity, own.nodes),
        };
        let mut faces: Vec<Shown>;
        if !mesh.is_volume() {
            let cells = mesh.cells();
            faces = cells.iter().filter(|own| own.cell.is_flat()).map(&mut show).collect();
            faces.iter_mut().zip(cells.ids()).for_each(|(face, id)| face.element = Some(id));
            mesh.sides().iter().for_each(|own| _ = patch(own.entity, own.nodes));
        } else if mesh.sides().is_empty() {
            faces = skin(mesh);
            faces.iter_mut().for_each(|face| face.patch = patch(EntityKey::unmarked(2), &face.nodes));
        } else {
            faces = mesh.sides().iter().map(&mut show).collect();
            find_cells(mesh, &mut faces);
        }
        Surface { faces, patches }
    }

    /// The patches of this name, or of an entity that is written so (`surface 3`, or its number alone); `None` where there is none.
    #[must_use]
    pub fn named(&self, wanted: &str) -> Option<Vec<usize>> {
        let is = |patch: &Patch| {
            let number = patch.entity.tag.to_string();
            patch.name == wanted || patch.entity.to_string() == wanted || number == wanted
        };
        let found: Vec<usize> = (0..self.patches.len()).filter(|&p| is(&self.patches[p])).collect();
        Some(found).filter(|found| !found.is_empty())
    }
}

/// Finds the cell behind each boundary element.
fn find_cells(mesh: &Mesh, faces: &mut [Shown]) {
    let corners = |face: &Shown| FaceKey::new(&face.nodes[..face.cell.corner_count()]);
    let places: FxHashMap<FaceKey, usize> =
        faces.iter().enumerate().map(|(place, face)| (corners(face), place)).collect();
    let of_cell = |own: Element| own.sides().filter_map(|side| Some((*places.get(&side)?, own.id))).collect::<Vec<_>>();
    let found: Vec<(usize, ElementId)> = mesh.cells().par_iter().flat_map_iter(of_cell).collect();
    found.into_iter().rev().for_each(|(place, id)| faces[place].element = Some(id));
}

/// The sides that one cell alone has.
fn skin(mesh: &Mesh) -> Vec<Shown> {
    let cells = mesh.cells();
    let of_cell =
        |own: Element| own.sides().enumerate().map(move |(side, key)| (key, own.id, side)).collect::<Vec<_>>();
    let mut sides: Vec<(FaceKey, ElementId, usize)> = cells.par_iter().flat_map_iter(of_cell).collect();
    sides.par_sort_unstable();
    let alone = sides.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0]);
    let shown = |(_, id, side): (FaceKey, ElementId, usize)| {
        let own = cells.get(id);
        let nodes: Vec<NodeId> = side_nodes(own.cell, mesh.order())[side].iter().map(|&n| own.nodes[n]).collect();
        let cell = own.cell.faces()[side].cell;
        Shown { cell, nodes, element: Some(id), patch: 0 }
    };
    let mut faces: Vec<Shown> = alone.map(shown).collect();
    faces.sort_by_key(|face| face.element);
    faces
}
