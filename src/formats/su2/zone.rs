//! A mesh from the zones of an SU2 file.

use std::collections::HashMap;

use glam::DVec3;

use super::type_code::ORDER;
use crate::element::{Cell, Order};
use crate::formats::assembly::{Assembly, node_of};
use crate::formats::error::Fault;
use crate::mesh::{EntityKey, Mesh, NodeId};

/// A zone as it stands in the file.
#[derive(Default)]
pub(super) struct Zone {
    pub(super) dimension: Option<usize>,
    pub(super) points: Option<Vec<DVec3>>,
    pub(super) cells: Option<Elements>,
    pub(super) markers: Vec<Marker>,
    /// `NMARK=`, and the markers that there are, with those that are not used.
    pub(super) announced: Option<u64>,
    pub(super) markers_found: u64,
}

impl Zone {
    /// Whether nothing has been said of it but its dimension.
    pub(super) fn is_bare(&self) -> bool {
        self.points.is_none() && self.cells.is_none() && self.announced.is_none() && self.markers_found == 0
    }
}

/// Elements as they stand in the file.
#[derive(Default)]
pub(super) struct Elements {
    pub(super) kinds: Vec<(Cell, Order)>,
    /// The line of each.
    pub(super) lines: Vec<u64>,
    /// The nodes of all, one element behind the other.
    pub(super) nodes: Vec<i64>,
}

/// Named boundary elements.
pub(super) struct Marker {
    pub(super) name: String,
    pub(super) elements: Elements,
}

/// The mesh of all zones, and the line of what is wrong with it.
pub(super) fn mesh(mut zones: Vec<Zone>, notes: Vec<String>) -> Result<Mesh, (Option<u64>, Fault)> {
    let mut points = Vec::new();
    let mut starts = Vec::new();
    for zone in &mut zones {
        starts.push(points.len());
        points.append(&mut zone.points.take().unwrap_or_default());
    }
    starts.push(points.len());
    let mut assembly = Assembly::new(points).map_err(|fault| (None, fault))?;
    assembly.parts.notes = notes;
    let mut tags: HashMap<&str, i32> = HashMap::new();
    for (n, zone) in zones.iter().enumerate() {
        let range = starts[n]..starts[n + 1];
        if let Some(cells) = &zone.cells {
            push(&mut assembly, cells, &range, n as i32 + 1)?;
        }
        for Marker { name, elements } in &zone.markers {
            let next = tags.len() as i32 + 1;
            let tag = *tags.entry(name).or_insert(next);
            push(&mut assembly, elements, &range, tag)?;
            if let Some((cell, _)) = elements.kinds.first().filter(|_| tag == next) {
                let dimension = cell.dimension() as u8;
                let group = assembly.group(dimension, name, Some(tag));
                assembly.entity(EntityKey::new(dimension, tag), vec![group]);
            }
        }
    }
    if zones.len() > 1 {
        assembly
            .parts
            .notes
            .push(format!("the file has {} zones, which become one mesh; their points are not joined", zones.len()));
    }
    assembly.finish().map_err(|fault| (None, fault))
}

/// Adds elements whose nodes are counted from 0 within a range of the points.
fn push(
    assembly: &mut Assembly,
    elements: &Elements,
    points: &std::ops::Range<usize>,
    tag: i32,
) -> Result<(), (Option<u64>, Fault)> {
    let mut rest = &elements.nodes[..];
    let mut nodes: Vec<NodeId> = Vec::new();
    for (n, (&(cell, order), &line)) in elements.kinds.iter().zip(&elements.lines).enumerate() {
        let told = |fault| (Some(line), fault);
        assembly.set_order(cell, order).map_err(told)?;
        let (own, others) = rest.split_at(cell.node_count(order));
        rest = others;
        nodes.clear();
        nodes.resize(own.len(), NodeId::default());
        for (&slot, &number) in ORDER.slots(cell, order).unwrap_or_default().iter().zip(own) {
            let node = node_of(points.len(), number, 0, n as u64).map_err(told)?;
            nodes[usize::from(slot)] = NodeId::new(points.start + node.index()).map_err(|fault| told(fault.into()))?;
        }
        assembly.push(cell, EntityKey::new(cell.dimension() as u8, tag), &nodes);
    }
    Ok(())
}
