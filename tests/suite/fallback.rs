//! What is not valid at P3 goes back towards the curved mesh of P2, not to the straight one, and from there to the CAD again.

use crate::common::impatient::Impatient;
use crate::common::{json, number, root, sagitta};
use sagitta::certify::{self, Settings};
use sagitta::curve::Job;
use sagitta::element::Order;
use sagitta::formats;

/// On this torus the straight prisms lean by up to 88 degrees off their own faces, which turn by 50 degrees at P3.
fn torus(end: &str) -> std::path::PathBuf {
    root().join(format!("fixtures/torus_coarse/torus.{end}"))
}

/// With a tenth of the sweeps, P3 ends inverted; without the way forward again, 104 faces stayed off the CAD.
#[test]
fn faces_that_were_taken_back_come_to_the_cad_again() {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
    let [mesh, cad, linkage] = ["msh", "step", "meshlink.xml"].map(torus);
    let files = args!["curve", mesh, "--cad", cad, "--linkage", linkage, "-o", out, "--report", report];
    let told = sagitta(files.iter().chain(&args!["--order", "3", "--max-sweeps", "20", "--quiet"])).expect(0).stdout;
    let report = json(&report);
    let sweeps = number(&report, "/smoothing/sweeps");
    assert!(sweeps > 80.0, "it did not go through recovery, and shows nothing: {told}");
    assert!(report["off_cad"].as_array().unwrap().is_empty(), "{told}");
    let written = formats::read(&out).unwrap();
    assert!(certify::mesh(&written, written.points(), None, &Settings::default()).holds());
    let c_jac = number(&report, "/smoothing/end/c_jac");
    assert!(c_jac > 0.2, "C_JAC {c_jac}");
}

/// At once: nothing is tried; on the way forward: what was reached by then is what is kept.
#[test]
fn where_no_time_is_left_faces_keep_their_curve_of_p2() {
    let ended_after = |patience: usize| {
        let [mesh, cad, linkage] = ["msh", "step", "meshlink.xml"].map(torus);
        let mut job = Job::new(mesh, cad, Some(linkage), Order::new(3).unwrap());
        job.settings.smoothing.max_sweeps = 20;
        let curved = job.run(&mut Impatient::new(3, patience)).unwrap();
        assert!(curved.smoothed.stopped && curved.certificate.holds(), "{patience}");
        assert!(
            certify::mesh(&curved.mesh, curved.mesh.points(), None, &Settings::default()).holds(),
            "{patience}: not the mesh that was proven"
        );
        let off_cad = curved.off_cad;
        assert!(
            !off_cad.is_empty() && off_cad.iter().all(|face| face.order().unwrap().get() == 2),
            "{patience}: {off_cad:?}"
        );
        off_cad.iter().map(|face| face.fraction().unwrap()).fold(1.0, f64::min)
    };
    let (at_once, on_the_way) = (ended_after(1), ended_after(350));
    assert!(at_once < 0.5 && on_the_way > 0.5, "{at_once} {on_the_way}");
}
