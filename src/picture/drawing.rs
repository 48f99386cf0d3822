//! Faces and sections as triangles on the canvas: curved ones in as many pieces as the window shows, shaded, with the edges of the elements.

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use super::camera::Camera;
use super::canvas::{SAMPLES, Triangle};
use super::colour::Colour;
use crate::element::{Cell, Filling, Order, basis, lattice};
use crate::mesh::{Mesh, NodeId};
use crate::scene::{CutPlane, Section, Shown};

/// How far a drawn face may be from the curved one, in pixels.
const SLACK: f64 = 0.1;

/// Divisions of a face's edge at most.
const FINEST: usize = 16;

/// A face in pieces.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Its place among the faces.
    pub face: usize,
    /// Divisions of its edges.
    divisions: usize,
    /// Points of its filling.
    pub points: Vec<DVec3>,
    /// Unit normals there.
    normals: Vec<DVec3>,
}

/// Fillings of the faces of a mesh by kind and divisions, with weights and slopes of the nodes at their points.
#[derive(Debug)]
pub(super) struct Pieces {
    order: Order,
    known: HashMap<(Cell, usize), Table>,
}

#[derive(Debug)]
struct Table {
    filling: Filling,
    weights: Vec<Vec<f64>>,
    slopes: Vec<Vec<[f64; 3]>>,
}

impl Pieces {
    /// The fillings for a mesh of an order.
    pub(super) fn new(order: Order) -> Pieces {
        let table = |cell, divisions| {
            let filling = Filling::new(cell, divisions);
            let weights = filling.weights(order);
            let slopes = filling.points().iter().map(|&at| basis::gradients(cell, order, at)).collect();
            Table { filling, weights, slopes }
        };
        let kinds = Cell::FLAT.into_iter().flat_map(|cell| (1..=FINEST).map(move |n| (cell, n)));
        Pieces { order, known: kinds.map(|(cell, n)| ((cell, n), table(cell, n))).collect() }
    }

    /// The faces that a camera sees, in pieces.
    pub(super) fn of(&self, mesh: &Mesh, faces: &[Shown], shown: &[bool], camera: &Camera) -> Vec<Piece> {
        let wanted = faces.par_iter().enumerate().filter(|(_, face)| shown[face.patch]);
        wanted.filter_map(|(place, face)| self.piece(mesh, place, face, camera)).collect()
    }

    fn piece(&self, mesh: &Mesh, place: usize, face: &Shown, camera: &Camera) -> Option<Piece> {
        let nodes: Vec<DVec3> = mesh.points_of(&face.nodes).collect();
        let divisions = self.divisions(face.cell, &nodes, camera);
        let table = self.known.get(&(face.cell, divisions))?;
        let at = |weights: &Vec<f64>| nodes.iter().zip(weights).map(|(&x, &weight)| x * weight).sum();
        let points: Vec<DVec3> = table.weights.iter().map(at).collect();
        let along =
            |slopes: &[[f64; 3]], axis: usize| nodes.iter().zip(slopes).map(|(&x, own)| x * own[axis]).sum::<DVec3>();
        let normal = |slopes: &Vec<[f64; 3]>| along(slopes, 0).cross(along(slopes, 1)).normalize_or(camera.frame[2]);
        Some(Piece { face: place, divisions, points, normals: table.slopes.iter().map(normal).collect() })
    }

    /// As many divisions as the bulge of a face asks for.
    fn divisions(&self, cell: Cell, nodes: &[DVec3], camera: &Camera) -> usize {
        let p = self.order.get() as f64;
        let corners = &nodes[..cell.corner_count()];
        let bulge = |(node, &x): (&[u8; 3], &DVec3)| {
            let weights = basis::values(cell, Order::LINEAR, node.map(|i| f64::from(i) / p));
            corners.iter().zip(weights).map(|(&c, weight)| c * weight).sum::<DVec3>().distance(x)
        };
        let curved = self.order > Order::LINEAR || corners.len() == 4;
        if !curved {
            return 1;
        }
        let bulge = lattice(cell, self.order).iter().zip(nodes).map(bulge).fold(0.0, f64::max);
        let bulge = if corners.len() == 4 { bulge.max(0.25 * twist(corners)) } else { bulge };
        let pixels = bulge * camera.scale / SAMPLES as f64;
        ((pixels / SLACK).sqrt().ceil() as usize).clamp(1, FINEST)
    }

