//! What of a mesh is written for VTK: cells, points, and the arrays on them. VTK has no pyramid beyond the linear one: each becomes the
//! degenerate hex of the same order, whose points are the pyramid's own at the hex's lattice and whose upper face is the apex. That is exact
//! (the pyramid's functions are polynomials on the cube), but adds `(p + 1)^3` points a pyramid, and the Jacobian vanishes at the apex.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::{self, Write};

use super::node_order::{ORDER, pyramid_as_hex};
use super::type_code;
use crate::element::{Cell, Order};
use crate::formats::field::{Field, Support, Values};
use crate::formats::part::Unwritten;
use crate::mesh::{Block, Entity, EntityKey, Mesh, NodeId};

/// What of a mesh is written.
#[derive(Clone, Copy)]
pub(super) enum Selection<'a> {
    All,
    /// The elements of the mesh's top dimension.
    Cells,
    /// The boundary elements whose entity has this label.
    Patch(&'a str),
}

impl Selection<'_> {
    fn has(self, block: &Block, mesh: &Mesh) -> bool {
        let top = block.cell.dimension() == mesh.dimension();
        match self {
            Selection::All => true,
            Selection::Cells => top,
            Selection::Patch(label) => {
                block.cell.dimension() + 1 == mesh.dimension() && mesh.label(block.entity) == label
            }
        }
    }
}

/// The cells and points that are written.
pub(super) struct Grid<'a> {
    pub(super) mesh: &'a Mesh,
    top: usize,
    parts: Vec<Part<'a>>,
    /// Nodes of the mesh that are written, where that are not all, and the place of each among them.
    nodes: Option<(Vec<usize>, Vec<usize>)>,
    /// Points of the mesh and those added for pyramids.
    pub(super) points: usize,
    pub(super) cells: usize,
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
pub(super) struct Array<'a> {
    pub(super) section: &'static str,
    pub(super) name: &'a str,
    pub(super) kind: &'static str,
    width: usize,
    pub(super) components: usize,
    pub(super) count: usize,
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
    pub(super) fn bytes(&self) -> u64 {
        (self.width * self.count) as u64
    }
}

