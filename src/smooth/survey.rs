//! The Jacobian survey of one element: `J / J_c` at its points, and what the objective's derivatives need of it.
//!
//! The loops run over lanes of points, with the instructions that the machine has (AVX2 and FMA where there are): a P4 tet
//! surveyed at density 16 multiplies 35 nodes by 969 points by 9 entries. Blocks of points where no term is left
//! (`J >= J_c`) are passed over.

use glam::{DMat3, DVec3};
use pulp::{Arch, Simd, WithSimd};

use super::density::Density;
use super::derivative::NodeDerivative;
use crate::element::samples::LANES;
use crate::element::{Cell, Order, Samples};

/// Tables for all elements of one cell.
pub(super) struct Survey {
    arch: Arch,
    count: usize,
    padded: usize,
    nodes: usize,
    corners: usize,
    /// The last entry of every frame, to begin with: a plane cell's slopes along its third axis are none, and it stands on the unit vector.
    up: f64,
    curved: Vec<f64>,
    /// The linear element's gradients at the same points, for `J_c`; one block where they are the same at all points.
    linear: Vec<f64>,
}

/// Buffers that are kept from element to element.
#[derive(Default)]
pub(super) struct Scratch {
    /// Cofactors of `dx_a/dxi_b` at the points, `[3 a + b][point]`.
    cofactors: Vec<f64>,
    /// `J_c` at the points.
    jc: Vec<f64>,
    /// `J / J_c` at the points.
    ratio: Vec<f64>,
    slope: Vec<f64>,
    curvature: Vec<f64>,
    /// Gradient (3) and Hessian (6) of every node, by lane.
    sums: Vec<f64>,
}

impl Survey {
    /// The survey of density `divisions`.
    pub(super) fn new(cell: Cell, order: Order, divisions: usize) -> Survey {
        let curved = Samples::survey(cell, order, divisions);
        let (nodes, corners) = (cell.node_count(order), cell.corner_count());
        let mut linear = by_block(&Samples::survey(cell, Order::LINEAR, divisions), corners);
        let block = 3 * corners * LANES;
        let same = |chunk: &[f64]| chunk.iter().zip(&linear).all(|(a, b)| a == b);
        let uniform = linear.chunks_exact(LANES).all(|lanes| lanes.iter().all(|x| *x == lanes[0]));
        if uniform && linear.chunks(block).all(same) {
            linear.truncate(block);
        }
        let (count, padded) = (curved.count(), curved.padded());
        let up = if cell.is_flat() { 1.0 } else { 0.0 };
        Survey { arch: Arch::new(), count, padded, nodes, corners, up, curved: by_block(&curved, nodes), linear }
    }

    /// Smallest `C_JAC` at the points, equation (6).
    pub(super) fn c_jac(&self, points: &[DVec3], targets: &[DVec3], scratch: &mut Scratch) -> f64 {
        self.look(points, targets, false, scratch);
        scratch.ratio[..self.count].iter().copied().fold(1.0, f64::min)
    }

    /// The mean of the points' terms.
    pub(super) fn value(&self, points: &[DVec3], targets: &[DVec3], density: &Density, scratch: &mut Scratch) -> f64 {
        self.look(points, targets, false, scratch);
        scratch.ratio[..self.count].iter().map(|&l| density.jacobian(l).value).sum::<f64>() / self.count as f64
    }

    /// `weight` times the mean of the points' terms; its derivatives are added to `nodes`.
    pub(super) fn derivatives(
        &self,
        points: &[DVec3],
        targets: &[DVec3],
        (density, weight): (&Density, f64),
        scratch: &mut Scratch,
        nodes: &mut [NodeDerivative],
    ) -> f64 {
        self.look(points, targets, true, scratch);
        let scale = weight / self.count as f64;
        for (own, fill) in [(&mut scratch.slope, 0.0), (&mut scratch.curvature, 0.0)] {
            own.clear();
            own.resize(self.padded, fill);
        }
        let mut value = 0.0;
        for s in 0..self.count {
            let jet = density.jacobian(scratch.ratio[s]);
            let inverse = 1.0 / scratch.jc[s];
            value += scale * jet.value;
            scratch.slope[s] = scale * jet.slope * inverse;
            scratch.curvature[s] = scale * jet.curvature * inverse * inverse;
        }
        if value > 0.0 {
            scratch.sums.clear();
            scratch.sums.resize(self.nodes * SUMS * LANES, 0.0);
            self.arch.dispatch(Gather { survey: self, scratch });
            for (node, lanes) in nodes.iter_mut().zip(scratch.sums.chunks_exact(SUMS * LANES)) {
                let sum = |q: usize| lanes[q * LANES..(q + 1) * LANES].iter().sum::<f64>();
                node.gradient += DVec3::new(sum(0), sum(1), sum(2));
                let [xx, yy, zz, yz, xz, xy] = [3, 4, 5, 6, 7, 8].map(sum);
                node.hessian += DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
            }
        }
        value
    }

