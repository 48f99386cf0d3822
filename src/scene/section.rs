//! Sections of a mesh by a plane that stands on an axis: curved elements cut as they are.

use glam::DVec3;
use rayon::prelude::*;

use crate::element::{Cell, Filling, Order, Tables};
use crate::mesh::{Element, ElementId, Mesh};

/// An axis of space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl Axis {
    /// Its place in coordinates.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// The axis of a letter.
    #[must_use]
    pub fn of(letter: &str) -> Option<Axis> {
        match letter {
            "x" | "X" => Some(Axis::X),
            "y" | "Y" => Some(Axis::Y),
            "z" | "Z" => Some(Axis::Z),
            _ => None,
        }
    }
}

/// A plane on which one coordinate has one value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPlane {
    /// Which coordinate.
    pub axis: Axis,
    /// Its value, in the mesh's unit.
    pub at: f64,
}

/// A triangle of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Its corners.
    pub corners: [DVec3; 3],
    /// For each corner, whether the edge opposite it lies on a side of the element: a line of the mesh.
    pub lines: [bool; 3],
    /// The element that is cut.
    pub element: ElementId,
}

/// Divisions of the edges of a curved element that is cut.
const DIVISIONS: usize = 4;

/// The triangles in which a plane cuts the volumes of a mesh, in the order of the elements. Straight elements are cut exactly, curved ones as linear simplices of
/// a quarter of their edges.
#[must_use]
pub fn section(mesh: &Mesh, cut: CutPlane) -> Vec<Section> {
    let axis = cut.axis.index();
    let crossed = |own: &Element| {
        let (low, high) = mesh
            .points_of(own.nodes)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x[axis]), high.max(x[axis])));
        low <= cut.at && cut.at <= high
    };
    let cells = mesh.cells();
    let volumes = cells.par_iter().filter(|own| own.cell.dimension() == 3 && crossed(own));
    volumes.flat_map_iter(|own| of_element(mesh, &own, cut)).collect()
}

/// A filling with the weights of an element's nodes at its points.
struct Weighted {
    filling: Filling,
    weights: Vec<Vec<f64>>,
}

fn weighted(cell: Cell, order: Order) -> &'static Weighted {
    static TABLES: Tables<Weighted> = Tables::new();
    TABLES.get(cell, order, || {
        let filling = Filling::new(cell, if order == Order::LINEAR { 2 } else { DIVISIONS });
        let weights = filling.weights(order);
        Weighted { filling, weights }
    })
}

fn of_element(mesh: &Mesh, own: &Element, cut: CutPlane) -> Vec<Section> {
    let Weighted { filling, weights } = weighted(own.cell, mesh.order());
    let at = |weights: &Vec<f64>| mesh.points_of(own.nodes).zip(weights).map(|(x, &weight)| x * weight).sum::<DVec3>();
    let points: Vec<DVec3> = weights.iter().map(at).collect();
    let above: Vec<f64> = points.iter().map(|x| x[cut.axis.index()] - cut.at).collect();
    let mut triangles = Vec::new();
    for (simplex, outside) in filling.simplices() {
        let (over, under): (Vec<usize>, Vec<usize>) =
            (0..simplex.len()).partition(|&q| above[usize::from(simplex[q])] >= 0.0);
        let between = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|q| usize::from(simplex[q]));
            points[a].lerp(points[b], above[a] / (above[a] - above[b]))
        };
        let mut add = |corners, lines| triangles.push(Section { corners, lines, element: own.id });
        match (&over[..], &under[..]) {
            // Edge between the points on a-b and a-c: on the side opposite d.
            (&[a], &[b, c, d]) | (&[b, c, d], &[a]) => {
                let corners = [between(a, b), between(a, c), between(a, d)];
                add(corners, [outside[b], outside[c], outside[d]]);
            }
            (&[a, b], &[c, d]) => {
                // Round: a-c, b-c (opposite d), b-d (opposite a), a-d (opposite c), and back (opposite b).
                let [ac, bc, bd, ad] = [between(a, c), between(b, c), between(b, d), between(a, d)];
                add([ac, bc, bd], [outside[a], false, outside[d]]);
                add([ac, bd, ad], [outside[c], outside[b], false]);
            }
            _ => {}
        }
    }
    triangles
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::formats;

    /// The sections of a mesh of all cells at neighbouring planes are as large as the volume between them says.
    #[test]
    fn sections_add_up_to_the_volume() {
        for name in ["hexpyrtet_p3_msh41a.msh", "cylprism_p2_msh41b.msh"] {
            let mesh = formats::read(format!("fixtures/samples/{name}").as_ref()).unwrap();
            let area = |at: f64| -> f64 {
                let triangles = section(&mesh, CutPlane { axis: Axis::Z, at });
                triangles
                    .iter()
                    .map(|t| (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).length() / 2.0)
                    .sum()
            };
            let (low, high) = mesh.points().iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x.z), b.max(x.z)));
            let steps = 400;
            let height = (high - low) / f64::from(steps);
            let sum: f64 = (0..steps).map(|k| area(low + (f64::from(k) + 0.5) * height) * height).sum();
            let filled: f64 = mesh.cells().iter().map(|own| volume(&mesh, &own)).sum();
            assert!((sum / filled - 1.0).abs() < 2e-3, "{name}: {sum} for {filled}");
        }
    }

    fn volume(mesh: &Mesh, own: &Element) -> f64 {
        let Weighted { filling, weights } = weighted(own.cell, mesh.order());
        let at =
            |q: u16| -> DVec3 { mesh.points_of(own.nodes).zip(&weights[usize::from(q)]).map(|(x, &w)| x * w).sum() };
        let of = |s: &[u16]| (at(s[1]) - at(s[0])).cross(at(s[2]) - at(s[0])).dot(at(s[3]) - at(s[0])).abs() / 6.0;
        filling.simplices().map(|(simplex, _)| of(simplex)).sum()
    }
}
