//! Sliding nodes on walls: where a curved rim bends into the wall's own triangles, layers must give way as whole columns.

use crate::common::{fixture, json, number, sagitta};
use glam::DVec3;
use sagitta::formats;

/// The dish with a hole of six edges (`fixtures/make_dish.py`): least `C_JAC`, and the farthest point of its wall from the CAD.
fn curve(order: &str, more: &[&str]) -> (f64, f64) {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["dish.msh", "dish.json"].map(|name| folder.path().join(name));
    let [mesh, cad] = ["msh", "step"].map(|extension| fixture("dish", extension));
    let options = args!["curve", mesh, "--cad", cad, "--quiet", "--order", order, "-o", out, "--report", report];
    sagitta(options.into_iter().chain(more.iter().map(Into::into))).expect(0);
    let report = json(&report);
    let patches = report["patches"].as_array().unwrap();
    let dish = patches.iter().find(|patch| patch["names"][0] == "dish").unwrap();
    (number(&report, "/smoothing/end/c_jac"), number(dish, "/cad_distance_max"))
}

/// What the fit of the wall gained at P3 (a tenth of the distance, if the wall is frozen) a slide may cost, but not what P3 gains on P2.
#[test]
fn sliding_columns_gain_what_frozen_walls_cannot() {
    let mut before = None;
    for order in ["2", "3"] {
        let (slid, slid_away) = curve(order, &[]);
        let (frozen, frozen_away) = curve(order, &["--freeze-walls"]);
        println!(
            "P{order}: C_JAC {frozen:.3} frozen, {slid:.3} slid; wall off the CAD {frozen_away:.2e}, {slid_away:.2e}"
        );
        assert!(slid >= frozen + 0.1, "P{order}: {frozen} frozen, {slid} slid");
        let most = before.map_or(1.2 * frozen_away, |below| 0.1 * below);
        assert!(slid_away <= most, "P{order}: the wall is {slid_away} off the CAD, {frozen_away} frozen");
        before = Some(slid_away);
    }
}

/// Linear nodes of the dish's wall before and after; they come first in the file, layer by layer (`fixtures/make_dish.py`).
fn wall_nodes(more: &[&str]) -> Vec<[DVec3; 2]> {
    const LAYERS: usize = 12;
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("dish.msh");
    let [mesh, cad] = ["msh", "step"].map(|extension| fixture("dish", extension));
    let options = args!["curve", mesh, "--cad", cad, "--quiet", "--order", "2", "-o", out];
    sagitta(options.into_iter().chain(more.iter().map(Into::into))).expect(0);
    let [before, after] = [mesh, out].map(|path| formats::read(&path).unwrap().into_parts().points);
    let wall = before.len() / (LAYERS + 1);
    before.into_iter().zip(after).take(wall).map(|(before, after)| [before, after]).collect()
}

#[test]
fn linear_nodes_slide_on_the_wall_unless_they_are_held() {
    const RADIUS: f64 = 4.0;
    let moved = |nodes: &[[DVec3; 2]]| nodes.iter().map(|[a, b]| a.distance(*b)).fold(0.0, f64::max);
    let slid = wall_nodes(&[]);
    assert!(moved(&slid) > 1e-6 * RADIUS, "the wall's linear nodes moved by {:e}", moved(&slid));
    for [_, place] in &slid {
        let off = (place.distance(DVec3::Z * RADIUS) - RADIUS).abs();
        assert!(off < 1e-12 * RADIUS, "a linear node is {off:e} off the sphere, at {place}");
    }
    for held in ["--freeze-linear", "--freeze-walls"] {
        let most = moved(&wall_nodes(&[held]));
        assert!(most < 1e-11 * RADIUS, "{held}: a linear node moved by {most:e}");
    }
}
