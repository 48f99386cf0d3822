//! Sections of MSH 2.2.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::BufRead;

use super::draft::{Draft, ElementType};
use super::read41::{dimension, periodic_pair};
use super::source::{Record, Source, Text};
use crate::formats::error::{Fault, Flaw};
use crate::formats::scanner::Scanner;
use crate::mesh::{Block, EntityKey, NodeId, Periodic};

/// A positive `int` as node or element number.
fn number(source: &mut impl Source, what: &'static str) -> Result<u64, Flaw> {
    let value = source.int(what)?;
    u64::try_from(value).map_err(|_| source.flaw(Fault::Number { what, found: value.to_string() }))
}

/// The count that heads a section: a line of text in both encodings.
pub(super) fn count<R: BufRead>(scanner: &mut Scanner<R>, what: &'static str, binary: bool) -> Result<u64, Flaw> {
    let count = scanner.number(what)?;
    if binary {
        scanner.end_line(what)?;
    }
    Ok(count)
}

/// `$Nodes` or, with the entity and parameters of each node, `$ParametricNodes`, after the count.
pub(super) fn nodes(source: &mut impl Source, draft: &mut Draft, count: u64, parametric: bool) -> Result<(), Flaw> {
    let count = source.checked(count, "nodes", Record { ints: 1, sizes: 0, reals: 3 })?;
    for _ in 0..count {
        let row = source.begin_row("a node")?;
        let tag = number(source, "a node number")?;
        let point = source.reals::<3>("a node's coordinates")?;
        if !parametric {
            draft.push_node(source, tag, point, None)?;
            source.end_row(row, "a node")?;
            continue;
        }
        let entity = EntityKey::new(dimension(source)?, source.int("an entity tag")?);
        let id = draft.push_node(source, tag, point, Some(entity))?;
        let mut uv = [0.0; 2];
        let given = if entity.dimension < 3 { usize::from(entity.dimension) } else { 0 };
        for value in &mut uv[..given] {
            *value = source.real("a node's parameters")?;
        }
        if given > 0 {
            draft.push_parameters(source, id, uv)?;
        }
        source.end_row(row, "a node")?;
    }
    draft.end_nodes(source)
}

/// Elements of `$Elements` as they come; an element in several physical groups comes once for each.
struct Elements<'a> {
    draft: &'a mut Draft,
    numbers: Vec<u64>,
    nodes: Vec<NodeId>,
}

/// An element's number, kind and tags.
struct Head {
    tag: u64,
    kind: ElementType,
    physical: i32,
    entity: i32,
}

/// `$Elements` as text, after the count.
pub(super) fn elements_text(source: &mut impl Source, draft: &mut Draft, count: u64) -> Result<(), Flaw> {
    let count = source.checked(count, "elements", Record { ints: 4, ..Record::default() })?;
    let mut elements = Elements { draft, numbers: Vec::new(), nodes: Vec::new() };
    for _ in 0..count {
        let row = source.begin_row("an element")?;
        let tag = number(source, "an element number")?;
        let code = source.int("an element type")?;
        let tag_count = source.int("the number of tags")?;
        let kind = elements.draft.element_type(source, code)?;
        let [physical, entity] = tags(source, tag_count)?;
        elements.read_nodes(source, kind)?;
        source.end_row(row, "an element")?; // before the nodes are looked up: what is wrong with the line is the cause
        elements.push(source, &Head { tag, kind, physical, entity })?;
    }
    elements.finish();
    Ok(())
}

/// `$Elements` as bytes, after the count: runs of elements of one type and number of tags.
pub(super) fn elements_binary(source: &mut impl Source, draft: &mut Draft, count: u64) -> Result<(), Flaw> {
    let mut left = source.checked(count, "elements", Record { ints: 2, ..Record::default() })? as u64;
    let mut elements = Elements { draft, numbers: Vec::new(), nodes: Vec::new() };
    while left > 0 {
        let code = source.int("an element type")?;
        let run = number(source, "the number of elements of a run")?;
        let tag_count = source.int("the number of tags")?;
        let kind = elements.draft.element_type(source, code)?;
        if run == 0 || run > left {
            return Err(source.flaw(Fault::Miscounted { what: "elements", announced: left, found: run }));
        }
        left -= run;
        for _ in 0..run {
            let tag = number(source, "an element number")?;
            let [physical, entity] = tags(source, tag_count)?;
            elements.read_nodes(source, kind)?;
            elements.push(source, &Head { tag, kind, physical, entity })?;
        }
    }
    elements.finish();
    Ok(())
}

/// Physical and entity tag; partitions behind them are passed over.
fn tags(source: &mut impl Source, count: i32) -> Result<[i32; 2], Flaw> {
    let count = u64::try_from(count).unwrap_or(u64::MAX);
    let mut kept = [0; 2];
    for n in 0..source.checked(count, "element tags", Record::INT)? {
        let tag = source.int("an element's tags")?;
        if let Some(place) = kept.get_mut(n) {
            *place = tag;
        }
    }
    Ok(kept)
}

