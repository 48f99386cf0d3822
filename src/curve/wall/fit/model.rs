//! Distances of wall faces and edges from the CAD as linear functions of where their nodes slide, and what is minimised.
//!
//! A node that slides by `w` along the tangents of its curve or surface takes a point of the wall along by `phi w`, `phi` its Lagrange
//! function. With `n` the direction from the point's foot to the point, the distance changes by `phi n . w`: to first order the CAD is
//! its tangent plane at the foot. As `n` turns along an edge, a slide changes the distance even though the node stays on the CAD.

use glam::DVec3;

use crate::mesh::NodeId;

/// Power of the distances: a sum of 8th powers is near to the maximum, and smooth.
const POWER: i32 = 8;
/// Power of a line's strains over their limits: high, so that a line is nearly held by them alone.
const LIMITED: i32 = 32;
/// Weight of the squared strain against the 8th power of a distance over its level.
///
/// With 2 the weeble's wall comes out 1.10e-3 off the CAD, with 3 1.24e-3; wing_sharp at scale 0.4 with `C_JAC` 0.793 and 0.797.
const STIFFNESS: f64 = 3.0;

/// A step shorter than this share of Newton's is not tried.
const LEAST_STEP: f64 = 1e-6;
/// What is added to the diagonal of Newton's matrix, as a share of its largest entry: where distances are next to nothing, there are slides that
/// change none of them.
const DAMPING: f64 = 1e-12;
/// A step that gains less than this share is the last.
const CONVERGED: f64 = 1e-6;

/// A node that may slide along its curve or surface.
pub(super) struct Slider {
    pub(super) node: NodeId,
    /// Unit tangents: one on a curve, two on a surface, none where there are none.
    pub(super) along: Vec<DVec3>,
    /// Where the model takes it.
    pub(super) step: DVec3,
    /// Pieces around it, and its place in each one's list of sliders.
    pub(super) at: Vec<(usize, usize)>,
}

/// A wall face or edge around sliding nodes.
pub(super) struct Model {
    /// Its number among the pieces of the wall.
    pub(super) piece: usize,
    /// What distances are compared with.
    pub(super) level: f64,
    /// The largest distance that it may come out with.
    pub(super) room: f64,
    /// Distances at its samples.
    pub(super) distances: Vec<f64>,
    /// Its sliding nodes.
    pub(super) sliders: Vec<Response>,
    /// Gradients of the rim's functions: `[point][rim node]`.
    pub(super) slopes: Vec<Vec<DVec3>>,
    /// Means over the points of the products of two gradients: `[rim node][rim node]`.
    pub(super) products: Vec<Vec<f64>>,
    /// How far each of the rim's nodes has slid since it was projected.
    pub(super) shifts: Vec<DVec3>,
    /// Of a line of a plane mesh: by how much it may be squeezed and stretched.
    pub(super) limits: Option<[f64; 2]>,
}

/// What a sliding node does to a piece.
pub(super) struct Response {
    /// Its number among the sliders.
    pub(super) slider: usize,
    /// Its place in the rim.
    pub(super) rim: usize,
    /// Change of each distance by a unit step along each tangent.
    pub(super) slopes: Vec<Vec<f64>>,
}

/// Lets the nodes slide one after the other, `sweeps` times, to the minimum over all pieces of
///
/// ```text
/// sum  mean (d / level)^8  +  STIFFNESS mean |grad u|^2
/// ```
///
/// `d` the distances of a piece's samples and `u` what its rim has slid. The second term keeps neighbours together: thin faces, whose
/// long edges lie side by side, would fold.
pub(super) fn relax(sliders: &mut [Slider], models: &mut [Model], sweeps: usize) {
    for _ in 0..sweeps {
        for slider in &mut *sliders {
            let step = newton(slider, models);
            let moved: DVec3 = slider.along.iter().zip(step).map(|(t, s)| *t * s).sum();
            slider.step += moved;
            for &(m, r) in &slider.at {
                let Model { distances, sliders, shifts, .. } = &mut models[m];
                shifts[sliders[r].rim] += moved;
                for (slopes, s) in sliders[r].slopes.iter().zip(step) {
                    distances.iter_mut().zip(slopes).for_each(|(d, slope)| *d += slope * s);
                }
            }
        }
    }
}

