//! A GMF file from a mesh.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::keyword::{self, Keyword};
use super::node_order;
use super::sink::{Form, Sink};
use crate::element::{Cell, Order, lattice};
use crate::formats::part::Unwritten;
use crate::mesh::{Block, Mesh, NodeId};

/// Writes a mesh, as bytes or as text. Equal meshes make equal bytes.
///
/// Elements stand in the mesh's order within their kind. Elements on points are corners.
pub(super) fn write(out: &mut impl Write, mesh: &Mesh, binary: bool) -> Result<(), Unwritten> {
    let sections = sections(mesh);
    let form = if binary { Form::Bytes { version: version(mesh, &sections) } } else { Form::Text };
    Ok(write_as(out, mesh, &sections, form)?)
}

/// The lowest version that positions and counts fit into.
fn version(mesh: &Mesh, sections: &[Section]) -> u32 {
    let rows = sections.iter().map(|section| section.rows).max().unwrap_or(0);
    let fits = |length: u64| i32::try_from(length).is_ok();
    if !fits(rows.max(mesh.points().len()) as u64) {
        return 4;
    }
    let form = Form::Bytes { version: 2 };
    let length: u64 = sections.iter().map(|section| section.length(form)).sum();
    if fits(length + START) { 2 } else { 3 }
}

/// Bytes beside the sections, at most.
const START: u64 = 64;

/// A keyword and its rows.
pub(super) struct Section<'a> {
    keyword: Keyword,
    rows: usize,
    ints: u64,
    reals: u64,
    content: Content<'a>,
}

enum Content<'a> {
    Vertices {
        axes: usize,
    },
    Elements(Vec<&'a Block>),
    Ordering(Cell),
    Corners(Vec<NodeId>),
    /// Nodes, tags of entities, parameters.
    OnGeometry(Vec<(NodeId, i32, Vec<f64>)>),
}

impl Section<'_> {
    fn length(&self, form: Form) -> u64 {
        form.head() + form.int_width() + self.rows as u64 * (self.ints * form.int_width() + 8 * self.reals)
    }
}

/// Everything that is written of a mesh.
pub(super) fn sections(mesh: &Mesh) -> Vec<Section<'_>> {
    let axes = axes(mesh);
    let vertices = Content::Vertices { axes };
    let mut sections = vec![Section {
        keyword: Keyword::Vertices,
        rows: mesh.points().len(),
        ints: 1,
        reals: axes as u64,
        content: vertices,
    }];
    let order = mesh.order();
    let of_cell = |cell: Cell| -> Vec<&Block> {
        mesh.blocks().iter().filter(|block| block.cell == cell && !block.tags.is_empty()).collect()
    };
    for cell in keyword::cells() {
        let blocks = of_cell(cell);
        let (rows, ints) = (blocks.iter().map(|block| block.tags.len()).sum(), cell.node_count(order) as u64 + 1);
        if rows == 0 {
            continue;
        }
        if order > Order::LINEAR {
            let (rows, ints) = (cell.node_count(order), node_order::indices(cell) as u64);
            let (keyword, content) = (Keyword::Ordering(cell, order), Content::Ordering(cell));
            sections.push(Section { keyword, rows, ints, reals: 0, content });
        }
        let (keyword, content) = (Keyword::Elements(cell, order), Content::Elements(blocks));
        sections.push(Section { keyword, rows, ints, reals: 0, content });
    }
    let mut corners: Vec<NodeId> = of_cell(Cell::Point).iter().flat_map(|block| block.nodes.iter().copied()).collect();
    corners.sort_unstable();
    corners.dedup();
    if !corners.is_empty() {
        let (rows, content) = (corners.len(), Content::Corners(corners));
        sections.push(Section { keyword: Keyword::Corners, rows, ints: 1, reals: 0, content });
    }
    sections.extend((0..=2).filter_map(|dimension| on_geometry(mesh, dimension)));
    sections
}

/// Coordinates of a vertex: two where the mesh is one of the plane.
fn axes(mesh: &Mesh) -> usize {
    // -0 has a sign that would be lost.
    if mesh.dimension() == 2 && mesh.points().iter().all(|x| x.z.to_bits() == 0) { 2 } else { 3 }
}

