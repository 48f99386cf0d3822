//! Meshes of faces on CAD surfaces, without a volume: put on the CAD, fitted to it, and proven free of folds.

use std::path::{Path, PathBuf};

use crate::common::{fixture, json, number, sagitta};
use glam::DVec3;
use sagitta::element::{Cell, Order, Samples, basis};
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{EntityKey, Mesh, NodeId, Parts};
use serde_json::Value;

/// Radii of the torus of `fixtures/torus`.
const TORUS: [f64; 2] = [1.0, 0.35];

/// The faces of a volume mesh alone, on the nodes that they have; those of `turned` entities and places with their corners the other way round.
fn skin(volume: &Path, turned: impl Fn(EntityKey, usize) -> bool) -> Mesh {
    let mesh = formats::read(volume).unwrap();
    let (mut parts, mut known) = (Parts::default(), vec![None; mesh.points().len()]);
    for block in mesh.side_blocks() {
        for (place, nodes) in block.elements(Order::LINEAR).enumerate() {
            let mut nodes: Vec<NodeId> = nodes
                .iter()
                .map(|node| {
                    *known[node.index()].get_or_insert_with(|| {
                        parts.points.push(mesh.points()[node.index()]);
                        NodeId::new(parts.points.len() - 1).unwrap()
                    })
                })
                .collect();
            if turned(block.entity, place) {
                nodes.reverse();
            }
            parts.push(block.cell, block.entity, &nodes);
        }
    }
    Mesh::new(parts).unwrap()
}

struct Place {
    dir: tempfile::TempDir,
    mesh: PathBuf,
}

impl Place {
    fn new(mesh: &Mesh) -> Place {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("skin.msh");
        formats::write(&path, mesh, &WriteOptions::default()).unwrap();
        Place { dir, mesh: path }
    }

    /// Curves it; what is told, the report and the mesh.
    fn curved(&self, cad: &Path, order: Order) -> (String, Value, Mesh) {
        let [output, report] = ["out.msh", "report.json"].map(|name| self.dir.path().join(name));
        let p = order.get().to_string();
        let options =
            args!["curve", self.mesh, "--surface", "--cad", cad, "--order", p, "-o", output, "--report", report, "-q"];
        let told = sagitta(options).expect(0).stdout;
        (told, json(&report), formats::read(&output).unwrap())
    }

    fn refused(&self, cad: &Path, more: &[&str]) -> String {
        let output = self.dir.path().join("none.msh");
        let options = args!["curve", self.mesh, "--cad", cad, "--order", "2", "-o", output];
        let refused = sagitta(options.iter().cloned().chain(more.iter().map(Into::into))).expect(2).stderr;
        assert!(!output.exists());
        refused
    }
}

/// Farthest point of the torus's faces from it, and the least cosine between their normals and its own.
fn off_the_torus(mesh: &Mesh) -> (f64, f64) {
    let (mut far, mut cosine) = (0.0_f64, 1.0_f64);
    for block in mesh.cell_blocks() {
        let samples = Samples::survey(block.cell, Order::LINEAR, 12);
        for nodes in block.elements(mesh.order()) {
            let corners: Vec<DVec3> = mesh.points_of(&nodes[..block.cell.corner_count()]).collect();
            if corners.iter().any(|x| x.length() > 2.0) {
                continue; // the outer sphere
            }
            let (mut facing, mut own) = (0.0, Vec::new());
            for &at in &samples.points()[..samples.count()] {
                let of = |weights: Vec<f64>| mesh.points_of(nodes).zip(weights).map(|(x, w)| x * w).sum::<DVec3>();
                let x = of(basis::values(block.cell, mesh.order(), at));
                let slopes = basis::gradients(block.cell, mesh.order(), at);
                let [u, v] = [0, 1].map(|axis| of(slopes.iter().map(|slope| slope[axis]).collect()));
                let ring = x.with_z(0.0).normalize() * TORUS[0];
                far = far.max((x.distance(ring) - TORUS[1]).abs());
                let product = u.cross(v).normalize().dot((x - ring).normalize());
                facing += product;
                own.push(product);
            }
            cosine = own.into_iter().map(|product| product * facing.signum()).fold(cosine, f64::min);
        }
    }
    (far, cosine)
}

#[test]
fn a_torus_without_a_volume_is_curved() {
    let cad = fixture("torus", "step");
    let linear = skin(&fixture("torus", "msh"), |_, _| false);
    let place = Place::new(&linear);
    let mut last = off_the_torus(&linear).0;
    for order in Order::all().skip(1) {
        let (told, report, mesh) = place.curved(&cad, order);
        let faces = linear.cells().len();
        assert!(told.contains(&format!("walls: none of {faces} faces folds (proven)")), "{told}");
        assert_eq!((&report["certified"], &report["off_cad"]), (&true.into(), &serde_json::json!([])));
        assert_eq!((mesh.order(), mesh.cells().len()), (order, faces));
        let (far, cosine) = off_the_torus(&mesh);
        assert!(far < 0.3 * last && cosine > 0.5, "{order}: {far:.2e} after {last:.2e}, cosine {cosine:.2}");
        last = far;
        for cell in report["cells"].as_array().unwrap() {
            assert!(number(cell, "/c_jac_min") > 0.3, "{cell}");
        }
    }
}

/// Its planar parts follow the curved rims, its quadrilaterals the spheres.
#[test]
fn quadrilaterals_and_planes_are_curved() {
    for case in ["weeble_hybrid", "sphere_shell"] {
        let linear = skin(&fixture(case, "msh"), |_, _| false);
        let (told, report, mesh) = Place::new(&linear).curved(&fixture(case, "step"), Order::new(3).unwrap());
        assert!(report["certified"] == true && told.contains("(proven)"), "{told}");
        assert_eq!(mesh.counts()[&Cell::Triangle], linear.counts()[&Cell::Triangle]);
        assert_eq!(report["faces_without_cad"], 0, "{told}");
    }
}

#[test]
fn faces_upside_down_and_meshes_of_another_kind_are_refused() {
    let cad = fixture("torus", "step");
    let first = formats::read(&fixture("torus", "msh")).unwrap().side_blocks().next().unwrap().entity;
    let turned = Place::new(&skin(&fixture("torus", "msh"), |entity, place| entity == first && place == 7));
    let told = turned.refused(&cad, &["--surface"]);
    assert!(told.contains("1 faces lie upside down on their CAD face") && told.contains("triangle"), "{told}");
    let whole = Place::new(&skin(&fixture("torus", "msh"), |_, _| false));
    assert!(whole.refused(&cad, &[]).contains("--surface curves it"));
    for (case, why) in [("torus", "has volume elements"), ("naca0012_sharp", "lies in one plane")] {
        let [mesh, cad] = ["msh", "step"].map(|extension| fixture(case, extension));
        let other = Place { mesh, dir: tempfile::tempdir().unwrap() };
        let told = other.refused(&cad, &["--surface"]);
        assert!(told.contains(&format!("{why}: leave --surface away")), "{told}");
    }
}
