//! Which CAD faces, edges and vertices hold each boundary node, and which CAD edge each mesh edge runs along.

use std::collections::BTreeMap;

use cad::{Aabb, BoxTree, EdgeId, FaceId, Group, Model, VertexId};
use glam::DVec3;
use rayon::prelude::*;

use super::Tolerance;
use crate::associate::Joints;
use crate::mesh::{Boundary, Mesh, NodeId};

/// The middle of a mesh edge may be this far from the CAD edge that it runs along; fraction of its length (an arc of 180 degrees has 0.5).
const BULGE: f64 = 0.5;
/// A CAD edge may be this far from the faces that it bounds; fraction of the CAD's diagonal.
const GAP: f64 = 1e-4;

/// The CAD faces at a node, and the CAD edges with the parameters of the feet.
type AtNode = (Vec<FaceId>, Vec<(EdgeId, f64)>);

/// The CAD entities at every node of the mesh; nothing at nodes inside the volume.
#[derive(Debug)]
pub struct Incidence {
    /// CAD faces within tolerance, ascending.
    pub faces: Vec<Vec<FaceId>>,
    /// CAD edges within tolerance, doubled ones as one, with the parameter of the foot.
    edges: Vec<Vec<(EdgeId, f64)>>,
    /// CAD vertices within tolerance, ascending: unsewn faces have each their own.
    pub vertices: Vec<Vec<VertexId>>,
    /// How far each boundary node may be from what holds it; `None` inside the volume.
    slack: Vec<Option<f64>>,
}

impl Incidence {
    /// What holds the nodes of the boundary.
    #[must_use]
    pub fn new(
        mesh: &Mesh,
        boundary: &Boundary,
        model: &Model,
        joints: &Joints<'_>,
        tolerance: &Tolerance,
    ) -> Incidence {
        let (slack, gap) = (slacks(mesh, boundary, tolerance), GAP * model.diagonal());
        let single = |&(id, _): &(EdgeId, &[FaceId])| Group::of_edges(model, &[id]).ok().map(|group| (id, group));
        let curves: Vec<(EdgeId, Group)> = joints.edges().collect::<Vec<_>>().iter().filter_map(single).collect();
        let surfaces: Vec<(FaceId, &Group)> =
            model.faces().iter().filter_map(|face| Some((face.id, joints.face(face.id)?))).collect();
        let surface_tree = BoxTree::new(&surfaces.iter().map(|(_, group)| group.bounds()).collect::<Vec<_>>());
        let curve_tree = BoxTree::new(&curves.iter().map(|(_, group)| group.bounds()).collect::<Vec<_>>());
        let near = |x: DVec3, slack: f64| Aabb::of_points([x]).grown(slack);
        let at = |n: usize| {
            let (x, Some(slack)) = (mesh.points()[n], slack[n]) else { return Default::default() };
            let holds = |&i: &usize| surfaces[i].1.distance(x) <= slack;
            let faces = surface_tree.overlapping(near(x, slack)).into_iter().filter(holds).map(|i| surfaces[i].0);
            let edges = curve_tree.overlapping(near(x, slack)).into_iter().filter_map(|i| {
                let foot = curves[i].1.closest(x, None).filter(|foot| foot.distance <= slack)?;
                Some((curves[i].0, foot.parameters?[0]))
            });
            let (mut faces, edges): AtNode = (faces.collect(), edges.collect());
            // The CAD's own gap between an edge and its faces may be larger than the tolerance.
            let beside = edges.iter().flat_map(|&(edge, _)| joints.faces_of(edge)).copied();
            faces.extend(beside.filter(|&id| joints.face(id).is_some_and(|face| face.distance(x) <= gap)));
            faces.sort_unstable();
            faces.dedup();
            (faces, edges)
        };
        let (faces, edges) =
            (0..mesh.points().len()).into_par_iter().map(at).collect::<Vec<AtNode>>().into_iter().unzip();
        let vertex = |n: usize| {
            let near =
                |vertex: &&cad::Vertex| slack[n].is_some_and(|slack| vertex.point.distance(mesh.points()[n]) <= slack);
            model.vertices().iter().filter(near).map(|vertex| vertex.id).collect()
        };
        let vertices = (0..mesh.points().len()).into_par_iter().map(vertex).collect();
        Incidence { faces, edges, vertices, slack }
    }

