//! Volumes and areas of meshes of any order, by Gauss quadrature.
#![allow(unreachable_pub)] // what a test file uses of it

use std::collections::BTreeMap;

use glam::DVec3;
use sagitta::element::{Cell, Order, basis};
use sagitta::mesh::{EntityKey, Mesh};

/// Gauss-Legendre points and weights on 0 to 1 that are exact up to degree 15.
const GAUSS: [[f64; 2]; 8] = {
    let half = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_3],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
        [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
    ];
    let mut all = [[0.0; 2]; 8];
    let mut n = 0;
    while n < 4 {
        let [x, w] = half[n];
        all[2 * n] = [0.5 - 0.5 * x, 0.5 * w];
        all[2 * n + 1] = [0.5 + 0.5 * x, 0.5 * w];
        n += 1;
    }
    all
};

/// Chart coordinates and weights of a rule on a cell of two or three dimensions.
fn rule(cell: Cell) -> Vec<([f64; 3], f64)> {
    let line = |on: bool| if on { GAUSS.to_vec() } else { vec![[0.0, 1.0]] };
    let mut points = Vec::new();
    for [u, wu] in GAUSS {
        for [v, wv] in GAUSS {
            for [t, wt] in line(cell.dimension() == 3) {
                let weight = wu * wv * wt;
                points.push(match cell {
                    Cell::Triangle | Cell::Prism => ([u, v * (1.0 - u), t], weight * (1.0 - u)),
                    Cell::Tet => {
                        let (y, left) = (v * (1.0 - u), (1.0 - u) * (1.0 - v));
                        ([u, y, t * left], weight * (1.0 - u) * left)
                    }
                    // The pyramid's chart is the cube itself.
                    Cell::Pyramid => ([u, v, t], weight * (1.0 - t) * (1.0 - t)),
                    _ => ([u, v, t], weight),
                });
            }
        }
    }
    points
}

/// Gradients of an element's functions and weights at a rule's points.
fn table(cell: Cell, order: Order) -> Vec<(Vec<[f64; 3]>, f64)> {
    rule(cell).into_iter().map(|(at, weight)| (basis::gradients(cell, order, at), weight)).collect()
}

/// Volume of the cells of three dimensions, and area by entity of those of two; of a plane mesh the signed area of each cell.
pub fn measure(mesh: &Mesh) -> (f64, BTreeMap<EntityKey, f64>) {
    let (mut volume, mut areas) = (0.0, BTreeMap::new());
    let plane = !mesh.is_volume();
    for block in mesh.blocks().iter().filter(|block| block.cell.dimension() >= 2) {
        let table = table(block.cell, mesh.order());
        for nodes in block.elements(mesh.order()) {
            let points: Vec<DVec3> = mesh.points_of(nodes).collect();
            let mut normal = DVec3::ZERO;
            for (gradients, weight) in &table {
                let [x, y, z] = std::array::from_fn(|axis| -> DVec3 {
                    points.iter().zip(gradients).map(|(&point, gradient)| point * gradient[axis]).sum()
                });
                if block.cell.dimension() == 3 {
                    volume += weight * x.dot(y.cross(z));
                } else if plane {
                    normal += weight * x.cross(y);
                } else {
                    *areas.entry(block.entity).or_default() += weight * x.cross(y).length();
                }
            }
            if plane {
                *areas.entry(block.entity).or_default() += normal.length();
            }
        }
    }
    (volume, areas)
}
