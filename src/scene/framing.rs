//! Which patches stand far round the others, as a far field does, so that a view of all would show nothing of the walls.

use cad::Aabb;

use super::Patch;

/// How much larger the smallest outer patch is than the largest inner one, at least.
const STEP: f64 = 2.0;

/// Largest box of the inner patches together, as a fraction of the whole mesh's.
const INNER: f64 = 0.5;

/// The part of all sides that lie on the inner patches, at least: they are no detail, as the tip of a wing alone would be.
const SHARE: f64 = 0.1;

/// For each patch, whether it stands far round the others: the diagonals of the patches' boxes fall by a factor of 2 between outer and inner
/// ones, and the inner ones together are at most half of the mesh across and have a tenth of its sides or more. Where nothing is so small, as
/// in a duct, none does.
#[must_use]
pub fn outer(patches: &[Patch]) -> Vec<bool> {
    let all = |some: &[&Patch]| some.iter().fold(Aabb::EMPTY, |all, own| all.union(own.bounds)).diagonal();
    let mut falling: Vec<&Patch> = patches.iter().collect();
    falling.sort_by(|a, b| b.bounds.diagonal().total_cmp(&a.bounds.diagonal()));
    let whole = all(&falling);
    let step = |k: usize| falling[k - 1].bounds.diagonal() / falling[k].bounds.diagonal().max(f64::MIN_POSITIVE);
    let sides = |some: &[&Patch]| some.iter().map(|own| own.count).sum::<usize>() as f64;
    let many = SHARE * sides(&falling);
    let is_fall = |&k: &usize| step(k) >= STEP && all(&falling[k..]) <= INNER * whole && sides(&falling[k..]) >= many;
    let Some(fall) = (1..falling.len()).find(is_fall) else { return vec![false; patches.len()] };
    let least = falling[fall].bounds.diagonal();
    patches.iter().map(|own| own.bounds.diagonal() > least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::EntityKey;
    use glam::DVec3;

    fn patch(from: [f64; 3], to: [f64; 3]) -> Patch {
        let bounds = Aabb::of_points([DVec3::from(from), DVec3::from(to)]);
        Patch { entity: EntityKey::new(2, 1), name: String::new(), count: 1, bounds }
    }

    #[test]
    fn a_far_field_and_a_symmetry_plane_are_outer() {
        let wing = [patch([0.0; 3], [1.0, 2.0, 0.1]), patch([0.9, 0.0, 0.0], [1.0, 2.0, 0.0])];
        let far = [patch([-50.0, 0.0, -50.0], [50.0, 80.0, 50.0]), patch([-50.0, 0.0, -50.0], [50.0, 0.0, 50.0])];
        assert_eq!(outer(&[wing.as_slice(), &far].concat()), [false, false, true, true]);
    }

    #[test]
    fn a_detail_is_not_all_that_is_seen() {
        let tip = patch([0.0, 2.0, 0.0], [0.1, 2.0, 0.1]);
        let walls = [patch([0.0; 3], [1.0, 2.0, 0.1]), patch([-0.1; 3], [1.1, 2.1, 0.2])];
        let walls = walls.map(|own| Patch { count: 100, ..own });
        assert_eq!(outer(&[walls.as_slice(), &[tip]].concat()), [false; 3]);
    }

    #[test]
    fn a_duct_has_no_outer_patch() {
        let ends = [patch([0.0; 3], [0.0, 1.0, 1.0]), patch([9.0, 0.0, 0.0], [9.0, 1.0, 1.0])];
        let wall = [patch([0.0; 3], [9.0, 1.0, 1.0])];
        assert_eq!(outer(&[ends.as_slice(), &wall].concat()), [false; 3]);
        assert_eq!(outer(&wall), [false]);
        assert!(outer(&[]).is_empty());
    }
}
