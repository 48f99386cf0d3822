//! The elements of MFEM: their numbers, and the order in which their edges and faces are counted (`fem/geom.cpp`).

use crate::element::Cell;

/// What MFEM says of one cell.
pub(in crate::formats) struct Geometry {
    pub(super) cell: Cell,
    /// Number in files.
    pub(super) code: u8,
    /// Corner pairs of the edges, in the order of counting.
    pub(in crate::formats) edges: &'static [[u8; 2]],
    /// Corner loops of the faces, in the order of counting; nodes inside a face are counted along the loop of the first element
    /// that has it.
    pub(in crate::formats) faces: &'static [&'static [u8]],
}

const fn flat(cell: Cell, code: u8, edges: &'static [[u8; 2]]) -> Geometry {
    Geometry { cell, code, edges, faces: &[] }
}

static GEOMETRIES: [Geometry; 8] = [
    flat(Cell::Point, 0, &[]),
    flat(Cell::Line, 1, &[[0, 1]]),
    flat(Cell::Triangle, 2, &[[0, 1], [1, 2], [2, 0]]),
    flat(Cell::Quad, 3, &[[0, 1], [1, 2], [2, 3], [3, 0]]),
    Geometry {
        cell: Cell::Tet,
        code: 4,
        edges: &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]],
        faces: &[&[1, 2, 3], &[0, 3, 2], &[0, 1, 3], &[0, 2, 1]],
    },
    Geometry {
        cell: Cell::Hex,
        code: 5,
        edges: &[[0, 1], [1, 2], [3, 2], [0, 3], [4, 5], [5, 6], [7, 6], [4, 7], [0, 4], [1, 5], [2, 6], [3, 7]],
        faces: &[&[3, 2, 1, 0], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7], &[4, 5, 6, 7]],
    },
    Geometry {
        cell: Cell::Prism,
        code: 6,
        edges: &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
        faces: &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
    },
    Geometry {
        cell: Cell::Pyramid,
        code: 7,
        edges: &[[0, 1], [1, 2], [3, 2], [0, 3], [0, 4], [1, 4], [2, 4], [3, 4]],
        faces: &[&[3, 2, 1, 0], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]],
    },
];

/// What MFEM says of a cell.
pub(in crate::formats) fn of(cell: Cell) -> &'static Geometry {
    // Every cell stands in the list; the first answers for what there is not.
    GEOMETRIES.iter().find(|own| own.cell == cell).unwrap_or(&GEOMETRIES[0])
}

/// The cell of a number.
pub(super) fn meaning(code: i64) -> Option<Cell> {
    GEOMETRIES.iter().find(|own| i64::from(own.code) == code).map(|own| own.cell)
}
