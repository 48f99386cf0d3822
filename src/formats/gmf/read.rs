//! A mesh from the keywords of a GMF file.

use std::io::BufRead;

use glam::DVec3;

use super::association::{self, OnGeometry};
use super::fault::GmfFault;
use super::keyword::Keyword;
use super::node_order;
use super::source::Source;
use crate::element::{Cell, Order};
use crate::formats::assembly::{Assembly, node_of};
use crate::formats::error::{Fault, Flaw};
use crate::mesh::{EntityKey, Mesh, NodeId};

/// The mesh of a file.
pub(super) fn mesh(mut source: Source<impl BufRead>) -> Result<Mesh, Flaw> {
    let mut draft = Draft::default();
    while let Some(keyword) = source.keyword()? {
        draft.section(&mut source, keyword)?;
    }
    draft.unknown = std::mem::take(&mut source.unknown);
    draft.ended = source.ended;
    draft.mesh().map_err(|fault| source.flaw(fault))
}

/// What has been read so far.
#[derive(Default)]
struct Draft {
    dimension: Option<usize>,
    points: Option<Vec<DVec3>>,
    elements: Vec<Elements>,
    /// For each slot of an element in the file, the node of the internal order that it holds.
    orderings: Vec<(Cell, Order, Vec<u8>)>,
    on_geometry: Vec<OnGeometry>,
    corners: Vec<NodeId>,
    /// Whether the vertices are control points.
    bezier: bool,
    /// Keywords of no use, and how many rows they have.
    unused: Vec<(&'static str, usize)>,
    /// Keywords that are not known: they may be others, misspelt.
    unknown: Vec<String>,
    /// Whether the file has its `End`.
    ended: bool,
}

/// Elements of one keyword.
struct Elements {
    cell: Cell,
    order: Order,
    /// Nodes in the order of the file.
    nodes: Vec<NodeId>,
    references: Vec<i32>,
}

impl Draft {
    fn section(&mut self, source: &mut Source<impl BufRead>, keyword: Keyword) -> Result<(), Flaw> {
        match keyword {
            Keyword::Dimension => {
                let dimension = source.dimension()?;
                if !matches!(dimension, 2 | 3) {
                    return Err(source.flaw(GmfFault::Dimension(dimension)));
                }
                self.dimension = Some(dimension as usize);
            }
            Keyword::Vertices => self.vertices(source)?,
            Keyword::Elements(cell, order) => self.elements(source, cell, order)?,
            Keyword::Ordering(cell, order) => self.ordering(source, cell, order)?,
            Keyword::OnGeometry(dimension) => self.on_geometry(source, dimension)?,
            Keyword::Corners => {
                for row in 1..=source.count("Corners", 1, 0)? {
                    let corner = self.vertex(source, row as u64)?;
                    self.corners.push(corner);
                }
            }
            Keyword::BezierBasis => self.bezier = source.int("BezierBasis")? != 0,
            Keyword::Precision => {
                let bits = source.int("FloatingPointPrecision")?;
                source.set_precision(bits)?;
            }
            Keyword::Unused(word) => {
                self.unused.push((word, source.count(word, 1, 0)?));
                source.pass_over();
                return Ok(());
            }
            Keyword::Refused(word) => return Err(source.flaw(GmfFault::Elements(word))),
            Keyword::End => {}
        }
        source.end_keyword()
    }

    fn vertices(&mut self, source: &mut Source<impl BufRead>) -> Result<(), Flaw> {
        if self.points.is_some() {
            return Err(source.flaw(GmfFault::Repeated("Vertices")));
        }
        let later = || "Vertices".to_owned();
        let dimension = self.dimension.ok_or_else(|| GmfFault::Order { earlier: "Dimension", later: later() });
        let dimension = dimension.map_err(|fault| source.flaw(fault))?;
        let count = source.count("Vertices", 1, dimension as u64)?;
        NodeId::new(count).map_err(|cause| source.flaw(cause))?;
        let mut points = Vec::with_capacity(count);
        for _ in 0..count {
            let mut point = [0.0; 3];
            for x in &mut point[..dimension] {
                *x = source.real("a vertex' coordinates")?;
            }
            source.int("a vertex' reference")?;
            points.push(DVec3::from_array(point));
        }
        self.points = Some(points);
        Ok(())
    }

    /// A vertex by its number, which `by` (a row) refers to.
    fn vertex(&self, source: &mut Source<impl BufRead>, by: u64) -> Result<NodeId, Flaw> {
        let number = source.int("a vertex' number")?;
        let count = self.points.as_ref().map_or(0, Vec::len);
        node_of(count, number, 1, by).map_err(|fault| source.flaw(fault))
    }

    /// Refuses what refers to vertices before there are any.
    fn after_vertices(&self, source: &Source<impl BufRead>, keyword: Keyword) -> Result<(), Flaw> {
        match self.points {
            Some(_) => Ok(()),
            None => Err(source.flaw(GmfFault::Order { earlier: "Vertices", later: keyword.names().1 })),
        }
    }

