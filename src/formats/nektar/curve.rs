//! Points of curved edges and faces, brought to the even ones of this program.

use glam::DVec3;

use super::fault::NektarFault;
use super::tables::Points;
use super::write::places;
use crate::element::{Cell, Order, basis, interior_start, lattice};

/// The order of an edge's curve.
///
/// # Errors
/// It is none that is read.
pub(super) fn edge_order(curve: &Points) -> Result<Order, NektarFault> {
    let found = curve.points.len();
    let order = found.checked_sub(1).and_then(|p| Order::new(p).ok());
    order.ok_or(NektarFault::Order { what: "edge", id: curve.id, found })
}

/// The order of a face's curve.
///
/// # Errors
/// It is none that is read.
pub(super) fn face_order(cell: Cell, curve: &Points) -> Result<Order, NektarFault> {
    let found = curve.points.len();
    let order = Order::all().find(|&order| cell.node_count(order) == found);
    order.ok_or(NektarFault::Order { what: "face", id: curve.id, found })
}

/// Gauss-Lobatto points of the unit interval.
fn lobatto(order: Order) -> Vec<f64> {
    let half: &[f64] = match order.get() {
        3 => &[0.0, 0.276_393_202_250_021],
        4 => &[0.0, 0.172_673_164_646_011_4, 0.5],
        p => return (0..=p).map(|i| i as f64 / p as f64).collect(),
    };
    let p = order.get();
    (0..=p).map(|i| if i < half.len() { half[i] } else { 1.0 - half[p - i] }).collect()
}

/// The points inside an edge, evenly divided, from its first end on.
///
/// # Errors
/// Points that are not known.
pub(super) fn edge(order: Order, curve: &Points) -> Result<Vec<DVec3>, NektarFault> {
    let along = match curve.kind.as_str() {
        "PolyEvenlySpaced" => return Ok(curve.points[1..order.get()].to_vec()),
        "GaussLobattoLegendre" => lobatto(order),
        _ => return Err(NektarFault::Kind { what: "edge", id: curve.id, kind: curve.kind.clone() }),
    };
    // The ends of the line come first in the internal order.
    let p = order.get();
    let listed: Vec<usize> = [0, p].into_iter().chain(1..p).collect();
    let at: Vec<[f64; 3]> = listed.iter().map(|&i| [along[i], 0.0, 0.0]).collect();
    let values: Vec<DVec3> = listed.iter().map(|&i| curve.points[i]).collect();
    Ok(inner(Cell::Line, order, &at, &values))
}

/// The points inside a face, on the even lattice in internal order, from its first corner on.
///
/// # Errors
/// Points that are not known.
pub(super) fn face(cell: Cell, order: Order, curve: &Points) -> Result<Vec<DVec3>, NektarFault> {
    let unknown = || NektarFault::Kind { what: "face", id: curve.id, kind: curve.kind.clone() };
    let places = places(cell, order);
    let start = interior_start(cell, order);
    let mut values = vec![DVec3::ZERO; places.len()];
    places.iter().zip(&curve.points).for_each(|(&place, &x)| values[place] = x);
    let along = match (cell, curve.kind.as_str()) {
        (Cell::Triangle, "NodalTriEvenlySpaced") | (Cell::Quad, "PolyEvenlySpaced") => {
            return Ok(values.split_off(start));
        }
        (Cell::Quad, "GaussLobattoLegendre" | "NodalQuadElec") => lobatto(order),
        // On their edges these have Gauss-Lobatto points, and up to P3 one point at most inside, the middle.
        (Cell::Triangle, "NodalTriElec" | "NodalTriFekete") if order.get() < 4 => lobatto(order),
        _ => return Err(unknown()),
    };
    let p = order.get();
    let at = |&[i, j, _]: &[u8; 3]| {
        let [i, j] = [usize::from(i), usize::from(j)];
        let is_inside = cell == Cell::Triangle && i > 0 && j > 0 && i + j < p;
        if is_inside { [1.0 / 3.0, 1.0 / 3.0, 0.0] } else { [along[i], along[j], 0.0] }
    };
    let at: Vec<[f64; 3]> = lattice(cell, order).iter().map(at).collect();
    Ok(inner(cell, order, &at, &values))
}

/// The values at a cell's inner nodes of the function that has given values at given points.
fn inner(cell: Cell, order: Order, at: &[[f64; 3]], values: &[DVec3]) -> Vec<DVec3> {
    let matrix = basis::from_points(cell, order, at);
    let rows = matrix.chunks_exact(values.len()).skip(interior_start(cell, order));
    rows.map(|row| row.iter().zip(values).map(|(&w, &x)| w * x).sum()).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn even(order: Order) -> Vec<f64> {
        (0..=order.get()).map(|i| i as f64 / order.get() as f64).collect()
    }

    /// Points of a known function, in the order and at the places that each kind has: what is made of them is the function's.
    #[test]
    fn points_are_brought_to_even_ones() {
        let order = Order::new(3).unwrap();
        let bump = |x: f64, y: f64| DVec3::new(x + 0.1 * y * y * y, y - 0.2 * x * x * y, x * y);
        let along = lobatto(order);
        let edge_curve = |kind: &str, at: &[f64]| Points {
            id: 0,
            kind: kind.into(),
            points: at.iter().map(|&x| bump(x, 0.5)).collect(),
        };
        for (kind, at) in [("GaussLobattoLegendre", along.clone()), ("PolyEvenlySpaced", even(order))] {
            let made = edge(order, &edge_curve(kind, &at)).unwrap();
            let wanted = [1.0, 2.0].map(|i| bump(i / 3.0, 0.5));
            assert!(made.iter().zip(wanted).all(|(a, b)| a.distance(b) < 1e-14), "{kind}");
        }
        for (kind, at) in [("GaussLobattoLegendre", along.clone()), ("PolyEvenlySpaced", even(order))] {
            let rows = at.iter().flat_map(|&y| at.iter().map(move |&x| (x, y)));
            let curve = Points { id: 0, kind: kind.into(), points: rows.map(|(x, y)| bump(x, y)).collect() };
            let made = face(Cell::Quad, order, &curve).unwrap();
            let nodes = &lattice(Cell::Quad, order)[interior_start(Cell::Quad, order)..];
            for (x, at) in made.iter().zip(nodes) {
                assert!(x.distance(bump(f64::from(at[0]) / 3.0, f64::from(at[1]) / 3.0)) < 1e-14, "{kind} {at:?}");
            }
        }
        let [a, b] = [along[1], along[2]];
        let third = 1.0 / 3.0;
        let electric = [
            (0.0, 0.0),
            (1.0, 0.0),
            (0.0, 1.0),
            (a, 0.0),
            (b, 0.0),
            (b, a),
            (a, b),
            (0.0, b),
            (0.0, a),
            (third, third),
        ];
        // The functions of a triangle of P3.
        let cubic = |x: f64, y: f64| DVec3::new(x * x * y, y * y * y - x, x + y * y);
        let curve =
            Points { id: 0, kind: "NodalTriElec".into(), points: electric.iter().map(|&(x, y)| cubic(x, y)).collect() };
        let made = face(Cell::Triangle, order, &curve).unwrap();
        assert!(made.len() == 1 && made[0].distance(cubic(third, third)) < 1e-14);
    }
}
