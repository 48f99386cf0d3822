//! Plane meshes of triangles and quadrilaterals from end to end: on CAD edges, by the same pipeline as volumes.
//!
//! *Good* means, by `tests/judge/judge_2d.py`: same cells on the same corners, conforming, in the plane, no inverted element, certified, nodes
//! on the CAD, no line that runs back, no wall farther from the CAD than Gmsh's own elevation at P2 and than 0.7 times it above; and from
//! the program: exit code 0, nothing given up, `C_WCN >= 0.85` and `C_JAC >= 0.8`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::common::{fixture, json, number, python, root, sagitta, script, warn};
use glam::DVec3;
use sagitta::element::{Cell, Order, basis};
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{EntityKey, Mesh, NodeId, Parts};
use serde_json::Value;

/// Lines that the judge compares with Gmsh's; on circles the two are the same at P2, to rounding.
const SAME: f64 = 1.001;

struct Curved {
    dir: tempfile::TempDir,
    told: String,
    report: Value,
}

impl Curved {
    fn output(&self) -> std::path::PathBuf {
        self.dir.path().join("out.msh")
    }

    fn mesh(&self) -> Mesh {
        formats::read(&self.output()).unwrap()
    }
}

/// Curves a mesh; all must be on the CAD, certified, and good.
#[track_caller]
fn curved(linear: &Path, cad: &Path, order: usize, more: &[OsString]) -> Curved {
    let dir = tempfile::tempdir().unwrap();
    let [output, report] = ["out.msh", "report.json"].map(|name| dir.path().join(name));
    let p = order.to_string();
    let mut arguments =
        args!["curve", linear, "--cad", cad, "--order", p, "-o", output, "--report", report, "-q"].to_vec();
    arguments.extend_from_slice(more);
    let told = sagitta(&arguments).expect(0).stdout;
    let report = json(&report);
    for key in ["off_cad", "open_faces"] {
        assert_eq!(report[key], serde_json::json!([]), "{key}: {told}");
    }
    assert_eq!((&report["certified"], &report["faces_without_cad"]), (&true.into(), &0.into()), "{told}");
    for cell in report["cells"].as_array().unwrap() {
        let [c_wcn, c_jac] = [number(cell, "/c_wcn_min"), number(cell, "/c_jac_min")];
        assert!(c_wcn >= 0.85 && c_jac >= 0.8, "{cell}: {told}");
    }
    Curved { dir, told, report }
}

#[track_caller]
fn judged(linear: &Path, cad: &Path, order: usize, own: &Curved) {
    let Some(python) = python("plane meshes are judged by our own report only, NOT by tests/judge/judge_2d.py") else {
        sagitta(args!["check", own.output(), "--linear", linear]).expect(0);
        return;
    };
    let judge = script(&python, "judge_2d.py", &args![linear, own.output(), "--cad", cad]);
    for key in ["topology_kept", "conforming", "finite", "boundary_kept"] {
        assert_eq!(judge[key], true, "{key} of {judge:#}");
    }
    for key in ["invalid_elements", "boundary_folded", "nonconforming_faces", "bare_outer_faces"] {
        assert_eq!(judge[key], 0, "{key} of {judge:#}");
    }
    assert_eq!(judge["certified"], "yes", "{}", judge["certified_counts"]);
    let figure = |key: &str| number(&judge, &format!("/{key}"));
    assert!(figure("out_of_plane") == 0.0 && figure("wall_node_dist_max_abs") < 1e-9, "{judge:#}");
    let (far, gmsh) = (figure("boundary_dist_max"), figure("boundary_dist_baseline"));
    let times = far / gmsh;
    warn(&format!("{} P{order}: {far:.2e} off the CAD = {times:.2} x Gmsh's", linear.display()));
    assert!(times <= if order == 2 { SAME } else { 0.7 }, "{times} x Gmsh's distance: {judge:#}");
}

#[test]
fn the_dry_run_speaks_of_edges() {
    let [linear, cad] = ["msh", "step"].map(|extension| fixture("naca0012_sharp", extension));
    let told = sagitta(args!["curve", linear, "--cad", cad, "--order", "2", "--dry-run"]).expect(0).stdout;
    let heads: Vec<&str> = told.lines().find(|line| line.starts_with("patch")).unwrap().split_whitespace().collect();
    assert_eq!(heads, ["patch", "edges", "undecided", "off", "CAD", "distance", "CAD", "edges"]);
}

