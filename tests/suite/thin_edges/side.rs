//! One side of a thin body, triangulated coarsely, and its chord points.

use cad::{FaceId, Foot, Group, Model};
use glam::DVec3;

/// Share of an edge's length by which a right foot may be away from the point of the surface half way in parameters.
const NEAR: f64 = 0.5;

/// A side: a face over `ranges` of its parameters in `cells`, each cut into two triangles by the same diagonal.
pub struct Side<'a> {
    pub model: &'a Model,
    pub face: FaceId,
    pub ranges: [[f64; 2]; 2],
    pub cells: [usize; 2],
}

/// A point of a straight triangle and where it belongs.
pub struct ChordPoint {
    pub point: DVec3,
    /// The point of the surface at the same place of the triangle in parameters.
    pub home: DVec3,
    /// Length of the longest edge of its triangle.
    pub size: f64,
}

/// Feet of the chord points of some sides.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    pub points: usize,
    /// Feet in the group of the own side that are not on it, or not near where they belong, or not proven.
    pub astray_in_groups: usize,
    /// Feet in the group of all sides that are on another side, because that is nearer.
    pub astray_in_one: usize,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.points += other.points;
        self.astray_in_groups += other.astray_in_groups;
        self.astray_in_one += other.astray_in_one;
    }
}

impl Tally {
    /// Share of points that one group of all sides sends astray.
    pub fn share(&self) -> f64 {
        self.astray_in_one as f64 / self.points.max(1) as f64
    }
}

impl<'a> Side<'a> {
    /// The whole parameter range of a face.
    pub fn whole(model: &'a Model, face: FaceId, cells: [usize; 2]) -> Self {
        Self { model, face, ranges: model.face(face).unwrap().parameters, cells }
    }

    /// The surface at fractions of the ranges.
    pub fn surface(&self, fractions: [f64; 2]) -> DVec3 {
        let at = |i: usize| self.ranges[i][0] + fractions[i] * (self.ranges[i][1] - self.ranges[i][0]);
        self.model.evaluate(self.face.into(), [at(0), at(1)]).unwrap().point()
    }

    /// Nodes of order `p` of all triangles but their corners, each once.
    pub fn chord_points(&self, p: usize) -> Vec<ChordPoint> {
        let [n, m] = self.cells;
        let place = |i: usize, j: usize| [i as f64 / (p * n) as f64, j as f64 / (p * m) as f64];
        let inner = |&(i, j): &(usize, usize)| !(i.is_multiple_of(p) && j.is_multiple_of(p));
        let nodes = (0..=p * n).flat_map(|i| (0..=p * m).map(move |j| (i, j))).filter(inner);
        nodes
            .map(|(i, j)| {
                let cell = [(i / p).min(n - 1), (j / p).min(m - 1)];
                let local = [i - p * cell[0], j - p * cell[1]].map(|k| k as f64 / p as f64);
                let (point, size) = self.straight(cell, local);
                ChordPoint { point, home: self.surface(place(i, j)), size }
            })
            .collect()
    }

    /// A point of the straight triangles of a cell, and the longest edge there.
    fn straight(&self, cell: [usize; 2], [a, b]: [f64; 2]) -> (DVec3, f64) {
        let corner = |i: usize, j: usize| {
            self.surface([(cell[0] + i) as f64 / self.cells[0] as f64, (cell[1] + j) as f64 / self.cells[1] as f64])
        };
        let far = a + b > 1.0;
        let (o, u, v) =
            if far { (corner(1, 1), corner(0, 1), corner(1, 0)) } else { (corner(0, 0), corner(1, 0), corner(0, 1)) };
        let (a, b) = if far { (1.0 - a, 1.0 - b) } else { (a, b) };
        (o + a * (u - o) + b * (v - o), u.distance(v).max(u.distance(o)).max(v.distance(o)))
    }

    /// Projects the chord points of order `p` on this side alone, and on all `sides`.
    pub fn tally(&self, p: usize, sides: &[FaceId]) -> Tally {
        let own = Group::of_faces(self.model, &[self.face]).unwrap();
        let one = Group::of_faces(self.model, sides).unwrap();
        let points = self.chord_points(p);
        let xs: Vec<DVec3> = points.iter().map(|chord| chord.point).collect();
        let [right, mixed] =
            [&own, &one].map(|group| xs.iter().map(|&x| group.closest(x, None).unwrap()).collect::<Vec<Foot>>());
        let mut tally = Tally { points: points.len(), ..Tally::default() };
        for ((chord, right), mixed) in points.iter().zip(&right).zip(&mixed) {
            let at_home = right.point.distance(chord.home) < NEAR * chord.size;
            let on_side =
                right.entity == self.face.into() && right.distance <= chord.home.distance(chord.point) + 1e-12;
            tally.astray_in_groups += usize::from(!(at_home && on_side && right.is_proven()));
            let nearer = mixed.distance < right.distance - 1e-9 * self.model.diagonal();
            tally.astray_in_one += usize::from(nearer && mixed.entity != self.face.into());
        }
        tally
    }
}
