//! The same by linkage: a layer of prisms on either side, tied to its side by a linkage file, elevated and projected.

use std::path::Path;

use cad::{FaceId, Group};
use glam::DVec3;
use sagitta::associate::{self, Linkage};
use sagitta::curve::Settings;
use sagitta::curve::level::{Case as LevelCase, Level};
use sagitta::element::{Cell, Order};
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{Boundary, EntityKey, Mesh, NodeId, Parts};

use super::section::{Section, sections};
use super::side::Side;
use super::{CELLS, ORDERS, read};

/// Height of the prisms, share of the chord.
const HEIGHT: f64 = 0.05;

/// Nodes of the mesh, its blocks, and the nodes of the walls.
#[derive(Default)]
struct Layer {
    parts: Parts,
}

impl Layer {
    fn push(&mut self, cell: Cell, dimension: u8, tag: i32, nodes: &[usize]) {
        let nodes: Vec<NodeId> = nodes.iter().map(|&node| NodeId::new(node).unwrap()).collect();
        self.parts.push(cell, EntityKey::new(dimension, tag), &nodes);
    }

    /// Prisms on the triangles of a side, upwards or downwards; the wall gets the entity `tag`, the rest `tag + 10`.
    fn add(&mut self, side: &Side, tag: i32, up: bool) {
        let [n, m] = side.cells;
        let first = self.parts.points.len();
        let count = (n + 1) * (m + 1);
        let wall = (0..count).map(|k| side.surface([(k / (m + 1)) as f64 / n as f64, (k % (m + 1)) as f64 / m as f64]));
        let wall: Vec<DVec3> = wall.collect();
        let lift = if up { HEIGHT } else { -HEIGHT } * DVec3::Z;
        self.parts.points.extend(wall.iter().copied().chain(wall.iter().map(|p| *p + lift)));
        let at = |i: usize, j: usize| first + i * (m + 1) + j;
        for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
            for triangle in [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]] {
                let [a, b, c] = if up { triangle } else { [triangle[0], triangle[2], triangle[1]] };
                self.push(Cell::Triangle, 2, tag, &[a, b, c]);
                self.push(Cell::Triangle, 2, tag + 10, &[a + count, b + count, c + count]);
                self.push(Cell::Prism, 3, tag, &[a, b, c, a + count, b + count, c + count]);
            }
        }
        let along = (0..n).flat_map(|i| [[at(i, 0), at(i + 1, 0)], [at(i, m), at(i + 1, m)]]);
        let across = (0..m).flat_map(|j| [[at(0, j), at(0, j + 1)], [at(n, j), at(n, j + 1)]]);
        for [a, b] in along.chain(across) {
            self.push(Cell::Quad, 2, tag + 10, &[a, b, b + count, a + count]);
        }
    }

    fn mesh(self) -> Mesh {
        Mesh::new(self.parts).unwrap()
    }
}

/// Two sheets: entity 1 on face 1, entity 2 on face 2.
fn linkage(mesh: &Mesh) -> String {
    let sheet = |tag: i32, name: &str| {
        let block = mesh.blocks().iter().find(|b| b.entity == EntityKey::new(2, tag)).unwrap();
        let rows = block.elements(mesh.order()).map(|nodes| {
            let tags = nodes.iter().map(|node| mesh.node_tags()[node.index()].to_string());
            tags.collect::<Vec<_>>().join(" ")
        });
        format!(
            "<MeshSheet name=\"{name}\" gref=\"{tag}\"><MeshFace etype=\"Tri3\" format=\"text\" count=\"{}\">{}</MeshFace></MeshSheet>",
            block.tags.len(),
            rows.collect::<Vec<_>>().join(" ")
        )
    };
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<MeshLink version=\"1.0\">\n<GeometryFile filename=\"section.igs\">\
         <GeometryReference gid=\"1\" ref=\"face-1\"/><GeometryReference gid=\"2\" ref=\"face-2\"/></GeometryFile>\n\
         <MeshFile filename=\"layers.msh\"><MeshModelReference ref=\"fluid\">\n{}\n{}\n</MeshModelReference></MeshFile>\n</MeshLink>\n",
        sheet(1, "upper"),
        sheet(2, "lower")
    )
}

/// Classifies the layers of a section on their sides and projects them at every order: wall nodes, and those that are not on their side.
fn project(section: &Section, folder: &Path) -> (usize, usize) {
    let [cad, link] = ["section.igs", "link.xml"].map(|name| folder.join(name));
    std::fs::write(&cad, crate::common::iges::file(&section.patches())).unwrap();
    let model = read(&cad);
    let mut layer = Layer::default();
    for (k, tag) in [(0, 1), (1, 2)] {
        layer.add(&Side::whole(&model, FaceId::new(k), CELLS), tag, k == 0);
    }
    let linear = layer.mesh();
    std::fs::write(&link, linkage(&linear)).unwrap();
    let boundary = Boundary::new(&linear);
    let linkage = Linkage::read(&link, "layers.msh".as_ref()).unwrap();
    let candidates = associate::linked(&linkage, &linear, &boundary, &model).unwrap();
    let association = associate::associate(&linear, &boundary, &model, &candidates, 1e-3).unwrap();
    let (mut nodes, mut astray) = (0, 0);
    for (p, (tag, face)) in ORDERS.into_iter().flat_map(|p| [(p, (1, 0)), (p, (2, 1))]) {
        let order = Order::new(p).unwrap();
        let settings = Settings::new(order);
        let case = LevelCase { settings: &settings, boundary: &boundary, association: &association };
        let (mut level, _) = Level::new(case, elevate(&linear, order).unwrap());
        sagitta::curve::wall::project(&mut level);
        let own = Group::of_faces(&model, &[FaceId::new(face)]).unwrap();
        let wall = level.mesh().blocks().iter().find(|b| b.entity == EntityKey::new(2, tag)).unwrap();
        let mut numbers: Vec<usize> = wall.nodes.iter().map(|node| node.index()).collect();
        numbers.sort_unstable();
        numbers.dedup();
        nodes += numbers.len();
        let place = |n: usize| level.displaced(n);
        let off = |n: &&usize| own.distance(place(**n)) > 1e-9 * model.diagonal();
        astray += numbers.iter().filter(off).count();
    }
    (nodes, astray)
}

#[test]
fn linkage_keeps_wall_nodes_on_their_side() {
    let folder = tempfile::tempdir().unwrap();
    let mut total = 0;
    for section in sections() {
        let (nodes, astray) = project(&section, folder.path());
        assert_eq!(astray, 0, "{section}: of {nodes} wall nodes");
        total += nodes;
    }
    println!("by linkage: {total} wall nodes of {} sections, P2 to P4, all on their side", sections().len());
}
