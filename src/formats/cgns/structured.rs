//! Structured zones: their cells as hexes or quadrilaterals, their boundary conditions as faces of ranges of indices.

use super::fault::CgnsFault;
use super::labels;
use super::tree::{Ints, Tree};
use crate::element::Cell;
use crate::formats::error::Flaw;

/// The indices of a structured zone, the first fastest; a plane one has one layer of points.
pub(super) struct Grid {
    size: [usize; 3],
    dimension: usize,
}

/// Faces by the places of their corners among the points of the zone.
pub(super) type Faces = Vec<Vec<usize>>;

/// First and last of a range of indices, counted from 1, along as many axes as the zone has; the first may be beyond the last.
type Range = [[i64; 3]; 2];

impl Grid {
    /// The grid of a structured zone whose cells are of a dimension.
    ///
    /// # Errors
    /// Sizes that are none.
    pub(super) fn new(zone: &Tree, dimension: usize) -> Result<Grid, Flaw> {
        let numbers = zone.ints()?;
        let mut size = [1; 3];
        for (axis, points) in size.iter_mut().enumerate().take(dimension) {
            let [own, cells] = [axis, axis + dimension].map(|n| numbers.get(n).unwrap_or(0));
            let known =
                usize::try_from(own).ok().filter(|&n| n > 1 && cells == own - 1 && numbers.len() == 3 * dimension);
            *points = known.ok_or_else(|| zone.flaw(CgnsFault::Size { axis: axis + 1, points: own, cells }))?;
        }
        Ok(Grid { size, dimension })
    }

    /// Number of points.
    pub(super) fn points(&self) -> usize {
        self.size.iter().fold(1, |product, &n| product.saturating_mul(n))
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.size[0] * (j + self.size[1] * k)
    }

    /// What its cells are.
    pub(super) fn cell(&self) -> Cell {
        if self.dimension == 2 { Cell::Quad } else { Cell::Hex }
    }

    /// What the sides of its cells are.
    pub(super) fn side(&self) -> Cell {
        if self.dimension == 2 { Cell::Line } else { Cell::Quad }
    }

