//! The keywords, by their names in text and their numbers in binary files (libMeshb 7).

use crate::element::{Cell, Order};

/// What a keyword says that is read or written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    Dimension,
    Vertices,
    Elements(Cell, Order),
    /// In which order the nodes of elements follow.
    Ordering(Cell, Order),
    /// Vertices on geometric entities of this dimension.
    OnGeometry(u8),
    End,
}

/// Numbers of the elements' keywords, and of those of their orderings, at P1 to P4, with the stem of their names.
const ELEMENTS: [(Cell, &str, [i32; 4], [i32; 4]); 7] = [
    (Cell::Line, "Edges", [5, 25, 92, 93], [141, 127, 128, 142]),
    (Cell::Triangle, "Triangles", [6, 24, 90, 91], [143, 129, 130, 144]),
    (Cell::Quad, "Quadrilaterals", [7, 27, 88, 89], [145, 131, 132, 146]),
    (Cell::Tet, "Tetrahedra", [8, 30, 96, 97], [147, 133, 134, 148]),
    (Cell::Pyramid, "Pyramids", [49, 87, 100, 101], [149, 135, 136, 150]),
    (Cell::Prism, "Prisms", [9, 86, 102, 103], [151, 137, 138, 152]),
    (Cell::Hex, "Hexahedra", [10, 33, 98, 99], [153, 139, 140, 154]),
];

/// The others, by name and number.
const OTHERS: [(Keyword, &str, i32); 6] = [
    (Keyword::Dimension, "Dimension", 3),
    (Keyword::Vertices, "Vertices", 4),
    (Keyword::OnGeometry(0), "VerticesOnGeometricVertices", 40),
    (Keyword::OnGeometry(1), "VerticesOnGeometricEdges", 41),
    (Keyword::OnGeometry(2), "VerticesOnGeometricTriangles", 42),
    (Keyword::End, "End", 54),
];

/// The cells in the order in which they are written.
pub(super) fn cells() -> impl Iterator<Item = Cell> {
    ELEMENTS.iter().map(|(cell, ..)| *cell)
}

impl Keyword {
    /// All keywords, with name and number.
    fn all() -> impl Iterator<Item = (Keyword, String, i32)> {
        let of_elements = ELEMENTS.iter().flat_map(|&(cell, stem, own, ordering)| {
            Order::all().zip(own.into_iter().zip(ordering)).flat_map(move |(order, (own, ordering))| {
                let name = named(cell, stem, order);
                let p1 = if order == Order::LINEAR { format!("{stem}{}1", letter(cell)) } else { name.clone() };
                let ordering = (Keyword::Ordering(cell, order), format!("{p1}Ordering"), ordering);
                [(Keyword::Elements(cell, order), name, own), ordering]
            })
        });
        of_elements.chain(OTHERS.iter().map(|&(keyword, name, code)| (keyword, name.to_owned(), code)))
    }

    /// The keyword of a name; older files call prisms pentahedra.
    pub(super) fn of_name(name: &str) -> Option<Keyword> {
        let name = name.replacen("Pentahedra", "Prisms", 1);
        Keyword::all().find(|(_, own, _)| *own == name).map(|(keyword, ..)| keyword)
    }

    /// The keyword of a number.
    pub(super) fn of_code(code: i64) -> Option<Keyword> {
        Keyword::all().find(|(.., own)| i64::from(*own) == code).map(|(keyword, ..)| keyword)
    }

    /// Its name.
    pub(super) fn name(self) -> String {
        Keyword::all().find(|(keyword, ..)| *keyword == self).map_or_else(String::new, |(_, name, _)| name)
    }

    /// Its number.
    pub(super) fn code(self) -> i32 {
        Keyword::all().find(|(keyword, ..)| *keyword == self).map_or(0, |(.., code)| code)
    }
}

/// `TrianglesP2`, `HexahedraQ3`; linear elements have no suffix.
fn named(cell: Cell, stem: &str, order: Order) -> String {
    if order == Order::LINEAR { stem.to_owned() } else { format!("{stem}{}{}", letter(cell), order.get()) }
}

/// Cells that are products of lines are Q, the others P.
fn letter(cell: Cell) -> char {
    if matches!(cell, Cell::Quad | Cell::Hex) { 'Q' } else { 'P' }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_each_of_one_keyword() {
        for (keyword, name, code) in Keyword::all() {
            assert_eq!(Keyword::of_name(&name), Some(keyword), "{name}");
            assert_eq!(Keyword::of_code(code.into()), Some(keyword), "{name}");
        }
        assert_eq!(Keyword::of_name("HexahedraQ3"), Keyword::of_code(98));
        assert_eq!(Keyword::of_name("Pentahedra"), Some(Keyword::Elements(Cell::Prism, Order::LINEAR)));
    }
}
