//! What may be wrong with a CAD model: the data of `sagitta info`.

use crate::geometry::leaf::Side;
use crate::geometry::newton;
use crate::ids::{EdgeId, FaceId};
use crate::model::crease::Crease;
use crate::model::{Edge, Kind, Model};
use crate::tolerance::{LOOSE, TINY, TRIM_GAP};
use std::collections::BTreeMap;
use std::fmt;

/// Points of a pcurve that are held against its edge.
const SAMPLES: u32 = 8;

/// A report on a model. Lists are ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct Health {
    /// Number of faces of each kind.
    pub faces: BTreeMap<Kind, usize>,
    /// Number of edges of each kind.
    pub edges: BTreeMap<Kind, usize>,
    /// Number of vertices.
    pub vertices: usize,
    /// Edges that bound one face only, on one side, and match no other: open rims.
    pub open_edges: Vec<EdgeId>,
    /// Sets of edges that are one within tolerance, between faces that are not sewn, see [`Model::sewing`].
    pub doubled_edges: Vec<Vec<EdgeId>>,
    /// Edges that bound no face.
    pub free_edges: Vec<EdgeId>,
    /// Edges shorter than [`TINY`](crate::tolerance::TINY).
    pub tiny_edges: Vec<EdgeId>,
    /// Faces smaller than that.
    pub tiny_faces: Vec<FaceId>,
    /// Faces whose boundary contradicts itself or the surface.
    pub trims: Vec<(FaceId, TrimFault)>,
    /// Lines inside faces at which the surface turns.
    pub creases: Vec<Crease>,
    /// Entities of the file that came to no shape, see [`Model::dropped`].
    pub dropped: Vec<String>,
    /// What OCCT's checks say, see [`Model::warnings`].
    pub warnings: Vec<String>,
}

/// What is wrong with the boundary of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TrimFault {
    /// Nothing of the surface lies inside the boundary.
    Void,
    /// The edges of a wire do not come back to where they began.
    Open {
        /// Number of the wire in the face, from 0.
        wire: usize,
    },
    /// The boundary curve on the surface is away from the edge by more than tolerances allow.
    Gap {
        /// The edge.
        edge: EdgeId,
        /// How far, in the unit of the model.
        distance: f64,
        /// The edge's tolerance.
        tolerance: f64,
    },
}

impl fmt::Display for TrimFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Void => f.write_str("nothing lies inside its boundary"),
            Self::Open { wire } => write!(f, "wire {} is open", wire + 1),
            Self::Gap { edge, distance, tolerance } => {
                write!(f, "{edge} is {distance:.3e} away from the surface, its tolerance is {tolerance:.1e}")
            }
        }
    }
}

impl Model {
    /// Counts entities and looks for what may spoil a projection.
    pub fn health(&self) -> Health {
        let mut health = Health {
            faces: BTreeMap::new(),
            edges: BTreeMap::new(),
            vertices: self.vertices().len(),
            open_edges: self.sewing().open.clone(),
            doubled_edges: self.sewing().merged.clone(),
            free_edges: self.edges_where(|edge| edge.faces.is_empty()),
            tiny_edges: self.edges_where(|edge| !edge.degenerate && edge.bounds.diagonal() < TINY * self.diagonal()),
            tiny_faces: Vec::new(),
            trims: Vec::new(),
            creases: Vec::new(),
            dropped: self.dropped().to_vec(),
            warnings: self.warnings().to_vec(),
        };
        for face in self.faces() {
            *health.faces.entry(face.kind).or_default() += 1;
            if face.bounds.diagonal() < TINY * self.diagonal() {
                health.tiny_faces.push(face.id);
            }
            health.creases.extend(self.creases(face.id));
            health.trims.extend(self.trim_faults(face.id).into_iter().map(|fault| (face.id, fault)));
        }
        for edge in self.edges() {
            *health.edges.entry(edge.kind).or_default() += 1;
        }
        health
    }

    fn edges_where(&self, wanted: impl Fn(&Edge) -> bool) -> Vec<EdgeId> {
        self.edges().iter().filter(|edge| wanted(edge)).map(|edge| edge.id).collect()
    }

    fn trim_faults(&self, id: FaceId) -> Vec<TrimFault> {
        let face = &self.geometry().faces[id.index()];
        if face.leaves.is_empty() {
            return vec![TrimFault::Void];
        }
        let wires = face.sides.chunk_by(|a, b| a.wire == b.wire).enumerate();
        let open = wires.filter(|(_, wire)| !self.is_closed(wire)).map(|(wire, _)| TrimFault::Open { wire });
        open.chain(face.sides.iter().filter_map(|side| self.gap(id, side))).collect()
    }

    /// Whether every vertex of a wire is the end of an even number of its edges.
    fn is_closed(&self, wire: &[Side]) -> bool {
        let mut ends: Vec<_> =
            wire.iter().filter_map(|side| side.edge).flat_map(|edge| self.edges()[edge].ends).flatten().collect();
        ends.sort_unstable();
        ends.chunk_by(|a, b| a == b).all(|same| same.len() % 2 == 0)
    }

    /// The largest distance of sampled points of a pcurve from its edge, where it is beyond [`TRIM_GAP`] or [`LOOSE`].
    fn gap(&self, id: FaceId, side: &Side) -> Option<TrimFault> {
        let chart = &self.geometry().faces[id.index()].chart;
        let edge = self.edges().get(side.edge?)?;
        let curve = self.geometry().edges[edge.id.index()].as_ref()?;
        let away = |k: u32| {
            let t = side.range[0] + (side.range[1] - side.range[0]) * f64::from(k) / f64::from(SAMPLES);
            let mut jet = [0.0; 4];
            side.pcurve.d1(t, &mut jet).ok()?;
            let x = chart.d2(jet[0], jet[1])[0];
            let locals = curve.leaves.iter().map(|leaf| {
                newton::on_curve(&curve.curve, leaf.range, x, 0.5 * (leaf.range[0] + leaf.range[1])).distance_squared
            });
            Some(locals.fold(f64::INFINITY, f64::min).sqrt())
        };
        let distance = (0..=SAMPLES).filter_map(away).fold(0.0, f64::max);
        let tolerance = TRIM_GAP * edge.tolerance.max(self.faces()[id.index()].tolerance);
        (distance > tolerance.min(LOOSE * self.diagonal()) + 1e-9 * self.diagonal()).then_some(TrimFault::Gap {
            edge: edge.id,
            distance,
            tolerance: edge.tolerance,
        })
    }
}
