//! Writing.

use std::io::{self, Write};

use super::keyword::{Keyword, cells};
use super::node_order::coordinates;
use crate::element::{Cell, Order};
use crate::formats::output::Unwritten;
use crate::mesh::{Block, Mesh, NodeId};

/// Bytes of a keyword's number.
const CODE: u64 = 4;

/// Writes a mesh in binary, of the lowest version that has room: 2, 3 beyond 2 GB, 4 beyond 2^31 numbers.
///
/// # Errors
/// What the stream returns.
pub(super) fn binary(out: &mut impl Write, mesh: &Mesh) -> Result<(), Unwritten> {
    let sections = Sections::new(mesh);
    let most = sections.list.iter().map(|section| section.lines).max().unwrap_or(0);
    let version: i32 = if most.max(mesh.points().len()) > i32::MAX as usize {
        4
    } else if sections.bytes(2) > i32::MAX as u64 {
        3
    } else {
        2
    };
    out.write_all(&1_i32.to_le_bytes())?;
    out.write_all(&version.to_le_bytes())?;
    let mut sink = Binary { out, version, at: 8 };
    sections.write(&mut sink)?;
    Ok(())
}

/// Writes a mesh as text.
///
/// # Errors
/// What the stream returns.
pub(super) fn text(out: &mut impl Write, mesh: &Mesh) -> Result<(), Unwritten> {
    writeln!(out, "MeshVersionFormatted 2")?;
    Sections::new(mesh).write(&mut Text { out, begun: false })?;
    Ok(())
}

/// Takes the keywords and numbers of a file.
trait Sink {
    /// That vertices have three coordinates.
    fn dimension(&mut self) -> io::Result<()>;
    /// A keyword, with the number of its lines where it has such, and of the whole and real numbers of all of them.
    fn keyword(&mut self, keyword: Keyword, lines: Option<usize>, numbers: [u64; 2]) -> io::Result<()>;
    fn int(&mut self, value: i64) -> io::Result<()>;
    fn real(&mut self, value: f64) -> io::Result<()>;
    fn end_line(&mut self) -> io::Result<()>;
}

/// What the file consists of.
struct Sections<'a> {
    mesh: &'a Mesh,
    list: Vec<Section<'a>>,
}

/// A keyword and how large it is.
struct Section<'a> {
    keyword: Keyword,
    lines: usize,
    /// Whole and real numbers a line.
    width: [u64; 2],
    content: Content<'a>,
}

enum Content<'a> {
    Vertices,
    Blocks(Vec<&'a Block>),
    Ordering(Cell, Order),
    /// Nodes on geometric entities of a dimension, with their parameters.
    OnGeometry(Vec<(NodeId, i32, [f64; 2])>),
}

