//! Reading.

use std::collections::BTreeMap;

use glam::DVec3;

use super::fault::GmfFault;
use super::keyword::Keyword;
use super::node_order::{coordinates, slots};
use super::source::Source;
use crate::element::{Cell, Order};
use crate::formats::ReadOptions;
use crate::formats::assembly::{Assembly, node_of};
use crate::formats::error::{Error, Fault, Flaw};
use crate::formats::format::Input;
use crate::mesh::{EntityKey, Mesh, NodeId};

/// Reads a mesh file.
pub(super) fn open(input: Input, _: &ReadOptions) -> Result<Mesh, Error> {
    let path = input.path;
    let content = input.whole()?;
    read(&content).map_err(|flaw| flaw.of(path))
}

/// What has been read so far.
#[derive(Default)]
struct File {
    dimension: usize,
    points: Option<Vec<DVec3>>,
    /// Elements by cell and order, in file order: nodes as the file numbers them, and the reference.
    elements: Vec<(Cell, Order, Vec<i64>)>,
    orderings: BTreeMap<(Cell, Order), Vec<Vec<i64>>>,
    /// Vertex, dimension and number of the geometric entity, parameters.
    classes: Vec<(i64, EntityKey, Option<[f64; 2]>)>,
    skipped: Vec<String>,
}

/// Reads a mesh from a file's content.
///
/// # Errors
/// The first [`Fault`] and its place. Memory stays within a small multiple of the content's length.
fn read(content: &[u8]) -> Result<Mesh, Flaw> {
    let mut source = Source::new(content)?;
    let mut file = File::default();
    while let Some(keyword) = source.keyword()? {
        match keyword {
            Ok(Keyword::End) => break,
            Ok(keyword) => file.take(keyword, &mut source)?,
            Err(name) if file.skipped.contains(&name) => {}
            Err(name) => file.skipped.push(name),
        }
    }
    file.mesh().map_err(|fault| source.flaw(fault))
}

impl File {
    /// Reads the lines of a keyword.
    fn take(&mut self, keyword: Keyword, source: &mut Source) -> Result<(), Flaw> {
        match keyword {
            Keyword::Dimension => {
                let dimension = source.dimension()?;
                self.dimension = match dimension {
                    2 | 3 => dimension as usize,
                    other => return Err(source.flaw(GmfFault::Dimension(other))),
                };
            }
            Keyword::Vertices => self.vertices(source)?,
            Keyword::Elements(cell, order) => self.elements(cell, order, source)?,
            Keyword::Ordering(cell, order) => {
                let width = coordinates(cell, order)[0].len();
                let count = source.count("nodes of an ordering", width as u64, 0)?;
                let mut row = || (0..width).map(|_| source.int("a node's coordinate")).collect::<Result<Vec<_>, _>>();
                let rows = (0..count).map(|_| row()).collect::<Result<Vec<_>, _>>()?;
                self.orderings.insert((cell, order), rows);
            }
            Keyword::OnGeometry(dimension) => self.on_geometry(dimension, source)?,
            Keyword::End => {}
        }
        Ok(())
    }

    fn vertices(&mut self, source: &mut Source) -> Result<(), Flaw> {
        if self.dimension == 0 {
            return Err(source.flaw(GmfFault::NoDimension(Keyword::Vertices.name())));
        }
        if self.points.is_some() {
            return Err(source.flaw(GmfFault::TwoVertices));
        }
        let count = source.count("vertices", 1, self.dimension as u64)?;
        let mut points = Vec::with_capacity(count);
        for _ in 0..count {
            let mut x = [0.0; 3];
            for x in &mut x[..self.dimension] {
                *x = source.real("a vertex's coordinates")?;
            }
            source.int("a vertex's reference")?;
            points.push(DVec3::from_array(x));
        }
        self.points = Some(points);
        Ok(())
    }

    fn elements(&mut self, cell: Cell, order: Order, source: &mut Source) -> Result<(), Flaw> {
        let width = cell.node_count(order) + 1;
        let count = source.count("elements", width as u64, 0)?;
        let mut numbers = Vec::with_capacity(count * width);
        for _ in 0..count * width {
            numbers.push(source.int("an element's nodes and reference")?);
        }
        self.elements.push((cell, order, numbers));
        Ok(())
    }

