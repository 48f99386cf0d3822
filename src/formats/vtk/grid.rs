//! A mesh from the arrays of an unstructured grid.

use std::collections::BTreeMap;

use glam::DVec3;

use super::array::Values;
use super::fault::VtkFault;
use super::node_order::{BEFORE_21, ORDER};
use super::type_code::{self, Type};
use crate::formats::assembly::{Assembly, node_of};
use crate::formats::error::Fault;
use crate::mesh::{EntityKey, Mesh, NodeId};

/// Cell arrays that tell the entity of a cell, the most telling first: this program's and Gmsh's, then other programs'.
const ENTITY_ARRAYS: [&str; 7] =
    ["CellEntityIds", "gmsh:geometrical", "medit:ref", "attribute", "material", "gmsh:physical", "patch"];

/// Cell arrays that tell the physical group of a cell beside its entity.
const GROUP_ARRAYS: [&str; 2] = ["patch", "gmsh:physical"];

/// An unstructured grid as VTK files hold it.
#[derive(Debug, Default)]
pub(super) struct Grid {
    pub(super) points: Vec<f64>,
    pub(super) connectivity: Vec<i64>,
    /// End of each cell in the connectivity.
    pub(super) offsets: Vec<i64>,
    pub(super) types: Vec<i64>,
    /// Whole-number cell arrays of [`ENTITY_ARRAYS`] and [`GROUP_ARRAYS`].
    pub(super) arrays: BTreeMap<String, Vec<i64>>,
    /// Names of such arrays whose numbers are not all whole.
    pub(super) unusable: Vec<String>,
    /// Whether the file is of a version in which two edges of Lagrange hexes stood the other way round, where it says its version.
    pub(super) old_hexes: Option<bool>,
}

impl Grid {
    /// Whether a cell array is of use.
    pub(super) fn wants(name: &str) -> bool {
        ENTITY_ARRAYS.contains(&name) || GROUP_ARRAYS.contains(&name)
    }

    /// Takes a cell array of one component in, if it is of use; of several pieces of a file one behind the other.
    pub(super) fn take(&mut self, name: &str, values: Values) {
        if !Grid::wants(name) {
            return;
        }
        match values.whole() {
            Some(values) => self.arrays.entry(name.to_owned()).or_default().extend(values),
            None => self.unusable.push(name.to_owned()),
        }
    }

    /// Refuses arrays that do not fit each other, as they must where a piece ends.
    ///
    /// # Errors
    /// A [`Fault`] of their lengths.
    pub(super) fn compare(&self) -> Result<(), Fault> {
        let cells = self.types.len();
        if self.offsets.len() != cells {
            let (announced, found) = (cells as u64, self.offsets.len() as u64);
            return Err(Fault::Miscounted { what: "ends of cells", announced, found });
        }
        let last = self.offsets.last().copied().unwrap_or(0);
        if usize::try_from(last) != Ok(self.connectivity.len()) {
            let (announced, found) = (last.unsigned_abs(), self.connectivity.len() as u64);
            return Err(Fault::Miscounted { what: "nodes of cells", announced, found });
        }
        if !self.points.len().is_multiple_of(3) {
            return Err(Fault::Truncated("the points"));
        }
        for (name, values) in &self.arrays {
            if values.len() != cells && !self.unusable.contains(name) {
                return Err(VtkFault::ArrayLength { name: name.clone(), found: values.len(), cells }.into());
            }
        }
        Ok(())
    }

    /// The mesh.
    ///
    /// # Errors
    /// A [`Fault`] of the arrays.
    pub(super) fn mesh(mut self) -> Result<Mesh, Fault> {
        self.compare()?;
        let unusable = std::mem::take(&mut self.unusable);
        unusable.iter().for_each(|name| drop(self.arrays.remove(name)));
        let cells = self.types.len();
        let points = self.points.chunks_exact(3).map(DVec3::from_slice).collect();
        let mut assembly = Assembly::new(points)?;
        for name in unusable {
            assembly.parts.notes.push(format!("the cell array {name} is not used: not all of its numbers are whole"));
        }
        let whole = |name: &&str| self.arrays.get(*name);
        let entities = ENTITY_ARRAYS.iter().find_map(whole);
        let groups = GROUP_ARRAYS.iter().find_map(whole).or(entities);
        let mut tags: BTreeMap<EntityKey, Vec<i32>> = BTreeMap::new();
        let mut nodes = Vec::new();
        let mut start = 0;
        for n in 0..cells {
            let end = usize::try_from(self.offsets[n]).ok().filter(|&end| end >= start);
            let numbers = end.and_then(|end| self.connectivity.get(start..end));
            let Some(numbers) = numbers else {
                let (count, rest) = (self.offsets[n].unsigned_abs(), self.connectivity.len() as u64);
                return Err(Fault::Count { what: "nodes of cells", count, rest });
            };
            start += numbers.len();
            let tag = n as u64 + 1;
            let cell = self.cell(&mut assembly, self.types[n], numbers, tag, &mut nodes)?;
            let number = |values: Option<&Vec<i64>>| values.and_then(|values| i32::try_from(values[n]).ok());
            let entity = EntityKey::new(cell.dimension() as u8, number(entities).filter(|&tag| tag > 0).unwrap_or(1));
            let known = tags.entry(entity).or_default();
            if let Some(group) = number(groups).filter(|group| *group > 0 && !known.contains(group)) {
                known.push(group);
            }
            assembly.push_tagged(cell, entity, tag, &nodes);
        }
        tags.into_iter().for_each(|(key, tags)| assembly.entity(key, tags));
        if entities.is_none() {
            assembly
                .parts
                .notes
                .push("the file has no cell array that tells patches apart (CellEntityIds, ...)".into());
        }
        assembly.finish()
    }

    /// A cell's kind; its nodes in internal order go to `nodes`.
    fn cell(
        &self,
        assembly: &mut Assembly,
        code: i64,
        numbers: &[i64],
        tag: u64,
        nodes: &mut Vec<NodeId>,
    ) -> Result<crate::element::Cell, Fault> {
        let (cell, order) = match type_code::meaning(code, numbers.len()) {
            Type::Complete(cell, order) => (cell, order),
            Type::Incomplete => return Err(VtkFault::IncompleteCell { tag, code }.into()),
            Type::Count => return Err(VtkFault::CellNodes { tag, code, found: numbers.len() }.into()),
            Type::Unknown => return Err(VtkFault::UnknownCell { tag, code }.into()),
        };
        assembly.set_order(cell, order)?;
        // The order of VTK's quadratic cells is that of the Lagrange cells, and has been the same in all versions.
        let lagrange = i64::from(type_code::LAGRANGE_HEX) == code;
        let old = lagrange && self.old_hexes.ok_or(VtkFault::NoVersion { tag })?;
        let file_order = if old { &BEFORE_21 } else { &ORDER };
        let slots = file_order.slots(cell, order).unwrap_or_default();
        nodes.clear();
        nodes.resize(numbers.len(), NodeId::default());
        for (&slot, &number) in slots.iter().zip(numbers) {
            nodes[usize::from(slot)] = node_of(assembly.parts.points.len(), number, 0, tag)?;
        }
        Ok(cell)
    }
}
