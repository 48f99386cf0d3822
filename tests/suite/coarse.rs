//! A mesh so coarse that it begins with elements turned inside out by more than their size: it must come out whole.

use crate::common::{json, number, root, sagitta};

/// Capping the regularisation of determinants once cost this case its walls (exit code 3); nothing else showed it.
#[test]
fn a_coarse_cylinder_comes_out_of_inversion_at_every_order() {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
    let case = |end: &str| root().join(format!("fixtures/cylinder_bl_coarse/cylinder_bl.{end}"));
    let [mesh, cad, linkage] = ["msh", "step", "meshlink.xml"].map(case);
    for order in ["2", "3", "4"] {
        let options = args!["curve", mesh, "--cad", cad, "--linkage", linkage, "--quiet", "--order", order];
        let files = args!["-o", out, "--report", report];
        // Order by order it begins valid at P3 and P4; directly it has to come out of inversion.
        for way in [None, Some("--direct")] {
            let all = options.iter().chain(&files).cloned().chain(way.map(Into::into));
            sagitta(all).expect(0);
            let report = json(&report);
            let [wcn, jac] = ["c_wcn", "c_jac"].map(|cost| number(&report, &format!("/smoothing/end/{cost}")));
            assert!(wcn >= 0.8 && jac >= 0.5, "P{order} {way:?}: C_WCN {wcn}, C_JAC {jac}");
        }
    }
}
