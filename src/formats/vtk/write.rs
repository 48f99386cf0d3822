//! VTU (VTK XML UnstructuredGrid): Lagrange cells, raw appended data, for pictures and for solvers that read them.
//!
//! XML version 2.2, because older ones mean another edge order in hexes. VTK has no pyramid beyond the linear one:
//! each becomes the degenerate hex of the same order, whose points are the pyramid's own at the hex's lattice and
//! whose upper face is the apex. That is exact (the pyramid's functions are polynomials on the cube), but adds
//! `(p + 1)^3` points a pyramid, and the Jacobian vanishes at the apex.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::io::{self, Write};

use super::node_order::{ORDER, pyramid_as_hex};
use super::type_code;
use crate::element::{Cell, Order};
use crate::formats::field::{Field, Support, Values};
use crate::formats::part::Unwritten;
use crate::mesh::{Block, Entity, EntityKey, Mesh};

/// Writes a mesh and fields on it; with `volume_only` without the cells below the mesh's top dimension, which
/// some readers refuse in the same file.
///
/// Besides the fields the cells carry `dimension`, `CellEntityIds` (the file's entity tag), and `patch` (the first
/// physical tag of the entity, 0 where there is none).
pub(super) fn write(out: &mut impl Write, mesh: &Mesh, fields: &[Field], volume_only: bool) -> Result<(), Unwritten> {
    let grid = Grid::new(mesh, volume_only);
    grid.check(fields)?;
    let arrays = grid.arrays(fields);
    out.write_all(grid.head(&arrays).as_bytes())?;
    for array in arrays {
        out.write_all(&array.bytes().to_le_bytes())?;
        grid.values(out, &array)?;
    }
    out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")?;
    Ok(())
}

/// The cells and points that are written.
struct Grid<'a> {
    mesh: &'a Mesh,
    top: usize,
    parts: Vec<Part<'a>>,
    /// Points of the mesh and those added for pyramids.
    points: usize,
    cells: usize,
}

/// A block and how VTK shows it.
struct Part<'a> {
    block: &'a Block,
    /// First physical tag, 0 where there is none.
    patch: i32,
    vtk: u8,
    shown: Shown,
}

enum Shown {
    /// By its own nodes: the element's node in each slot.
    Slots(&'static [u8]),
    /// By points of their own: the weights of the element's nodes in each.
    Points(Vec<Vec<f64>>),
}

impl Shown {
    fn new(cell: Cell, order: Order) -> (u8, Shown) {
        match (type_code::of(cell, order), ORDER.slots(cell, order)) {
            (Some(vtk), Some(slots)) => (vtk, Shown::Slots(slots)),
            _ => (type_code::LAGRANGE_HEX, Shown::Points(pyramid_as_hex(order))),
        }
    }

    /// Number of points of a cell.
    fn stride(&self) -> usize {
        match self {
            Shown::Slots(slots) => slots.len(),
            Shown::Points(points) => points.len(),
        }
    }
}

/// An array of the file: its name, type, and number of values.
struct Array<'a> {
    section: &'static str,
    name: &'a str,
    kind: &'static str,
    width: usize,
    components: usize,
    count: usize,
    content: Content<'a>,
}

enum Content<'a> {
    Field(&'a Field),
    Dimension,
    Entity,
    Patch,
    Points,
    Connectivity,
    Offsets,
    Types,
}

impl Array<'_> {
    fn bytes(&self) -> u64 {
        (self.width * self.count) as u64
    }
}

impl<'a> Grid<'a> {
    fn new(mesh: &'a Mesh, volume_only: bool) -> Grid<'a> {
        let top = mesh.dimension();
        let entities: HashMap<EntityKey, &Entity> = mesh.entities().iter().map(|e| (e.key, e)).collect();
        let wanted = mesh.blocks().iter().filter(|b| !volume_only || b.cell.dimension() == top);
        let part = |block: &'a Block| {
            let (vtk, shown) = Shown::new(block.cell, mesh.order());
            Part { block, patch: patch(&entities, block), vtk, shown }
        };
        let parts: Vec<Part> = wanted.map(part).collect();
        let cells = parts.iter().map(|part| part.block.tags.len()).sum();
        let added = parts.iter().filter(|part| matches!(part.shown, Shown::Points(_)));
        let points = mesh.points().len() + added.map(|part| part.block.tags.len() * part.shown.stride()).sum::<usize>();
        Grid { mesh, top, parts, points, cells }
    }

