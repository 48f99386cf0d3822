//! New boundary nodes go to their CAD group.
//!
//! A node's wish is first spread so that the wall polynomial follows the CAD well: the inner nodes of an edge go to equal
//! fractions of the length of the projected edge, those of a face to the smoothest extension of its edges' displacements. Projecting
//! the equispaced nodes of the chord instead bunches them where the wall leans away from the chord: at P4 the wall is then
//! 2.6 times as far from the CAD.
//!
//! An edge over a change of slope or curvature is nearer to the CAD if its nodes are not evenly spread: at P2 over the junction of a
//! line and an arc by a half, with the node at 0.55 to 0.65 of the length. For every edge alone that makes the wall worse: with up to
//! 0.03, 0.06 and 0.1 of the length the nozzle at scale 0.4 went from 1.5e-3 to 1.7, 2.1 and 2.3e-3 off the CAD, as the faces between
//! such edges bulge, and wing_blunt at scale 0.4 from C_WCN 0.94 to 0.06, as the edges of thin faces no longer move alike. So the edges
//! around the farthest faces are fitted together ([`crate::curve::wall::fit`]). Farthest point of the wall from its CAD, min C_WCN / C_JAC, seconds
//! of projection (all orders together), before and after:
//!
//! | case | as spread | fitted |
//! |---|---|---|
//! | nozzle 0.4 P2 | 1.48e-3, 0.975 / 0.807, 0.03 | 1.21e-3, 0.975 / 0.807, 0.11 |
//! | nozzle P2 | 1.71e-4, 0.992 / 0.819, 0.09 | 1.26e-4, 0.992 / 0.819, 0.2 to 0.4 |
//! | wing_blunt 0.4 P2 | 2.77e-4, 0.943 / 0.731, 0.01 | 1.52e-4, 0.944 / 0.737, 0.03 |
//! | wing_sharp 0.4 P2 | 2.77e-4, 0.928 / 0.805, 0.01 | 1.52e-4, 0.933 / 0.797, 0.02 |
//! | weeble P2 | 2.12e-3, 0.948 / 0.790, 0.01 | 1.24e-3, 0.948 / 0.790, 0.03 |
//! | weeble_hybrid P2 | 3.15e-3, 0.951 / 0.807, 0.00 | 2.52e-3, 0.951 / 0.801, 0.04 |
//! | sphere_shell P2 | 1.46e-3, 0.952 / 0.867, 0.00 | 7.73e-4, 0.951 / 0.868, 0.01 |
//! | torus P2 | 2.75e-3, 0.895 / 0.800, 0.00 | 2.03e-3, 0.896 / 0.802, 0.01 |
//! | cylinder_bl P2 | 2.28e-4, 0.991 / 0.943, 0.00 | the same |
//! | nozzle 0.4 P3 | 1.07e-3, 0.959 / 0.805, 0.05 | 4.01e-4, 0.965 / 0.805, 0.34 |
//! | wing_blunt 0.4 P3 | 8.29e-5, 0.921 / 0.743 | 4.26e-5, 0.918 / 0.750 |
//! | weeble P3 | 5.16e-4, 0.928 / 0.773, 0.01 | 1.46e-4, 0.930 / 0.793, 0.08 |
//! | torus P3 | 1.42e-3, 0.873 / 0.816 | 5.99e-4, 0.872 / 0.816 |
//! | nozzle 0.4 P4 | 1.92e-4, 0.933 / 0.805 | 1.17e-4, 0.954 / 0.805 |
//! | wing_blunt 0.4 P4 | 5.96e-5, 0.908 / 0.750 | 1.68e-5, 0.905 / 0.732 |
//! | wing_sharp 0.4 P4 | 5.97e-5, 0.814 / 0.678 | 2.29e-5, 0.812 / 0.715 |
//! | weeble P4 | 3.74e-5, 0.911 / 0.775 | 1.80e-5, 0.912 / 0.783 |
//! | torus P4 | 9.68e-5, 0.847 / 0.816 | 3.39e-5, 0.845 / 0.814 |

use std::iter::once;

use cad::Foot;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::associate::{Association, Classification};
use crate::curve::level::{Case, Level};
use crate::element::{Cell, Order, interior_count, interior_extension, interior_start};
use crate::mesh::NodeId;

/// Edges, faces or nodes that are projected at a time: what they take while they wait does not grow with the mesh.
const BATCH: usize = 1 << 12;
/// Positions between two nodes of an edge at which its projection is measured.
const STATIONS: usize = 4;
/// A projected edge this much longer than its chord does not run beside it: its nodes are not spread.
const LONGEST: f64 = 2.0;

