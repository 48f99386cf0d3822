//! MSH 4.1, from a mesh.

use std::io;

use super::node_order::ORDER;
use super::outline::Outline;
use super::sink::Sink;
use super::type_code;
use crate::formats::part::Unwritten;
use crate::mesh::Mesh;

/// Writes all sections after `$PhysicalNames`.
pub(super) fn write(sink: &mut impl Sink, mesh: &Mesh) -> Result<(), Unwritten> {
    let outline = Outline::new(mesh);
    entities(sink, &outline)?;
    nodes(sink, mesh, &outline)?;
    elements(sink, mesh, &outline)?;
    Ok(periodic(sink, mesh)?)
}

fn entities(sink: &mut impl Sink, outline: &Outline) -> io::Result<()> {
    sink.open("Entities")?;
    for dimension in 0..=3 {
        let count = outline.entities.iter().filter(|e| e.key.dimension == dimension).count();
        sink.size(count as u64)?;
    }
    sink.end_line()?;
    for entity in &outline.entities {
        let point = entity.key.dimension == 0;
        sink.int(entity.key.tag)?;
        sink.reals(&entity.bounds[0])?;
        if !point {
            sink.reals(&entity.bounds[1])?;
        }
        sink.ints(&entity.physical_tags)?;
        if !point {
            sink.ints(&entity.boundary)?;
        }
        sink.end_line()?;
    }
    sink.close("Entities")
}

/// The head of a list: number of blocks and items, smallest and largest number.
fn head(sink: &mut impl Sink, blocks: usize, tags: impl Iterator<Item = u64> + Clone) -> io::Result<()> {
    sink.size(blocks as u64)?;
    sink.size(tags.clone().count() as u64)?;
    sink.size(tags.clone().min().unwrap_or(0))?;
    sink.size(tags.max().unwrap_or(0))?;
    sink.end_line()
}

fn nodes(sink: &mut impl Sink, mesh: &Mesh, outline: &Outline) -> io::Result<()> {
    sink.open("Nodes")?;
    head(sink, outline.runs.len(), mesh.node_tags().iter().copied())?;
    for run in &outline.runs {
        let node = |n: usize| outline.node(run.places.start + n);
        sink.int(i32::from(run.entity.dimension))?;
        sink.int(run.entity.tag)?;
        sink.int(i32::from(run.parametric))?;
        sink.size(run.places.len() as u64)?;
        sink.end_line()?;
        sink.rows(run.places.len(), |sink, n| {
            sink.size(mesh.node_tags()[node(n)])?;
            sink.end_line()
        })?;
        sink.rows(run.places.len(), |sink, n| {
            sink.reals(&mesh.points()[node(n)].to_array())?;
            if let Some(uv) = outline.parameters(node(n)).filter(|_| run.parametric) {
                sink.reals(&uv[..usize::from(run.entity.dimension)])?;
            }
            sink.end_line()
        })?;
    }
    sink.close("Nodes")
}

fn elements(sink: &mut impl Sink, mesh: &Mesh, outline: &Outline) -> Result<(), Unwritten> {
    sink.open("Elements")?;
    head(sink, mesh.blocks().len(), mesh.blocks().iter().flat_map(|b| b.tags.iter().copied()))?;
    for (block, entity) in mesh.blocks().iter().zip(&outline.blocks) {
        let slots = slots(mesh, block)?;
        sink.int(i32::from(entity.dimension))?;
        sink.int(entity.tag)?;
        sink.int(type_code::of(block.cell, mesh.order()))?;
        sink.size(block.tags.len() as u64)?;
        sink.end_line()?;
        let stride = block.stride(mesh.order());
        sink.rows(block.tags.len(), |sink, n| {
            sink.size(block.tags[n])?;
            let nodes = &block.nodes[n * stride..][..stride];
            slots.iter().try_for_each(|&slot| sink.size(mesh.node_tags()[nodes[usize::from(slot)].index()]))?;
            sink.end_line()
        })?;
    }
    Ok(sink.close("Elements")?)
}

/// Gmsh's node order for a block.
pub(super) fn slots(mesh: &Mesh, block: &crate::mesh::Block) -> Result<&'static [u8], Unwritten> {
    let missing = || Unwritten::Inexpressible(format!("MSH has no {} of {}", block.cell, mesh.order()));
    ORDER.slots(block.cell, mesh.order()).ok_or_else(missing)
}

fn periodic(sink: &mut impl Sink, mesh: &Mesh) -> io::Result<()> {
    if mesh.periodic().is_empty() {
        return Ok(());
    }
    sink.open("Periodic")?;
    sink.size(mesh.periodic().len() as u64)?;
    sink.end_line()?;
    for link in mesh.periodic() {
        sink.int(i32::from(link.slave.dimension))?;
        sink.int(link.slave.tag)?;
        sink.int(link.master)?;
        sink.end_line()?;
        sink.size(link.affine.len() as u64)?;
        sink.reals(&link.affine)?;
        sink.end_line()?;
        sink.size(link.pairs.len() as u64)?;
        sink.end_line()?;
        for &(a, b) in &link.pairs {
            sink.size(mesh.node_tags()[a.index()])?;
            sink.size(mesh.node_tags()[b.index()])?;
            sink.end_line()?;
        }
    }
    sink.close("Periodic")
}
