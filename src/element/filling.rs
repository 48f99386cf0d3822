//! Linear simplices that fill a cell, at any number of divisions an edge: what is drawn, and cut by planes, in its place.

use std::collections::HashMap;

use super::cell::lattice_points;
use super::{Cell, Order, basis, bernstein};

/// A cell filled by linear simplices of its own dimension.
#[derive(Clone, Debug)]
pub struct Filling {
    cell: Cell,
    /// The points, equispaced in the unit cell.
    points: Vec<[f64; 3]>,
    /// The simplices, by their points: as many of them as the cell has dimensions, and one.
    simplices: Vec<Vec<u16>>,
    /// For each simplex and each of its points, whether the side opposite the point lies on a side of the cell.
    outside: Vec<Vec<bool>>,
    /// For each edge of the cell, the points on it from end to end.
    edges: Vec<Vec<u16>>,
}

impl Filling {
    /// The filling of a cell with `divisions` (1 to 16) on each edge.
    ///
    /// Cubes fall into simplices along one diagonal each (Kuhn). In coordinates in which the sides of the cell are among the planes of that
    /// partition, every simplex is either wholly inside or wholly outside.
    #[must_use]
    pub fn new(cell: Cell, divisions: usize) -> Filling {
        let n = divisions.clamp(1, 16);
        let lattice: Vec<[usize; 3]> = lattice_points(cell, n).collect();
        let places: HashMap<[usize; 3], u16> = lattice.iter().zip(0..).map(|(&at, place)| (at, place)).collect();
        let mut simplices: Vec<Vec<u16>> = Vec::new();
        for base in lattice_points(Cell::Hex, n - 1).filter(|at| at[cell.dimension()..].iter().all(|&x| x == 0)) {
            for way in ways(cell.dimension()) {
                let mut at = base;
                let corners = std::iter::once(None).chain(way.iter().map(|&axis| Some(axis)));
                let places = corners.map(|axis| {
                    axis.into_iter().for_each(|axis: usize| at[axis] += 1);
                    places.get(&upright(cell, at)).copied()
                });
                let own = places.collect::<Option<Vec<u16>>>();
                simplices.extend(own.map(|mut own| {
                    if is_odd(way) {
                        own.swap(cell.dimension() - 1, cell.dimension()); // all turn the same way round
                    }
                    own
                }));
            }
        }
        let outside = outside(&simplices);
        let on_edge = |&[a, b]: &[u8; 2]| {
            let [a, b] = [a, b].map(|q| cell.corners()[usize::from(q)].map(usize::from));
            let at = |step: usize| std::array::from_fn(|k| a[k] * (n - step) + b[k] * step);
            (0..=n).filter_map(|step| places.get(&at(step)).copied()).collect()
        };
        let edges = cell.edges().iter().map(on_edge).collect();
        let points = lattice.iter().map(|at| at.map(|x| x as f64 / n as f64)).collect();
        Filling { cell, points, simplices, outside, edges }
    }

    /// The points, in coordinates of the unit cell.
    #[must_use]
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The simplices by their points, each with what tells, for each of its points, whether the side opposite it lies on a side of the cell.
    pub fn simplices(&self) -> impl ExactSizeIterator<Item = (&[u16], &[bool])> {
        self.simplices.iter().map(Vec::as_slice).zip(self.outside.iter().map(Vec::as_slice))
    }

    /// For each edge of the cell, in the order of [`Cell::edges`], the points on it from end to end.
    #[must_use]
    pub fn edges(&self) -> &[Vec<u16>] {
        &self.edges
    }

    /// Weights of the nodes of an element at each point: `[point][node]`.
    #[must_use]
    pub fn weights(&self, order: Order) -> Vec<Vec<f64>> {
        self.points.iter().map(|&at| basis::values(self.cell, order, bernstein::chart(self.cell, at))).collect()
    }
}

/// The orders in which the axes of a cube can be gone along.
fn ways(dimension: usize) -> &'static [&'static [usize]] {
    match dimension {
        0 => &[&[]],
        1 => &[&[0]],
        2 => &[&[0, 1], &[1, 0]],
        _ => &[&[0, 1, 2], &[0, 2, 1], &[1, 0, 2], &[1, 2, 0], &[2, 0, 1], &[2, 1, 0]],
    }
}

/// Whether an odd number of exchanges leads to this order of axes.
fn is_odd(way: &[usize]) -> bool {
    let exchanged = |a: usize| way[a + 1..].iter().filter(|&&later| later < way[a]).count();
    (0..way.len()).map(exchanged).sum::<usize>() % 2 == 1
}

/// The lattice point of a cell at a point of the coordinates in which it is partitioned; one that no cell has where there is none.
fn upright(cell: Cell, [u, v, w]: [usize; 3]) -> [usize; 3] {
    match cell {
        Cell::Tet => [u.wrapping_sub(v), v.wrapping_sub(w), w],
        Cell::Triangle | Cell::Prism => [u.wrapping_sub(v), v, w],
        Cell::Pyramid => [u.wrapping_sub(w), v.wrapping_sub(w), w],
        Cell::Point | Cell::Line | Cell::Quad | Cell::Hex => [u, v, w],
    }
}

/// Which sides of the simplices no other simplex has.
fn outside(simplices: &[Vec<u16>]) -> Vec<Vec<bool>> {
    let side = |simplex: &[u16], opposite: usize| {
        let mut own: Vec<u16> = simplex.to_vec();
        own.remove(opposite);
        own.sort_unstable();
        own
    };
    let mut owners: HashMap<Vec<u16>, usize> = HashMap::new();
    for simplex in simplices {
        (0..simplex.len()).for_each(|q| *owners.entry(side(simplex, q)).or_default() += 1);
    }
    simplices.iter().map(|own| (0..own.len()).map(|q| owners.get(&side(own, q)) == Some(&1)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3};

    /// The simplices are as large as the cell together, and their outer sides as its sides.
    #[test]
    fn simplices_fill_the_cell() {
        for (cell, size) in [
            (Cell::Triangle, 0.5),
            (Cell::Quad, 1.0),
            (Cell::Tet, 1.0 / 6.0),
            (Cell::Pyramid, 1.0 / 3.0),
            (Cell::Prism, 0.5),
            (Cell::Hex, 1.0),
        ] {
            for n in 1..=5 {
                let filling = Filling::new(cell, n);
                let at = |place: u16| DVec3::from(filling.points()[usize::from(place)]);
                let volume = |own: &[u16]| {
                    let third = own.get(3).map_or(DVec3::Z / 3.0, |&q| at(q) - at(own[0]));
                    (DMat3::from_cols(at(own[1]) - at(own[0]), at(own[2]) - at(own[0]), third).determinant() / 6.0)
                        * if own.len() == 3 { 9.0 } else { 1.0 }
                };
                let whole: f64 = filling.simplices().map(|(own, _)| volume(own)).sum();
                assert!((whole - size).abs() < 1e-12, "{cell}, {n} divisions: {whole} of {size}");
                let outer = filling.simplices().flat_map(|(_, outside)| outside).filter(|outer| **outer).count();
                let expected: usize = match cell.dimension() {
                    2 => cell.edges().len() * n,
                    _ => cell.faces().iter().map(|face| (face.corners.len() - 2) * n * n).sum(),
                };
                assert_eq!(outer, expected, "{cell}, {n} divisions");
                assert!(filling.edges().iter().all(|edge| edge.len() == n + 1), "{cell}, {n} divisions");
            }
        }
    }
}
