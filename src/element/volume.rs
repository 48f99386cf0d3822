//! The volume of a linear cell.

use glam::DVec3;

use super::{Cell, Face};

/// Volume of a linear volume cell with these corners, negative where they turn the other way round.
///
/// By the divergence theorem over the faces; a quadrilateral is the mean of its two triangulations, which is exact for
/// the bilinear face.
#[must_use]
pub fn signed_volume(cell: Cell, corners: &[DVec3]) -> f64 {
    let Some(&origin) = corners.first() else { return 0.0 };
    let at = |corner: u8| corners[usize::from(corner)] - origin;
    let side = |face: &Face| {
        let sum = match *face.corners {
            [a, b, c] => triple(at(a), at(b), at(c)),
            [a, b, c, d] => {
                let [a, b, c, d] = [at(a), at(b), at(c), at(d)];
                0.5 * (triple(a, b, c) + triple(a, c, d) + triple(a, b, d) + triple(b, c, d))
            }
            _ => 0.0,
        };
        if face.outward { sum } else { -sum }
    };
    cell.faces().iter().map(side).sum::<f64>() / 6.0
}

fn triple(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    a.dot(b.cross(c))
}

#[cfg(test)]
mod tests {
    use super::super::{Order, mirrored};
    use super::*;

    #[test]
    fn unit_cells_have_their_volumes_and_mirrored_ones_the_negative() {
        let volumes = [(Cell::Tet, 1.0 / 6.0), (Cell::Pyramid, 1.0 / 3.0), (Cell::Prism, 0.5), (Cell::Hex, 1.0)];
        for (cell, volume) in volumes {
            let corner = |c: &[u8; 3]| DVec3::new(7.0, -3.0, 2.0) + DVec3::from(c.map(f64::from));
            let corners: Vec<DVec3> = cell.corners().iter().map(corner).collect();
            assert!((signed_volume(cell, &corners) - volume).abs() < 1e-14, "{cell}");
            let other: Vec<DVec3> = mirrored(cell, Order::LINEAR).iter().map(|&n| corners[usize::from(n)]).collect();
            assert!((signed_volume(cell, &other) + volume).abs() < 1e-14, "{cell}");
        }
    }

    /// A hex whose one face is a saddle: the volume under the bilinear patch `z = 1 + x y` is 1 + 1/4.
    #[test]
    fn bilinear_faces_count_exactly() {
        let mut corners: Vec<DVec3> = Cell::Hex.corners().iter().map(|c| DVec3::from(c.map(f64::from))).collect();
        corners[6].z = 2.0;
        assert!((signed_volume(Cell::Hex, &corners) - 1.25).abs() < 1e-14);
    }
}