/// Lets the nodes of a line that no other line shares slide to the minimum of the same, by at most so many steps of Newton's method. The
/// powers of its strains over their limits are added: cut off at its limits afterwards, a slide comes less far.
pub(super) fn solve(sliders: &mut [Slider], own: &mut Model, steps: usize) {
    let sliding: Vec<usize> =
        (0..own.sliders.len()).filter(|&r| sliders[own.sliders[r].slider].along.len() == 1).collect();
    let tangents: Vec<DVec3> = sliding.iter().map(|&r| sliders[own.sliders[r].slider].along[0]).collect();
    let mut value = own.value();
    for _ in 0..steps {
        let (gradient, hessian) = own.derivatives(&sliding, &tangents);
        let Some(step) = solved(hessian, gradient) else { break };
        let mut share = -1.0;
        own.slide(&sliding, &tangents, &step, share);
        let after = loop {
            let after = own.value();
            if after < value || share.abs() < LEAST_STEP {
                break after;
            }
            own.slide(&sliding, &tangents, &step, -0.5 * share);
            share *= 0.5;
        };
        for ((&r, tangent), own_step) in sliding.iter().zip(&tangents).zip(&step) {
            sliders[own.sliders[r].slider].step += *tangent * (own_step * share);
        }
        if value - after < CONVERGED * value {
            break;
        }
        value = after;
    }
}

/// Solves a small symmetric positive semidefinite system by Gauss's elimination, damped where it is nearly singular; `None` where it is zero.
fn solved(mut matrix: Vec<Vec<f64>>, mut side: Vec<f64>) -> Option<Vec<f64>> {
    let n = side.len();
    let largest = (0..n).map(|row| matrix[row][row]).fold(0.0, f64::max);
    (0..n).for_each(|row| matrix[row][row] += DAMPING * largest);
    for pivot in 0..n {
        let diagonal = matrix[pivot][pivot];
        if diagonal <= 0.0 || !diagonal.is_finite() {
            return None;
        }
        for row in (0..n).filter(|&row| row != pivot) {
            let factor = matrix[row][pivot] / diagonal;
            for column in pivot..n {
                let entry = matrix[pivot][column];
                matrix[row][column] -= factor * entry;
            }
            side[row] -= factor * side[pivot];
        }
    }
    Some((0..n).map(|row| side[row] / matrix[row][row]).collect())
}

/// Newton's step of one node, along its tangents.
fn newton(slider: &Slider, models: &[Model]) -> [f64; 2] {
    let ways = slider.along.len();
    let (mut g, mut h) = ([0.0; 2], [[0.0; 2]; 2]);
    for &(m, r) in &slider.at {
        let own = &models[m];
        let Response { rim, ref slopes, .. } = own.sliders[r];
        let power = f64::from(POWER);
        let share = power / own.distances.len().max(1) as f64;
        for (s, d) in own.distances.iter().enumerate() {
            let q = d / own.level;
            let weight = share * q.powi(POWER - 2);
            for a in 0..ways {
                let slope = slopes[a][s] / own.level;
                g[a] += weight * q * slope;
                for b in 0..ways {
                    h[a][b] += (power - 1.0) * weight * slope * slopes[b][s] / own.level;
                }
            }
        }
        let pull: DVec3 = own.shifts.iter().zip(&own.products[rim]).map(|(u, k)| *u * *k).sum();
        for a in 0..ways {
            g[a] += 2.0 * STIFFNESS * pull.dot(slider.along[a]);
            h[a][a] += 2.0 * STIFFNESS * own.products[rim][rim];
        }
    }
    let determinant = h[0][0] * h[1][1] - h[0][1] * h[1][0];
    match ways {
        1 if h[0][0] > 0.0 => [-g[0] / h[0][0], 0.0],
        2 if determinant > 0.0 => {
            [(g[1] * h[0][1] - g[0] * h[1][1]) / determinant, (g[0] * h[1][0] - g[1] * h[0][0]) / determinant]
        }
        _ => [0.0; 2],
    }
}

impl Model {
    /// What is minimised, of a line.
    fn value(&self) -> f64 {
        let count = self.distances.len().max(1) as f64;
        let far: f64 = self.distances.iter().map(|d| (d / self.level).powi(POWER)).sum();
        let mut strain = 0.0;
        for (u, row) in self.shifts.iter().zip(&self.products) {
            strain += self.shifts.iter().zip(row).map(|(v, k)| u.dot(*v) * k).sum::<f64>();
        }
        let (pulls, points) = (self.pulls(&self.shifts), self.slopes.len() as f64);
        far / count + STIFFNESS * strain + pulls.map(|pull| pull.abs().powi(LIMITED)).sum::<f64>() / points
    }

    /// Strains of a line at the lattice's points along its chord, over their limits: below zero where it is squeezed.
    pub(super) fn pulls(&self, shifts: &[DVec3]) -> impl Iterator<Item = f64> {
        let [squeezed, stretched] = self.limits.unwrap_or([f64::INFINITY; 2]);
        let strain = |slopes: &Vec<DVec3>| shifts.iter().zip(slopes).map(|(u, slope)| u.dot(*slope)).sum::<f64>();
        self.slopes.iter().map(strain).map(move |strain| strain / if strain < 0.0 { squeezed } else { stretched })
    }