/// Projects the boundary nodes of a level; [`Settings::freeze_linear`](crate::curve::Settings::freeze_linear) leaves the linear ones
/// where they are, on the CAD or not.
pub fn project(level: &mut Level) {
    let mut projector = Projector { level };
    if !projector.level.case.settings.freeze_linear {
        projector.linear_nodes();
    }
    projector.edges();
    projector.faces();
}

/// Positions on the CAD, and how many closest points were asked for.
struct Feet {
    positions: Vec<DVec3>,
    queries: usize,
    unproven: usize,
}

struct Projector<'l, 'a> {
    level: &'l mut Level<'a>,
}

impl<'a> Projector<'_, 'a> {
    fn association(&self) -> &'a Association {
        self.level.case.association
    }

    fn straight(&self, node: NodeId) -> DVec3 {
        self.level.straight()[node.index()]
    }

    /// The feet of wishes on a classification's group; planes and fixed positions need no CAD.
    fn feet(&self, classification: Classification, wishes: &[DVec3]) -> Feet {
        let association = self.association();
        let held = (classification, association.plane_of(classification), association.group_of(classification));
        let positions = match held {
            (_, Some(plane), _) => wishes.iter().map(|&x| plane.closest(x)).collect(),
            (Classification::Vertex(position), ..) => vec![position; wishes.len()],
            (_, _, Some(group)) => {
                let feet: Vec<Option<Foot>> = wishes.iter().map(|&x| group.closest(x, None)).collect();
                let unproven = feet.iter().filter(|foot| !foot.is_some_and(|foot| foot.is_proven())).count();
                let positions = feet.iter().zip(wishes).map(|(foot, &wish)| foot.map_or(wish, |foot| foot.point));
                return Feet { positions: self.in_plane(positions), queries: feet.len(), unproven };
            }
            _ => wishes.to_vec(),
        };
        Feet { positions: self.in_plane(positions.into_iter()), queries: 0, unproven: 0 }
    }

    /// Positions, those of a plane mesh in its plane: the CAD may be off it by rounding.
    fn in_plane(&self, positions: impl Iterator<Item = DVec3>) -> Vec<DVec3> {
        match self.level.plane() {
            Some(plane) => positions.map(|x| plane.closest(x)).collect(),
            None => positions.collect(),
        }
    }

    /// Puts some nodes at their feet.
    fn take(&mut self, nodes: impl Iterator<Item = usize>, feet: Feet) {
        let level = &mut *self.level;
        level.wall.count_queries(feet.queries, feet.unproven);
        for (node, position) in nodes.zip(feet.positions) {
            level.wall.displace(node, position - level.elevated.mesh.points()[node]);
        }
    }

    fn linear_nodes(&mut self) {
        let classifications = &self.association().nodes;
        let on_boundary = |n: &usize| classifications[*n] != Classification::Free;
        let boundary: Vec<usize> = (0..self.level.elevated.linear_nodes).filter(on_boundary).collect();
        for batch in boundary.chunks(BATCH) {
            let own = |&n: &usize| self.feet(classifications[n], &[self.level.straight()[n]]);
            let feet: Vec<Feet> = batch.par_iter().map(own).collect();
            for (&n, feet) in batch.iter().zip(feet) {
                self.take(once(n), feet);
            }
        }
    }

    fn edges(&mut self) {
        let elevated = &self.level.elevated;
        let order = elevated.mesh.order();
        let inner = interior_count(Cell::Line, order);
        let carriers = &elevated.carriers[Cell::Line as usize];
        let on_boundary = carriers.iter().take_while(|(_, first)| first.index() < elevated.boundary_nodes);
        let known: FxHashMap<[NodeId; 2], NodeId> =
            on_boundary.map(|(ends, first)| ([ends[0], ends[1]], first)).collect();
        let classified = self.association().edges.iter().zip(&self.level.case.boundary.edges);
        let edges: Vec<(Classification, [NodeId; 2], usize)> = classified
            .filter_map(|(&classification, ends)| known.get(ends).map(|first| (classification, *ends, first.index())))
            .collect();
        for batch in edges.chunks(BATCH) {
            let feet: Vec<Feet> =
                batch.par_iter().map(|&(classification, ends, _)| self.spread(classification, ends, order)).collect();
            for (&(classification, ends, first), feet) in batch.iter().zip(feet) {
                let size = self.straight(ends[0]).distance(self.straight(ends[1]));
                ends.iter().for_each(|end| self.level.wall.meets_edge(end.index(), size));
                for node in first..first + inner {
                    self.level.wall.classify(node, classification, size);
                }
                self.take(first..first + inner, feet);
            }
        }
    }

    /// Positions of an edge's inner nodes: on the CAD, at equal fractions of the projected edge's length.
    fn spread(&self, classification: Classification, ends: [NodeId; 2], order: Order) -> Feet {
        let p = order.get();
        let [a, b] = ends.map(|n| self.level.displaced(n.index()));
        let at = |s: f64| a.lerp(b, s);
        let even: Vec<f64> = (1..p).map(|k| k as f64 / p as f64).collect();
        let chord = |fractions: &[f64]| fractions.iter().map(|&s| at(s)).collect::<Vec<_>>();
        let association = self.association();
        if association.group_of(classification).is_none() || association.plane_of(classification).is_some() {
            return self.feet(classification, &chord(&even));
        }
        let stations: Vec<f64> = (1..p * STATIONS).map(|k| k as f64 / (p * STATIONS) as f64).collect();
        let measured = self.feet(classification, &chord(&stations));
        let fractions = equal_lengths(a, b, &stations, &measured.positions, p).unwrap_or(even);
        self.feet(classification, &chord(&fractions)).after(&measured)
    }

    fn faces(&mut self) {
        let Case { boundary, association, .. } = self.level.case;
        let faces: Vec<usize> = (0..boundary.faces.len()).collect();
        for (faces, classifications) in faces.chunks(BATCH).zip(association.faces.chunks(BATCH)) {
            let own = |(&f, &classification): (&usize, &Classification)| {
                let (rim, inner) = self.rim_and_inside(f);
                self.feet(classification, &self.wishes(boundary.faces[f].cell, rim, inner))
            };
            let feet: Vec<Feet> = faces.par_iter().zip(classifications).map(own).collect();
            for ((&f, &classification), feet) in faces.iter().zip(classifications).zip(feet) {
                let (rim, inner) = self.rim_and_inside(f);
                let size = self.straight(rim[0]).distance(self.straight(rim[1]));
                let inner: Vec<usize> = inner.iter().map(|n| n.index()).collect();
                inner.iter().for_each(|&node| self.level.wall.classify(node, classification, size));
                self.take(inner.into_iter(), feet);
            }
        }
    }

    /// Nodes of a boundary face: those of its rim, and those inside.
    fn rim_and_inside(&self, face: usize) -> (&[NodeId], &[NodeId]) {
        let (boundary, mesh) = (self.level.case.boundary, self.level.mesh());
        boundary.nodes(face, mesh).split_at(interior_start(boundary.faces[face].cell, mesh.order()))
    }

    /// Where the inner nodes of a face would go: the smoothest extension of its rim's displacement.
    fn wishes(&self, cell: Cell, rim: &[NodeId], inner: &[NodeId]) -> Vec<DVec3> {
        let extension = interior_extension(cell, self.level.mesh().order());
        let moved = |weights: &[f64]| -> DVec3 {
            rim.iter().zip(weights).map(|(n, &w)| self.level.wall.displacement(n.index()) * w).sum()
        };
        let inner = inner.iter().zip(extension.chunks_exact(rim.len()));
        inner.map(|(&node, weights)| self.straight(node) + moved(weights)).collect()
    }
}

