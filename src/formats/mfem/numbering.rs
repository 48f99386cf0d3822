//! How MFEM numbers the values of a continuous space of order p on a mesh: by vertex, edge, face and element.
//!
//! Edges and faces are counted when an element first has them, in the order of its geometry. The values inside an edge run from
//! its smaller vertex on; those inside a face row by row along the loop of the first element that has it
//! (`Mesh::GetElementToEdgeTable`, `Mesh::GetElementToFaceTable`, `FiniteElementSpace::GetElementDofs`).

use std::collections::hash_map::Entry;

use rustc_hash::FxHashMap;

use super::geometry;
use crate::element::{Cell, InteriorSlots, Order, Tables, interior_count, interior_start, lattice};
use crate::mesh::{FaceKey, NodeId};

/// The numbering of a mesh of one order.
pub(super) struct Numbering {
    order: Order,
    edges: FxHashMap<[NodeId; 2], usize>,
    faces: FxHashMap<FaceKey, Face>,
    /// Values before those of edges, faces and elements.
    starts: [usize; 3],
    /// Values of the elements before each, and of all.
    inner: Vec<usize>,
    tables: [Table; 2],
}

/// A face as the first element that has it sees it.
struct Face {
    /// Values of the faces counted before.
    first: usize,
    corners: [NodeId; 4],
}

/// What is needed of triangles and quadrilaterals.
struct Table {
    cell: Cell,
    slots: InteriorSlots,
    /// For each node inside, in internal order, its place row by row.
    rows: &'static [usize],
}

/// For each node inside a cell, in internal order, its place among them row by row, the first axis fastest.
fn rows(cell: Cell, order: Order) -> &'static [usize] {
    static TABLES: Tables<Vec<usize>> = Tables::new();
    TABLES.get(cell, order, || ranks(&lattice(cell, order)[interior_start(cell, order)..]))
}

/// For each node of a cell, in internal order, its place row by row.
pub(super) fn all_rows(cell: Cell, order: Order) -> &'static [usize] {
    static TABLES: Tables<Vec<usize>> = Tables::new();
    TABLES.get(cell, order, || ranks(lattice(cell, order)))
}

/// The place of each point among all, row by row.
fn ranks(points: &[[u8; 3]]) -> Vec<usize> {
    let key = |&[i, j, k]: &[u8; 3]| [k, j, i];
    points.iter().map(|at| points.iter().filter(|other| key(other) < key(at)).count()).collect()
}

fn ends(a: NodeId, b: NodeId) -> [NodeId; 2] {
    if a < b { [a, b] } else { [b, a] }
}

impl Numbering {
    /// The numbering of elements given by their corners, of `vertices` vertices.
    pub(super) fn new<'a>(
        order: Order,
        vertices: usize,
        elements: impl Iterator<Item = (Cell, &'a [NodeId])>,
    ) -> Numbering {
        let table = |cell| Table { cell, slots: InteriorSlots::new(cell, order), rows: rows(cell, order) };
        let (mut edges, mut faces): (FxHashMap<_, usize>, FxHashMap<_, Face>) = Default::default();
        let (mut in_faces, mut inner) = (0, vec![0]);
        let mut last = 0;
        for (cell, corners) in elements {
            let own = geometry::of(cell);
            let at = |corner: &u8| corners[usize::from(*corner)];
            for [a, b] in own.edges {
                let next = edges.len();
                edges.entry(ends(at(a), at(b))).or_insert(next);
            }
            for face in own.faces {
                let mut loop_of = [NodeId::NONE; 4];
                loop_of.iter_mut().zip(*face).for_each(|(slot, corner)| *slot = at(corner));
                if let Entry::Vacant(place) = faces.entry(FaceKey::new(&loop_of[..face.len()])) {
                    place.insert(Face { first: in_faces, corners: loop_of });
                    in_faces += interior_count(shape(face.len()), order);
                }
            }
            last += interior_count(cell, order);
            inner.push(last);
        }
        let of_edges = vertices + edges.len() * (order.get() - 1);
        let starts = [vertices, of_edges, of_edges + in_faces];
        Numbering { order, edges, faces, starts, inner, tables: [table(Cell::Triangle), table(Cell::Quad)] }
    }

    /// Number of all values.
    pub(super) fn count(&self) -> usize {
        self.starts[2] + self.inner.last().copied().unwrap_or(0)
    }

    /// The values of the element at a place among all, in internal node order.
    pub(super) fn element(&self, place: usize, cell: Cell, corners: &[NodeId], values: &mut Vec<usize>) {
        self.begin(cell, corners, values);
        if cell.dimension() == 3 {
            for face in cell.faces() {
                let mut own = [NodeId::NONE; 4];
                own.iter_mut().zip(face.corners).for_each(|(slot, &corner)| *slot = corners[usize::from(corner)]);
                self.face(&own[..face.corners.len()], values);
            }
        }
        let start = self.starts[2] + self.inner[place];
        values.extend(rows(cell, self.order).iter().map(|row| start + row));
    }

    /// The values of a side of elements, in internal node order; `false` where it is no side of any.
    pub(super) fn side(&self, cell: Cell, corners: &[NodeId], values: &mut Vec<usize>) -> bool {
        let known = match corners {
            &[a, b] => self.edges.contains_key(&ends(a, b)),
            _ => self.faces.contains_key(&FaceKey::new(corners)),
        };
        if known {
            self.begin(cell, corners, values);
            if cell.dimension() == 2 {
                self.face(corners, values);
            }
        }
        known
    }

    /// The values at corners and on edges.
    fn begin(&self, cell: Cell, corners: &[NodeId], values: &mut Vec<usize>) {
        values.clear();
        values.extend(corners.iter().map(|corner| corner.index()));
        let inside = self.order.get() - 1;
        for &[a, b] in cell.edges() {
            let (a, b) = (corners[usize::from(a)], corners[usize::from(b)]);
            let start = self.starts[0] + self.edges.get(&ends(a, b)).copied().unwrap_or(0) * inside;
            values.extend((0..inside).map(|step| start + if a < b { step } else { inside - 1 - step }));
        }
    }

    /// The values inside a face, in the internal order of the face with these corners.
    fn face(&self, corners: &[NodeId], values: &mut Vec<usize>) {
        let Some(known) = self.faces.get(&FaceKey::new(corners)) else { return };
        let place = |corner: &NodeId| corners.iter().position(|own| own == corner).unwrap_or(0) as u8;
        let mut seen = [0; 4];
        seen.iter_mut().zip(&known.corners[..corners.len()]).for_each(|(slot, corner)| *slot = place(corner));
        let table = &self.tables[corners.len() - 3];
        debug_assert_eq!(table.cell, shape(corners.len()));
        let start = self.starts[1] + known.first;
        values.extend(table.slots.of(seen).iter().map(|&slot| start + table.rows[slot]));
    }
}

fn shape(corners: usize) -> Cell {
    if corners == 3 { Cell::Triangle } else { Cell::Quad }
}
