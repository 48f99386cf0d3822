//! Boundary patches: the boundary elements of one name.

use std::sync::Arc;

use cad::EntityId;
use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use rayon::prelude::*;
use sagitta::associate::Classification;
use sagitta::curve::Curved;
use sagitta::element::Cell;
use sagitta::mesh::{Block, EntityKey, NodeId};
use sagitta::report;

use crate::mesh::{Held, cell};
use crate::node_arrays::{self, NodeArray};

/// The boundary elements of one name; see `sagitta.Patch`.
#[pyclass(frozen)]
pub(crate) struct Patch {
    held: Arc<Held>,
    entities: Vec<EntityKey>,
}

impl Patch {
    /// The names of all patches of a mesh, in the order in which they stand there.
    pub(crate) fn names(held: &Held) -> Vec<String> {
        let mut names = Vec::new();
        for block in side_blocks(held) {
            for name in names_of(held, block.entity) {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        names
    }

    pub(crate) fn named(held: &Arc<Held>, name: &str) -> PyResult<Patch> {
        let mut entities: Vec<EntityKey> = side_blocks(held).iter().map(|block| block.entity).collect();
        entities.retain(|&entity| names_of(held, entity).iter().any(|own| own == name));
        entities.dedup();
        if entities.is_empty() {
            let known = Patch::names(held).join(", ");
            return Err(PyKeyError::new_err(format!("no patch is called {name:?}; there are: {known}")));
        }
        Ok(Patch { held: held.clone(), entities })
    }

    fn blocks(&self) -> impl Iterator<Item = &Block> {
        side_blocks(&self.held).into_iter().filter(|block| self.entities.contains(&block.entity))
    }

    fn kinds_of_cells(&self) -> Vec<Cell> {
        let mut kinds: Vec<Cell> = self.blocks().map(|block| block.cell).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds
    }

    /// Its faces as the boundary of the curving numbers them, in the sequence of [`Patch::nodes`], one kind after the other.
    fn faces(&self) -> PyResult<(&Curved, Vec<usize>)> {
        let curved = &self.held.curving()?.curved;
        let all = curved.boundary.faces.iter().enumerate();
        let mut own: Vec<_> = all.filter(|(_, face)| self.entities.contains(&face.entity)).collect();
        own.sort_by_key(|(_, face)| face.cell); // stable: the file's sequence within a kind
        Ok((curved, own.into_iter().map(|(face, _)| face).collect()))
    }
}

/// The blocks of boundary elements: those that a curving puts on CAD, else the sides of the cells.
fn side_blocks(held: &Held) -> Vec<&Block> {
    let mesh = held.mesh();
    let of_curving = held.curving().ok().and_then(|own| own.curved.boundary.faces.first());
    match of_curving {
        Some(face) => mesh.blocks().iter().filter(|own| own.cell.dimension() == face.cell.dimension()).collect(),
        None => mesh.side_blocks().collect(),
    }
}

/// The physical names of an entity; what stands for them where it has none.
fn names_of(held: &Held, entity: EntityKey) -> Vec<String> {
    let names = held.mesh().names_of(entity);
    if names.is_empty() { vec![entity.to_string()] } else { names }
}

#[pymethods]
impl Patch {
    /// Kinds of faces that there are.
    fn kinds(&self) -> Vec<&'static str> {
        self.kinds_of_cells().into_iter().map(Cell::name).collect()
    }

    /// Nodes of the faces of one kind, `(n, k)`.
    fn nodes<'py>(&self, py: Python<'py>, kind: &str, order: &str) -> PyResult<NodeArray<'py>> {
        let kind = cell(kind)?;
        let lists: Vec<&[NodeId]> = self.blocks().filter(|own| own.cell == kind).map(|own| &own.nodes[..]).collect();
        node_arrays::gathered(py, kind, self.held.mesh().order(), order, &lists)
    }

    /// The CAD entity that each face lies on; nothing where it is not associated with the CAD.
    fn cad_face(&self, py: Python<'_>) -> PyResult<Vec<Option<String>>> {
        let (curved, faces) = self.faces()?;
        let entities = py.detach(|| faces.par_iter().map(|&face| entity_of(curved, face)).collect::<Vec<_>>());
        Ok(entities.into_iter().map(|entity| entity.map(|own| own.to_string())).collect())
    }

    /// The largest distance of each face from its CAD; NaN where it is not associated with the CAD.
    fn distance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (curved, faces) = self.faces()?;
        let far = |&face: &usize| report::distance(curved, face).map_or(f64::NAN, |own| own.max);
        Ok(PyArray1::from_vec(py, py.detach(|| faces.par_iter().map(far).collect())))
    }
}

/// The CAD entity of a face: of several the one that is nearest to the middle of its corners.
fn entity_of(curved: &Curved, face: usize) -> Option<EntityId> {
    let Classification::Surface(surface) = curved.association.faces[face] else { return None };
    let group = &curved.association.surfaces[surface].group;
    match group.entities() {
        [only] => Some(*only),
        _ => {
            let corners = &curved.boundary.corners[face];
            let middle = curved.mesh.points_of(corners).sum::<glam::DVec3>() / corners.len() as f64;
            group.closest(middle, None).map(|foot| foot.entity)
        }
    }
}
