//! Sixty plane meshes round random NACA sections, at P2 to P4: a small part of `make gauntlet-2d` (`tests/gauntlet`), made here without
//! other programs. The CAD is the spline through their coordinates, `sagitta spline`.

use std::f64::consts::TAU;
use std::path::Path;

use crate::common::random::{Random, seed};
use crate::common::{json, number, sagitta};
use glam::DVec3;
use rayon::prelude::*;
use sagitta::element::Cell;
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{EntityKey, Mesh, NodeId, Parts};

const CASES: u64 = 60;
/// Least `C_JAC`.
const FLOOR: f64 = 0.6;
/// Coordinates between two wall nodes.
const BETWEEN: usize = 4;
/// Radius of the far field, in chords.
const FAR: f64 = 6.0;

/// A section's coordinates from the trailing edge over the upper side and back, `4 k + 1` of them; sharp.
fn section(random: &mut Random, edges: usize) -> Vec<DVec3> {
    let [camber, place, thick] = [[0.0, 0.05], [0.3, 0.6], [0.07, 0.2]].map(|[from, to]| random.between(from, to));
    let count = BETWEEN * edges;
    let at = |k: usize| {
        let turn = TAU * k as f64 / count as f64;
        let x = 0.5 * (1.0 + turn.cos());
        let series = x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1036 * x)));
        let half = 5.0 * thick * (0.2969 * x.sqrt() + series);
        let (from, run) = if x < place { (x, place) } else { (1.0 - x, 1.0 - place) };
        let (mean, slope) =
            (camber * from * (2.0 * run - from) / (run * run), 2.0 * camber * (run - from) / (run * run));
        let slope = if x < place { slope } else { -slope };
        let side = if 2 * k < count { 1.0 } else { -1.0 };
        let normal = DVec3::new(-slope, 1.0, 0.0).normalize();
        DVec3::new(x, mean, 0.0) + normal * (side * half)
    };
    let mut points: Vec<DVec3> = (0..=count).map(at).collect();
    (points[0], points[count]) = (DVec3::X, DVec3::X);
    points
}

/// Cells in columns from wall nodes to a circle; `cell` or, of `None`, quadrilaterals below and triangles above.
fn mesh(wall: &[DVec3], first: f64, layers: usize, cell: Option<Cell>) -> Mesh {
    let around = wall.len();
    let power = (first / FAR).ln() / (1.0 / layers as f64).ln();
    // The column off the trailing edge halves the angle there.
    let off = wall[0] - (wall[1] + wall[around - 1]) / 2.0;
    let tilt = off.y.atan2(off.x);
    let mut parts = Parts::default();
    for layer in 0..=layers {
        let share = (layer as f64 / layers as f64).powf(power);
        for (k, x) in wall.iter().enumerate() {
            let angle = TAU * k as f64 / around as f64 + tilt;
            let far = DVec3::new(0.5, 0.0, 0.0) + DVec3::new(angle.cos(), angle.sin(), 0.0) * FAR;
            parts.points.push(x.lerp(far, share));
        }
    }
    let mut push = |cell: Cell, tag: i32, nodes: &[usize]| {
        let nodes: Vec<NodeId> = nodes.iter().map(|&node| NodeId::new(node).unwrap()).collect();
        parts.push(cell, EntityKey::new(cell.dimension() as u8, tag), &nodes);
    };
    for k in 0..around {
        let next = (k + 1) % around;
        push(Cell::Line, 101, &[k, next]);
        push(Cell::Line, 102, &[layers * around + k, layers * around + next]);
        for layer in 0..layers {
            let [a, b] = [k, next].map(|k| layer * around + k);
            let [d, c] = [a, b].map(|node| node + around);
            if cell.unwrap_or(if 2 * layer < layers { Cell::Quad } else { Cell::Triangle }) == Cell::Quad {
                push(Cell::Quad, 1, &[b, a, d, c]);
            } else {
                push(Cell::Triangle, 1, &[b, a, d]);
                push(Cell::Triangle, 1, &[b, d, c]);
            }
        }
    }
    Mesh::new(parts).unwrap()
}

/// What is amiss with a case, at one of the orders.
fn faults(dir: &Path, case: u64, seed: u64) -> Vec<String> {
    let mut random = Random(seed.wrapping_add(case));
    let [dat, step, linear, output, report] =
        ["dat", "step", "msh", "out.msh", "json"].map(|extension| dir.join(format!("{case}.{extension}")));
    let edges = 24 + 2 * random.below(24);
    let (points, first) = (section(&mut random, edges), random.decade(1e-6, 1e-4));
    let cell = [Some(Cell::Triangle), Some(Cell::Quad), None][case as usize % 3];
    let rows: String = points.iter().map(|x| format!("{} {}\n", x.x, x.y)).collect();
    std::fs::write(&dat, format!("case {case}\n{rows}")).unwrap();
    sagitta(args!["spline", dat, "-o", step]).expect(0);
    let wall: Vec<DVec3> = points[..points.len() - 1].iter().step_by(BETWEEN).copied().collect();
    formats::write(&linear, &mesh(&wall, first, 20 + random.below(20), cell), &WriteOptions::default()).unwrap();
    let mut faults = Vec::new();
    for order in ["2", "3", "4"] {
        let options = args![
            "curve",
            linear,
            "--cad",
            step,
            "--order",
            order,
            "-o",
            output,
            "--report",
            report,
            "-q",
            "--threads",
            "1"
        ];
        let done = sagitta(options);
        let least = |key: &str| {
            let cells = json(&report)["cells"].as_array().unwrap().clone();
            cells.iter().map(|cell| number(cell, key)).fold(1.0, f64::min)
        };
        if done.code != Some(0) {
            faults.push(format!("case {case} P{order}: exit {:?}: {}{}", done.code, done.stdout, done.stderr));
        } else if least("/c_jac_min") < FLOOR {
            faults.push(format!("case {case} P{order}: C_JAC {}", least("/c_jac_min")));
        }
    }
    faults
}

#[test]
fn random_sections_are_curved() {
    let (dir, seed) = (tempfile::tempdir().unwrap(), seed(18));
    let all: Vec<String> = (0..CASES).into_par_iter().flat_map_iter(|case| faults(dir.path(), case, seed)).collect();
    assert!(all.is_empty(), "{} runs of {}:\n{}", all.len(), 3 * CASES, all.join("\n"));
}
