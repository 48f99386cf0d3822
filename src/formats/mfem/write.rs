//! An MFEM mesh from a mesh.

use std::io::{self, Write};

use super::collection::Collection;
use super::geometry;
use super::numbering::Numbering;
use super::sets::{Attributes, Set};
use crate::element::{Cell, Order};
use crate::formats::part::Unwritten;
use crate::mesh::{Element, FaceKey, Mesh, NodeId};

/// Writes a mesh. Equal meshes make equal bytes.
///
/// Elements and boundary elements keep their order; vertices are the corners of elements in the order of the nodes.
pub(super) fn write(out: &mut impl Write, mesh: &Mesh) -> Result<(), Unwritten> {
    let [cells, sides] = [Attributes::of(mesh, mesh.cell_blocks()), Attributes::of(mesh, mesh.side_blocks())];
    let named = !(cells.sets.is_empty() && sides.sets.is_empty());
    writeln!(out, "MFEM mesh v1.{}\n\ndimension\n{}", if named { 3 } else { 0 }, mesh.dimension())?;
    let corners = Corners::of(mesh)?;
    writeln!(out, "\nelements\n{}", mesh.cells().len())?;
    for block in mesh.cell_blocks() {
        let attribute = cells.attribute(block);
        block.elements(mesh.order()).try_for_each(|nodes| element(out, attribute, block.cell, &corners, nodes))?;
    }
    sets(out, named, "attribute_sets", &cells.sets)?;
    let kept = |cell: Cell, nodes: &[NodeId]| corners.sides.contains(&FaceKey::new(&nodes[..cell.corner_count()]));
    let count = mesh.sides().iter().filter(|side| kept(side.cell, side.nodes)).count();
    writeln!(out, "\nboundary\n{count}")?;
    for block in mesh.side_blocks() {
        let attribute = sides.attribute(block);
        for nodes in block.elements(mesh.order()).filter(|nodes| kept(block.cell, nodes)) {
            element(out, attribute, block.cell, &corners, nodes)?;
        }
    }
    sets(out, named, "bdr_attribute_sets", &sides.sets)?;
    writeln!(out, "\nvertices\n{}", corners.nodes.len())?;
    if mesh.order() == Order::LINEAR {
        writeln!(out, "{}", axes(mesh))?;
        corners.nodes.iter().try_for_each(|node| point(out, mesh, *node))?;
    } else {
        nodes(out, mesh, &corners)?;
    }
    if named {
        writeln!(out, "\nmfem_mesh_end")?;
    }
    Ok(())
}

/// The vertices of a mesh, and the sides of its cells.
struct Corners {
    /// The node of each vertex.
    nodes: Vec<NodeId>,
    /// The vertex of each node that is one.
    vertices: Vec<Option<NodeId>>,
    sides: rustc_hash::FxHashSet<FaceKey>,
}

impl Corners {
    fn of(mesh: &Mesh) -> Result<Corners, Unwritten> {
        let mut vertices = vec![None; mesh.points().len()];
        mesh.cells().iter().flat_map(|cell| cell.corners()).for_each(|node| vertices[node.index()] = Some(*node));
        let mut nodes = Vec::new();
        for vertex in &mut vertices {
            if let Some(node) = *vertex {
                let number = NodeId::new(nodes.len()).map_err(|error| Unwritten::Inexpressible(error.to_string()))?;
                *vertex = Some(number);
                nodes.push(node);
            }
        }
        Ok(Corners { nodes, vertices, sides: mesh.cells().iter().flat_map(|cell| cell.sides()).collect() })
    }

    /// The vertices at an element's corners.
    fn at(&self, cell: Cell, nodes: &[NodeId]) -> Vec<NodeId> {
        nodes[..cell.corner_count()].iter().filter_map(|node| self.vertices[node.index()]).collect()
    }
}