    /// Its derivatives by the slides of some of its nodes along their tangents.
    fn derivatives(&self, sliding: &[usize], tangents: &[DVec3]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let n = sliding.len();
        let (mut g, mut h) = (vec![0.0; n], vec![vec![0.0; n]; n]);
        let power = f64::from(POWER);
        let share = power / self.distances.len().max(1) as f64;
        for (s, d) in self.distances.iter().enumerate() {
            let q = d / self.level;
            let weight = share * q.powi(POWER - 2);
            let slope = |a: usize| self.sliders[sliding[a]].slopes[0][s] / self.level;
            for a in 0..n {
                g[a] += weight * q * slope(a);
                for b in 0..n {
                    h[a][b] += (power - 1.0) * weight * slope(a) * slope(b);
                }
            }
        }
        self.limit(sliding, tangents, &mut g, &mut h);
        for a in 0..n {
            let own = &self.products[self.sliders[sliding[a]].rim];
            let pull: DVec3 = self.shifts.iter().zip(own).map(|(u, k)| *u * *k).sum();
            g[a] += 2.0 * STIFFNESS * pull.dot(tangents[a]);
            for b in 0..n {
                h[a][b] += 2.0 * STIFFNESS * own[self.sliders[sliding[b]].rim] * tangents[a].dot(tangents[b]);
            }
        }
        (g, h)
    }

    /// Adds the derivatives of what its strains over their limits add.
    fn limit(&self, sliding: &[usize], tangents: &[DVec3], g: &mut [f64], h: &mut [Vec<f64>]) {
        let [squeezed, stretched] = self.limits.unwrap_or([f64::INFINITY; 2]);
        let hard = f64::from(LIMITED);
        let share = hard / self.slopes.len() as f64;
        for (pull, slopes) in self.pulls(&self.shifts).zip(&self.slopes) {
            let limit = if pull < 0.0 { squeezed } else { stretched };
            let weight = share * pull.abs().powi(LIMITED - 2);
            let slope = |a: usize| slopes[self.sliders[sliding[a]].rim].dot(tangents[a]) / limit;
            for a in 0..sliding.len() {
                g[a] += weight * pull * slope(a);
                for b in 0..sliding.len() {
                    h[a][b] += (hard - 1.0) * weight * slope(a) * slope(b);
                }
            }
        }
    }

    /// Slides some of its nodes along their tangents by a share of a step.
    fn slide(&mut self, sliding: &[usize], tangents: &[DVec3], step: &[f64], share: f64) {
        for ((&r, tangent), step) in sliding.iter().zip(tangents).zip(step) {
            let Response { rim, ref slopes, .. } = self.sliders[r];
            self.shifts[rim] += *tangent * (step * share);
            self.distances.iter_mut().zip(&slopes[0]).for_each(|(d, slope)| *d += slope * step * share);
        }
    }

    /// What the rim has slid at a fraction of its way from `before`.
    pub(super) fn shifts_at(&self, before: &[DVec3], share: f64) -> Vec<DVec3> {
        before.iter().zip(&self.shifts).map(|(a, b)| a.lerp(*b, share)).collect()
    }

    /// Largest strain `|grad u|` where the rim has slid from `before` by a fraction of its way.
    pub(super) fn strain(&self, before: &[DVec3], share: f64) -> f64 {
        let shifts = self.shifts_at(before, share);
        let at = |slopes: &Vec<DVec3>| -> f64 {
            let row = |axis: usize| -> DVec3 { shifts.iter().zip(slopes).map(|(u, s)| *s * u[axis]).sum() };
            (0..3).map(|axis| row(axis).length_squared()).sum::<f64>().sqrt()
        };
        self.slopes.iter().map(at).fold(0.0, f64::max)
    }
}

/// Gradients in space of functions with the given slopes; zero on edges, but for those of a plane mesh (`lines`), and where the corners lie
/// in a line.
///
/// `straight` are the slopes of the corners' linear functions.
pub(super) fn gradients(slopes: &[[f64; 2]], straight: &[[f64; 2]], corners: &[DVec3], lines: bool) -> Vec<DVec3> {
    let axis = |a: usize| -> DVec3 { corners.iter().zip(straight).map(|(x, s)| *x * s[a]).sum() };
    let (a, b) = (axis(0), axis(1));
    let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
    let area = aa * bb - ab * ab;
    if lines && aa > 0.0 {
        return slopes.iter().map(|s| a * (s[0] / aa)).collect();
    }
    if area <= 0.0 {
        return vec![DVec3::ZERO; slopes.len()];
    }
    let (u, v) = ((a * bb - b * ab) / area, (b * aa - a * ab) / area);
    slopes.iter().map(|s| u * s[0] + v * s[1]).collect()
}
