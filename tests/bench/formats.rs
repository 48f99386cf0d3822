//! Megabytes a second of reading and writing the binary formats: a block of a million hexes, and one of order 3.
//!
//! `cargo bench --bench formats`, from the repository's root; prints a table, the best of three runs each, file in the page cache.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use glam::DVec3;
use sagitta::element::{Cell, Order};
use sagitta::formats::{self, ReadOptions, WriteOptions, cgns, msh};
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{Block, EntityKey, Mesh, NodeId, Parts};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, word, path] = arguments.as_slice()
        && word == cgns::READER_SUBCOMMAND
    {
        return cgns::serve_reader(path.as_ref());
    }
    match table() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn table() -> Result<(), Box<dyn Error>> {
    println!("| format | MB | read MB/s | written MB/s |\n|---|---|---|---|");
    let folder = tempfile::tempdir()?;
    for (order, cells) in [(1, 100), (3, 32)] {
        let mesh = elevate(&block(cells)?, Order::new(order)?)?.mesh;
        let v2 = WriteOptions { msh_version: msh::Version::V2_2, ..WriteOptions::default() };
        let written = [
            ("MSH 4.1", "a.msh", WriteOptions::default()),
            ("MSH 2.2", "b.msh", v2),
            ("CGNS", "c.cgns", WriteOptions::default()),
            ("VTU, appended raw", "d.vtu", WriteOptions::default()),
        ];
        for (name, file, options) in written {
            let path = folder.path().join(file);
            let seconds = best(|| Ok(_ = formats::write(&path, &mesh, &options)?))?;
            row(&format!("{name}, P{order}"), &path, Some(seconds))?;
        }
        if order == 1 {
            for (name, file, bytes) in
                [("UGRID lb8", "e.lb8.ugrid", ugrid(&mesh)), ("legacy VTK", "f.vtk", legacy(&mesh))]
            {
                let path = folder.path().join(file);
                std::fs::write(&path, bytes)?;
                row(&format!("{name}, P1"), &path, None)?;
            }
        }
    }
    Ok(())
}

fn row(name: &str, path: &Path, written: Option<f64>) -> Result<(), Box<dyn Error>> {
    let options = ReadOptions { reader: Some(std::env::current_exe()?), ..ReadOptions::default() };
    let read = best(|| {
        formats::read_with(path, &options)?;
        Ok(())
    })?;
    let size = std::fs::metadata(path)?.len() as f64 / 1e6;
    let written = written.map_or_else(|| "-".to_owned(), |seconds| format!("{:.0}", size / seconds));
    println!("| {name} | {size:.0} | {:.0} | {written} |", size / read);
    Ok(())
}

fn best(mut work: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut least = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        work()?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    Ok(least)
}

/// A cube of `n` x `n` x `n` hexes, with the quadrilaterals of its sides.
fn block(n: usize) -> Result<Mesh, Box<dyn Error>> {
    let count = n + 1;
    let node = |i: usize, j: usize, k: usize| NodeId::new(i + count * (j + count * k));
    let mut parts = Parts::default();
    for k in 0..count {
        for j in 0..count {
            parts.points.extend((0..count).map(|i| DVec3::new(i as f64, j as f64, k as f64) / n as f64));
        }
    }
    let mut hexes = Vec::new();
    for (k, j, i) in (0..n).flat_map(|k| (0..n).flat_map(move |j| (0..n).map(move |i| (k, j, i)))) {
        for corner in Cell::Hex.corners() {
            let [a, b, c] = [0, 1, 2].map(|axis| usize::from(corner[axis]));
            hexes.push(node(i + a, j + b, k + c)?);
        }
    }
    let mut tags = 1..;
    let mut push = |cell, entity, nodes: Vec<NodeId>, stride| {
        let tags = tags.by_ref().take(nodes.len() / stride).collect();
        parts.blocks.push(Block { tags, nodes, ..Block::new(cell, entity) });
    };
    push(Cell::Hex, EntityKey::new(3, 1), hexes, 8);
    for side in 0..6_i32 {
        let (axis, end) = (side as usize / 2, (side as usize % 2) * n);
        let mut quads = Vec::new();
        for (a, b) in (0..n).flat_map(|b| (0..n).map(move |a| (a, b))) {
            for (u, v) in [(a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)] {
                let mut at = [u, v, 0];
                at[2] = end;
                at.rotate_right((axis + 1) % 3);
                quads.push(node(at[0], at[1], at[2])?);
            }
        }
        push(Cell::Quad, EntityKey::new(2, side + 1), quads, 4);
    }
    Ok(Mesh::new(parts)?)
}

fn ugrid(mesh: &Mesh) -> Vec<u8> {
    let (quads, hexes): (Vec<&Block>, Vec<&Block>) = (mesh.side_blocks().collect(), mesh.cell_blocks().collect());
    let count = |blocks: &[&Block]| blocks.iter().map(|block| block.tags.len()).sum::<usize>();
    let counts = [mesh.points().len(), 0, count(&quads), 0, 0, 0, count(&hexes)];
    let mut bytes: Vec<u8> = counts.iter().flat_map(|n| (*n as i32).to_le_bytes()).collect();
    bytes.extend(mesh.points().iter().flat_map(|x| x.to_array()).flat_map(f64::to_le_bytes));
    let nodes = |blocks: &[&Block]| -> Vec<u8> {
        blocks.iter().flat_map(|block| &block.nodes).flat_map(|n| (n.index() as i32 + 1).to_le_bytes()).collect()
    };
    bytes.extend(nodes(&quads));
    bytes.extend(quads.iter().flat_map(|block| block.tags.iter().flat_map(|_| block.entity.tag.to_le_bytes())));
    bytes.extend(nodes(&hexes));
    bytes
}

fn legacy(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = b"# vtk DataFile Version 3.0\nblock\nBINARY\nDATASET UNSTRUCTURED_GRID\n".to_vec();
    bytes.extend(format!("POINTS {} double\n", mesh.points().len()).bytes());
    bytes.extend(mesh.points().iter().flat_map(|x| x.to_array()).flat_map(f64::to_be_bytes));
    let cells = || mesh.blocks().iter().flat_map(|block| block.elements(Order::LINEAR));
    let (count, numbers) = (cells().count(), cells().map(|nodes| 1 + nodes.len()).sum::<usize>());
    bytes.extend(format!("\nCELLS {count} {numbers}\n").bytes());
    for nodes in cells() {
        bytes.extend((nodes.len() as i32).to_be_bytes());
        bytes.extend(nodes.iter().flat_map(|n| (n.index() as i32).to_be_bytes()));
    }
    bytes.extend(format!("\nCELL_TYPES {count}\n").bytes());
    bytes.extend(cells().flat_map(|nodes| (if nodes.len() == 8 { 12_i32 } else { 9 }).to_be_bytes()));
    bytes
}
