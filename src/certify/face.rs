//! Faces on walls: a proof that a curved triangle or quadrilateral, in a plane mesh a line, does not fold.
//!
//! A face `x(u, v)` stands upright where its normal `x_u x x_v` has a positive product with the mean normal `m` of the
//! linear face. That product is the determinant of `(x_u, x_v, m)`, a polynomial of degree `2 (p - 1)` on triangles and
//! `2 p - 1` by axis on quadrilaterals, and is treated as the volume's Jacobians are: Bernstein coefficients with a bound
//! of their rounding, halved until decided.
//!
//! `m` is not the only vector that will do: where the face's normals all have a positive product with any one vector, its projection along
//! that vector is locally one-to-one: the face has no fold. On a strongly curved wall a coarse face rightly leans by more
//! than 90 degrees against its linear face: those of the torus at scale 0.5 stand at up to 87 degrees to the wall itself in their
//! corners. Where `m` does not prove it, another vector is asked for, on the side of `m`: the middle of the face's own normals, if
//! a survey finds them all on the side of the CAD's normals ([`crate::curve::proof`]); a face that doubles back over its wall is none such.
//!
//! A line in a plane of normal `m` runs forward where its tangent has a positive product with its chord `t`: that product is the
//! determinant of `(x_u, m x t, m)`, a polynomial of degree `p - 1`.

use glam::DVec3;
use rayon::prelude::*;

use super::form::Form;
use super::judge::{Arithmetic, Frame, Judge, Shape, frame};
use super::pieces::{Accuracy, Reference};
use super::real::Double;
use super::search::{Goal, Task};
use super::{Settings, Verdict};
use crate::element::{Cell, Order, basis};

/// A curved face of a wall.
#[derive(Clone, Debug)]
pub struct WallFace {
    /// Triangle or quadrilateral; line.
    pub cell: Cell,
    /// Its order.
    pub order: Order,
    /// Its nodes in internal order.
    pub points: Vec<DVec3>,
    /// The corners of the linear face.
    pub corners: Vec<DVec3>,
    /// The unit normal of the plane that a line lies in.
    pub plane: Option<DVec3>,
}

/// A wall face that is not proven to be free of folds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceFinding {
    /// Its number among the boundary's faces.
    pub face: usize,
    /// Folded, or undecided.
    pub verdict: Verdict,
    /// A point of the fold; the face's first corner where it is undecided.
    pub place: DVec3,
}

/// What is proven of the faces on walls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls {
    /// Number of faces.
    pub faces: usize,
    /// Those that are not proven to be free of folds, in their order.
    pub failures: Vec<FaceFinding>,
}

impl Walls {
    /// Whether every face is proven to be free of folds.
    #[must_use]
    pub fn hold(&self) -> bool {
        self.failures.is_empty()
    }

    /// Number of faces proven to fold.
    #[must_use]
    pub fn folded(&self) -> usize {
        self.failures.iter().filter(|f| f.verdict != Verdict::Undecided).count()
    }
}

/// Judges the faces with the given numbers; `face` reads them, and `other` gives a vector that a face that leans far may be compared
/// with. The result does not depend on the number of threads.
#[must_use]
pub fn walls(
    numbers: &[usize],
    face: impl Fn(usize) -> WallFace + Sync,
    other: impl Fn(usize) -> Option<DVec3> + Sync,
    settings: &Settings,
) -> Walls {
    let examine = |judge: &mut Judge, &number: &usize| {
        let own = face(number);
        let verdict = judge.fold(&own, || other(number), settings);
        let place = match verdict {
            Verdict::Valid => return None,
            Verdict::Invalid { at, .. } => {
                let weights = basis::values(own.cell, own.order, at);
                own.points.iter().zip(weights).map(|(&x, weight)| x * weight).sum()
            }
            Verdict::Undecided => own.points.first().copied().unwrap_or_default(),
        };
        Some(FaceFinding { face: number, verdict, place })
    };
    let failures: Vec<Option<FaceFinding>> =
        numbers.par_iter().with_min_len(64).map_init(Judge::default, examine).collect();
    Walls { faces: numbers.len(), failures: failures.into_iter().flatten().collect() }
}