impl<'a> Grid<'a> {
    pub(super) fn new(mesh: &'a Mesh, selection: Selection<'_>) -> Grid<'a> {
        let top = mesh.dimension();
        let entities: HashMap<EntityKey, &Entity> = mesh.entities().iter().map(|e| (e.key, e)).collect();
        let wanted = mesh.blocks().iter().filter(|block| selection.has(block, mesh));
        let part = |block: &'a Block| {
            let (vtk, shown) = Shown::new(block.cell, mesh.order());
            Part { block, patch: patch(&entities, block), vtk, shown }
        };
        let parts: Vec<Part> = wanted.map(part).collect();
        let cells = parts.iter().map(|part| part.block.tags.len()).sum();
        let added = parts.iter().filter(|part| matches!(part.shown, Shown::Points(_)));
        let nodes = matches!(selection, Selection::Patch(_)).then(|| nodes(mesh, &parts));
        let own = nodes.as_ref().map_or(mesh.points().len(), |(own, _)| own.len());
        let points = own + added.map(|part| part.block.tags.len() * part.shown.stride()).sum::<usize>();
        Grid { mesh, top, parts, nodes, points, cells }
    }

    /// Refuses fields whose length is not that of what they belong to.
    pub(super) fn check(&self, fields: &[Field]) -> Result<(), Unwritten> {
        for field in fields {
            let (what, needed) = match &field.support {
                Support::Points => ("points", self.mesh.points().len()),
                Support::Elements => ("elements", self.mesh.cells().len()),
                Support::Sides(places) => ("boundary elements", places.len()),
            };
            if field.values.len() != needed {
                let found = field.values.len();
                let reason = format!("field {:?} has {found} values for {needed} {what}", field.name);
                return Err(Unwritten::Inexpressible(reason));
            }
        }
        Ok(())
    }

    /// All arrays, in file order; those of boundary elements only where there are some.
    pub(super) fn arrays<'b>(&self, fields: impl IntoIterator<Item = &'b Field>) -> Vec<Array<'b>> {
        let has_sides = self.parts.iter().any(|part| part.block.cell.dimension() + 1 == self.top);
        let shown = |field: &&Field| has_sides || !matches!(field.support, Support::Sides(_));
        let fields: Vec<&Field> = fields.into_iter().filter(shown).collect();
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
            let (kind, components) = match field.values {
                Values::Real(_) => ("Float64", 1),
                Values::Vectors(_) => ("Float64", 3),
                Values::Integer(_) => ("Int64", 1),
            };
            of(section, &field.name, kind, 8, components, items, Content::Field(field))
        };
        let on = |points| fields.iter().copied().filter(move |f| (f.support == Support::Points) == points);
        let connectivity = self.parts.iter().map(|part| part.block.tags.len() * part.shown.stride()).sum();
        let mut arrays: Vec<Array> = on(true).map(|f| field("PointData", self.points, f)).collect();
        arrays.extend(on(false).map(|f| field("CellData", self.cells, f)));
        arrays.push(of("CellData", "dimension", "UInt8", 1, 1, self.cells, Content::Dimension));
        arrays.push(of("CellData", "CellEntityIds", "Int32", 4, 1, self.cells, Content::Entity));
        arrays.push(of("CellData", "patch", "Int32", 4, 1, self.cells, Content::Patch));
        arrays.push(of("Points", "Points", "Float64", 8, 3, self.points, Content::Points));
        arrays.push(of("Cells", "connectivity", "Int64", 8, 1, connectivity, Content::Connectivity));
        arrays.push(of("Cells", "offsets", "Int64", 8, 1, self.cells, Content::Offsets));
        arrays.push(of("Cells", "types", "UInt8", 1, 1, self.cells, Content::Types));
        arrays
    }

    /// Writes the values of an array.
    pub(super) fn values(&self, out: &mut impl Write, array: &Array) -> io::Result<()> {
        match &array.content {
            Content::Field(Field { support: Support::Points, values, .. }) => match values {
                Values::Real(values) => {
                    self.each_point(|terms| out.write_all(&sum(terms, |n| values[n]).to_le_bytes()))
                }
                Values::Vectors(values) => self.each_point(|terms| {
                    let at = |axis: usize| sum(terms, |n| values[n][axis]).to_le_bytes();
                    (0..3).try_for_each(|axis| out.write_all(&at(axis)))
                }),
                Values::Integer(values) => {
                    self.each_point(|terms| out.write_all(&values[nearest(terms)].to_le_bytes()))
                }
            },
            Content::Field(Field { support, values, .. }) => self.each_place(support, |place| match values {
                Values::Real(values) => out.write_all(&place.map_or(f64::NAN, |n| values[n]).to_le_bytes()),
                Values::Vectors(values) => {
                    let own = place.map_or([f64::NAN; 3], |n| values[n]);
                    own.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))
                }
                Values::Integer(values) => out.write_all(&place.map_or(-1, |n| values[n]).to_le_bytes()),
            }),
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
        match &self.nodes {
            Some((nodes, _)) => nodes.iter().try_for_each(|&n| visit(&[(n, 1.0)]))?,
            None => (0..self.mesh.points().len()).try_for_each(|n| visit(&[(n, 1.0)]))?,
        }
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

    /// Visits the place of every written cell's value in a field on elements or boundary elements.
    fn each_place(&self, support: &Support, mut visit: impl FnMut(Option<usize>) -> io::Result<()>) -> io::Result<()> {
        let Support::Sides(places) = support else { return self.each_cell(|_, element| visit(element)) };
        let order = self.mesh.order();
        for block in self.parts.iter().map(|part| part.block) {
            let corners = block.cell.corner_count();
            let is_side = block.cell.dimension() + 1 == self.top;
            let place = |nodes: &[NodeId]| if is_side { places.of(&nodes[..corners]) } else { None };
            block.elements(order).try_for_each(|nodes| visit(place(nodes)))?;
        }
        Ok(())
    }

    /// The names of the patches that are written, with the entity tags of each.
    pub(super) fn patches(&self) -> BTreeMap<String, BTreeSet<i32>> {
        let mut patches: BTreeMap<String, BTreeSet<i32>> = BTreeMap::new();
        let sides = self.parts.iter().map(|part| part.block).filter(|block| block.cell.dimension() + 1 == self.top);
        sides.for_each(|side| {
            patches.entry(self.mesh.label(side.entity)).or_default().insert(side.entity.tag);
        });
        patches
    }

    /// Whether a field has a finite value on all that is written.
    pub(super) fn is_known(&self, field: &Field) -> bool {
        let is_finite = |place: usize| match &field.values {
            Values::Real(values) => values[place].is_finite(),
            Values::Vectors(values) => values[place].iter().all(|x| x.is_finite()),
            Values::Integer(_) => true,
        };
        let known = |place: Option<usize>| match place.is_some_and(is_finite) {
            true => Ok(()),
            false => Err(io::ErrorKind::Other.into()),
        };
        match &field.support {
            Support::Points => self.each_point(|terms| terms.iter().try_for_each(|&(n, _)| known(Some(n)))).is_ok(),
            support => self.each_place(support, known).is_ok(),
        }
    }

    fn connectivity(&self, out: &mut impl Write) -> io::Result<()> {
        let place = |n: usize| self.nodes.as_ref().map_or(n, |(_, places)| places[n]) as i64;
        let mut added = self.nodes.as_ref().map_or(self.mesh.points().len(), |(own, _)| own.len());
        for part in &self.parts {
            for nodes in part.block.elements(self.mesh.order()) {
                match &part.shown {
                    Shown::Slots(slots) => {
                        for &slot in *slots {
                            out.write_all(&place(nodes[usize::from(slot)].index()).to_le_bytes())?;
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

/// The nodes of blocks in the order of the mesh, and the place of each of the mesh's nodes among them.
fn nodes(mesh: &Mesh, parts: &[Part]) -> (Vec<usize>, Vec<usize>) {
    let mut places = vec![usize::MAX; mesh.points().len()];
    parts.iter().flat_map(|part| &part.block.nodes).for_each(|n| places[n.index()] = 0);
    let own: Vec<usize> = (0..places.len()).filter(|&n| places[n] == 0).collect();
    own.iter().enumerate().for_each(|(place, &n)| places[n] = place);
    (own, places)
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