    /// Vertices on geometric entities: a curve has one parameter, a surface two, and both the distance of the vertex from it.
    fn on_geometry(&mut self, dimension: u8, source: &mut Source) -> Result<(), Flaw> {
        let reals = if dimension == 0 { 0 } else { u64::from(dimension) + 1 };
        let count = source.count("vertices on geometry", 2, reals)?;
        for _ in 0..count {
            let (vertex, entity) = (source.int("a vertex on geometry")?, source.int("a geometric entity")?);
            let mut parameters = [0.0; 2];
            for t in &mut parameters[..usize::from(dimension)] {
                *t = source.real("a parameter")?;
            }
            if dimension > 0 {
                source.real("a vertex's distance")?;
            }
            let tag = i32::try_from(entity)
                .map_err(|_| source.flaw(Fault::Number { what: "a geometric entity", found: entity.to_string() }))?;
            let known = (dimension > 0).then_some(parameters).filter(|[u, v]| u.is_finite() && v.is_finite());
            self.classes.push((vertex, EntityKey::new(dimension, tag), known));
        }
        Ok(())
    }

    fn mesh(self) -> Result<Mesh, Fault> {
        let File { points, elements, orderings, classes, skipped, .. } = self;
        let points = points.ok_or(GmfFault::NoVertices)?;
        let nodes = points.len();
        let mut assembly = Assembly::new(points)?;
        let mut notes = Vec::new();
        let mut number = 0;
        for (cell, order, numbers) in elements.into_iter().filter(|(.., numbers)| !numbers.is_empty()) {
            assembly.set_order(cell, order)?;
            let slots = match orderings.get(&(cell, order)) {
                Some(given) => slots(cell, order, given).ok_or(GmfFault::Ordering { cell, order })?,
                None => (0..cell.node_count(order)).collect(),
            };
            if order > Order::LINEAR && !orderings.contains_key(&(cell, order)) {
                notes.push(format!(
                    "{} has no ordering: its nodes were taken as corners, edges, faces and inside, in the order of CGNS",
                    Keyword::Elements(cell, order).name()
                ));
            }
            let entities = Entities::new(cell, numbers.chunks_exact(slots.len() + 1).map(|line| line[slots.len()]))?;
            let mut own = vec![NodeId::default(); slots.len()];
            for line in numbers.chunks_exact(slots.len() + 1) {
                number += 1;
                for (&slot, &node) in slots.iter().zip(line) {
                    own[slot] = node_of(nodes, node, 1, number)?;
                }
                assembly.push(cell, entities.of(line[slots.len()]), &own);
            }
        }
        classify(&mut assembly, nodes, &classes)?;
        if !skipped.is_empty() {
            notes.push(format!("not read: {}", skipped.join(", ")));
        }
        assembly.parts.notes.extend(notes);
        assembly.finish()
    }
}

/// Entities of references.
struct Entities {
    dimension: u8,
    /// What is added to references below 1, so that tags are positive and unlike the others.
    shift: i64,
}

impl Entities {
    fn new(cell: Cell, references: impl Iterator<Item = i64>) -> Result<Entities, Fault> {
        let (least, most) = references.fold((1, 0), |(least, most), own| (own.min(least), own.max(most)));
        let shift = most - least + 1;
        let largest = i32::try_from(most.max(if least < 1 { shift } else { 0 }));
        let found = || Fault::Number { what: "an element's reference", found: most.to_string() };
        largest.map_err(|_| found())?;
        Ok(Entities { dimension: cell.dimension() as u8, shift })
    }

    /// A reference below 1 comes behind the others.
    fn of(&self, reference: i64) -> EntityKey {
        let tag = if reference < 1 { reference + self.shift } else { reference };
        EntityKey::new(self.dimension, tag as i32)
    }
}

/// Says on which geometry nodes lie: the lowest entity counts, with its parameters.
fn classify(
    assembly: &mut Assembly,
    nodes: usize,
    classes: &[(i64, EntityKey, Option<[f64; 2]>)],
) -> Result<(), Fault> {
    if classes.is_empty() {
        return Ok(());
    }
    let mut known: Vec<Option<(EntityKey, Option<[f64; 2]>)>> = vec![None; nodes];
    for (line, &(vertex, key, parameters)) in (1..).zip(classes) {
        let own = &mut known[node_of(nodes, vertex, 1, line)?.index()];
        if own.is_none_or(|(other, _)| key.dimension < other.dimension) {
            *own = Some((key, parameters));
        }
    }
    assembly.parts.node_entities = known.iter().map(|own| own.map(|(key, _)| key)).collect();
    for (n, own) in known.iter().enumerate() {
        if let Some((_, Some(parameters))) = own {
            assembly.parts.node_parameters.push((NodeId::new(n)?, *parameters));
        }
    }
    Ok(())
}