    /// Tells `take` of every point and node: node, `C_JAC` at the point, its slope by the node (none where it is 1).
    pub(super) fn sensitivities(
        &self,
        points: &[DVec3],
        targets: &[DVec3],
        scratch: &mut Scratch,
        mut take: impl FnMut(usize, f64, DVec3),
    ) {
        self.look(points, targets, true, scratch);
        for s in 0..self.count {
            let (capped, inverse) = (scratch.ratio[s] >= 1.0, 1.0 / scratch.jc[s]);
            let row = |a: usize| DVec3::from([0, 1, 2].map(|b| scratch.cofactors[(3 * a + b) * self.padded + s]));
            let rows = [0, 1, 2].map(row);
            let table = &self.curved[(s / LANES) * self.nodes * 3 * LANES..];
            for (node, slopes) in table.chunks_exact(3 * LANES).take(self.nodes).enumerate() {
                let g = DVec3::from([0, 1, 2].map(|b| slopes[b * LANES + s % LANES]));
                let slope = if capped { DVec3::ZERO } else { DVec3::from(rows.map(|row| row.dot(g) * inverse)) };
                take(node, scratch.ratio[s].min(1.0), slope);
            }
        }
    }

    /// Fills ratios, `J_c` and, where wanted, cofactors.
    fn look(&self, points: &[DVec3], targets: &[DVec3], cofactors: bool, scratch: &mut Scratch) {
        scratch.jc.resize(self.padded, 0.0);
        scratch.ratio.resize(self.padded, 0.0);
        scratch.cofactors.resize(9 * self.padded, 0.0);
        self.arch.dispatch(Look { survey: self, points, targets, cofactors, scratch });
    }
}

/// Sums a node: gradient and the upper triangle of the Hessian block.
const SUMS: usize = 9;

/// `[block of points][node][axis][lane]`.
fn by_block(samples: &Samples, nodes: usize) -> Vec<f64> {
    let mut table = Vec::with_capacity(samples.padded() * nodes * 3);
    for start in (0..samples.padded()).step_by(LANES) {
        for node in 0..nodes {
            for slopes in samples.gradient(node) {
                table.extend_from_slice(&slopes[start..start + LANES]);
            }
        }
    }
    table
}

struct Look<'a> {
    survey: &'a Survey,
    points: &'a [DVec3],
    targets: &'a [DVec3],
    cofactors: bool,
    scratch: &'a mut Scratch,
}

impl WithSimd for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Look { survey, points, targets, cofactors, scratch } = self;
        let parts = LANES / S::F64_LANES;
        let blocks = survey.padded / S::F64_LANES;
        let curved = S::as_simd_f64s(&survey.curved).0;
        let linear = S::as_simd_f64s(&survey.linear).0;
        let fixed = survey.linear.len() == 3 * survey.corners * LANES;
        let jc = S::as_mut_simd_f64s(&mut scratch.jc).0;
        let ratio = S::as_mut_simd_f64s(&mut scratch.ratio).0;
        let out = S::as_mut_simd_f64s(&mut scratch.cofactors).0;
        let corners = &targets[..survey.corners];
        for block in 0..blocks {
            let (chunk, part) = (block / parts, block % parts);
            jc[block] = if fixed && block > 0 {
                jc[0]
            } else {
                let frame =
                    frame(simd, survey.up, &linear[chunk * survey.corners * 3 * parts..], (parts, part), corners);
                determinant(simd, &frame, &cofactors_of(simd, &frame))
            };
            let frame = frame(simd, survey.up, &curved[chunk * survey.nodes * 3 * parts..], (parts, part), points);
            let cofactor = cofactors_of(simd, &frame);
            ratio[block] = simd.div_f64s(determinant(simd, &frame, &cofactor), jc[block]);
            if cofactors {
                for (q, c) in cofactor.into_iter().enumerate() {
                    out[q * blocks + block] = c;
                }
            }
        }
    }
}