impl Judge {
    /// Whether a face is proven to be free of folds ([`Verdict::Valid`]) or to have one. A face without size, with too few
    /// nodes or with coordinates that are not finite is undecided.
    ///
    /// `other` is asked for a second vector where the mean normal of the linear face does not prove it.
    pub fn fold(&mut self, face: &WallFace, other: impl FnOnce() -> Option<DVec3>, settings: &Settings) -> Verdict {
        let normal = match face.plane {
            None => mean_normal(&face.corners),
            Some(_) => face.corners.windows(2).map(|ends| ends[1] - ends[0]).sum::<DVec3>().normalize_or_zero(),
        };
        if face.corners.len() != face.cell.corner_count() || normal == DVec3::ZERO || !normal.is_finite() {
            return Verdict::Undecided;
        }
        let mut against = |vector: DVec3| {
            let WallFace { cell, order, ref points, ref corners, plane } = *face;
            let of_line = plane.map(|plane| [plane.cross(vector), plane]);
            let upright = of_line.as_ref().map_or(std::slice::from_ref(&vector), |both| &both[..]);
            let shape = Shape { cell, order, points, corners: Some(corners), upright };
            let Some(frame) = frame(&shape) else { return Verdict::Undecided };
            match self.fold_in::<f64>(&shape, frame, settings) {
                Verdict::Undecided => self.fold_in::<Double>(&shape, frame, settings),
                decided => decided,
            }
        };
        let first = against(normal);
        let other = || other().filter(|other| other.dot(normal) > 0.0).and_then(DVec3::try_normalize);
        let stands = first == Verdict::Valid || other().is_some_and(|other| against(other) == Verdict::Valid);
        if stands { Verdict::Valid } else { first }
    }

    fn fold_in<T: Arithmetic>(&mut self, shape: &Shape, frame: Frame, settings: &Settings) -> Verdict {
        let (own, form) = (self.coefficients::<T>(shape, frame), Form::of(shape.cell, shape.order));
        let reference = Reference::Constant(own.largest);
        let task = Task { form, reference, accuracy: [own, Accuracy::default()], goal: Goal::Verdict };
        // Only the sign matters: any bound is near enough.
        let settings = Settings { gap: f64::INFINITY, ..*settings };
        self.search.run(&task, &self.root, &settings).verdict
    }
}

/// The unit mean normal of a linear face with these corners: that of a triangle, the cross product of a quadrilateral's diagonals; zero where
/// the face has no area.
#[must_use]
pub fn mean_normal(corners: &[DVec3]) -> DVec3 {
    let fan = corners.windows(2).skip(1).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0]));
    fan.sum::<DVec3>().normalize_or_zero()
}

#[cfg(test)]
#[allow(clippy::panic)]
mod tests {
    use super::*;
    use crate::element::lattice;

    /// The unit face, its nodes moved by a map.
    fn face(cell: Cell, order: Order, map: impl Fn(DVec3) -> DVec3) -> WallFace {
        let unit = |at: &[u8; 3], p: usize| DVec3::from(at.map(|x| f64::from(x) / p as f64));
        let points = lattice(cell, order).iter().map(|at| map(unit(at, order.get()))).collect();
        let corners = lattice(cell, Order::LINEAR).iter().map(|at| map(unit(at, 1))).collect();
        WallFace { cell, order, points, corners, plane: None }
    }

    /// Somewhere else, turned, small: no verdict may depend on it.
    fn placed(x: DVec3) -> DVec3 {
        glam::DMat3::from_rotation_x(0.7) * glam::DMat3::from_rotation_z(1.9) * x * 3e-3 + DVec3::new(40.0, -3.0, 17.0)
    }

    fn verdict(face: &WallFace) -> Verdict {
        Judge::default().fold(face, || None, &Settings::default())
    }

    const FACES: [Cell; 2] = [Cell::Triangle, Cell::Quad];

    #[test]
    fn flat_and_strongly_curved_faces_pass() {
        for cell in FACES {
            for order in Order::all() {
                assert_eq!(verdict(&face(cell, order, placed)), Verdict::Valid, "{cell} {order}");
                if order > Order::LINEAR {
                    // A bowl whose rim leans by up to 72 degrees.
                    let bowl = |x: DVec3| {
                        let off = x - DVec3::new(0.5, 0.5, 0.0);
                        placed(x + DVec3::Z * 3.0 * off.x * off.x)
                    };
                    assert_eq!(verdict(&face(cell, order, bowl)), Verdict::Valid, "{cell} {order}");
                }
            }
        }
    }

