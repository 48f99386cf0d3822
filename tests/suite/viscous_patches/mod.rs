//! Random viscous patches on curved walls: every one comes out valid and, but for 2 % at most, on its CAD.
//!
//! A patch is a B-spline wall over a square of 4x4 or 5x5 cells, written as IGES, and layers of cells over it. There is one
//! for every kind of cells, shape of wall, order and band of sagittas: 240. The aspect ratio is drawn between 10, or 10 times the
//! sagitta in wall spacings (no facet is bent by more than a tenth of its edges), and 1e4. All follows from one seed:
//! `SAGITTA_SEED=N cargo test --release --test viscous_patches -- --nocapture`. Files of patches that fail are kept in the
//! target folder.

mod case;
mod cells;
mod layers;
mod outcome;
mod patch;
mod sampling;
mod surface;
mod wall;

use std::path::Path;
use std::sync::Mutex;

use case::{ASPECT_RATIOS, BANDS, Case, Kind, ORDERS, Shape};
use outcome::Outcome;

/// Least number of patches.
const PATCHES: usize = 200;
/// Largest share of patches that may be off their CAD.
const OFF_CAD: f64 = 0.02;
/// Largest share of drawings that may be thrown away because their linear mesh is inverted.
const REJECTED: f64 = 0.05;
/// Least share of patches in each decade of aspect ratios.
const DECADE: f64 = 0.1;

/// Curves all patches, as many at a time as there are cores.
fn outcomes(cases: &[Case]) -> Vec<Outcome> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("viscous_patches");
    std::fs::create_dir_all(&folder).unwrap();
    let (next, done) = (Mutex::new(cases.iter()), Mutex::new(Vec::new()));
    let work = || {
        while let Some(&case) = { next.lock().unwrap().next() } {
            let outcome = Outcome::of(case, &folder);
            if outcome.is_good() {
                outcome::files(&case, &folder).iter().for_each(|file| std::fs::remove_file(file).unwrap());
            }
            println!("{outcome}");
            done.lock().unwrap().push(outcome);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().unwrap().get() {
            scope.spawn(work);
        }
    });
    done.into_inner().unwrap()
}

/// Each value must occur in an equal part of all.
#[track_caller]
fn shared_equally(outcomes: &[Outcome], parts: usize, what: &str, part: impl Fn(&Outcome) -> usize) {
    let mut counts = vec![0; parts];
    outcomes.iter().for_each(|outcome| counts[part(outcome)] += 1);
    let (fewest, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
    println!("patches by {what}: {fewest} to {most} in each of {parts} parts");
    assert_eq!((fewest * parts, most * parts), (outcomes.len(), outcomes.len()), "{what}: {counts:?}");
}

/// The shares that the candidate is made for.
fn shares(outcomes: &[Outcome]) {
    assert!(outcomes.len() >= PATCHES);
    let kind = |o: &Outcome| Kind::ALL.iter().position(|&k| k == o.case.kind).unwrap();
    let shape = |o: &Outcome| Shape::ALL.iter().position(|&s| s == o.case.shape).unwrap();
    let order = |o: &Outcome| ORDERS.iter().position(|&p| p == o.case.order).unwrap();
    let within = |o: &Outcome, [from, to]: [f64; 2]| from <= o.patch.sagitta && o.patch.sagitta < to;
    let band = |o: &Outcome| (0..BANDS).find(|&band| within(o, Case { band, ..o.case }.sagittas())).unwrap();
    let [kinds, shapes, orders] = [Kind::ALL.len(), Shape::ALL.len(), ORDERS.len()];
    shared_equally(outcomes, kinds, "kind", kind);
    shared_equally(outcomes, shapes, "shape", shape);
    shared_equally(outcomes, orders, "order", order);
    shared_equally(outcomes, BANDS, "measured sagitta", band);
    let together = |o: &Outcome| ((kind(o) * shapes + shape(o)) * orders + order(o)) * BANDS + band(o);
    shared_equally(outcomes, kinds * shapes * orders * BANDS, "all of them", together);

    let [least, most] = ASPECT_RATIOS;
    assert!(outcomes.iter().all(|o| (least..=most).contains(&o.patch.aspect_ratio)));
    let mut decades = [0; 3];
    outcomes.iter().for_each(|o| decades[((o.patch.aspect_ratio / least).log10() as usize).min(2)] += 1);
    println!("patches by decade of the aspect ratio: {decades:?}");
    assert!(decades.iter().all(|&count| count as f64 >= DECADE * outcomes.len() as f64), "{decades:?}");
}

#[test]
fn every_patch_is_valid_and_nearly_all_are_on_their_cad() {
    let outcomes = outcomes(&Case::all(crate::common::random::seed(20_260_705)));
    shares(&outcomes);
    let listed = |title: &str, chosen: &dyn Fn(&Outcome) -> bool| {
        let found: Vec<String> = outcomes.iter().filter(|o| chosen(o)).map(ToString::to_string).collect();
        println!("{title}: {} of {}\n{}", found.len(), outcomes.len(), found.join("\n"));
        found.len()
    };
    let invalid = listed("not valid", &|o| o.unproven + o.inverted > 0);
    let off_cad = listed("off the CAD", &|o| !o.off_cad.is_empty());
    let rejected: usize = outcomes.iter().map(|o| o.patch.rejected).sum();
    println!("drawings thrown away because their linear mesh is inverted: {rejected}");
    assert!(rejected as f64 <= REJECTED * (outcomes.len() + rejected) as f64, "{rejected} drawings thrown away");
    assert_eq!(invalid, 0);
    assert!(off_cad as f64 <= OFF_CAD * outcomes.len() as f64, "{off_cad} of {} off the CAD", outcomes.len());
}
