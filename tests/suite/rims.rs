//! Walls that end at a patch which is neither on the CAD nor planar: it follows their edges.

use sagitta::element::{Order, basis};
use sagitta::formats;
use sagitta::mesh::Mesh;

use crate::common::{fixture, json, number, sagitta};

/// The sides of the layers on the sheet, and what lies on top of them (`fixtures/make_sheet.py`).
const SIDE: u64 = 9002;
const TOP: u64 = 9001;

/// How far nodes of the curved mesh's boundary elements with this entity number are from their straight places.
fn farthest_from_straight(mesh: &Mesh, tag: u64) -> f64 {
    let mut farthest = 0.0_f64;
    for block in mesh.blocks().iter().filter(|block| u64::try_from(block.entity.tag) == Ok(tag)) {
        let lattice = basis::at_lattice(block.cell, Order::LINEAR, mesh.order());
        for nodes in block.nodes.chunks(lattice.len()) {
            for (node, weights) in nodes.iter().zip(&lattice) {
                let straight = nodes.iter().zip(weights).map(|(n, w)| mesh.points()[n.index()] * *w);
                farthest = farthest.max(mesh.points()[node.index()].distance(straight.sum()));
            }
        }
    }
    farthest
}

/// With its sides straight the sheet leaves the CAD with all of its 92 faces: its edges are off their chords along the sides by up to 28 first
/// spacings.
#[test]
fn the_sides_of_layers_on_an_open_face_follow_its_edges() {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
    let [mesh, cad] = ["msh", "step"].map(|extension| fixture("sheet", extension));
    for order in ["2", "3", "4"] {
        let options = args!["curve", mesh, "--cad", cad, "-q", "--order", order, "-o", out, "--report", report];
        let told = sagitta(options).expect(0).stdout;
        assert!(told.contains("side: 192 faces do not stay straight but follow"), "{told}");
        let report = json(&report);
        assert!(report["off_cad"].as_array().unwrap().is_empty());
        let [wcn, jac] = ["c_wcn", "c_jac"].map(|cost| number(&report, &format!("/smoothing/end/{cost}")));
        println!("sheet P{order}: C_WCN {wcn:.3}, C_JAC {jac:.3}");
        assert!(wcn >= 0.9 && jac >= 0.75, "P{order}: {wcn} {jac}");
        let curved = formats::read(&out).unwrap();
        assert!(
            farthest_from_straight(&curved, SIDE) > 5.0,
            "the edges are off their chords by 8 first spacings of 0.3"
        );
        assert!(farthest_from_straight(&curved, TOP) < 1e-9, "what has no edge in common with the wall stays straight");
    }
}