/// Which nodes lie on which entities of a dimension, where they have parameters there; points need none, but are written only where
/// elements name them or other nodes have parameters: alone they tell nothing, and readers such as meshio do not know the section.
fn on_geometry(mesh: &Mesh, dimension: u8) -> Option<Section<'_>> {
    let mut rows: BTreeMap<NodeId, (i32, Vec<f64>)> = BTreeMap::new();
    if dimension == 0 {
        for block in mesh.blocks().iter().filter(|block| block.cell == Cell::Point) {
            rows.extend(block.nodes.iter().map(|&node| (node, (block.entity.tag, Vec::new()))));
        }
        let classified = mesh.node_entities().iter().enumerate().filter(|_| !mesh.node_parameters().is_empty());
        for (n, key) in classified.filter_map(|(n, key)| Some((n, (*key)?))).filter(|(_, key)| key.dimension == 0) {
            // All nodes of a mesh have numbers.
            rows.entry(NodeId::new(n).unwrap_or_default()).or_insert((key.tag, Vec::new()));
        }
    } else {
        for &(node, parameters) in mesh.node_parameters() {
            let own = mesh.node_entities().get(node.index()).copied().flatten();
            if let Some(key) = own.filter(|key| key.dimension == dimension) {
                rows.insert(node, (key.tag, parameters[..usize::from(dimension)].to_vec()));
            }
        }
    }
    rows.retain(|_, (tag, _)| *tag > 0);
    let reals = if dimension == 0 { 0 } else { u64::from(dimension) + 1 };
    let rows: Vec<_> = rows.into_iter().map(|(node, (tag, parameters))| (node, tag, parameters)).collect();
    let keyword = Keyword::OnGeometry(dimension);
    let section = Section { keyword, rows: rows.len(), ints: 2, reals, content: Content::OnGeometry(rows) };
    (section.rows > 0).then_some(section)
}

/// Writes sections in a given form.
pub(super) fn write_as(out: &mut impl Write, mesh: &Mesh, sections: &[Section], form: Form) -> io::Result<()> {
    let mut sink = Sink::new(out, form);
    sink.begin(axes(mesh) as u32)?;
    let mut next = 8 + form.head() + 4;
    for section in sections {
        next += section.length(form);
        sink.keyword(section.keyword, section.rows as u64, next)?;
        content(&mut sink, mesh, section)?;
    }
    sink.end()
}

fn content(sink: &mut Sink<impl Write>, mesh: &Mesh, section: &Section) -> io::Result<()> {
    let number = |node: &NodeId| node.index() as i64 + 1;
    match &section.content {
        Content::Vertices { axes } => mesh.points().iter().try_for_each(|point| {
            point.to_array()[..*axes].iter().try_for_each(|&x| sink.real(x))?;
            sink.int(0)?;
            sink.end_row()
        }),
        Content::Elements(blocks) => blocks.iter().try_for_each(|block| {
            block.elements(mesh.order()).try_for_each(|nodes| {
                nodes.iter().try_for_each(|node| sink.int(number(node)))?;
                sink.int(block.entity.tag.into())?;
                sink.end_row()
            })
        }),
        Content::Ordering(cell) => lattice(*cell, mesh.order()).iter().try_for_each(|&at| {
            let row = node_order::row(*cell, mesh.order(), at);
            row.into_iter().try_for_each(|index| sink.int(index.into()))?;
            sink.end_row()
        }),
        Content::Corners(nodes) => nodes.iter().try_for_each(|node| {
            sink.int(number(node))?;
            sink.end_row()
        }),
        Content::OnGeometry(rows) => rows.iter().try_for_each(|(node, tag, parameters)| {
            sink.int(number(node))?;
            sink.int((*tag).into())?;
            parameters.iter().try_for_each(|&x| sink.real(x))?;
            // The distance from the entity, where there are parameters.
            if !parameters.is_empty() {
                sink.real(0.0)?;
            }
            sink.end_row()
        }),
    }
}
