//! Numbers and names by which file formats call the elements.

use super::{Cell, Order};

/// Gmsh's number of the complete element: `[P1, P2, P3, P4]`, in the order of [`Cell::ALL`].
const GMSH: [[i32; 4]; 8] = [
    [15; 4],
    [1, 8, 26, 27],
    [2, 9, 21, 23],
    [3, 10, 36, 37],
    [4, 11, 29, 30],
    [7, 14, 118, 119],
    [6, 13, 90, 91],
    [5, 12, 92, 93],
];

/// Gmsh's numbers of elements that leave out interior nodes.
const GMSH_INCOMPLETE: [i32; 17] = [16, 39, 40, 20, 22, 24, 137, 32, 19, 125, 126, 18, 111, 112, 17, 99, 100];

/// CGNS' number of the complete element, in the order of [`Cell::ALL`] (`cgnslib.h`).
const CGNS: [[i32; 4]; 8] = [
    [2; 4],
    [3, 4, 24, 40],
    [5, 6, 26, 42],
    [7, 9, 28, 44],
    [10, 11, 30, 47],
    [12, 13, 33, 50],
    [14, 16, 36, 53],
    [17, 19, 39, 56],
];

/// What a Gmsh element number stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GmshType {
    /// An element with all nodes of its lattice.
    Complete(Cell, Order),
    /// An element that leaves out interior nodes (serendipity).
    Incomplete,
    /// An element of order 5 to 10.
    TooHigh,
}

/// Gmsh's number of an element.
#[must_use]
pub fn gmsh(cell: Cell, order: Order) -> i32 {
    GMSH[cell as usize][order.get() - 1]
}

/// What a Gmsh element number stands for; `None` where it is no element that could be curved (polygons, ...).
#[must_use]
pub fn from_gmsh(code: i32) -> Option<GmshType> {
    for cell in Cell::ALL {
        if let Some(order) = Order::all().find(|&order| gmsh(cell, order) == code) {
            return Some(GmshType::Complete(cell, order));
        }
    }
    if GMSH_INCOMPLETE.contains(&code) {
        return Some(GmshType::Incomplete);
    }
    // Line, triangle, quadrilateral, tet, hex, prism, pyramid of order 5, and of order 6 to 10 (GmshDefines.h).
    let high =
        matches!(code, 28 | 62..=66 | 25 | 42..=46 | 38 | 47..=51 | 31 | 71..=75 | 94..=98 | 106..=110 | 120..=124);
    high.then_some(GmshType::TooHigh)
}

/// CGNS' `ElementType_t` number of an element.
#[must_use]
pub fn cgns(cell: Cell, order: Order) -> i32 {
    CGNS[cell as usize][order.get() - 1]
}

/// What a CGNS `ElementType_t` number stands for, where it is a complete element.
#[must_use]
pub fn from_cgns(code: i32) -> Option<(Cell, Order)> {
    Cell::ALL.into_iter().flat_map(|cell| Order::all().map(move |p| (cell, p))).find(|&(cell, p)| cgns(cell, p) == code)
}

/// CGNS' name of an element: `TETRA_10`, ...
#[must_use]
pub fn cgns_name(cell: Cell, order: Order) -> String {
    let stem = match cell {
        Cell::Point => return "NODE".into(),
        Cell::Line => "BAR",
        Cell::Triangle => "TRI",
        Cell::Quad => "QUAD",
        Cell::Tet => "TETRA",
        Cell::Pyramid => "PYRA",
        Cell::Prism => "PENTA",
        Cell::Hex => "HEXA",
    };
    format!("{stem}_{}", cell.node_count(order))
}

/// VTK's number of the Lagrange hex, which stands for the pyramids that VTK lacks.
pub const VTK_LAGRANGE_HEX: u8 = 72;

/// VTK's number of an element; `None` for pyramids beyond the linear one, which VTK lacks.
///
/// Linear elements are the classic ones, except the prism: which way VTK's own wedge points has changed between
/// versions, and the Lagrange wedge's has not.
#[must_use]
pub fn vtk(cell: Cell, order: Order) -> Option<u8> {
    let linear = order == Order::LINEAR;
    match cell {
        Cell::Point => Some(1),
        Cell::Line => Some(if linear { 3 } else { 68 }),
        Cell::Triangle => Some(if linear { 5 } else { 69 }),
        Cell::Quad => Some(if linear { 9 } else { 70 }),
        Cell::Tet => Some(if linear { 10 } else { 71 }),
        Cell::Hex => Some(if linear { 12 } else { VTK_LAGRANGE_HEX }),
        Cell::Prism => Some(73),
        Cell::Pyramid => linear.then_some(14),
    }
}

/// What a VTK cell type with a number of nodes stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VtkType {
    /// A cell with all nodes of its lattice, in the order of VTK's Lagrange cells.
    Complete(Cell, Order),
    /// A cell that leaves out interior nodes, or has nodes that no lattice has.
    Incomplete,
    /// A cell of a known type with a number of nodes that none of its orders has.
    Count,
    /// No cell that could be curved.
    Unknown,
}

/// What a VTK cell type stands for. The complete quadratic cells have the order of the Lagrange cells of order 2.
#[must_use]
pub fn from_vtk(code: i64, nodes: usize) -> VtkType {
    let cell = match code {
        1 => Cell::Point,
        3 | 21 | 68 => Cell::Line,
        5 | 22 | 69 => Cell::Triangle,
        9 | 28 | 70 => Cell::Quad,
        10 | 24 | 71 => Cell::Tet,
        14 => Cell::Pyramid,
        13 | 32 | 73 => Cell::Prism,
        12 | 29 | 72 => Cell::Hex,
        23 | 25 | 26 | 27 | 30 | 31 | 33..=37 | 74 => return VtkType::Incomplete,
        _ => return VtkType::Unknown,
    };
    let fixed = match code {
        1 | 3 | 5 | 9 | 10 | 12 | 13 | 14 => Some(1),
        21 | 22 | 24 | 28 | 29 | 32 => Some(2),
        _ => None,
    };
    let fits = |order: &Order| fixed.is_none_or(|p| order.get() == p) && cell.node_count(*order) == nodes;
    Order::all().find(fits).map_or(VtkType::Count, |order| VtkType::Complete(cell, order))
}