    /// Refuses fields whose length is not that of what they belong to.
    fn check(&self, fields: &[Field]) -> Result<(), Unwritten> {
        for field in fields {
            let (what, needed) = match field.support {
                Support::Points => ("points", self.mesh.points().len()),
                Support::Elements => ("elements", self.mesh.cells().len()),
            };
            if field.values.len() != needed {
                let found = field.values.len();
                let reason = format!("field {:?} has {found} values for {needed} {what}", field.name);
                return Err(Unwritten::Inexpressible(reason));
            }
        }
        Ok(())
    }

    /// All arrays, in file order.
    fn arrays<'b>(&self, fields: &'b [Field]) -> Vec<Array<'b>> {
        let of = |section, name, kind, width, components, items: usize, content| Array {
            section,
            name,
            kind,
            width,
            components,
            count: items * components,
            content,
        };
        let field = |section, items, field: &'b Field| {
            let kind = match field.values {
                Values::Real(_) => "Float64",
                Values::Integer(_) => "Int64",
            };
            of(section, &field.name, kind, 8, 1, items, Content::Field(field))
        };
        let on = |support| fields.iter().filter(move |f| f.support == support);
        let connectivity = self.parts.iter().map(|part| part.block.tags.len() * part.shown.stride()).sum();
        let mut arrays: Vec<Array> = on(Support::Points).map(|f| field("PointData", self.points, f)).collect();
        arrays.extend(on(Support::Elements).map(|f| field("CellData", self.cells, f)));
        arrays.push(of("CellData", "dimension", "UInt8", 1, 1, self.cells, Content::Dimension));
        arrays.push(of("CellData", "CellEntityIds", "Int32", 4, 1, self.cells, Content::Entity));
        arrays.push(of("CellData", "patch", "Int32", 4, 1, self.cells, Content::Patch));
        arrays.push(of("Points", "Points", "Float64", 8, 3, self.points, Content::Points));
        arrays.push(of("Cells", "connectivity", "Int64", 8, 1, connectivity, Content::Connectivity));
        arrays.push(of("Cells", "offsets", "Int64", 8, 1, self.cells, Content::Offsets));
        arrays.push(of("Cells", "types", "UInt8", 1, 1, self.cells, Content::Types));
        arrays
    }

    /// The XML before the appended data.
    fn head(&self, arrays: &[Array]) -> String {
        let mut xml = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  \
             <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
            self.points, self.cells
        );
        let mut offset = 0;
        for section in ["PointData", "CellData", "Points", "Cells"] {
            let _ = writeln!(xml, "      <{section}>");
            for array in arrays.iter().filter(|array| array.section == section) {
                let Array { name, kind, components, .. } = array;
                let name = escaped(name);
                let _ = writeln!(
                    xml,
                    "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                     format=\"appended\" offset=\"{offset}\"/>"
                );
                offset += 8 + array.bytes();
            }
            let _ = writeln!(xml, "      </{section}>");
        }
        xml.push_str("    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_");
        xml
    }

    /// Writes the values of an array.
    fn values(&self, out: &mut impl Write, array: &Array) -> io::Result<()> {
        match &array.content {
            Content::Field(Field { support: Support::Points, values: Values::Real(values), .. }) => {
                self.each_point(|terms| out.write_all(&sum(terms, |n| values[n]).to_le_bytes()))
            }
            Content::Field(Field { support: Support::Points, values: Values::Integer(values), .. }) => {
                self.each_point(|terms| out.write_all(&values[nearest(terms)].to_le_bytes()))
            }
            Content::Field(Field { support: Support::Elements, values: Values::Real(values), .. }) => {
                self.each_cell(|_, element| out.write_all(&element.map_or(f64::NAN, |n| values[n]).to_le_bytes()))
            }
            Content::Field(Field { support: Support::Elements, values: Values::Integer(values), .. }) => {
                self.each_cell(|_, element| out.write_all(&element.map_or(-1, |n| values[n]).to_le_bytes()))
            }
            Content::Dimension => self.each_cell(|part, _| out.write_all(&[part.block.cell.dimension() as u8])),
            Content::Entity => self.each_cell(|part, _| out.write_all(&part.block.entity.tag.to_le_bytes())),
            Content::Patch => self.each_cell(|part, _| out.write_all(&part.patch.to_le_bytes())),
            Content::Points => self.each_point(|terms| {
                let at = |axis: usize| sum(terms, |n| self.mesh.points()[n][axis]).to_le_bytes();
                (0..3).try_for_each(|axis| out.write_all(&at(axis)))
            }),
            Content::Connectivity => self.connectivity(out),
            Content::Offsets => {
                let mut end = 0;
                self.each_cell(|part, _| {
                    end += part.shown.stride() as i64;
                    out.write_all(&end.to_le_bytes())
                })
            }
            Content::Types => self.each_cell(|part, _| out.write_all(&[part.vtk])),
        }
    }

    /// Visits every written point as a weighted sum of nodes: the mesh's points first, then those of pyramids.
    fn each_point(&self, mut visit: impl FnMut(&[(usize, f64)]) -> io::Result<()>) -> io::Result<()> {
        (0..self.mesh.points().len()).try_for_each(|n| visit(&[(n, 1.0)]))?;
        let mut terms = Vec::new();
        for part in &self.parts {
            let Shown::Points(points) = &part.shown else { continue };
            for nodes in part.block.elements(self.mesh.order()) {
                for weights in points {
                    terms.clear();
                    terms.extend(nodes.iter().zip(weights).map(|(node, &weight)| (node.index(), weight)));
                    visit(&terms)?;
                }
            }
        }
        Ok(())
    }

    /// Visits every written cell; one of the top dimension with its place among those.
    fn each_cell(&self, mut visit: impl FnMut(&Part, Option<usize>) -> io::Result<()>) -> io::Result<()> {
        let mut elements = 0..;
        for part in &self.parts {
            let top = part.block.cell.dimension() == self.top;
            for _ in &part.block.tags {
                visit(part, if top { elements.next() } else { None })?;
            }
        }
        Ok(())
    }

    fn connectivity(&self, out: &mut impl Write) -> io::Result<()> {
        let mut added = self.mesh.points().len();
        for part in &self.parts {
            for nodes in part.block.elements(self.mesh.order()) {
                match &part.shown {
                    Shown::Slots(slots) => {
                        for &slot in *slots {
                            out.write_all(&(nodes[usize::from(slot)].index() as i64).to_le_bytes())?;
                        }
                    }
                    Shown::Points(points) => {
                        for point in added..added + points.len() {
                            out.write_all(&(point as i64).to_le_bytes())?;
                        }
                        added += points.len();
                    }
                }
            }
        }
        Ok(())
    }
}

/// A block's first physical tag: its own (MSH 2.2) or that of its entity.
fn patch(entities: &HashMap<EntityKey, &Entity>, block: &Block) -> i32 {
    let of_entity = || entities.get(&block.entity)?.physical_tags.first();
    block.physical_tags.first().or_else(of_entity).map_or(0, |tag| tag.saturating_abs())
}

fn sum(terms: &[(usize, f64)], value: impl Fn(usize) -> f64) -> f64 {
    terms.iter().map(|&(n, weight)| weight * value(n)).sum()
}

/// The node of largest weight.
fn nearest(terms: &[(usize, f64)]) -> usize {
    terms.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |&(n, _)| n)
}

fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
