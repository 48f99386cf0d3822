//! Sections of MSH 4.1.

use super::draft::Draft;
use super::fault::MshFault;
use super::source::{Record, Source};
use crate::formats::error::{Fault, Flaw};
use crate::mesh::{Block, Entity, EntityKey, Periodic};

/// A dimension, 0 to 3.
pub(super) fn dimension(source: &mut impl Source) -> Result<u8, Flaw> {
    match source.int("a dimension")? {
        known @ 0..=3 => Ok(known as u8),
        other => Err(source.flaw(MshFault::EntityDimension(other))),
    }
}

fn entity_key(source: &mut impl Source) -> Result<EntityKey, Flaw> {
    Ok(EntityKey::new(dimension(source)?, source.int("an entity tag")?))
}

/// `$Entities`: all points, curves, surfaces, volumes.
pub(super) fn entities(source: &mut impl Source, draft: &mut Draft) -> Result<(), Flaw> {
    for (dimension, count) in entity_counts(source)? {
        for _ in 0..count {
            let row = source.begin_row("an entity")?;
            let tag = source.int("an entity tag")?;
            let entity = entity_body(source, EntityKey::new(dimension, tag))?;
            source.end_row(row, "an entity")?;
            draft.parts.entities.push(entity);
        }
    }
    Ok(())
}

/// `$PartitionedEntities`: only which entity each is a part of is kept.
pub(super) fn partitioned_entities(source: &mut impl Source, draft: &mut Draft) -> Result<(), Flaw> {
    source.size("the number of partitions")?;
    let ghosts = source.count("ghost entities", Record { ints: 2, ..Record::default() })?;
    for _ in 0..2 * ghosts {
        source.int("a ghost entity")?;
    }
    for (dimension, count) in entity_counts(source)? {
        for _ in 0..count {
            let tag = source.int("an entity tag")?;
            let parent = (source.int("a parent's dimension")?, source.int("a parent's tag")?);
            source.ints("partition numbers")?;
            let key = EntityKey::new(dimension, tag);
            entity_body(source, key)?;
            if let (parent_dimension @ 0..=3, parent_tag) = parent {
                draft.parents.insert(key, EntityKey::new(parent_dimension as u8, parent_tag));
            }
        }
    }
    Ok(())
}

fn entity_counts(source: &mut impl Source) -> Result<[(u8, usize); 4], Flaw> {
    let mut counts = [(0, 0); 4];
    for (dimension, count) in (0..).zip(&mut counts) {
        // A tag, a box or point, and a count at least.
        let record = Record { ints: 1, sizes: 1, reals: if dimension == 0 { 3 } else { 6 } };
        *count = (dimension, source.count("entities", record)?);
    }
    Ok(counts)
}

/// What stands after an entity's tag (and its partitions).
fn entity_body(source: &mut impl Source, key: EntityKey) -> Result<Entity, Flaw> {
    let lower = source.reals::<3>("an entity's box")?;
    let upper = if key.dimension == 0 { lower } else { source.reals::<3>("an entity's box")? };
    if let Some(wrong) = lower.iter().chain(&upper).find(|x| !x.is_finite()) {
        return Err(source.flaw(Fault::Number { what: "an entity's box", found: wrong.to_string() }));
    }
    let physical_tags = source.ints("physical tags")?;
    let boundary = if key.dimension == 0 { Vec::new() } else { source.ints("bounding entities")? };
    Ok(Entity { key, bounds: [lower, upper], physical_tags, boundary })
}

/// `$Nodes`.
pub(super) fn nodes(source: &mut impl Source, draft: &mut Draft) -> Result<(), Flaw> {
    let header = Record { ints: 3, sizes: 1, reals: 0 };
    let blocks = source.count("node blocks", header)?;
    let node = Record { ints: 0, sizes: 1, reals: 3 };
    let announced = source.count("nodes", node)?;
    source.size("the smallest node number")?;
    source.size("the largest node number")?;
    draft.parts.points.reserve_exact(announced);
    draft.parts.node_tags.reserve_exact(announced);
    draft.parts.node_entities.reserve_exact(announced);
    let mut tags = Vec::new();
    for _ in 0..blocks {
        let key = entity_key(source)?;
        let parametric = source.int("the mark of parametric nodes")? != 0;
        let count = source.count("nodes", node)?;
        tags.clear();
        for _ in 0..count {
            tags.push(source.size("a node number")?);
        }
        let entity = draft.parent(key);
        for &tag in &tags {
            let row = source.begin_row("a node's coordinates")?;
            let point = source.reals::<3>("a node's coordinates")?;
            let id = draft.push_node(source, tag, point, Some(entity))?;
            if parametric {
                let mut parameters = [0.0; 3];
                for value in &mut parameters[..usize::from(key.dimension)] {
                    *value = source.real("a node's parameters")?;
                }
                // A part's parameters are not those of an entity of another dimension.
                if matches!(key.dimension, 1 | 2) && entity.dimension == key.dimension {
                    draft.push_parameters(source, id, [parameters[0], parameters[1]])?;
                }
            }
            source.end_row(row, "a node's coordinates")?;
        }
    }
    let found = draft.parts.points.len() as u64;
    if found != announced as u64 {
        return Err(source.flaw(Fault::Miscounted { what: "nodes", announced: announced as u64, found }));
    }
    draft.end_nodes(source)
}

