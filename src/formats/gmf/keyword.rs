//! Keywords of GMF files: numbers in binary files, words in text.

use crate::element::{Cell, Order};

/// What a part of a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    Dimension,
    Vertices,
    Elements(Cell, Order),
    /// The order of the nodes of elements.
    Ordering(Cell, Order),
    /// Which vertices lie on which point (0), curve (1) or surface (2) of the geometry.
    OnGeometry(u8),
    Corners,
    BezierBasis,
    Precision,
    End,
    /// Counted rows that are of no use here.
    Unused(&'static str),
    /// Elements that cannot be read.
    Refused(&'static str),
}

/// The number of `Dimension`, which all binary files begin with.
pub(super) const DIMENSION: u32 = 3;

/// Keywords that are not of elements.
const OTHERS: [(i32, &str, Keyword); 19] = [
    (DIMENSION as i32, "Dimension", Keyword::Dimension),
    (4, "Vertices", Keyword::Vertices),
    (13, "Corners", Keyword::Corners),
    (14, "Ridges", Keyword::Unused("Ridges")),
    (15, "RequiredVertices", Keyword::Unused("RequiredVertices")),
    (16, "RequiredEdges", Keyword::Unused("RequiredEdges")),
    (17, "RequiredTriangles", Keyword::Unused("RequiredTriangles")),
    (18, "RequiredQuadrilaterals", Keyword::Unused("RequiredQuadrilaterals")),
    (40, "VerticesOnGeometricVertices", Keyword::OnGeometry(0)),
    (41, "VerticesOnGeometricEdges", Keyword::OnGeometry(1)),
    (42, "VerticesOnGeometricTriangles", Keyword::OnGeometry(2)),
    (46, "Polyhedra", Keyword::Refused("Polyhedra")),
    (54, "End", Keyword::End),
    (82, "PeriodicVertices", Keyword::Unused("PeriodicVertices")),
    (125, "BezierBasis", Keyword::BezierBasis),
    (155, "FloatingPointPrecision", Keyword::Precision),
    (200, "Prisms9", Keyword::Refused("Prisms9")),
    (201, "Hexahedra12", Keyword::Refused("Hexahedra12")),
    (207, "PolyhedraHeaders", Keyword::Refused("Polyhedra")),
];

/// Keywords of a cell, by order.
struct Kind {
    cell: Cell,
    stem: &'static str,
    /// `P`, or `Q` for products of lines.
    letter: char,
    elements: [i32; 4],
    orderings: [i32; 4],
}

const KINDS: [Kind; 7] = [
    Kind { cell: Cell::Line, stem: "Edges", letter: 'P', elements: [5, 25, 92, 93], orderings: [141, 127, 128, 142] },
    Kind {
        cell: Cell::Triangle,
        stem: "Triangles",
        letter: 'P',
        elements: [6, 24, 90, 91],
        orderings: [143, 129, 130, 144],
    },
    Kind {
        cell: Cell::Quad,
        stem: "Quadrilaterals",
        letter: 'Q',
        elements: [7, 27, 88, 89],
        orderings: [145, 131, 132, 146],
    },
    Kind {
        cell: Cell::Tet,
        stem: "Tetrahedra",
        letter: 'P',
        elements: [8, 30, 96, 97],
        orderings: [147, 133, 134, 148],
    },
    Kind {
        cell: Cell::Pyramid,
        stem: "Pyramids",
        letter: 'P',
        elements: [49, 87, 100, 101],
        orderings: [149, 135, 136, 150],
    },
    Kind {
        cell: Cell::Prism,
        stem: "Prisms",
        letter: 'P',
        elements: [9, 86, 102, 103],
        orderings: [151, 137, 138, 152],
    },
    Kind {
        cell: Cell::Hex,
        stem: "Hexahedra",
        letter: 'Q',
        elements: [10, 33, 98, 99],
        orderings: [153, 139, 140, 154],
    },
];

/// The cells that have keywords, in the order in which they are written.
pub(super) fn cells() -> impl Iterator<Item = Cell> {
    KINDS.iter().map(|kind| kind.cell)
}

/// Every keyword with its number and word.
fn all() -> impl Iterator<Item = (i32, String, Keyword)> {
    let elements = KINDS.iter().flat_map(|kind| {
        Order::all().flat_map(move |order| {
            let place = order.get() - 1;
            let suffix = format!("{}{}", kind.letter, order.get());
            let plain = if order == Order::LINEAR { kind.stem.to_owned() } else { format!("{}{suffix}", kind.stem) };
            [
                (kind.elements[place], plain, Keyword::Elements(kind.cell, order)),
                (kind.orderings[place], format!("{}{suffix}Ordering", kind.stem), Keyword::Ordering(kind.cell, order)),
            ]
        })
    });
    OTHERS.iter().map(|&(code, word, keyword)| (code, word.to_owned(), keyword)).chain(elements)
}

impl Keyword {
    /// The keyword of a number.
    pub(super) fn of_code(code: i32) -> Option<Keyword> {
        all().find(|(own, ..)| *own == code).map(|(.., keyword)| keyword)
    }

    /// The keyword of a word; older files call prisms pentahedra.
    pub(super) fn of_word(word: &str) -> Option<Keyword> {
        let word = word.replacen("Pentahedra", "Prisms", 1);
        all().find(|(_, own, _)| *own == word).map(|(.., keyword)| keyword)
    }

    /// Its number and word; those of `End` for keywords that are none.
    pub(super) fn names(self) -> (i32, String) {
        let end = || (54, "End".to_owned());
        all().find(|(.., own)| *own == self).map_or_else(end, |(code, word, _)| (code, word))
    }
}