impl Feet {
    /// With the counts of the feet that led to these.
    fn after(self, earlier: &Feet) -> Feet {
        let (queries, unproven) = (self.queries + earlier.queries, self.unproven + earlier.unproven);
        Feet { queries, unproven, ..self }
    }
}

/// Chord fractions whose feet divide the projected edge into `p` pieces of equal length; `None` where the feet do not run
/// along the chord from `a` to `b`.
fn equal_lengths(a: DVec3, b: DVec3, stations: &[f64], feet: &[DVec3], p: usize) -> Option<Vec<f64>> {
    let mut lengths = vec![0.0];
    let mut fractions = vec![0.0];
    let mut last = a;
    for (&foot, &fraction) in feet.iter().chain([&b]).zip(stations.iter().chain([&1.0])) {
        lengths.push(lengths.last()? + last.distance(foot));
        fractions.push(fraction);
        if (foot - last).dot(b - a) <= 0.0 {
            return None;
        }
        last = foot;
    }
    let total = *lengths.last()?;
    if total > LONGEST * a.distance(b) {
        return None;
    }
    (1..p).map(|k| inverted(&lengths, &fractions, total * k as f64 / p as f64)).collect()
}

/// The fraction at which a rising table of lengths reaches `length`: the cubic through the four nearest entries.
fn inverted(lengths: &[f64], fractions: &[f64], length: f64) -> Option<f64> {
    let above = lengths.partition_point(|&l| l < length);
    let first = above.saturating_sub(2).min(lengths.len().checked_sub(4)?);
    let (x, y) = (&lengths[first..first + 4], &fractions[first..first + 4]);
    let mut fraction = 0.0;
    for i in 0..4 {
        let weight: f64 = (0..4).filter(|&j| j != i).map(|j| (length - x[j]) / (x[i] - x[j])).product();
        fraction += weight * y[i];
    }
    Some(fraction)
}
