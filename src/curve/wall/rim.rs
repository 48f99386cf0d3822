//! Faces off the CAD that follow the rims of curved walls.
//!
//! Where layers end at a patch that is neither on the CAD nor planar, as on an open CAD face, the edges of the wall follow the CAD along that
//! patch. Would its other nodes stay, its faces would fold where an edge moves along them by more than a layer is high, and cells be sheared
//! where it moves across: on the sheet (`fixtures/make_sheet.py`, edges off their chords by 28 first spacings) all 92 wall faces left the CAD,
//! on a wind turbine's blade 8 000 for six such edges. So these faces are carried along as the volume is. Patches that were asked to stay
//! straight do.

use std::collections::BTreeSet;

use rustc_hash::FxHashSet;

use crate::associate::{Classification, Side, sides};
use crate::curve::level::Level;
use crate::curve::perturb::carried_along;
use crate::element::edge_nodes;
use crate::mesh::EntityKey;

/// Two faces of a patch go on in one another if the cosine between their normals is at least this: the patch above the layers, where it has
/// the same name as the sides, does not follow.
const GOES_ON: f64 = 0.5;

/// Displaces the nodes of faces that follow the rims beside them; what there is to say of each patch.
pub(in crate::curve) fn follow_rims(level: &mut Level) -> Vec<String> {
    let faces = following(level);
    if faces.is_empty() {
        return Vec::new();
    }
    for (node, displacement) in carried_along(level, &faces) {
        level.wall.displace(node, displacement);
    }
    let boundary = level.case.boundary;
    let entity = |&face: &usize| boundary.faces[face].entity;
    let patches: BTreeSet<EntityKey> = faces.iter().map(entity).collect();
    let note = |patch: EntityKey| {
        let count = faces.iter().filter(|face| entity(face) == patch).count();
        let name = level.mesh().label(patch);
        format!(
            "{name}: {count} faces do not stay straight but follow the edges of the curved walls beside them; --straight \"{name}\" \
             holds them"
        )
    };
    patches.into_iter().map(note).collect()
}

/// The faces that follow: of patches off the CAD that were not asked to stay straight those at a displaced rim, and those in which they go
/// on smoothly.
fn following(level: &Level) -> FxHashSet<usize> {
    let (boundary, association) = (level.case.boundary, level.case.association);
    let asked = level.case.settings.patches.straight(level.mesh(), boundary).unwrap_or_default();
    let may_follow = |face: usize| {
        association.faces[face] == Classification::Straight && !asked.contains(&boundary.faces[face].entity)
    };
    let mut front: Vec<usize> =
        (0..boundary.faces.len()).filter(|&face| may_follow(face) && has_displaced_edge(level, face)).collect();
    let mut following: FxHashSet<usize> = front.iter().copied().collect();
    if front.is_empty() {
        return following;
    }
    let sides: Vec<Side> = sides(level.mesh(), boundary);
    while let Some(face) = front.pop() {
        let corners = &boundary.corners[face];
        let ends = corners.iter().zip(corners.iter().cycle().skip(1));
        let edges = ends.filter_map(|(&a, &b)| boundary.edge([a, b]));
        for other in edges.flat_map(|edge| boundary.edge_faces[edge].iter().copied()) {
            let goes_on = boundary.faces[other].entity == boundary.faces[face].entity
                && sides[other].normal.dot(sides[face].normal) >= GOES_ON;
            if goes_on && may_follow(other) && following.insert(other) {
                front.push(other);
            }
        }
    }
    following
}

/// Whether an inner node of one of a face's edges is displaced.
fn has_displaced_edge(level: &Level, face: usize) -> bool {
    let cell = level.case.boundary.faces[face].cell;
    let nodes = level.case.boundary.nodes(face, level.mesh());
    let mut inner = edge_nodes(cell, level.mesh().order()).iter().flat_map(|edge| edge[2..].iter());
    inner.any(|&place| level.wall.displacement(nodes[place].index()).length_squared() > 0.0)
}
