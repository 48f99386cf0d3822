//! Plane meshes by size: rings of quadrilaterals at P4 and of triangles at P2 between two circles, curved in memory.
//!
//! `cargo bench --bench plane`, from the repository's root; prints a table. The last row is the large one; its peak memory is the process's.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use cad::{Model, ReadOptions};
use glam::DVec3;
use sagitta::curve::{Settings, curve};
use sagitta::element::{Cell, Order};
use sagitta::mesh::{Block, EntityKey, Mesh, NodeId, Parts};

/// Thickness of the first layer.
const FIRST: f64 = 1e-4;

fn main() -> ExitCode {
    println!("| cells | order | nodes | seconds | peak MB | min J/Jc |");
    println!("|---|---|---|---|---|---|");
    let cases = [(Cell::Quad, 100, 100, 4), (Cell::Triangle, 100, 50, 2), (Cell::Triangle, 1000, 500, 2)];
    for (cell, around, layers, order) in cases {
        if let Err(error) = row(cell, around, layers, order) {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn row(cell: Cell, around: usize, layers: usize, order: usize) -> Result<(), Box<dyn std::error::Error>> {
    let path = PathBuf::from(format!("{}/fixtures/annulus/annulus.step", env!("CARGO_MANIFEST_DIR")));
    let (model, mesh) = (Model::read(&path, &ReadOptions::default())?, ring(cell, around, layers)?);
    let (count, order) = (mesh.cells().len(), Order::new(order)?);
    let start = Instant::now();
    let curved = curve(mesh, &model, None, &Settings::new(order), &mut ())?;
    let (seconds, nodes) = (start.elapsed().as_secs_f64(), curved.mesh.points().len());
    let least = curved.certificate.relative.lower;
    println!("| {count} {cell} | {order} | {nodes} | {seconds:.2} | {:.0} | {least:.3} |", peak());
    Ok(())
}

/// Cells between the circles of `annulus.step`, of radius 1 and 2, in layers that grow off the inner one.
fn ring(cell: Cell, around: usize, layers: usize) -> Result<Mesh, Box<dyn std::error::Error>> {
    let mut parts = Parts::default();
    // Layer k is at t + (1 - t) FIRST-graded height: the power that puts the first at FIRST.
    let power = FIRST.ln() / (1.0 / layers as f64).ln();
    for layer in 0..=layers {
        let radius = 1.0 + (layer as f64 / layers as f64).powf(power);
        for k in 0..around {
            let angle = TAU * k as f64 / around as f64;
            parts.points.push(DVec3::new(angle.cos(), angle.sin(), 0.0) * radius);
        }
    }
    let mut blocks = [Block::new(cell, EntityKey::new(2, 1)), Block::new(Cell::Line, EntityKey::new(1, 11))];
    let mut push = |block: usize, nodes: &[usize]| -> Result<(), sagitta::mesh::TooMany> {
        let tag = blocks[block].tags.len() as u64 + 1;
        blocks[block].tags.push(tag);
        for &node in nodes {
            blocks[block].nodes.push(NodeId::new(node)?);
        }
        Ok(())
    };
    for k in 0..around {
        let next = (k + 1) % around;
        for layer in [0, layers] {
            push(1, &[layer * around + k, layer * around + next])?;
        }
        for layer in 0..layers {
            let [a, b] = [k, next].map(|k| layer * around + k);
            let [d, c] = [a, b].map(|node| node + around);
            if cell == Cell::Quad {
                push(0, &[b, a, d, c])?;
            } else {
                push(0, &[b, a, d])?;
                push(0, &[b, d, c])?;
            }
        }
    }
    Ok(Mesh::new(Parts { blocks: blocks.into(), ..parts })?)
}

/// Largest resident memory so far, in MB; 0 where the system does not say.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok()).unwrap_or(0.0) / 1e3
}