/// `$Elements`.
///
/// Elements that a partitioner put between its parts (their entity is part of one of a higher dimension) are
/// left out: they are not of the mesh that was partitioned.
pub(super) fn elements(source: &mut impl Source, draft: &mut Draft) -> Result<(), Flaw> {
    let blocks = source.count("element blocks", Record { ints: 3, sizes: 1, reals: 0 })?;
    let announced = source.size("the number of elements")?;
    source.size("the smallest element number")?;
    source.size("the largest element number")?;
    let mut found = 0;
    for _ in 0..blocks {
        let key = entity_key(source)?;
        let code = source.int("an element type")?;
        let kind = draft.element_type(source, code)?;
        if kind.cell.dimension() != usize::from(key.dimension) {
            return Err(source.flaw(MshFault::ElementDimension { entity: key, found: kind.cell.dimension() }));
        }
        let node_count = kind.node_count();
        let record = Record { sizes: 1 + node_count as u64, ..Record::default() };
        let count = source.count("elements", record)?;
        found += count as u64;
        let parent = draft.parent(key);
        let mut block = Block::new(kind.cell, parent);
        block.tags.reserve_exact(count);
        block.nodes.reserve_exact(count * node_count);
        let mut numbers = vec![0; node_count];
        for _ in 0..count {
            let row = source.begin_row("an element")?;
            let tag = source.size("an element number")?;
            for number in &mut numbers {
                *number = source.size("an element's nodes")?;
            }
            source.end_row(row, "an element")?;
            block.tags.push(tag);
            draft.push_element(source, kind, tag, &numbers, &mut block.nodes)?;
        }
        if parent.dimension == key.dimension {
            draft.parts.blocks.push(block);
        }
    }
    if found != announced {
        return Err(source.flaw(Fault::Miscounted { what: "elements", announced, found }));
    }
    Ok(())
}

/// `$Periodic`.
pub(super) fn periodic(source: &mut impl Source, draft: &mut Draft) -> Result<(), Flaw> {
    let links = source.count("periodic links", Record { ints: 3, sizes: 2, reals: 0 })?;
    for _ in 0..links {
        let slave = entity_key(source)?;
        let master = source.int("a periodic entity")?;
        let values = source.count("coefficients of a map", Record::REAL)?;
        let affine = (0..values).map(|_| source.real("a periodic map")).collect::<Result<_, _>>()?;
        let count = source.count("periodic nodes", Record { sizes: 2, ..Record::default() })?;
        let mut pairs = Vec::with_capacity(count);
        for _ in 0..count {
            let row = source.begin_row("a pair of nodes")?;
            let pair = [source.size("periodic nodes")?, source.size("periodic nodes")?];
            source.end_row(row, "a pair of nodes")?;
            pairs.push(periodic_pair(source, draft, slave, pair)?);
        }
        let master = draft.parent(EntityKey::new(slave.dimension, master)).tag;
        let slave = draft.parent(slave);
        draft.parts.periodic.push(Periodic { slave, master, affine, pairs });
    }
    Ok(())
}

/// The two nodes of a pair, by file number.
pub(super) fn periodic_pair(
    source: &impl Source,
    draft: &Draft,
    slave: EntityKey,
    [a, b]: [u64; 2],
) -> Result<(crate::mesh::NodeId, crate::mesh::NodeId), Flaw> {
    let by = slave.tag.unsigned_abs().into();
    Ok((draft.node(source, a, "periodic entity", by)?, draft.node(source, b, "periodic entity", by)?))
}