    fn elements(&mut self, source: &mut Source<impl BufRead>, cell: Cell, order: Order) -> Result<(), Flaw> {
        self.after_vertices(source, Keyword::Elements(cell, order))?;
        let stride = cell.node_count(order);
        let count = source.count("elements", stride as u64 + 1, 0)?;
        let mut elements = Elements { cell, order, nodes: Vec::new(), references: Vec::new() };
        elements.nodes.reserve_exact(count * stride);
        elements.references.reserve_exact(count);
        for row in 1..=count as u64 {
            for _ in 0..stride {
                elements.nodes.push(self.vertex(source, row)?);
            }
            let reference = source.int("an element's reference")?;
            let reference = i32::try_from(reference).map_err(|_| source.flaw(GmfFault::Reference(reference)))?;
            elements.references.push(reference);
        }
        self.elements.push(elements);
        Ok(())
    }

    fn ordering(&mut self, source: &mut Source<impl BufRead>, cell: Cell, order: Order) -> Result<(), Flaw> {
        let indices = node_order::indices(cell);
        let count = source.count("nodes of an order", indices as u64, 0)?;
        let mut rows = Vec::with_capacity(count * indices);
        for _ in 0..count * indices {
            rows.push(source.int("a node's indices")?);
        }
        let wrong = || {
            let (word, nodes) = (Keyword::Ordering(cell, order).names().1, cell.node_count(order));
            source.flaw(GmfFault::Ordering(word, nodes))
        };
        let slots = node_order::slots(cell, order, &rows).ok_or_else(wrong)?;
        self.orderings.push((cell, order, slots));
        Ok(())
    }

    fn on_geometry(&mut self, source: &mut Source<impl BufRead>, dimension: u8) -> Result<(), Flaw> {
        self.after_vertices(source, Keyword::OnGeometry(dimension))?;
        let axes = usize::from(dimension);
        // Behind the parameters stands a distance.
        let reals = if dimension == 0 { 0 } else { axes as u64 + 1 };
        for row in 1..=source.count("VerticesOnGeometric*", 2, reals)? {
            let node = self.vertex(source, row as u64)?;
            let tag = source.int("a geometric entity")?;
            let mut parameters = [0.0; 2];
            for value in &mut parameters[..axes] {
                *value = source.real("a vertex' parameters")?;
            }
            if dimension > 0 {
                source.real("a vertex' distance")?;
            }
            if !parameters.iter().all(|x| x.is_finite()) {
                return Err(source.flaw(Fault::NotFinite(node.index() as u64 + 1)));
            }
            let tag = i32::try_from(tag).map_err(|_| source.flaw(GmfFault::Reference(tag)))?;
            // 0 is none, as for elements.
            if tag > 0 {
                self.on_geometry.push(OnGeometry { node, entity: EntityKey::new(dimension, tag), parameters });
            }
        }
        Ok(())
    }

    fn mesh(self) -> Result<Mesh, Fault> {
        let points = self.points.ok_or(GmfFault::Missing("Vertices"))?;
        let mut assembly = Assembly::new(points)?;
        let tags = Tags::new(&self.elements);
        let mut assumed = false;
        let mut nodes = Vec::new();
        for Elements { cell, order, nodes: all, references } in self.elements {
            if references.is_empty() {
                continue;
            }
            assembly.set_order(cell, order)?;
            let given = self.orderings.iter().find(|(c, o, _)| (*c, *o) == (cell, order)).map(|(.., slots)| &slots[..]);
            // Of order 2 there is but one in use.
            assumed |= given.is_none() && order.get() > 2;
            for (own, &reference) in all.chunks_exact(cell.node_count(order)).zip(&references) {
                nodes.clear();
                nodes.extend_from_slice(own);
                for (&slot, &node) in given.unwrap_or_default().iter().zip(own) {
                    nodes[usize::from(slot)] = node;
                }
                assembly.push(cell, tags.entity(cell, reference), &nodes);
            }
        }
        if self.bezier && assembly.parts.order > Order::LINEAR {
            return Err(GmfFault::Bezier.into());
        }
        if assumed {
            let note =
                "no ...Ordering keyword says how nodes of elements are ordered; taken as in CGNS (not as in Gmsh)";
            assembly.parts.notes.push(note.into());
        }
        for (word, count) in self.unused.iter().filter(|(_, count)| *count > 0) {
            assembly.parts.notes.push(format!("{count} {word} are not used"));
        }
        let told = self.unknown.iter().map(|word| format!("the keyword {word}, which is not known, is not used"));
        assembly.parts.notes.extend(told);
        if !self.ended {
            assembly.parts.notes.push("the file has no keyword End: it may have been cut off".into());
        }
        association::apply(&mut assembly, self.on_geometry, &self.corners);
        assembly.finish()
    }
}

/// Tags of entities: the references of elements. One that is not positive, which says that there is none, becomes the
/// next free tag.
struct Tags {
    /// Free tags, by dimension.
    free: [i32; 4],
}

impl Tags {
    fn new(elements: &[Elements]) -> Tags {
        let mut free = [1; 4];
        for own in elements {
            let free = &mut free[own.cell.dimension()];
            let largest = own.references.iter().copied().max().unwrap_or(0);
            *free = largest.saturating_add(1).max(*free);
        }
        Tags { free }
    }

    fn entity(&self, cell: Cell, reference: i32) -> EntityKey {
        let tag = if reference > 0 { reference } else { self.free[cell.dimension()] };
        EntityKey::new(cell.dimension() as u8, tag)
    }
}