fn element(out: &mut impl Write, attribute: i32, cell: Cell, corners: &Corners, nodes: &[NodeId]) -> io::Result<()> {
    write!(out, "{attribute} {}", geometry::of(cell).code)?;
    corners.at(cell, nodes).iter().try_for_each(|vertex| write!(out, " {}", vertex.index()))?;
    writeln!(out)
}

fn sets(out: &mut impl Write, named: bool, title: &str, sets: &[Set]) -> io::Result<()> {
    if !named {
        return Ok(());
    }
    writeln!(out, "\n{title}\n{}", sets.len())?;
    for Set { name, attributes } in sets {
        // As C++'s std::quoted has it.
        write!(out, "\"{}\" {}", name.replace('\\', "\\\\").replace('"', "\\\""), attributes.len())?;
        attributes.iter().try_for_each(|attribute| write!(out, " {attribute}"))?;
        writeln!(out)?;
    }
    Ok(())
}

/// Coordinates of a point: two where the mesh is one of the plane.
fn axes(mesh: &Mesh) -> usize {
    // -0 has a sign that would be lost.
    if mesh.dimension() == 2 && mesh.points().iter().all(|x| x.z.to_bits() == 0) { 2 } else { 3 }
}

fn point(out: &mut impl Write, mesh: &Mesh, node: NodeId) -> io::Result<()> {
    let point = mesh.points()[node.index()].to_array();
    let [first, rest @ ..] = &point[..axes(mesh)] else { return Ok(()) };
    write!(out, "{first:?}")?;
    rest.iter().try_for_each(|x| write!(out, " {x:?}"))?;
    writeln!(out)
}

/// The nodes as a grid function.
fn nodes(out: &mut impl Write, mesh: &Mesh, corners: &Corners) -> Result<(), Unwritten> {
    let has_pyramids = mesh.cells().iter().any(|cell| cell.cell == Cell::Pyramid);
    let space = Collection::written(mesh.order(), has_pyramids);
    let (name, axes) = (space.name(mesh.dimension()), axes(mesh));
    writeln!(out, "\nnodes\nFiniteElementSpace\nFiniteElementCollection: {name}\nVDim: {axes}\nOrdering: 1\n")?;
    if !space.continuous {
        let mut values = Vec::new();
        for cell in mesh.cells().iter() {
            values.clear();
            values.resize(cell.nodes.len(), NodeId::default());
            space.places(cell.cell).iter().zip(cell.nodes).for_each(|(&place, &node)| values[place] = node);
            values.iter().try_for_each(|&node| point(out, mesh, node))?;
        }
        return Ok(());
    }
    let at: Vec<(Cell, Vec<NodeId>)> =
        mesh.cells().iter().map(|cell| (cell.cell, corners.at(cell.cell, cell.nodes))).collect();
    let elements = at.iter().map(|(cell, corners)| (*cell, &corners[..]));
    let numbering = Numbering::new(mesh.order(), corners.nodes.len(), elements);
    let (mut nodes, mut places): (Vec<Option<NodeId>>, Vec<usize>) = (vec![None; numbering.count()], Vec::new());
    for (n, (cell, (_, at))) in mesh.cells().iter().zip(&at).enumerate() {
        numbering.element(n, cell.cell, at, &mut places);
        for (&place, &node) in places.iter().zip(cell.nodes) {
            match nodes[place].replace(node) {
                Some(other) if other != node && mesh.points()[other.index()] != mesh.points()[node.index()] => {
                    return Err(apart(&cell));
                }
                _ => {}
            }
        }
    }
    let missing = || Unwritten::Inexpressible("an element has a node at two corners; remove it".to_owned());
    nodes.into_iter().try_for_each(|node| Ok(point(out, mesh, node.ok_or_else(missing)?)?))
}

fn apart(cell: &Element) -> Unwritten {
    Unwritten::Inexpressible(format!(
        "{} {} has another node than its neighbour on a side that they share; make the mesh conforming",
        cell.cell, cell.tag
    ))
}