/// `frame[3 a + b] = sum_i x_i[a] dphi_i/dxi_b`, and `up` added to the last.
#[inline(always)]
fn frame<S: Simd>(
    simd: S,
    up: f64,
    table: &[S::f64s],
    (parts, part): (usize, usize),
    points: &[DVec3],
) -> [S::f64s; 9] {
    let mut frame = [simd.splat_f64s(0.0); 9];
    frame[8] = simd.splat_f64s(up);
    for (x, slopes) in points.iter().zip(table.chunks_exact(3 * parts)) {
        let slopes = [slopes[part], slopes[parts + part], slopes[2 * parts + part]];
        for (a, x) in [x.x, x.y, x.z].into_iter().enumerate() {
            let x = simd.splat_f64s(x);
            for (b, &slope) in slopes.iter().enumerate() {
                frame[3 * a + b] = simd.mul_add_e_f64s(x, slope, frame[3 * a + b]);
            }
        }
    }
    frame
}

/// Cofactors of row-major 3x3 matrices, row-major.
#[inline(always)]
fn cofactors_of<S: Simd>(simd: S, m: &[S::f64s; 9]) -> [S::f64s; 9] {
    let minor =
        |a: usize, b: usize, c: usize, d: usize| simd.sub_f64s(simd.mul_f64s(m[a], m[b]), simd.mul_f64s(m[c], m[d]));
    [
        minor(4, 8, 5, 7),
        minor(5, 6, 3, 8),
        minor(3, 7, 4, 6),
        minor(2, 7, 1, 8),
        minor(0, 8, 2, 6),
        minor(1, 6, 0, 7),
        minor(1, 5, 2, 4),
        minor(2, 3, 0, 5),
        minor(0, 4, 1, 3),
    ]
}

#[inline(always)]
fn determinant<S: Simd>(simd: S, m: &[S::f64s; 9], cofactors: &[S::f64s; 9]) -> S::f64s {
    let two = simd.mul_add_e_f64s(m[1], cofactors[1], simd.mul_f64s(m[0], cofactors[0]));
    simd.mul_add_e_f64s(m[2], cofactors[2], two)
}

/// Adds up the nodes' derivatives: `J` is affine in a node with the slope `c = cof(D) grad phi`.
struct Gather<'a> {
    survey: &'a Survey,
    scratch: &'a mut Scratch,
}

impl WithSimd for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Gather { survey, scratch } = self;
        let parts = LANES / S::F64_LANES;
        let blocks = survey.padded / S::F64_LANES;
        let curved = S::as_simd_f64s(&survey.curved).0;
        let cofactors = S::as_simd_f64s(&scratch.cofactors).0;
        let (slope, curvature) = (S::as_simd_f64s(&scratch.slope).0, S::as_simd_f64s(&scratch.curvature).0);
        let sums = S::as_mut_simd_f64s(&mut scratch.sums).0;
        for block in 0..blocks {
            let lanes = block * S::F64_LANES..(block + 1) * S::F64_LANES;
            if scratch.curvature[lanes].iter().all(|&c| c == 0.0) {
                continue;
            }
            let (chunk, part) = (block / parts, block % parts);
            let cof: [S::f64s; 9] = std::array::from_fn(|q| cofactors[q * blocks + block]);
            let (slope, curvature) = (slope[block], curvature[block]);
            let table = curved[chunk * survey.nodes * 3 * parts..].chunks_exact(3 * parts);
            for (slopes, sums) in table.zip(sums.chunks_exact_mut(SUMS * parts)) {
                let g = [slopes[part], slopes[parts + part], slopes[2 * parts + part]];
                let row = |a: usize| {
                    let two = simd.mul_add_e_f64s(cof[3 * a + 1], g[1], simd.mul_f64s(cof[3 * a], g[0]));
                    simd.mul_add_e_f64s(cof[3 * a + 2], g[2], two)
                };
                let c = [row(0), row(1), row(2)];
                let bent = c.map(|c| simd.mul_f64s(c, curvature));
                let products = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];
                for (a, &c) in c.iter().enumerate() {
                    let sum = &mut sums[a * parts + part];
                    *sum = simd.mul_add_e_f64s(slope, c, *sum);
                }
                for (q, (a, b)) in products.into_iter().enumerate() {
                    let sum = &mut sums[(3 + q) * parts + part];
                    *sum = simd.mul_add_e_f64s(bent[a], c[b], *sum);
                }
            }
        }
    }
}
