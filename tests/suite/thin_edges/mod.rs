//! Thin trailing edges: chord points of coarse triangles land on their own side with groups, on the wrong one without.
//!
//! The middle of a straight mesh edge on the convex side of a thin curved section lies inside the section by its sagitta,
//! often nearer to the other side. `cargo test --release --test thin_edges -- --nocapture` prints the figures;
//! `SAGITTA_CAD=FOLDER[:FOLDER]` adds a wind turbine's blade and the ONERA M6.

mod linkage;
mod section;
mod side;

use std::path::Path;

use cad::{FaceId, Model, ReadOptions};
use section::{Section, sections};
use side::{Side, Tally};

/// Triangles of a side: pairs along chord and span.
const CELLS: [usize; 2] = [8, 3];

/// Polynomial orders.
const ORDERS: [usize; 3] = [2, 3, 4];

/// Share astray from which on a case counts, and the share of cases that must.
const ASTRAY: f64 = 0.05;
const CASES: f64 = 0.5;

fn read(path: &Path) -> Model {
    Model::read(path, &ReadOptions::default()).unwrap()
}

/// Both sides of a section, by order.
fn tally(section: &Section, folder: &Path) -> [Tally; 3] {
    let path = folder.join("section.igs");
    std::fs::write(&path, crate::common::iges::file(&section.patches())).unwrap();
    let model = read(&path);
    assert_eq!(model.faces().len(), section.patches().len());
    let sides = [0, 1].map(FaceId::new);
    ORDERS.map(|p| {
        let mut sum = Tally::default();
        sides.iter().for_each(|&face| sum += Side::whole(&model, face, CELLS).tally(p, &sides));
        sum
    })
}

fn told(tallies: &[Tally; 3]) -> String {
    let one = |(p, t): (&usize, &Tally)| format!("P{p} {:4.1} % of {}", 100.0 * t.share(), t.points);
    ORDERS.iter().zip(tallies).map(one).collect::<Vec<_>>().join(", ")
}

#[test]
fn groups_keep_chord_points_on_their_side() {
    let folder = tempfile::tempdir().unwrap();
    let (mut total, mut counting) = (Tally::default(), [0; 3]);
    for section in sections() {
        let tallies = tally(&section, folder.path());
        println!("{section}: on the wrong side without groups: {}", told(&tallies));
        for (k, tally) in tallies.into_iter().enumerate() {
            assert_eq!(tally.astray_in_groups, 0, "{section}, P{}: {tally:?}", ORDERS[k]);
            counting[k] += usize::from(tally.share() >= ASTRAY);
            total += tally;
        }
    }
    let count = sections().len();
    println!(
        "{count} sections, {} chord points: with groups {} astray; with one group of both sides {} ({:.1} %); \
         sections with at least {:.0} % astray: P2 {}, P3 {}, P4 {}",
        total.points,
        total.astray_in_groups,
        total.astray_in_one,
        100.0 * total.share(),
        100.0 * ASTRAY,
        counting[0],
        counting[1],
        counting[2]
    );
    assert!(counting.iter().all(|&n| n as f64 >= CASES * count as f64), "{counting:?} of {count}");
}

/// Faces of foreign CAD that are sides of one thin body.
struct Foreign {
    file: &'static str,
    sides: &'static [usize],
    /// Cells in u and v.
    cells: [usize; 2],
}

#[test]
fn groups_keep_chord_points_of_foreign_cad_on_their_side() {
    let folders = crate::common::foreign::foreign_folders();
    for foreign in [
        // u along the span
        Foreign { file: "iea15/IEA_15MW_CFD.stp", sides: &[2, 3], cells: [20, 4] },
        Foreign { file: "iea15/IEA_15MW_CFD.igs", sides: &[1, 2], cells: [20, 4] },
        Foreign { file: "refine/onera-m6-sharp-te.egads", sides: &[3, 4], cells: [6, 4] },
    ] {
        let Some(path) = folders.iter().map(|folder| folder.join(foreign.file)).find(|path| path.exists()) else {
            crate::common::warn(&format!("SAGITTA_CAD names no folder with {}: it is NOT tried", foreign.file));
            continue;
        };
        let model = read(&path);
        let sides: Vec<FaceId> = foreign.sides.iter().map(|&tag| FaceId::new(tag - 1)).collect();
        let tallies = ORDERS.map(|p| {
            let mut sum = Tally::default();
            sides.iter().for_each(|&face| sum += Side::whole(&model, face, foreign.cells).tally(p, &sides));
            sum
        });
        println!("{}: on the wrong side without groups: {}", foreign.file, told(&tallies));
        for tally in tallies {
            assert_eq!(tally.astray_in_groups, 0, "{}: {tally:?}", foreign.file);
        }
    }
}
