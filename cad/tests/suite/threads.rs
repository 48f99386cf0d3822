//! Races would show as feet that differ with the number of threads: not one bit may.
//!
//! By hand: `cargo test -p sagitta-cad --release --test threads -- --ignored --nocapture`

use crate::common::{Random, fixture, shape};
use cad::{End, Evaluation, Foot, Group, Hint, Model};
use glam::DVec3;

fn bytes_of(feet: &[Option<Foot>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for foot in feet.iter().flatten() {
        let residual = if let End::Stalled { residual } = foot.end { residual } else { 0.0 };
        let numbers = foot
            .point
            .to_array()
            .into_iter()
            .chain(foot.parameters.into_iter().flatten())
            .chain([foot.distance, residual]);
        numbers.for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend(format!("{} {:?} {:?}", foot.entity, foot.end, foot.doubt).bytes());
    }
    bytes
}

/// Closest points with and without hints, and evaluations, on 1, 2 and 4 threads.
fn race(model: &Model, count: usize) {
    let faces: Vec<_> = model.faces().iter().map(|face| face.id).collect();
    let group = Group::of_faces(model, &faces).unwrap();
    let mut random = Random(61);
    let bounds = model.bounds();
    let xs: Vec<DVec3> = (0..count).map(|_| random.in_box(bounds.min, bounds.max)).collect();
    let moved: Vec<DVec3> =
        xs.iter().map(|x| *x + 1e-3 * model.diagonal() * random.in_box(-DVec3::ONE, DVec3::ONE)).collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let feet = group.closest_batch(&xs, &mut []);
            let mut hints = vec![Hint::default(); xs.len()];
            group.closest_batch(&xs, &mut hints);
            let hinted = group.closest_batch(&moved, &mut hints);
            let at: Vec<_> = feet.iter().flatten().filter_map(|foot| Some((foot.entity, foot.parameters?))).collect();
            let points = group.evaluate_batch(&at);
            let mut bytes = [bytes_of(&feet), bytes_of(&hinted)].concat();
            let jets =
                points.iter().flatten().filter_map(|e| if let Evaluation::Surface(s) = e { Some(s) } else { None });
            jets.for_each(|s| {
                let vectors = [s.point].into_iter().chain(s.first).chain(s.second);
                vectors.flat_map(|v| v.to_array()).for_each(|number| bytes.extend(number.to_le_bytes()));
            });
            bytes
        })
    };
    let one = run(1);
    for threads in [2, 4] {
        assert!(run(threads) == one, "{:?}: {threads} threads", model.path());
    }
    println!(
        "{:?}: {count} queries, as many with hints, on 1, 2 and 4 threads: the same {} bytes",
        model.path(),
        one.len()
    );
}

/// A wing with edges and corners.
fn wing() -> Model {
    fixture("wing_sharp/wing_sharp.step")
}

/// Surfaces of all kinds; those that OCCT evaluates are slow.
fn kinds() -> Model {
    shape("kinds.brep")
}

#[test]
fn threads_change_no_bit() {
    race(&wing(), 100_000);
    race(&kinds(), 1000);
}

#[test]
#[ignore = "minutes; by hand"]
fn threads_change_no_bit_of_a_million() {
    race(&wing(), 1_000_000);
    race(&kinds(), 20_000);
}
