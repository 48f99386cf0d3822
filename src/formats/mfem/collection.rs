//! The finite element spaces that nodes are values of (`fem/fe_coll.cpp`), and where in an element each value belongs.

use super::numbering::all_rows;
use crate::element::{Cell, Order, basis, lattice};

/// A space of nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Collection {
    /// Whether elements share values (H1) or have their own (L2).
    pub(super) continuous: bool,
    pub(super) order: Order,
    pub(super) points: Points,
    /// Whether pyramids have the space of Bergot, which is that of this program; MFEM's default is that of Fuentes.
    bergot: bool,
}

/// Points of the unit interval that values belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Points {
    /// Even, with the ends.
    Even,
    Lobatto,
    Legendre,
}

/// Numbers of MFEM's kinds of points, in names of L2 spaces.
const NUMBERS: [(Points, &str); 3] = [(Points::Legendre, "0"), (Points::Lobatto, "1"), (Points::Even, "4")];
/// Their letters, in names of H1 spaces.
const LETTERS: [(Points, &str); 2] = [(Points::Lobatto, "G"), (Points::Even, "U")];

impl Collection {
    /// The space in which a mesh is written: H1, but L2 where pyramids are curved, as MFEM 4.10 numbers the values on the faces of
    /// Bergot's pyramids in another way than on those of its other elements.
    pub(super) fn written(order: Order, has_pyramids: bool) -> Collection {
        let apart = has_pyramids && order > Order::LINEAR;
        Collection { continuous: !apart, order, points: Points::Even, bergot: apart }
    }

    /// What files call a space that is written.
    pub(super) fn name(self, dimension: usize) -> String {
        let order = self.order.get();
        match self.continuous {
            true => format!("H1@U_{dimension}D_P{order}"),
            false => format!("L2_T4_{dimension}D_P{order}_Pyr0"),
        }
    }

    /// The space of a name, where it is one of those that are read.
    pub(super) fn of(name: &str) -> Option<Collection> {
        let known = |continuous, order, points, bergot| {
            Some(Collection { continuous, order: Order::new(order).ok()?, points, bergot })
        };
        match name {
            "Linear" => return known(true, 1, Points::Even, false),
            "Quadratic" => return known(true, 2, Points::Even, false),
            "Cubic" => return known(true, 3, Points::Even, false),
            _ => {}
        }
        // H1_3D_P2, H1@U_3D_P2, L2_3D_P2, L2_T1_3D_P2; with _Pyr0 or _Pyr1 behind
        let mut words = name.split('_');
        let space = words.next()?;
        let mut points = match space.split_once('@') {
            Some(("H1", letter)) => LETTERS.iter().find(|(_, own)| *own == letter)?.0,
            None if space == "H1" => Points::Lobatto,
            None if space == "L2" => Points::Legendre,
            _ => return None,
        };
        let mut word = words.next()?;
        if let Some(number) = word.strip_prefix('T').filter(|_| space == "L2") {
            points = NUMBERS.iter().find(|(_, own)| *own == number)?.0;
            word = words.next()?;
        }
        word.strip_suffix('D')?.parse::<u8>().ok()?;
        let order = words.next()?.strip_prefix('P')?.parse().ok()?;
        let bergot = match words.next() {
            None | Some("Pyr1") => false,
            Some("Pyr0") => true,
            Some(_) => return None,
        };
        known(space.starts_with("H1"), order, points, bergot)
    }

    /// Whether the nodes of an element are known from its values.
    pub(super) fn has(self, cell: Cell) -> bool {
        let order = self.order.get();
        match cell {
            // The two spaces of linear pyramids are one; on faces of continuous ones beyond order 2 values have another order.
            Cell::Pyramid => order == 1 && self.continuous || self.bergot && (order < 3 || !self.continuous),
            _ => true,
        }
    }

    /// Row-major, `[node][value]`, both in internal order: the nodes of an element from its values. `None` where they are the
    /// values themselves.
    pub(super) fn to_nodes(self, cell: Cell) -> Option<Vec<f64>> {
        let p = self.order.get();
        let is_even = match self.points {
            Points::Even => true,
            Points::Lobatto => p < 3,
            Points::Legendre => false,
        };
        if is_even || cell == Cell::Point {
            return None;
        }
        let c = self.points.of(p);
        let points: Vec<[f64; 3]> =
            lattice(cell, self.order).iter().map(|at| place(cell, p, &c, at.map(usize::from))).collect();
        Some(basis::from_points(cell, self.order, &points))
    }

    /// For each node of an element in internal order, the place of its value among the element's own (L2).
    pub(super) fn places(self, cell: Cell) -> &'static [usize] {
        all_rows(cell, self.order)
    }
}

impl Points {
    /// The `p + 1` points.
    fn of(self, p: usize) -> Vec<f64> {
        let even = || (0..=p).map(|i| i as f64 / p as f64).collect();
        let half: Vec<f64> = match (self, p) {
            (Points::Even, _) => return even(),
            (Points::Lobatto, 3) => vec![-1.0, -(0.2f64.sqrt())],
            (Points::Lobatto, 4) => vec![-1.0, -((3.0f64 / 7.0).sqrt()), 0.0],
            (Points::Lobatto, _) => return even(),
            (Points::Legendre, 1) => vec![-((1.0f64 / 3.0).sqrt())],
            (Points::Legendre, 2) => vec![-(0.6f64.sqrt()), 0.0],
            (Points::Legendre, 3) => {
                let root = (2.0 / 7.0) * 1.2f64.sqrt();
                vec![-((3.0 / 7.0 + root).sqrt()), -((3.0 / 7.0 - root).sqrt())]
            }
            (Points::Legendre, _) => {
                let root = 2.0 * (10.0f64 / 7.0).sqrt();
                vec![-((5.0 + root).sqrt()) / 3.0, -((5.0 - root).sqrt()) / 3.0, 0.0]
            }
        };
        let on = |i: usize| if i < half.len() { half[i] } else { -half[p - i] };
        (0..=p).map(|i| (1.0 + on(i)) / 2.0).collect()
    }
}

/// Where in the unit cell the value belongs that stands for a lattice point (constructors in `fem/fe/fe_h1.cpp` and `fe_l2.cpp`).
fn place(cell: Cell, p: usize, c: &[f64], [i, j, k]: [usize; 3]) -> [f64; 3] {
    match cell {
        Cell::Point => [0.0; 3],
        Cell::Line => [c[i], 0.0, 0.0],
        Cell::Quad => [c[i], c[j], 0.0],
        Cell::Hex => [c[i], c[j], c[k]],
        Cell::Triangle | Cell::Prism => {
            let w = c[i] + c[j] + c[p - i - j];
            [c[i] / w, c[j] / w, if cell == Cell::Prism { c[k] } else { 0.0 }]
        }
        Cell::Tet => {
            let w = c[i] + c[j] + c[k] + c[p - i - j - k];
            [c[i] / w, c[j] / w, c[k] / w]
        }
        Cell::Pyramid if k == p && c[0] == 0.0 => [0.0, 0.0, 1.0],
        Cell::Pyramid => {
            let (wj, wi) = (c[j] + c[k] + c[p - j - k], c[i] + c[k] + c[p - i - k]);
            let w = wi * wj * c[p - k];
            [c[i] * (c[j] + c[p - j - k]) / w, c[j] * (c[i] + c[p - i - k]) / w, c[k] * c[p - k] / w]
        }
    }
}
