//! What the fit sees of the wall: its faces and its edges on curves, their nodes, and how far they are from the CAD.

use std::collections::BTreeMap;

use cad::{Foot, Group};
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::table::Table;
use crate::associate::{Association, Classification, normal_of};
use crate::curve::level::Level;
use crate::element::{Cell, edge_nodes};
use crate::mesh::{Boundary, NodeId};

/// Faces that are measured at a time: what they take while they wait does not grow with the mesh.
const BATCH: usize = 1 << 12;

/// A foot this fraction of an edge beside its point, along the curve, is as near as closest points are found.
const BESIDE: f64 = 1e-7;

/// What is measured: a mesh face on a surface, or a mesh edge on a curve.
#[derive(Clone, Copy)]
pub(super) enum Part {
    /// By index in [`crate::mesh::Boundary::faces`].
    Face(usize),
    /// By index in [`crate::mesh::Boundary::edges`].
    Edge(usize),
}

/// A part of the wall, and its distance from the CAD.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) part: Part,
    pub(super) far: f64,
}

/// Surface or curve, by index.
pub(super) type Place = (bool, usize);

/// Largest distance by surface and curve.
pub(super) type Levels = BTreeMap<Place, f64>;

/// A level whose wall is being fitted.
pub(super) struct Fit<'l, 'a> {
    pub(super) level: &'l mut Level<'a>,
    /// Nodes of periodic pairs.
    pub(super) paired: FxHashSet<NodeId>,
    /// Displacements as projected.
    pub(super) start: Vec<DVec3>,
    pub(super) tables: FxHashMap<Cell, Table>,
}

impl<'a> Fit<'_, 'a> {
    fn boundary(&self) -> &'a Boundary {
        self.level.case.boundary
    }

    fn association(&self) -> &'a Association {
        self.level.case.association
    }

    pub(super) fn cell(&self, part: Part) -> Cell {
        match part {
            Part::Face(face) => self.boundary().faces[face].cell,
            Part::Edge(_) => Cell::Line,
        }
    }

    pub(super) fn classification(&self, part: Part) -> Classification {
        match part {
            Part::Face(face) => self.association().faces[face],
            Part::Edge(edge) => self.association().edges[edge],
        }
    }

    /// All nodes, those of the rim first.
    pub(super) fn nodes(&self, part: Part) -> Vec<NodeId> {
        let mesh = self.level.mesh();
        let of_face = |face: usize| self.boundary().nodes(face, mesh);
        match part {
            Part::Face(face) => of_face(face).to_vec(),
            Part::Edge(edge) => {
                let ends = self.boundary().edges[edge];
                let Some(&face) = self.boundary().edge_faces[edge].first() else { return ends.to_vec() };
                let nodes = of_face(face);
                let own = |slots: &&Vec<usize>| ends.iter().all(|end| slots[..2].iter().any(|&s| nodes[s] == *end));
                let slots = edge_nodes(self.boundary().faces[face].cell, mesh.order()).iter().find(own);
                slots.map_or(ends.to_vec(), |slots| slots.iter().map(|&s| nodes[s]).collect())
            }
        }
    }

    pub(super) fn rim(&self, part: Part) -> Vec<NodeId> {
        let mut nodes = self.nodes(part);
        nodes.truncate(self.tables[&self.cell(part)].rim);
        nodes
    }

    pub(super) fn straight(&self, node: NodeId) -> DVec3 {
        self.level.straight()[node.index()]
    }

    pub(super) fn position(&self, node: NodeId) -> DVec3 {
        self.level.displaced(node.index())
    }

    /// The group that holds a classification's nodes; planes need none.
    pub(super) fn group(&self, classification: Classification) -> Option<&'a Group> {
        self.association().group_of(classification).filter(|_| self.association().plane_of(classification).is_none())
    }

    pub(super) fn slides(&self, node: NodeId) -> bool {
        let new = node.index() >= self.level.elevated.linear_nodes;
        new && self.group(self.level.wall.classification(node.index())).is_some() && !self.paired.contains(&node)
    }

    /// Length of a part's first edge.
    pub(super) fn size(&self, part: Part) -> f64 {
        let [a, b] = match part {
            Part::Face(face) => [self.boundary().corners[face][0], self.boundary().corners[face][1]],
            Part::Edge(edge) => self.boundary().edges[edge],
        };
        self.straight(a).distance(self.straight(b))
    }

    /// Points of the wall, and their feet.
    pub(super) fn feet(&self, part: Part, values: &[Vec<f64>]) -> Vec<(DVec3, Option<Foot>)> {
        let Some(group) = self.group(self.classification(part)) else { return Vec::new() };
        let positions: Vec<DVec3> = self.nodes(part).into_iter().map(|n| self.position(n)).collect();
        let point = |values: &Vec<f64>| positions.iter().zip(values).map(|(x, v)| *x * *v).sum();
        values.iter().map(point).map(|x| (x, group.closest(x, None))).collect()
    }

    pub(super) fn far(&self, part: Part, values: &[Vec<f64>]) -> f64 {
        let feet = self.feet(part, values).into_iter();
        feet.filter_map(|(x, foot)| Some(self.gap(part, x, &foot?))).fold(0.0, f64::max)
    }

    /// How far a point of the wall is from the CAD; in a plane mesh across the curve, where its foot is beside it only by what closest
    /// points are worth.
    pub(super) fn gap(&self, part: Part, x: DVec3, foot: &Foot) -> f64 {
        let plane = self.level.plane();
        let normal = plane.and_then(|_| normal_of(self.group(self.classification(part))?, foot, plane));
        let across = normal.map(|normal| (x - foot.point).project_onto(normal));
        let beside = |across: &DVec3| (x - foot.point).distance(*across) <= BESIDE * self.size(part);
        across.filter(beside).map_or(foot.distance, DVec3::length)
    }

    /// The faces and edges that have nodes to slide, roughly measured.
    pub(super) fn pieces(&self) -> Vec<Piece> {
        let faces = (0..self.boundary().faces.len()).map(Part::Face);
        let on_curve = |&edge: &usize| matches!(self.association().edges[edge], Classification::Curve(_));
        let parts: Vec<Part> = faces.chain((0..self.boundary().edges.len()).filter(on_curve).map(Part::Edge)).collect();
        let measured = |&part: &Part| {
            let slides =
                self.group(self.classification(part)).is_some() && self.rim(part).into_iter().any(|n| self.slides(n));
            slides.then(|| Piece { part, far: self.far(part, &self.tables[&self.cell(part)].coarse) })
        };
        let batch = |parts: &[Part]| parts.par_iter().filter_map(measured).collect::<Vec<_>>();
        parts.chunks(BATCH).flat_map(batch).collect()
    }

    pub(super) fn levels(&self, pieces: &[Piece]) -> Levels {
        let mut levels = Levels::new();
        for piece in pieces {
            let own = levels.entry(self.key(piece.part)).or_insert(0.0);
            *own = piece.far.max(*own);
        }
        levels
    }

    pub(super) fn key(&self, part: Part) -> Place {
        match self.classification(part) {
            Classification::Curve(curve) => (true, curve),
            Classification::Surface(surface) => (false, surface),
            _ => (false, usize::MAX),
        }
    }

    /// How far the nodes of a part's rim have slid.
    pub(super) fn shifts(&self, part: Part) -> Vec<DVec3> {
        let slid = |n: NodeId| self.level.wall.displacement(n.index()) - self.start[n.index()];
        self.rim(part).into_iter().map(slid).collect()
    }
}