    /// How far the nodes of a boundary face may be from what holds them.
    pub(super) fn slack(&self, boundary: &Boundary, face: usize) -> f64 {
        boundary.corners[face].iter().filter_map(|n| self.slack[n.index()]).fold(0.0, f64::max)
    }

    /// For every boundary edge the CAD edges that it runs along: both ends lie on the CAD edge with no other node between them, and the foot of
    /// the middle lies between theirs.
    #[must_use]
    pub fn along(&self, mesh: &Mesh, boundary: &Boundary, model: &Model) -> Vec<Vec<EdgeId>> {
        let mut rows: BTreeMap<EdgeId, Vec<(f64, NodeId)>> = BTreeMap::new();
        for (n, edges) in self.edges.iter().enumerate() {
            let Ok(node) = NodeId::new(n) else { continue };
            edges.iter().for_each(|&(edge, t)| rows.entry(edge).or_default().push((t, node)));
        }
        let mut along = vec![Vec::new(); boundary.edges.len()];
        for (id, mut row) in rows {
            let (Some(edge), Ok(group)) = (model.edge(id), Group::of_edges(model, &[id])) else { continue };
            row.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let closed = edge.ends[0] == edge.ends[1];
            let steps = if closed { row.len() } else { row.len().saturating_sub(1) };
            for step in 0..steps {
                let [(from, a), (to, b)] = [row[step], row[(step + 1) % row.len()]];
                let Some(found) = boundary.edge([a, b]) else { continue };
                let [a, b] = [a, b].map(|n| mesh.points()[n.index()]);
                let Some(foot) = group.closest(0.5 * (a + b), None) else { continue };
                let Some([t, _]) = foot.parameters else { continue };
                let between = if from < to { (from..=to).contains(&t) } else { t >= from || t <= to };
                if between && foot.distance <= BULGE * a.distance(b) && !along[found].contains(&id) {
                    along[found].push(id);
                }
            }
        }
        along
    }
}

/// How far each boundary node may be from what holds it; `None` inside the volume.
pub(super) fn slacks(mesh: &Mesh, boundary: &Boundary, tolerance: &Tolerance) -> Vec<Option<f64>> {
    let spacing = if tolerance.is_wide() { along_wall(mesh, boundary) } else { shortest_edges(mesh, boundary) };
    let mut slacks = vec![None; mesh.points().len()];
    for node in boundary.corners.iter().flatten() {
        slacks[node.index()] = Some(tolerance.at(spacing[node.index()]));
    }
    slacks
}

/// The shortest mesh edge at each node.
fn shortest_edges(mesh: &Mesh, boundary: &Boundary) -> Vec<f64> {
    let mut shortest = vec![f64::INFINITY; mesh.points().len()];
    let cells = mesh.cells();
    for [a, b] in cells.iter().flat_map(|cell| cell.edges()).chain(boundary.edges.iter().copied()) {
        let length = mesh.points()[a.index()].distance(mesh.points()[b.index()]);
        for end in [a, b] {
            shortest[end.index()] = shortest[end.index()].min(length);
        }
    }
    shortest
}

/// The shortest edge of the boundary face at each node that has the longest one.
fn along_wall(mesh: &Mesh, boundary: &Boundary) -> Vec<f64> {
    let mut spacing = vec![0.0_f64; mesh.points().len()];
    for corners in &boundary.corners {
        let next = corners.iter().cycle().skip(1);
        let lengths =
            corners.iter().zip(next).map(|(a, b)| mesh.points()[a.index()].distance(mesh.points()[b.index()]));
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        corners.iter().for_each(|n| spacing[n.index()] = spacing[n.index()].max(shortest));
    }
    spacing
}
