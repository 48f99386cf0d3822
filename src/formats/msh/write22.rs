//! MSH 2.2, from a mesh.

use std::collections::HashMap;

use super::sink::Sink;
use super::type_code;
use super::write41::slots;
use crate::formats::part::Unwritten;
use crate::mesh::{Block, Entity, EntityKey, Mesh};

/// Writes all sections after `$PhysicalNames`.
pub(super) fn write(sink: &mut impl Sink, mesh: &Mesh) -> Result<(), Unwritten> {
    nodes(sink, mesh)?;
    elements(sink, mesh)?;
    periodic(sink, mesh)
}

/// A number as this version holds it.
fn int(value: u64) -> Result<i32, Unwritten> {
    i32::try_from(value).map_err(|_| {
        Unwritten::Inexpressible(format!("number {value} is beyond MSH 2.2's limit of {}; write version 4.1", i32::MAX))
    })
}

fn nodes(sink: &mut impl Sink, mesh: &Mesh) -> Result<(), Unwritten> {
    sink.open("Nodes")?;
    sink.text(&format!("{}\n", mesh.points().len()))?;
    for (&tag, point) in mesh.node_tags().iter().zip(mesh.points()) {
        sink.int(int(tag)?)?;
        sink.reals(&point.to_array())?;
        sink.end_line()?;
    }
    Ok(sink.close("Nodes")?)
}

/// The physical groups of a block's elements: 0 where there is none, else one or several positive tags.
fn groups(entities: &HashMap<EntityKey, &Entity>, block: &Block) -> Vec<i32> {
    let of_entity = || entities.get(&block.entity).map(|e| &e.physical_tags);
    let tags = if block.physical_tags.is_empty() { of_entity() } else { Some(&block.physical_tags) };
    match tags {
        // The sign gives the group's orientation, for which this version has no place.
        Some(tags) if !tags.is_empty() => tags.iter().map(|tag| tag.saturating_abs()).collect(),
        _ => vec![0],
    }
}

/// An element in several groups stands once for each: first under its own number, then under new ones.
fn elements<S: Sink>(sink: &mut S, mesh: &Mesh) -> Result<(), Unwritten> {
    let entities: HashMap<EntityKey, &Entity> = mesh.entities().iter().map(|e| (e.key, e)).collect();
    let groups: Vec<Vec<i32>> = mesh.blocks().iter().map(|block| groups(&entities, block)).collect();
    let count: usize = mesh.blocks().iter().zip(&groups).map(|(block, groups)| block.tags.len() * groups.len()).sum();
    let mut last = mesh.blocks().iter().flat_map(|b| &b.tags).copied().max().unwrap_or(0);
    sink.open("Elements")?;
    sink.text(&format!("{count}\n"))?;
    for (block, groups) in mesh.blocks().iter().zip(&groups) {
        let slots = slots(mesh, block)?;
        for (n, &group) in groups.iter().enumerate() {
            let head = [type_code::of(block.cell, mesh.order()), int(block.tags.len() as u64)?, 2];
            if S::BINARY && !block.tags.is_empty() {
                head.iter().try_for_each(|&value| sink.int(value))?;
            }
            for (&tag, nodes) in block.tags.iter().zip(block.elements(mesh.order())) {
                let tag = if n == 0 {
                    tag
                } else {
                    last += 1;
                    last
                };
                sink.int(int(tag)?)?;
                if !S::BINARY {
                    sink.int(head[0])?;
                    sink.int(head[2])?;
                }
                sink.int(group)?;
                sink.int(block.entity.tag)?;
                for &slot in slots {
                    sink.int(int(mesh.node_tags()[nodes[usize::from(slot)].index()])?)?;
                }
                sink.end_line()?;
            }
        }
    }
    Ok(sink.close("Elements")?)
}

/// Text in both encodings.
fn periodic(sink: &mut impl Sink, mesh: &Mesh) -> Result<(), Unwritten> {
    if mesh.periodic().is_empty() {
        return Ok(());
    }
    sink.text(&format!("$Periodic\n{}\n", mesh.periodic().len()))?;
    for link in mesh.periodic() {
        sink.text(&format!("{} {} {}\n", link.slave.dimension, link.slave.tag, link.master))?;
        if !link.affine.is_empty() {
            let values: Vec<String> = link.affine.iter().map(|x| format!("{x:?}")).collect();
            sink.text(&format!("Affine {}\n", values.join(" ")))?;
        }
        sink.text(&format!("{}\n", link.pairs.len()))?;
        for &(a, b) in &link.pairs {
            sink.text(&format!("{} {}\n", mesh.node_tags()[a.index()], mesh.node_tags()[b.index()]))?;
        }
    }
    Ok(sink.text("$EndPeriodic\n")?)
}