    /// The points of each cell's corners.
    pub(super) fn cells(&self) -> impl Iterator<Item = Vec<usize>> + '_ {
        let end = std::array::from_fn(|axis| self.size[axis] - usize::from(axis < self.dimension));
        let corners = self.cell().corners();
        all([[0; 3], end]).map(move |at| {
            let point = |corner: &[u8; 3]| self.index(std::array::from_fn(|axis| at[axis] + usize::from(corner[axis])));
            corners.iter().map(point).collect()
        })
    }

    /// A range of indices of a node.
    pub(super) fn range(&self, numbers: Ints) -> Option<Range> {
        let at = |n: usize, axis: usize| {
            if axis < self.dimension { numbers.get(n * self.dimension + axis) } else { Some(1) }
        };
        let end = |n: usize| Some([at(n, 0)?, at(n, 1)?, at(n, 2)?]);
        (numbers.len() == 2 * self.dimension).then(|| Some([end(0)?, end(1)?])).flatten()
    }

    /// The points of the corners of the faces that a condition covers, by its range and where that counts; `None` where it is no part
    /// of a layer.
    pub(super) fn faces(&self, [first, last]: Range, location: &str) -> Option<Faces> {
        let flat: Vec<usize> = (0..self.dimension).filter(|&axis| first[axis] == last[axis]).collect();
        let is_outer = |axis: &usize| first[*axis] == 1 || first[*axis] == self.size[*axis] as i64;
        let normal = match location {
            "IFaceCenter" => 0,
            "JFaceCenter" => 1,
            "KFaceCenter" => 2,
            // A row of faces is flat along two axes; it is a part of an outer layer.
            _ => *flat.iter().find(|axis| is_outer(axis)).or(flat.first())?,
        };
        let mut bounds = [[0; 3], [1; 3]];
        for axis in 0..self.dimension {
            let [a, b] = [first[axis].min(last[axis]), first[axis].max(last[axis])];
            // Behind the last face that begins there; between two points there is one.
            let end = if axis == normal || location != "Vertex" { b } else { b - 1 };
            let most = self.size[axis] as i64 - i64::from(axis != normal);
            if a < 1 || end < a || end > most || (axis == normal && a != b) {
                return None;
            }
            bounds[0][axis] = usize::try_from(a - 1).ok()?;
            bounds[1][axis] = usize::try_from(end).ok()?;
        }
        let along: Vec<usize> = (0..self.dimension).filter(|&axis| axis != normal).collect();
        let corners = self.side().corners();
        let point = |at: [usize; 3], corner: &[u8; 3]| {
            let mut at = at;
            along.iter().zip(corner).for_each(|(&axis, &step)| at[axis] += usize::from(step));
            self.index(at)
        };
        Some(all(bounds).map(|at| corners.iter().map(|corner| point(at, corner)).collect()).collect())
    }

    /// The points of a range in its order, the first axis fastest.
    ///
    /// `None` where it is not of this grid.
    pub(super) fn listed(&self, [first, last]: Range) -> Option<Vec<[i64; 3]>> {
        let fits = |at: [i64; 3]| (0..3).all(|axis| (1..=self.size[axis] as i64).contains(&at[axis]));
        if !fits(first) || !fits(last) {
            return None;
        }
        let count = |axis: usize| (first[axis] - last[axis]).unsigned_abs() as usize + 1;
        let at = |n: [usize; 3]| {
            std::array::from_fn(|axis| first[axis] + (last[axis] - first[axis]).signum() * n[axis] as i64)
        };
        Some(all([[0; 3], [0, 1, 2].map(count)]).map(at).collect())
    }

    /// The place of a point among the zone's, where the zone has it.
    pub(super) fn place(&self, at: [i64; 3]) -> Option<usize> {
        let mut own = [0; 3];
        for axis in 0..3 {
            own[axis] = usize::try_from(at[axis] - 1).ok().filter(|&n| n < self.size[axis])?;
        }
        Some(self.index(own))
    }

    /// Pairs of points of a connection to another structured zone: their places in each.
    ///
    /// # Errors
    /// Ranges that are of no grid, or do not match.
    pub(super) fn pairs(&self, other: &Grid, node: &Tree) -> Result<Vec<(usize, usize)>, Flaw> {
        let range = |grid: &Grid, name: &'static str| {
            let numbers = node.required(labels::RANGE, name)?.ints()?;
            grid.range(numbers).ok_or_else(|| node.flaw(CgnsFault::IndexRange(name)))
        };
        let (own, donor) = (range(self, "PointRange")?, range(other, "PointRangeDonor")?);
        let transform: Vec<i64> = match node.child(labels::TRANSFORM) {
            Some(transform) => transform.ints()?.iter().collect(),
            None => (1..=self.dimension as i64).collect(),
        };
        let axes = || transform.iter().map(|step| step.unsigned_abs() as usize);
        let is_permutation = (1..=self.dimension).all(|axis| axes().filter(|&own| own == axis).count() == 1);
        if transform.len() != self.dimension || !is_permutation || self.dimension != other.dimension {
            return Err(node.flaw(CgnsFault::Transform(transform)));
        }
        let listed = self.listed(own).ok_or_else(|| node.flaw(CgnsFault::IndexRange("PointRange")))?;
        let image = |at: [i64; 3]| {
            let mut image = donor[0];
            for (axis, step) in transform.iter().enumerate() {
                image[step.unsigned_abs() as usize - 1] += step.signum() * (at[axis] - own[0][axis]);
            }
            image
        };
        if image(own[1]) != donor[1] {
            return Err(node.flaw(CgnsFault::IndexRange("PointRangeDonor")));
        }
        let pair = |at: [i64; 3]| Some((self.place(at)?, other.place(image(at))?));
        let pairs: Option<Vec<(usize, usize)>> = listed.into_iter().map(pair).collect();
        pairs.ok_or_else(|| node.flaw(CgnsFault::IndexRange("PointRangeDonor")))
    }
}

/// All indices from the first to before the end, the first axis fastest.
fn all([first, end]: [[usize; 3]; 2]) -> impl Iterator<Item = [usize; 3]> {
    let axis = move |n: usize| first[n]..end[n];
    axis(2).flat_map(move |k| axis(1).flat_map(move |j| axis(0).map(move |i| [i, j, k])))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_those_of_the_range() {
        let grid = Grid { size: [3, 4, 2], dimension: 3 };
        // All of the layer i = 3: three by one faces, whichever end comes first.
        for range in [[[3, 1, 1], [3, 4, 2]], [[3, 4, 2], [3, 1, 1]]] {
            let faces = grid.faces(range, "Vertex").unwrap();
            assert_eq!(faces.len(), 3);
            assert_eq!(faces[0], [2, 5, 17, 14]);
        }
        assert_eq!(grid.faces([[3, 1, 1], [3, 3, 1]], "IFaceCenter").unwrap().len(), 3);
        assert_eq!(grid.faces([[1, 1, 1], [2, 1, 1]], "FaceCenter").unwrap().len(), 2);
        assert_eq!(grid.faces([[1, 1, 1], [3, 4, 2]], "Vertex"), None);
        assert_eq!(grid.faces([[4, 1, 1], [4, 4, 2]], "Vertex"), None);
        assert_eq!((grid.cells().count(), grid.points()), (6, 24));
        let plane = Grid { size: [3, 2, 1], dimension: 2 };
        assert_eq!(plane.faces([[1, 2, 1], [3, 2, 1]], "Vertex").unwrap(), [[3, 4], [4, 5]]);
        assert_eq!(plane.cells().next().unwrap(), [0, 1, 4, 3]);
    }
}