impl Elements<'_> {
    /// Takes the numbers of an element's nodes.
    fn read_nodes(&mut self, source: &mut impl Source, kind: ElementType) -> Result<(), Flaw> {
        self.numbers.clear();
        for _ in 0..kind.node_count() {
            self.numbers.push(number(source, "an element's nodes")?);
        }
        Ok(())
    }

    /// Adds the element whose nodes were read last.
    fn push(&mut self, source: &mut impl Source, head: &Head) -> Result<(), Flaw> {
        self.nodes.clear();
        self.draft.push_element(source, head.kind, head.tag, &self.numbers, &mut self.nodes)?;
        if self.joins_last(head) {
            if let Some(block) = self.draft.parts.blocks.last_mut() {
                block.tags.push(head.tag);
                block.nodes.extend_from_slice(&self.nodes);
            }
            return Ok(());
        }
        let entity = EntityKey::new(head.kind.cell.dimension() as u8, head.entity);
        let mut block = Block::new(head.kind.cell, entity);
        block.tags.push(self.take_repeated(head, &mut block.physical_tags).unwrap_or(head.tag));
        block.nodes.extend_from_slice(&self.nodes);
        if head.physical != 0 {
            block.physical_tags.push(head.physical);
        }
        match self.draft.parts.blocks.last_mut() {
            Some(last) if alike(last, &block) && last.physical_tags == block.physical_tags => {
                last.tags.append(&mut block.tags);
                last.nodes.append(&mut block.nodes);
            }
            _ => self.draft.parts.blocks.push(block),
        }
        Ok(())
    }

    /// Whether an element goes on with the last block.
    fn joins_last(&self, head: &Head) -> bool {
        self.draft.parts.blocks.last().is_some_and(|last| {
            let same_group = match last.physical_tags[..] {
                [] => head.physical == 0,
                [group] => head.physical == group,
                _ => false,
            };
            last.cell == head.kind.cell && last.entity.tag == head.entity && same_group
        })
    }

    /// Takes back the last element where the present one is the same in another physical group: its number, and
    /// the groups it was in.
    fn take_repeated(&mut self, head: &Head, groups: &mut Vec<i32>) -> Option<u64> {
        let blocks = &mut self.draft.parts.blocks;
        let last = blocks.last_mut()?;
        let same = last.cell == head.kind.cell && last.entity.tag == head.entity && last.nodes.ends_with(&self.nodes);
        if !same || head.physical == 0 || last.physical_tags.is_empty() || last.physical_tags.contains(&head.physical) {
            return None;
        }
        groups.extend_from_slice(&last.physical_tags);
        let tag = last.tags.pop()?;
        last.nodes.truncate(last.nodes.len() - self.nodes.len());
        if last.tags.is_empty() {
            blocks.pop();
        }
        Some(tag)
    }

    /// Unites blocks that hold the same elements in different physical groups.
    fn finish(self) {
        let mut rivals: HashMap<u64, Vec<usize>> = HashMap::new();
        let mut united: Vec<Block> = Vec::new();
        for block in self.draft.parts.blocks.drain(..) {
            let mut hasher = DefaultHasher::new();
            (block.cell, block.entity, &block.nodes).hash(&mut hasher);
            let rivals = rivals.entry(hasher.finish()).or_default();
            let repeats = |n: &usize| {
                let first: &Block = &united[*n];
                let again = block.physical_tags.iter().any(|tag| first.physical_tags.contains(tag));
                alike(first, &block) && first.nodes == block.nodes && !again
            };
            match rivals.iter().copied().find(repeats) {
                Some(n) => united[n].physical_tags.extend(block.physical_tags),
                None => {
                    rivals.push(united.len());
                    united.push(block);
                }
            }
        }
        self.draft.parts.blocks = united;
    }
}

/// Whether two blocks are of the same cell on the same entity.
fn alike(a: &Block, b: &Block) -> bool {
    a.cell == b.cell && a.entity == b.entity
}

/// `$Periodic`, which is text in both encodings.
pub(super) fn periodic<R: BufRead>(scanner: &mut Scanner<R>, draft: &mut Draft) -> Result<(), Flaw> {
    let links: u64 = scanner.number("the number of periodic links")?;
    for _ in 0..links {
        let slave = EntityKey::new(dimension(&mut Text(scanner))?, scanner.number("a periodic entity")?);
        let master = scanner.number("a periodic entity")?;
        let line = scanner.full_line("a periodic link")?;
        let (affine, line) = match line.strip_prefix("Affine") {
            Some(values) => {
                let affine: Result<Vec<f64>, _> = values.split_ascii_whitespace().map(str::parse).collect();
                let unexpected =
                    |_| Fault::Unexpected { what: "a periodic map", found: values.chars().take(40).collect() };
                (affine.map_err(|e| scanner.flaw(unexpected(e)))?, scanner.full_line("a periodic link")?)
            }
            None => (Vec::new(), line),
        };
        let unexpected =
            || Fault::Unexpected { what: "the number of periodic nodes", found: line.chars().take(40).collect() };
        let count = line.parse().map_err(|_| scanner.flaw(unexpected()))?;
        let mut source = Text(scanner);
        let count = source.checked(count, "periodic nodes", Record { sizes: 2, ..Record::default() })?;
        let mut pairs = Vec::with_capacity(count);
        for _ in 0..count {
            let row = source.begin_row("a pair of nodes")?;
            let pair = [source.size("periodic nodes")?, source.size("periodic nodes")?];
            source.end_row(row, "a pair of nodes")?;
            pairs.push(periodic_pair(&source, draft, slave, pair)?);
        }
        draft.parts.periodic.push(Periodic { slave, master, affine, pairs });
    }
    Ok(())
}
