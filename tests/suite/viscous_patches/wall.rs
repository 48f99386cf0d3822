//! The coarse wall: its nodes on the surface, its facets, and how far they are from it.

use glam::{DVec2, DVec3};

use crate::common::random::Random;
use crate::viscous_patches::case::Kind;
use crate::viscous_patches::surface::{Form, Surface};

/// Largest shift of a wall node from its place on the regular grid, in edge lengths.
const SHIFT: f64 = 0.15;
/// Places along a side of a facet at which its distance to the surface is taken.
const STATIONS: usize = 8;

/// The wall but for the surface that it lies on.
pub struct Grid {
    /// Cells along a side.
    pub cells: usize,
    /// Place of each node, in cells.
    places: Vec<DVec2>,
    /// Which diagonal cuts each cell.
    diagonals: Vec<bool>,
    /// Whether facets are quadrilaterals.
    quads: bool,
}

impl Grid {
    pub fn draw(kind: Kind, form: &Form, random: &mut Random) -> Grid {
        let n = form.cells;
        let mut places = Vec::new();
        for (i, j) in (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))) {
            let shift = DVec2::new(random.between(-SHIFT, SHIFT), random.between(-SHIFT, SHIFT));
            let free = |k: usize| if k == 0 || k == n { 0.0 } else { 1.0 };
            let aside = if form.split() == Some(i) { 0.0 } else { free(i) };
            places.push(DVec2::new(i as f64, j as f64) + shift * DVec2::new(aside, free(j)));
        }
        let diagonals = (0..n * n).map(|_| random.below(2) == 0).collect();
        Grid { cells: n, places, diagonals, quads: kind.has_quads() }
    }

    pub fn node(&self, i: usize, j: usize) -> usize {
        j * (self.cells + 1) + i
    }

    pub fn columns(&self) -> usize {
        self.places.len()
    }

    /// The cells, counterclockwise from above, and the two triangles of each.
    pub fn quads(&self) -> impl Iterator<Item = ([usize; 4], [[usize; 3]; 2])> {
        let n = self.cells;
        let cells = (0..n).flat_map(move |j| (0..n).map(move |i| (i, j)));
        cells.zip(&self.diagonals).map(|((i, j), &diagonal)| {
            let [a, b, c, d] = [self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)];
            let triangles = if diagonal { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
            ([a, b, c, d], triangles)
        })
    }

    /// The mesh's wall faces.
    fn facets(&self) -> Vec<Vec<usize>> {
        let facets = |(quad, triangles): ([usize; 4], [[usize; 3]; 2])| {
            if self.quads { vec![quad.to_vec()] } else { triangles.map(|t| t.to_vec()).to_vec() }
        };
        self.quads().flat_map(facets).collect()
    }

    /// The nodes on a surface.
    pub fn on(&self, surface: &Surface) -> Vec<DVec3> {
        self.places.iter().map(|&place| surface.at(place)).collect()
    }

    /// The largest distance of the surface to the facets, along their normals.
    pub fn sagitta(&self, surface: &Surface) -> f64 {
        let points = self.on(surface);
        let off = |facet: &Vec<usize>| {
            let corner = |k: usize| points[facet[k % facet.len()]];
            let normal = (corner(2) - corner(0)).cross(corner(3) - corner(1)).normalize();
            let at = |weights: Vec<f64>| {
                let mix = |of: &dyn Fn(usize) -> DVec3| -> DVec3 {
                    facet.iter().zip(&weights).map(|(&node, &w)| of(node) * w).sum()
                };
                let place = mix(&|node| self.places[node].extend(0.0)).truncate();
                (surface.at(place) - mix(&|node| points[node])).dot(normal).abs()
            };
            stations(facet.len()).map(at).fold(0.0, f64::max)
        };
        self.facets().iter().map(off).fold(0.0, f64::max)
    }

    /// The surface of a form whose sagitta on this grid is `wanted`, to 0.1 %.
    pub fn bent(&self, form: &Form, wanted: f64) -> Surface {
        let mut amplitude = wanted;
        loop {
            let surface = form.surface(amplitude);
            let factor = wanted / self.sagitta(&surface);
            if (factor - 1.0).abs() < 1e-3 {
                return surface;
            }
            amplitude *= factor;
        }
    }

    /// Unit normals at the nodes, means of the facets around them; in the planes of the sides on their borders.
    pub fn normals(&self, points: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; points.len()];
        for facet in self.facets() {
            let corner = |k: usize| points[facet[k % facet.len()]];
            let normal = (corner(2) - corner(0)).cross(corner(3) - corner(1)).normalize();
            facet.iter().for_each(|&node| sums[node] += normal);
        }
        let n = self.cells;
        for (i, j) in (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))) {
            let inside = |k: usize| if k == 0 || k == n { 0.0 } else { 1.0 };
            sums[self.node(i, j)] *= DVec3::new(inside(i), inside(j), 1.0);
        }
        sums.into_iter().map(DVec3::normalize).collect()
    }
}

/// Weights of the corners at points of a triangle or quadrilateral.
fn stations(corners: usize) -> impl Iterator<Item = Vec<f64>> {
    let at = |k: usize| k as f64 / STATIONS as f64;
    let square = (0..=STATIONS).flat_map(move |j| (0..=STATIONS).map(move |i| (at(i), at(j))));
    square.filter_map(move |(a, b)| match corners {
        4 => Some(vec![(1.0 - a) * (1.0 - b), a * (1.0 - b), a * b, (1.0 - a) * b]),
        _ => (a + b <= 1.0).then(|| vec![1.0 - a - b, a, b]),
    })
}
