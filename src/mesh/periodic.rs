//! Pairs of patches whose nodes correspond: which map takes one onto the other.

use cad::Aabb;
use glam::{DAffine3, DMat4};
use rustc_hash::FxHashSet;

use super::{Mesh, NodeId, Periodic};

/// The linear nodes of a pair correspond if none is farther from its partner's image; fraction of the mesh's bounding-box diagonal.
pub const CONGRUENT: f64 = 1e-6;

/// The map from master to slave that the record gives, in whichever direction it takes the nodes onto one another; where it gives none, a
/// shift that does.
#[must_use]
pub fn map_of(mesh: &Mesh, record: &Periodic) -> Option<DAffine3> {
    let slack = CONGRUENT * Aabb::of_points(mesh.points().iter().copied()).diagonal();
    let at = |node: NodeId| mesh.points()[node.index()];
    let fits = |map: &DAffine3| {
        record.pairs.iter().all(|&(slave, master)| map.transform_point3(at(master)).distance(at(slave)) <= slack)
    };
    let given: Option<[f64; 16]> = record.affine.clone().try_into().ok();
    match given {
        Some(rows) => maps(&rows).into_iter().find(fits),
        None => {
            let &(slave, master) = record.pairs.first()?;
            Some(DAffine3::from_translation(at(slave) - at(master))).filter(fits)
        }
    }
}

/// The maps that 16 numbers may mean: rows or columns, there or back. Writers differ.
#[must_use]
pub fn maps(numbers: &[f64; 16]) -> Vec<DAffine3> {
    let columns = DMat4::from_cols_array(numbers);
    let maps = [columns.transpose(), columns].map(|matrix| (matrix, DAffine3::from_mat4(matrix)));
    let is_affine = |matrix: &DMat4| matrix.row(3).abs_diff_eq(glam::DVec4::W, 1e-12);
    let usable = maps.into_iter().filter(|(matrix, map)| is_affine(matrix) && map.matrix3.determinant().abs() > 1e-12);
    usable.flat_map(|(_, map)| [map, map.inverse()]).collect()
}

/// The linear pairs of two sets of nodes under the first of these maps that takes one onto the other, `(slave, master)`, with that map.
#[must_use]
pub fn matched(
    mesh: &Mesh,
    masters: &[NodeId],
    slaves: &[NodeId],
    maps: &[DAffine3],
) -> Option<(DAffine3, Vec<(NodeId, NodeId)>)> {
    if masters.len() != slaves.len() || masters.is_empty() {
        return None;
    }
    let slack = CONGRUENT * Aabb::of_points(mesh.points().iter().copied()).diagonal();
    let boxes: Vec<Aabb> = slaves.iter().map(|n| Aabb::of_points([mesh.points()[n.index()]])).collect();
    let tree = cad::BoxTree::new(&boxes);
    maps.iter().find_map(|map| {
        let mut taken = FxHashSet::default();
        let pair = |&master: &NodeId| {
            let image = map.transform_point3(mesh.points()[master.index()]);
            let distance = |leaf: usize| Some(mesh.points()[slaves[leaf].index()].distance_squared(image));
            let found = tree.nearest(image, slack * slack, distance)?;
            taken.insert(found.leaf).then(|| (slaves[found.leaf], master))
        };
        let pairs: Option<Vec<_>> = masters.iter().map(pair).collect();
        pairs.map(|pairs| (*map, pairs))
    })
}
