//! CAD whose faces end apart from one another by more than the first cells are thick (`fixtures/make_gap.py`).

use crate::common::{fixture, json, number, sagitta};

/// Taken to the edge of the flat ends, the four first layers were crushed: 336 of 832 elements inverted at P2, and C_JAC was 0.07 in the end.
#[test]
fn layers_that_reach_over_the_edge_of_a_flat_face_stay_in_its_plane() {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
    let [mesh, cad] = ["msh", "step"].map(|extension| fixture("gap", extension));
    for order in ["2", "3", "4"] {
        let options = args!["curve", mesh, "--cad", cad, "-q", "--order", order, "-o", out, "--report", report];
        let told = sagitta(options).expect(0).stdout;
        let report = json(&report);
        assert!(report["off_cad"].as_array().unwrap().is_empty(), "{told}");
        assert_eq!(number(&report, "/smoothing/start/inverted"), 0.0, "{told}");
        let [wcn, jac] = ["c_wcn", "c_jac"].map(|cost| number(&report, &format!("/smoothing/end/{cost}")));
        println!("gap P{order}: C_WCN {wcn:.3}, C_JAC {jac:.3}");
        assert!(wcn >= 0.95 && jac >= 0.95, "P{order}: {told}");
        // No node moves by a hundredth of the first cells.
        for patch in report["patches"].as_array().unwrap() {
            assert!(number(patch, "/node_move_max") < 1e-5, "P{order}: {told}");
        }
    }
}
