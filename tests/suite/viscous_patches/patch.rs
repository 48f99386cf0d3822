//! A patch from its case: the CAD as an IGES file and the linear mesh on it.

use std::collections::BTreeMap;
use std::path::Path;

use sagitta::certify::{self, Settings};
use sagitta::element::Cell;
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{EntityKey, Mesh, NodeId, Parts};

use crate::common::random::Random;
use crate::viscous_patches::case::Case;
use crate::viscous_patches::cells::Cells;
use crate::viscous_patches::layers::{extrude, heights};
use crate::viscous_patches::surface::{Form, Surface};
use crate::viscous_patches::wall::Grid;

/// Cells along a side of the wall.
const CELLS: [usize; 2] = [4, 5];
/// Entity of the first side; the CAD has no such face.
const SIDES: i32 = 11;
/// Entity of the top.
const TOP: i32 = 15;
/// Attempts at a patch whose linear mesh is valid.
const ATTEMPTS: usize = 100;

/// A patch and its figures, in edge lengths or ratios.
pub struct Patch {
    pub surface: Surface,
    pub mesh: Mesh,
    /// In wall spacings.
    pub sagitta: f64,
    /// Edge length over wall spacing.
    pub aspect_ratio: f64,
    pub layers: usize,
    /// Thickness of the layer in which hexes or prisms end, in edge lengths.
    pub transition: f64,
    /// Drawings before this one whose linear mesh was inverted.
    pub rejected: usize,
}

impl Patch {
    /// The first drawing from the case's seed whose linear mesh is valid.
    pub fn draw(case: &Case) -> Patch {
        let mut random = Random(case.seed);
        for rejected in 0..ATTEMPTS {
            let patch = Patch::attempt(case, &mut random);
            if certify::mesh(&patch.mesh, patch.mesh.points(), None, &Settings::default()).holds() {
                return Patch { rejected, ..patch };
            }
        }
        panic!("{case}: {ATTEMPTS} inverted linear meshes")
    }

    fn attempt(case: &Case, random: &mut Random) -> Patch {
        let (spacings, aspect_ratio) = case.proportions(random);
        let form = Form::draw(case.shape, CELLS[random.below(CELLS.len())], random);
        let grid = Grid::draw(case.kind, &form, random);
        let surface = grid.bent(&form, spacings / aspect_ratio);
        let sagitta = grid.sagitta(&surface) * aspect_ratio;
        let heights = heights(1.0 / aspect_ratio, random);
        let layers = heights.len() - 1;
        // where pyramids stand on hexes, their layer must be thicker than the quadrilaterals are twisted
        let thick = |k: &usize| heights[k + 1] - heights[*k] > 0.5 * spacings / aspect_ratio;
        let first = (layers / 2..layers).find(thick).unwrap_or(layers - 1);
        let transition = first + random.below(layers - first);
        let points = extrude(&grid, &grid.on(&surface), &heights);
        let cells = Cells::fill(case.kind, &grid, points, transition);
        let mesh = mesh(cells, &grid, form.split(), layers);
        let transition = heights[transition + 1] - heights[transition];
        Patch { surface, mesh, sagitta, aspect_ratio, layers, transition, rejected: 0 }
    }

    /// Writes the CAD file and the mesh file.
    pub fn write(&self, cad: &Path, mesh: &Path) {
        std::fs::write(cad, crate::common::iges::file(&self.surface.faces)).unwrap();
        formats::write(mesh, &self.mesh, &WriteOptions::default()).unwrap();
    }
}

/// The mesh of the cells, its boundary faces on entities: those of the wall have the numbers of their CAD faces.
fn mesh(cells: Cells, grid: &Grid, split: Option<usize>, layers: usize) -> Mesh {
    let mut parts = Parts::default();
    let mut push = |cell: Cell, entity: EntityKey, nodes: &[usize]| {
        let nodes: Vec<NodeId> = nodes.iter().map(|&node| NodeId::new(node).unwrap()).collect();
        parts.push(cell, entity, &nodes);
    };
    for (cell, corners) in boundary(&cells.cells) {
        push(cell, EntityKey::new(2, entity(&corners, grid, split, layers)), &corners);
    }
    for (cell, corners) in &cells.cells {
        push(*cell, EntityKey::new(3, 1), corners);
    }
    Mesh::new(Parts { points: cells.points, ..parts }).unwrap()
}

/// Faces that one cell alone has, seen from outside counterclockwise.
fn boundary(cells: &[(Cell, Vec<usize>)]) -> Vec<(Cell, Vec<usize>)> {
    let mut single = BTreeMap::new();
    for (cell, corners) in cells {
        for face in cell.faces() {
            let mut own: Vec<usize> = face.corners.iter().map(|&q| corners[usize::from(q)]).collect();
            if !face.outward {
                own.reverse();
            }
            let mut key = own.clone();
            key.sort_unstable();
            if single.remove(&key).is_none() {
                single.insert(key, (face.cell, own));
            }
        }
    }
    single.into_values().collect()
}

/// The entity of a boundary face: a face of the CAD on the wall, else a side or the top.
fn entity(corners: &[usize], grid: &Grid, split: Option<usize>, layers: usize) -> i32 {
    let (n, columns) = (grid.cells, grid.columns());
    let all = |of: &dyn Fn(usize) -> bool| corners.iter().all(|&node| of(node));
    let (i, j) = (|node: usize| node % columns % (n + 1), |node: usize| node % columns / (n + 1));
    if all(&|node| node < columns) {
        return if split.is_none_or(|split| all(&|node| i(node) <= split)) { 1 } else { 2 };
    }
    if all(&|node| node / columns == layers) {
        return TOP;
    }
    let sides: [&dyn Fn(usize) -> bool; 4] =
        [&|node| i(node) == 0, &|node| i(node) == n, &|node| j(node) == 0, &|node| j(node) == n];
    SIDES + sides.iter().position(|side| all(side)).unwrap() as i32
}
