//! Cells between the layers, conforming whatever their kind.
//!
//! Wherever a side of a column is cut into triangles, its diagonal runs from the lower end of the column with the larger
//! number to the upper end of the other.

use glam::DVec3;
use sagitta::element::Cell;

use crate::viscous_patches::case::Kind;
use crate::viscous_patches::wall::Grid;

/// How the space between two layers over a cell of the wall is filled.
#[derive(Clone, Copy, PartialEq)]
enum Filling {
    Hex,
    Prisms,
    Tets,
    /// A pyramid on the lower quadrilateral, its apex in the middle, and tets around it.
    Cap,
}

/// Cells and the points they stand on: those of the layers, then apices.
pub struct Cells {
    pub points: Vec<DVec3>,
    pub cells: Vec<(Cell, Vec<usize>)>,
}

impl Cells {
    /// Fills the layers; hexes and prisms end at the layer `transition` where something else follows.
    pub fn fill(kind: Kind, grid: &Grid, points: Vec<DVec3>, transition: usize) -> Cells {
        let layers = points.len() / grid.columns() - 1;
        let mut all = Cells { points, cells: Vec::new() };
        for layer in 0..layers {
            let filling = filling(kind, layer, transition);
            for (quad, triangles) in grid.quads() {
                all.add(filling, [layer, layer + 1].map(|k| k * grid.columns()), quad, triangles);
            }
        }
        all
    }

    fn add(&mut self, filling: Filling, [low, high]: [usize; 2], quad: [usize; 4], triangles: [[usize; 3]; 2]) {
        let both = |columns: &[usize]| [low, high].iter().flat_map(|k| columns.iter().map(move |c| c + k)).collect();
        match filling {
            Filling::Hex => self.cells.push((Cell::Hex, both(&quad))),
            Filling::Prisms => self.cells.extend(triangles.map(|t| (Cell::Prism, both(&t)))),
            Filling::Tets => triangles.into_iter().for_each(|t| self.tets([low, high], t)),
            Filling::Cap => self.cap([low, high], quad, triangles),
        }
    }

    /// A prism in three tets.
    fn tets(&mut self, [low, high]: [usize; 2], mut triangle: [usize; 3]) {
        triangle.sort_unstable();
        let [a, b, c] = triangle;
        self.tet([low + a, low + b, low + c, high + a]);
        self.tet([low + b, low + c, high + a, high + b]);
        self.tet([low + c, high + a, high + b, high + c]);
    }

    fn cap(&mut self, [low, high]: [usize; 2], quad: [usize; 4], triangles: [[usize; 3]; 2]) {
        let corners = [low, high].into_iter().flat_map(|k| quad.map(|c| c + k));
        let apex = self.points.len();
        self.points.push(corners.map(|n| self.points[n]).sum::<DVec3>() / 8.0);
        let base = quad.map(|c| low + c);
        self.cells.push((Cell::Pyramid, [&base[..], &[apex]].concat()));
        for k in 0..4 {
            let [p, q] = [quad[k], quad[(k + 1) % 4]];
            let (a, b) = (p.min(q), p.max(q));
            self.tet([low + a, low + b, high + a, apex]);
            self.tet([low + b, high + a, high + b, apex]);
        }
        triangles.into_iter().for_each(|[a, b, c]| self.tet([high + a, high + b, high + c, apex]));
    }

    /// A tet, turned so that its volume is positive.
    fn tet(&mut self, mut corners: [usize; 4]) {
        let [o, a, b, c] = corners.map(|n| self.points[n]);
        if (a - o).cross(b - o).dot(c - o) < 0.0 {
            corners.swap(0, 1);
        }
        self.cells.push((Cell::Tet, corners.to_vec()));
    }
}

fn filling(kind: Kind, layer: usize, transition: usize) -> Filling {
    match kind {
        Kind::Tets => Filling::Tets,
        Kind::Prisms => Filling::Prisms,
        Kind::Hexes => Filling::Hex,
        Kind::Pyramids if layer == transition => Filling::Cap,
        Kind::Pyramids if layer < transition => Filling::Hex,
        Kind::Hybrid if layer < transition => Filling::Prisms,
        Kind::Pyramids | Kind::Hybrid => Filling::Tets,
    }
}