    /// The triangles of a piece, with the colours of its points.
    pub(super) fn triangles(
        &self,
        piece: &Piece,
        faces: &[Shown],
        colours: &[Colour],
        camera: &Camera,
        cut: Option<CutPlane>,
    ) -> Vec<Triangle> {
        let Some(Table { filling, .. }) = self.known.get(&(faces[piece.face].cell, piece.divisions)) else {
            return Vec::new();
        };
        let seen: Vec<[f32; 3]> = piece.points.iter().map(|&x| camera.see(x)).collect();
        let shaded: Vec<Colour> = piece.normals.iter().zip(colours).map(|(&n, &c)| shaded(c, n, camera)).collect();
        let beyond: Vec<f32> = piece.points.iter().map(|&x| beyond(x, camera, cut)).collect();
        let dark = darkness(&seen);
        let triangle = |(simplex, outside): (&[u16], &[bool])| {
            let own: [usize; 3] = std::array::from_fn(|q| usize::from(simplex[q]));
            Triangle {
                corners: own.map(|q| seen[q]),
                colours: own.map(|q| shaded[q]),
                beyond: own.map(|q| beyond[q]),
                lines: std::array::from_fn(|q| if outside[q] { dark } else { 0.0 }),
            }
        };
        filling.simplices().map(triangle).collect()
    }
}

/// How far the corners of a quadrilateral are from being flat.
fn twist(corners: &[DVec3]) -> f64 {
    (corners[0] + corners[2] - corners[1] - corners[3]).length() * 0.5
}

/// How dark the edges of a face are drawn: those of small ones would hide it.
fn darkness(seen: &[[f32; 3]]) -> f32 {
    let range = |axis: usize| {
        let values = seen.iter().map(|x| x[axis]);
        values.clone().fold(f32::NEG_INFINITY, f32::max) - values.fold(f32::INFINITY, f32::min)
    };
    let pixels = (range(0) * range(1)).sqrt() / SAMPLES as f32;
    0.8 * ((pixels - 2.5) / 9.0).clamp(0.0, 1.0)
}

/// A colour in the light that falls from beside the eye, on both sides of a face alike.
fn shaded(colour: Colour, normal: DVec3, camera: &Camera) -> Colour {
    let [right, up, eye] = camera.frame;
    let light = (eye - 0.3 * right + 0.45 * up).normalize();
    let facing = if normal.dot(eye) < 0.0 { -normal } else { normal };
    let part = (0.55 + 0.45 * facing.dot(light).max(0.0)) as f32;
    colour.map(|x| x * part)
}

/// How far a point is beyond the plane that cuts, towards the eye.
fn beyond(x: DVec3, camera: &Camera, cut: Option<CutPlane>) -> f32 {
    let Some(CutPlane { axis, at }) = cut else { return -1.0 };
    let towards = if camera.frame[2][axis.index()] < 0.0 { -1.0 } else { 1.0 };
    ((x[axis.index()] - at) * towards) as f32
}

/// The triangles of a section, of the colours of its elements.
pub(super) fn of_section(
    sections: &[Section],
    colour: impl Fn(usize) -> Colour + Sync,
    camera: &Camera,
) -> Vec<Triangle> {
    let of_element = |own: &[Section]| {
        let seen: Vec<[[f32; 3]; 3]> = own.iter().map(|triangle| triangle.corners.map(|x| camera.see(x))).collect();
        let dark = darkness(seen.as_flattened());
        let colours = [own.first().map_or(super::colour::NONE, |triangle| colour(triangle.element.index())); 3];
        let lines = |lines: [bool; 3]| lines.map(|line| if line { dark } else { 0.0 });
        let drawn = seen.into_iter().zip(own);
        drawn
            .map(|(corners, own)| Triangle { corners, colours, beyond: [-1.0; 3], lines: lines(own.lines) })
            .collect::<Vec<_>>()
    };
    let elements: Vec<&[Section]> = sections.chunk_by(|a, b| a.element == b.element).collect();
    elements.into_par_iter().flat_map_iter(of_element).collect()
}

/// The edges of an element as curves: the points of each, from end to end.
pub(super) fn edges(mesh: &Mesh, cell: Cell, nodes: &[NodeId]) -> Vec<Vec<DVec3>> {
    let weights = Filling::new(Cell::Line, FINEST).weights(mesh.order());
    let curve = |own: &Vec<usize>| {
        let ends: Vec<NodeId> = own.iter().map(|&q| nodes[q]).collect();
        let at = |weights: &Vec<f64>| mesh.points_of(&ends).zip(weights).map(|(x, &weight)| x * weight).sum();
        weights.iter().map(at).collect()
    };
    crate::element::edge_nodes(cell, mesh.order()).iter().map(curve).collect()
}