    #[test]
    fn lines_that_run_back_are_found() {
        for order in Order::all().filter(|order| order.get() >= 3) {
            let line = |back: f64| {
                let at = |s: f64| placed(DVec3::new(s - back * (s * (1.0 - s) * (1.0 - 2.0 * s)), 0.3 * s * s, 0.0));
                let points =
                    lattice(Cell::Line, order).iter().map(|n| at(f64::from(n[0]) / order.get() as f64)).collect();
                let plane = Some((placed(DVec3::Z) - placed(DVec3::ZERO)).normalize());
                verdict(&WallFace { cell: Cell::Line, order, points, corners: vec![at(0.0), at(1.0)], plane })
            };
            assert_eq!((line(0.0), line(-1.5)), (Verdict::Valid, Verdict::Valid), "{order}");
            assert!(matches!(line(4.0), Verdict::Invalid { .. }), "{order}");
        }
    }

    /// A face that lies flat and curls up at its end, to 141 degrees, where it leans by 103 degrees against its chord: compared with
    /// a vector between its ends' normals it is a graph. Where it curls on to 196 degrees, no vector makes it one.
    #[test]
    fn a_face_that_leans_far_is_held_against_another_vector() {
        for cell in FACES {
            for order in Order::all().filter(|order| order.get() >= 3) {
                let slope = |x: DVec3| x.x - x.x.powi(3) * 2.0 / 3.0;
                let curled = face(cell, order, |x| DVec3::new(slope(x), x.y, 0.8 / 3.0 * x.x.powi(3)));
                let more = |x: DVec3| DVec3::new(slope(x), x.y, 0.8 * (x.x.powi(2) / 2.0 - x.x.powi(3) * 0.45));
                let more = face(cell, order, more);
                let against = |face: &WallFace, degrees: u32| {
                    let angle = f64::from(degrees).to_radians();
                    let other = || Some(DVec3::new(-angle.sin(), 0.0, angle.cos()) * 7.0);
                    Judge::default().fold(face, other, &Settings::default())
                };
                assert!(matches!(verdict(&curled), Verdict::Invalid { .. }), "{cell} {order} leans too little");
                for degrees in (0..=180).step_by(5) {
                    let (curled, more) = (against(&curled, degrees), against(&more, degrees));
                    assert!((curled == Verdict::Valid) == (55..90).contains(&degrees), "{cell} {order} {degrees}");
                    assert!(more != Verdict::Valid, "{cell} {order} {degrees}");
                }
            }
        }
    }

    /// `x = u + a (u^2 - u)` has the slope `1 + a (2u - 1)`: it folds at `u = 0` from `a = 1` on, on `u < (a - 1) / (2 a)`.
    #[test]
    fn a_fold_is_found_where_it_is() {
        for cell in FACES {
            for order in Order::all().skip(1) {
                for (a, folded) in [(0.9, false), (0.9999, false), (1.0001, true), (1.3, true)] {
                    let squeezed = |x: DVec3| placed(DVec3::new(x.x + a * (x.x * x.x - x.x), x.y, 0.3 * x.x * x.y));
                    match verdict(&face(cell, order, squeezed)) {
                        Verdict::Valid => assert!(!folded, "{cell} {order}, a = {a}"),
                        Verdict::Invalid { at, value } => {
                            assert!(folded, "{cell} {order}, a = {a}");
                            assert!(at[0] <= (a - 1.0) / (2.0 * a) + 1e-12 && value <= 0.0, "{cell} {order}: {at:?}");
                        }
                        Verdict::Undecided => panic!("{cell} {order}, a = {a}: undecided"),
                    }
                }
            }
        }
    }

    /// A P4 face whose slope dips below zero between its nodes only: `x' = 1 - c B(u)`, all corner values positive.
    #[test]
    fn a_fold_between_nodes_is_found() {
        let order = Order::MAX;
        for cell in FACES {
            // x' = 4 (u - 0.4)^2 + level
            let wavy = |level: f64| {
                move |x: DVec3| {
                    let slope = 4.0 / 3.0 * ((x.x - 0.4).powi(3) + 0.064) + level * x.x;
                    placed(DVec3::new(slope, x.y, 0.1 * x.y * x.x))
                }
            };
            assert_eq!(verdict(&face(cell, order, wavy(1e-4))), Verdict::Valid, "{cell}");
            let Verdict::Invalid { at, .. } = verdict(&face(cell, order, wavy(-1e-4))) else {
                panic!("{cell}: the fold was not found");
            };
            assert!((at[0] - 0.4).abs() <= 0.005 + 1e-9, "{cell}: {at:?}");
        }
    }

    #[test]
    fn broken_faces_are_undecided() {
        let mut broken = face(Cell::Triangle, Order::MAX, placed);
        broken.points[3].x = f64::NAN;
        assert_eq!(verdict(&broken), Verdict::Undecided);
        let point = face(Cell::Quad, Order::MAX, |_| DVec3::ONE);
        assert_eq!(verdict(&point), Verdict::Undecided);
    }
}
