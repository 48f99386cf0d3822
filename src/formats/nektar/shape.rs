//! The elements of Nektar++: their letters, and the corners of their faces.

use crate::element::Cell;

/// What Nektar++ says of one cell.
pub(super) struct Shape {
    pub(super) cell: Cell,
    /// The name of its elements in files.
    pub(super) letter: &'static str,
    /// Corners of its sides, in the order in which files list them; they are this program's corners. Those of the faces are in the order
    /// of Nektar++'s axes: it collapses a triangle's last corner.
    pub(super) sides: &'static [&'static [u8]],
}

static SHAPES: [Shape; 6] = [
    Shape { cell: Cell::Triangle, letter: "T", sides: &[&[0, 1], &[1, 2], &[2, 0]] },
    Shape { cell: Cell::Quad, letter: "Q", sides: &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]] },
    Shape { cell: Cell::Tet, letter: "A", sides: &[&[0, 1, 2], &[0, 1, 3], &[1, 2, 3], &[0, 2, 3]] },
    Shape { cell: Cell::Pyramid, letter: "P", sides: &[&[0, 1, 2, 3], &[0, 1, 4], &[1, 2, 4], &[3, 2, 4], &[0, 3, 4]] },
    // Its corners 0 to 5 are 0, 2, 5, 3, 1, 4 here: the collapsed edge is that from 1 to 4.
    Shape {
        cell: Cell::Prism,
        letter: "R",
        sides: &[&[0, 2, 5, 3], &[0, 2, 1], &[2, 5, 4, 1], &[3, 5, 4], &[0, 3, 4, 1]],
    },
    Shape {
        cell: Cell::Hex,
        letter: "H",
        sides: &[&[0, 1, 2, 3], &[0, 1, 5, 4], &[1, 2, 6, 5], &[3, 2, 6, 7], &[0, 3, 7, 4], &[4, 5, 6, 7]],
    },
];

/// What Nektar++ says of a cell; it has no points and lines here.
pub(super) fn of(cell: Cell) -> Option<&'static Shape> {
    SHAPES.iter().find(|shape| shape.cell == cell)
}

/// The shape of a letter.
pub(super) fn lettered(letter: &str) -> Option<&'static Shape> {
    SHAPES.iter().find(|shape| shape.letter == letter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn the_sides_are_those_of_the_cell() {
        let set = |corners: &[u8]| corners.iter().copied().collect::<BTreeSet<u8>>();
        for shape in &SHAPES {
            let own: BTreeSet<_> = shape.sides.iter().map(|side| set(side)).collect();
            let cells: BTreeSet<_> = shape.cell.sides().map(set).collect();
            assert_eq!(own, cells, "{}", shape.cell);
        }
    }
}