#[test]
fn an_airfoil_with_layers_is_curved_and_judged() {
    let [linear, cad] = ["msh", "step"].map(|extension| fixture("naca0012_sharp", extension));
    for order in [2, 3, 4] {
        let own = curved(&linear, &cad, order, &[]);
        for line in ["plane mesh at z = 0, 3 walls on 3 curves", "walls: none of 80 edges folds (proven)"] {
            assert!(own.told.contains(line), "{line:?} in {}", own.told);
        }
        assert_eq!(own.report["plane"]["normal"], serde_json::json!([0.0, 0.0, 1.0]));
        judged(&linear, &cad, order, &own);
    }
}

/// The IGES file has the curves alone, in another order, and the SU2 file markers that are no numbers of CAD edges.
#[test]
fn curves_without_faces_and_meshes_without_tags_are_associated_by_geometry() {
    let [msh, su2, step, iges] = ["msh", "su2", "step", "igs"].map(|extension| fixture("naca0012_sharp", extension));
    let by_tags = curved(&msh, &step, 3, &[]).mesh();
    for (linear, cad) in [(&su2, &step), (&msh, &iges), (&su2, &iges)] {
        let own = curved(linear, cad, 3, &[]);
        let by_geometry = own.told.contains("associated by geometry, with 0 faces and 0 edges undecided");
        assert!(by_geometry || linear == &msh, "{}", own.told);
        let mesh = own.mesh();
        let apart = mesh.points().iter().zip(by_tags.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(apart < 1e-4, "{} and {}: {apart:e}", linear.display(), cad.display());
    }
}

#[test]
fn a_linkage_file_that_was_written_for_a_plane_mesh_curves_it() {
    let [linear, cad] = ["msh", "step"].map(|extension| fixture("naca0012_sharp", extension));
    let dir = tempfile::tempdir().unwrap();
    let linkage = dir.path().join("naca0012_sharp.meshlink.xml");
    sagitta(args!["link", linear, "--cad", cad, "-o", linkage]).expect(0);
    let text = std::fs::read_to_string(&linkage).unwrap();
    assert!(text.contains("MeshString") && !text.contains("MeshSheet "), "{text}");
    let own = curved(&linear, &cad, 2, &args!["--linkage", linkage]);
    let by_tags = curved(&linear, &cad, 2, &[]);
    assert_eq!(own.mesh().points(), by_tags.mesh().points());
}

/// The curves go through every point of the file, and a mesh beside them would be curved onto them.
#[test]
fn coordinates_become_curves() {
    let dir = tempfile::tempdir().unwrap();
    let [step, points, feet] = ["airfoil.step", "points.csv", "feet.csv"].map(|name| dir.path().join(name));
    let coordinates = root().join("fixtures/airfoils/naca2412.dat");
    let told = sagitta(args!["spline", coordinates, "-o", step]).expect(0).stdout;
    assert!(told.contains("81 points, blunt trailing edge"), "{told}");
    let rows: Vec<String> = std::fs::read_to_string(&coordinates)
        .unwrap()
        .lines()
        .skip(1)
        .map(|row| row.replace(' ', ",") + ",0")
        .collect();
    std::fs::write(&points, format!("x,y,z\n{}\n", rows.join("\n"))).unwrap();
    sagitta(args!["project", step, points, "-o", feet, "-q"]).expect(0);
    let far = std::fs::read_to_string(&feet).unwrap();
    let column = far.lines().next().unwrap().split(',').position(|name| name == "distance").expect("a distance");
    for line in far.lines().skip(1) {
        let distance: f64 = line.split(',').nth(column).unwrap().parse().unwrap();
        assert!(distance < 1e-9, "{line}");
    }
    let none = dir.path().join("none.dat");
    std::fs::write(&none, "nothing\n1 2\n").unwrap();
    let refused = sagitta(args!["spline", none, "-o", dir.path().join("none.step")]).expect(2).stderr;
    assert!(refused.contains("none.dat: has 1 points that differ"), "{refused}");
}

/// The blade's passage is one pitch wide; what goes out above comes in below.
#[test]
fn the_sides_of_a_cascade_stay_congruent() {
    let [linear, cad] = ["msh", "step"].map(|extension| fixture("cascade", extension));
    let own = curved(&linear, &cad, 3, &[]);
    let mesh = own.mesh();
    let at = |n: NodeId| mesh.points()[n.index()];
    let pairs: usize = mesh.periodic().iter().map(|record| record.pairs.len()).sum();
    assert!(pairs > 30, "the cascade is periodic: {pairs} pairs");
    for record in mesh.periodic().iter().filter(|record| !record.pairs.is_empty()) {
        let (slave, master) = record.pairs[0];
        let pitch = at(slave) - at(master);
        for &(slave, master) in &record.pairs {
            assert!((at(slave) - at(master)).distance(pitch) < 1e-12, "{:?}", (at(slave), at(master)));
        }
    }
}

/// Quadrilaterals in `n` by 2 between the circles of `annulus.step`, flattened along y.
fn ring(n: usize, radii: [f64; 2], flat: f64) -> Mesh {
    let mut parts = Parts::default();
    for layer in 0..3 {
        let radius = radii[0] + (radii[1] - radii[0]) * f64::from(layer) / 2.0;
        for k in 0..n {
            let angle = std::f64::consts::TAU * k as f64 / n as f64;
            parts.points.push(DVec3::new(angle.cos(), flat * angle.sin(), 0.0) * radius);
        }
    }
    let mut push = |cell: Cell, tag: i32, nodes: &[usize]| {
        let nodes: Vec<NodeId> = nodes.iter().map(|&node| NodeId::new(node).unwrap()).collect();
        parts.push(cell, EntityKey::new(cell.dimension() as u8, tag), &nodes);
    };
    for k in 0..n {
        let next = (k + 1) % n;
        push(Cell::Line, 11, &[k, next]);
        push(Cell::Line, 12, &[2 * n + k, 2 * n + next]);
        for layer in [0, n] {
            push(Cell::Quad, 1, &[layer + next, layer + k, layer + n + k, layer + n + next]);
        }
    }
    Mesh::new(parts).unwrap()
}

/// The wall's largest distance from the ellipse `x^2 + (y / flat)^2 = 1`, to first order, at dense points of its polynomials.
fn off_the_ellipse(mesh: &Mesh, flat: f64) -> f64 {
    let mut farthest = 0.0_f64;
    for block in mesh.side_blocks().filter(|block| block.entity.tag == 11) {
        for nodes in block.elements(mesh.order()) {
            for k in 0..=50 {
                let values = basis::values(Cell::Line, mesh.order(), [f64::from(k) / 50.0, 0.0, 0.0]);
                let x: DVec3 = mesh.points_of(nodes).zip(values).map(|(x, v)| x * v).sum();
                let (size, slope) = (x.x.hypot(x.y / flat), x.x.hypot(x.y / (flat * flat)));
                farthest = farthest.max((size - 1.0).abs() * size / slope);
            }
        }
    }
    farthest
}

/// `annulus.step` with ellipses in place of its circles.
fn flattened(dir: &Path, flat: f64) -> PathBuf {
    let text = std::fs::read_to_string(fixture("annulus", "step")).unwrap();
    let flatten = |line: &str| match line.split_once("= CIRCLE('',").map(|(name, rest)| (name, rest.rsplit_once(','))) {
        Some((name, Some((axes, radius)))) => {
            let radius: f64 = radius.trim_end_matches(");").parse().unwrap();
            format!("{name}= ELLIPSE('',{axes},{radius:?},{:?});", flat * radius)
        }
        _ => line.to_owned(),
    };
    let path = dir.join("ellipses.step");
    std::fs::write(&path, text.lines().map(flatten).collect::<Vec<_>>().join("\n")).unwrap();
    path
}

/// Where nodes slide freely a plane curve is approximated to twice the order (Hollig 1996); `p + 0.8` is what is promised.
#[test]
fn lines_come_to_circles_and_ellipses_with_the_order_that_is_promised() {
    let dir = tempfile::tempdir().unwrap();
    for (flat, levels) in [(1.0, [8, 16, 32]), (0.6, [16, 32, 64])] {
        let cad = flattened(dir.path(), flat);
        for p in [2_i32, 3, 4] {
            let distances = levels.map(|n| {
                let linear = dir.path().join(format!("ring{n}.msh"));
                formats::write(&linear, &ring(n, [1.0, 2.0], flat), &WriteOptions::default()).unwrap();
                let own = curved(&linear, &cad, p as usize, &[]);
                assert_eq!(own.mesh().order(), Order::new(p as usize).unwrap());
                off_the_ellipse(&own.mesh(), flat)
            });
            let rates = [0, 1].map(|k| (distances[k] / distances[k + 1]).log2());
            warn(&format!("ellipse of {flat} at P{p}: {distances:?} off, orders {rates:.2?}"));
            let promised = f64::from(p) + 0.8;
            assert!(rates.iter().all(|&rate| rate >= promised), "{flat} P{p}: {distances:?}, orders {rates:.2?}");
        }
    }
}