impl<'a> Sections<'a> {
    fn new(mesh: &'a Mesh) -> Sections<'a> {
        let order = mesh.order();
        let mut list = vec![Section {
            keyword: Keyword::Vertices,
            lines: mesh.points().len(),
            width: [1, 3],
            content: Content::Vertices,
        }];
        for cell in cells() {
            let blocks: Vec<&Block> = mesh.blocks().iter().filter(|block| block.cell == cell).collect();
            let lines = blocks.iter().map(|block| block.tags.len()).sum();
            if lines == 0 {
                continue;
            }
            if order > Order::LINEAR {
                let table = coordinates(cell, order);
                list.push(Section {
                    keyword: Keyword::Ordering(cell, order),
                    lines: table.len(),
                    width: [table[0].len() as u64, 0],
                    content: Content::Ordering(cell, order),
                });
            }
            let width = [cell.node_count(order) as u64 + 1, 0];
            list.push(Section {
                keyword: Keyword::Elements(cell, order),
                lines,
                width,
                content: Content::Blocks(blocks),
            });
        }
        for dimension in 0..=2 {
            let nodes = on_geometry(mesh, dimension);
            if !nodes.is_empty() {
                let reals = if dimension == 0 { 0 } else { u64::from(dimension) + 1 };
                let (keyword, lines) = (Keyword::OnGeometry(dimension), nodes.len());
                list.push(Section { keyword, lines, width: [2, reals], content: Content::OnGeometry(nodes) });
            }
        }
        Sections { mesh, list }
    }

    /// Size of a binary file of a version.
    fn bytes(&self, version: i32) -> u64 {
        let own =
            |section: &Section| section.lines as u64 * (section.width[0] * int_width(version) + 8 * section.width[1]);
        self.list.iter().map(own).sum::<u64>() + 64 * (self.list.len() as u64 + 2)
    }

    fn write(&self, sink: &mut impl Sink) -> io::Result<()> {
        sink.dimension()?;
        for Section { keyword, lines, width, content } in &self.list {
            sink.keyword(*keyword, Some(*lines), width.map(|width| width * *lines as u64))?;
            self.content(content, sink)?;
        }
        sink.keyword(Keyword::End, None, [0, 0])?;
        sink.end_line()
    }

    fn content(&self, content: &Content, sink: &mut impl Sink) -> io::Result<()> {
        match content {
            Content::Vertices => {
                for x in self.mesh.points() {
                    x.to_array().into_iter().try_for_each(|x| sink.real(x))?;
                    sink.int(0)?;
                    sink.end_line()?;
                }
            }
            Content::Blocks(blocks) => {
                for block in blocks {
                    for nodes in block.elements(self.mesh.order()) {
                        nodes.iter().try_for_each(|node| sink.int(node.index() as i64 + 1))?;
                        sink.int(block.entity.tag.into())?;
                        sink.end_line()?;
                    }
                }
            }
            Content::Ordering(cell, order) => {
                for row in coordinates(*cell, *order) {
                    row.into_iter().try_for_each(|x| sink.int(x))?;
                    sink.end_line()?;
                }
            }
            Content::OnGeometry(nodes) => {
                for (node, tag, parameters) in nodes {
                    sink.int(node.index() as i64 + 1)?;
                    sink.int((*tag).into())?;
                    let dimension = usize::from(self.dimension_of(*node));
                    parameters[..dimension].iter().try_for_each(|&t| sink.real(t))?;
                    if dimension > 0 {
                        sink.real(0.0)?; // the distance from the geometry
                    }
                    sink.end_line()?;
                }
            }
        }
        Ok(())
    }

    fn dimension_of(&self, node: NodeId) -> u8 {
        self.mesh.node_entities()[node.index()].map_or(0, |key| key.dimension)
    }
}

/// The nodes on geometric entities of a dimension; on curves and surfaces those of which the parameters are known.
fn on_geometry(mesh: &Mesh, dimension: u8) -> Vec<(NodeId, i32, [f64; 2])> {
    let of_node = |node: NodeId| mesh.node_entities().get(node.index()).copied().flatten();
    let on = |node: NodeId| of_node(node).filter(|key| key.dimension == dimension).map(|key| key.tag);
    if dimension == 0 {
        let nodes = (0..mesh.points().len()).filter_map(|n| NodeId::new(n).ok());
        return nodes.filter_map(|node| Some((node, on(node)?, [0.0; 2]))).collect();
    }
    mesh.node_parameters().iter().filter_map(|&(node, parameters)| Some((node, on(node)?, parameters))).collect()
}

fn int_width(version: i32) -> u64 {
    if version > 3 { 8 } else { 4 }
}

struct Text<W> {
    out: W,
    /// Whether the present line has a number.
    begun: bool,
}

impl<W: Write> Text<W> {
    fn gap(&mut self) -> io::Result<()> {
        if std::mem::replace(&mut self.begun, true) { self.out.write_all(b" ") } else { Ok(()) }
    }
}

impl<W: Write> Sink for Text<W> {
    fn dimension(&mut self) -> io::Result<()> {
        writeln!(self.out, "\n{} 3", Keyword::Dimension.name())
    }

    fn keyword(&mut self, keyword: Keyword, lines: Option<usize>, _: [u64; 2]) -> io::Result<()> {
        write!(self.out, "\n{}", keyword.name())?;
        lines.map_or(Ok(()), |lines| writeln!(self.out, "\n{lines}"))
    }

    fn int(&mut self, value: i64) -> io::Result<()> {
        self.gap()?;
        write!(self.out, "{value}")
    }

    fn real(&mut self, value: f64) -> io::Result<()> {
        self.gap()?;
        write!(self.out, "{value:?}")
    }

    fn end_line(&mut self) -> io::Result<()> {
        self.begun = false;
        self.out.write_all(b"\n")
    }
}

struct Binary<W> {
    out: W,
    version: i32,
    /// Bytes written so far.
    at: u64,
}

impl<W: Write> Sink for Binary<W> {
    fn dimension(&mut self) -> io::Result<()> {
        self.at += 4; // of the number itself, which has 4 bytes in every version
        self.keyword(Keyword::Dimension, None, [0, 0])?;
        self.out.write_all(&3_i32.to_le_bytes())
    }

    fn keyword(&mut self, keyword: Keyword, lines: Option<usize>, [ints, reals]: [u64; 2]) -> io::Result<()> {
        let place = if self.version > 2 { 8 } else { 4 };
        let count = lines.map_or(0, |_| int_width(self.version));
        self.at += CODE + place + count + ints * int_width(self.version) + 8 * reals;
        let next = if keyword == Keyword::End { 0 } else { self.at };
        self.out.write_all(&keyword.code().to_le_bytes())?;
        match place {
            8 => self.out.write_all(&next.to_le_bytes())?,
            _ => self.out.write_all(&(next as u32).to_le_bytes())?,
        }
        lines.map_or(Ok(()), |lines| self.int(lines as i64))
    }

    fn int(&mut self, value: i64) -> io::Result<()> {
        match self.version {
            4.. => self.out.write_all(&value.to_le_bytes()),
            _ => self.out.write_all(&(value as i32).to_le_bytes()),
        }
    }

    fn real(&mut self, value: f64) -> io::Result<()> {
        self.out.write_all(&value.to_le_bytes())
    }

    fn end_line(&mut self) -> io::Result<()> {
        Ok(())
    }
}
