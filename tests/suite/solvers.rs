//! Files for solvers: what is written for each, what is refused, and MFEM, SU2 and HOPR meshes written and read again.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sagitta::element::{Cell, Order};
use sagitta::formats::{self, Error, WriteOptions, solver};
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{EntityKey, Mesh, NodeId, Parts, PhysicalName};

use crate::common::measure::measure;
use crate::common::sample::sample;
use crate::common::{fixture, sagitta};

/// A mesh with a line that belongs to no group, as the curves of a CAD do.
fn with_a_line(mesh: Mesh) -> Mesh {
    let mut parts = mesh.into_parts();
    let side = parts.blocks.iter().find(|block| block.cell.dimension() == 2).unwrap();
    let ends = [side.nodes[0], side.nodes[1]];
    parts.push(Cell::Line, EntityKey::new(1, 900), &ends);
    Mesh::new(parts).unwrap()
}

/// Tets, pyramids and hexes of an order, or prisms, curved so that no node is where another order would have it.
fn curved(name: &str, p: usize) -> Mesh {
    let mut mesh = elevate(&with_a_line(sample(name)), Order::new(p).unwrap()).unwrap().mesh;
    for x in mesh.points_mut() {
        *x += 0.02 * glam::DVec3::new((3.0 * x.y).sin(), (2.0 * x.z).cos(), (4.0 * x.x).sin());
    }
    mesh
}

fn zoo(p: usize) -> Mesh {
    curved("hexpyrtet_p1_msh41b.msh", p)
}

fn write(mesh: &Mesh, name: &str, word: Option<&str>) -> (tempfile::TempDir, PathBuf, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let options = WriteOptions::default();
    let notes = match word {
        Some(word) => formats::write_for(&path, mesh, solver::by_name(word).unwrap(), &options).unwrap(),
        None => formats::write(&path, mesh, &options).unwrap(),
    };
    (folder, path, notes)
}

/// Cells and sides by name, as sets of the coordinates of their nodes in order, bit for bit.
fn content(mesh: &Mesh) -> BTreeMap<(Cell, String), Vec<Vec<[u64; 3]>>> {
    let mut found: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for block in mesh.blocks().iter().filter(|block| block.cell.dimension() + 1 >= mesh.dimension()) {
        let names: BTreeSet<String> = mesh.names_of(block.entity).into_iter().collect();
        let names = names.into_iter().collect::<Vec<_>>().join(",");
        for nodes in block.elements(mesh.order()) {
            let points = mesh.points_of(nodes).map(|x| x.to_array().map(f64::to_bits)).collect();
            found.entry((block.cell, names.clone())).or_default().push(points);
        }
    }
    found
}

#[test]
fn meshes_are_the_same_in_mfem_and_su2() {
    for p in 1..=4 {
        let files = [("mesh.mfem", None), ("mesh.mesh", Some("mfem")), ("mesh.su2", None), ("mesh.su2", Some("su2"))];
        let meshes = [zoo(p), curved("cylprism_p1_msh41b.msh", p)];
        for (mesh, (name, word)) in meshes.iter().flat_map(|mesh| files.map(|file| (mesh, file))) {
            let (_folder, path, notes) = write(mesh, name, word);
            let again = formats::read(&path).unwrap();
            assert_eq!(content(&again), content(mesh), "{name} {word:?} P{p}: bits, names and order");
            assert_eq!(again.points().len(), mesh.points().len(), "{name} P{p}");
            // What is read is in blocks of one kind and patch: from then on a rewritten file has the same bytes.
            let (_folder, second, _) = write(&again, name, word);
            let (_folder, third, _) = write(&formats::read(&second).unwrap(), name, word);
            let [second, third] = [second, third].map(|path| std::fs::read(path).unwrap());
            assert!(second == third, "{name} {word:?} P{p}: other bytes");
            assert!(notes.iter().any(|note| note.contains("points, lines")), "{name}: {notes:?}");
        }
    }
}

#[test]
fn plane_meshes_are_the_same_in_mfem_and_su2() {
    let mesh = sample("circle2d_p2_msh22a.msh");
    for name in ["mesh.mfem", "mesh.su2"] {
        let (_folder, path, _) = write(&mesh, name, None);
        assert_eq!(content(&formats::read(&path).unwrap()), content(&mesh), "{name}");
    }
}

/// A solver's file holds cells and named sides and nothing else; each group has one number.
#[test]
fn files_for_solvers_hold_named_sides_alone() {
    let mesh = zoo(2);
    assert!(mesh.counts().contains_key(&Cell::Line));
    let (_folder, path, notes) = write(&mesh, "mesh.msh", Some("mfem"));
    let again = formats::read(&path).unwrap();
    let kinds: BTreeSet<usize> = again.counts().keys().map(|cell| cell.dimension()).collect();
    assert_eq!(kinds, BTreeSet::from([2, 3]));
    assert_eq!(content(&again), content(&mesh));
    assert!(notes.iter().any(|note| note.contains("elements below the boundary")), "{notes:?}");
    let tags: Vec<i32> = again.physical_names().iter().map(|own| own.tag).collect();
    assert_eq!(tags.iter().collect::<BTreeSet<_>>().len(), tags.len(), "{tags:?}");
}

#[test]
fn what_has_no_name_gets_one_and_is_told() {
    let bare = |mesh: Mesh| {
        let mut parts = Parts { physical_names: Vec::new(), ..mesh.into_parts() };
        parts.entities.iter_mut().for_each(|entity| entity.physical_tags.clear());
        // One side has no boundary element.
        let block = parts.blocks.iter_mut().find(|block| block.cell == Cell::Triangle).unwrap();
        let stride = block.nodes.len() / block.tags.len();
        block.tags.pop();
        block.nodes.truncate(block.tags.len() * stride);
        Mesh::new(parts).unwrap()
    };
    for p in [1, 3] {
        let mesh = bare(zoo(p));
        let (_folder, path, notes) = write(&mesh, "mesh.mesh", Some("mfem"));
        let again = formats::read(&path).unwrap();
        let names: BTreeSet<String> = again.physical_names().iter().map(|own| own.name.clone()).collect();
        assert!(names.contains("unmarked") && names.contains("fluid"), "{names:?}");
        assert_eq!(again.sides().len(), mesh.sides().len() + 1);
        assert!(notes.iter().any(|note| note.contains("1 sides of the skin have no boundary element")), "{notes:?}");
        assert!(notes.iter().any(|note| note.contains("belongs to no group; it is called surface_")), "{notes:?}");
        assert!(sagitta::mesh::Skin::of(&again).unmarked.is_empty());
    }
}

fn refusal(mesh: &Mesh, name: &str, word: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let told = formats::write_for(&path, mesh, solver::by_name(word).unwrap(), &WriteOptions::default()).unwrap_err();
    assert!(matches!(told, Error::Inexpressible { .. } | Error::Format { .. }), "{told}");
    assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none(), "nothing is written");
    told.to_string()
}

#[test]
fn what_a_solver_cannot_take_is_refused_with_what_it_can() {
    let told = refusal(&zoo(3), "mesh.msh", "dolfinx");
    assert!(told.contains("has no pyramid of P3") && told.contains("tet of P1 to P3"), "{told}");
    let told = refusal(&zoo(3), "mesh.msh", "mfem");
    assert!(told.contains("no pyramid of P3") && told.contains("in a .mesh file"), "{told}");
    let told = refusal(&zoo(1), "mesh.cgns", "pyfr");
    assert!(told.contains("PyFR") && told.contains(".msh"), "{told}");
    let told = refusal(&zoo(1), "mesh.msh", "dolfinx");
    assert!(told.contains("one kind of cell"), "{told}");
    let mut skew = zoo(2);
    let corner = skew.elements_of(Cell::Pyramid).iter().next().unwrap().corners()[0];
    skew.points_mut()[corner.index()] += glam::DVec3::splat(0.01);
    let told = refusal(&skew, "mesh.msh", "pyfr");
    assert!(told.contains("no parallelogram"), "{told}");
    // A surface in two groups, for a solver that knows one.
    let mut parts = sample("hexpyrtet_p1_msh41b.msh").into_parts();
    let wall = parts.blocks.iter().find(|block| block.cell == Cell::Triangle).unwrap().entity;
    parts.physical_names.push(PhysicalName { dimension: 2, tag: 77, name: "probe".into() });
    parts.entities.iter_mut().filter(|entity| entity.key == wall).for_each(|entity| entity.physical_tags.push(77));
    let told = refusal(&Mesh::new(parts.clone()).unwrap(), "mesh.su2", "su2");
    assert!(told.contains("probe") && told.contains("leave it in one"), "{told}");
    let both = Mesh::new(parts).unwrap();
    let (_folder, path, _) = write(&both, "mesh.mesh", Some("mfem"));
    assert_eq!(content(&formats::read(&path).unwrap()), content(&both), "MFEM has sets of attributes");
}

/// The refusal comes before the mesh is curved.
#[test]
fn curve_refuses_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let (output, report) = (folder.path().join("out.msh"), folder.path().join("r.json"));
    let began = std::time::Instant::now();
    let [mesh, cad] = ["msh", "step"].map(|ending| fixture("weeble_hybrid", ending));
    let [mesh, cad, out, json] = [&mesh, &cad, &output, &report].map(|path| path.to_str().unwrap());
    let done = sagitta(["curve", mesh, "--cad", cad, "--order", "4", "--for", "dolfinx", "-o", out, "--report", json]);
    assert_eq!(done.code, Some(2), "{}", done.stderr);
    assert!(done.stderr.contains("DOLFINx") && done.stderr.contains("has no"), "{}", done.stderr);
    assert!(!output.exists() && !report.exists());
    assert!(began.elapsed().as_secs() < 60);
}

/// A unit cell of each kind that MFEM has, of a space on other points than even ones: nodes come out on the lattice.
#[test]
fn nodes_of_other_points_are_brought_to_even_ones() {
    let lobatto = [0.0, (1.0 - 0.2f64.sqrt()) / 2.0, (1.0 + 0.2f64.sqrt()) / 2.0, 1.0];
    let mut text = "MFEM mesh v1.0\n\ndimension\n3\n\nelements\n1\n1 5 0 1 2 3 4 5 6 7\n\nboundary\n1\n3 3 3 2 1 0\n\nvertices\n8\n\nnodes\n\
                    FiniteElementSpace\nFiniteElementCollection: L2_T1_3D_P3\nVDim: 3\nOrdering: 1\n\n"
        .to_owned();
    let bump = |[x, y, z]: [f64; 3]| [x + 0.1 * y * y * y, y + 0.2 * x * x * z, z - 0.1 * x * y];
    for z in lobatto {
        for y in lobatto {
            for x in lobatto {
                let [x, y, z] = bump([x, y, z]);
                text += &format!("{x:?} {y:?} {z:?}\n");
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hex.mesh");
    std::fs::write(&path, text).unwrap();
    let mesh = formats::read(&path).unwrap();
    let hex = mesh.cells().iter().next().unwrap();
    for (at, x) in sagitta::element::lattice(Cell::Hex, mesh.order()).iter().zip(mesh.points_of(hex.nodes)) {
        let wanted = glam::DVec3::from(bump(at.map(|i| f64::from(i) / 3.0)));
        assert!(x.distance(wanted) < 1e-14, "{at:?}");
    }
    let side = mesh.sides().iter().next().unwrap();
    assert_eq!((side.cell, side.entity, side.nodes.len()), (Cell::Quad, EntityKey::new(2, 3), 16));
    assert!(mesh.points_of(side.nodes).all(|x| x.z.abs() < 0.11), "the side z = 0");
}

/// What MFEM says of meshes that it wrote itself (`tests/consumers/mfem_samples.py`).
#[test]
fn mfems_own_meshes_have_mfems_measures() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples");
    let text = std::fs::read_to_string(folder.join("mfem_figures.json")).unwrap();
    let figures: BTreeMap<String, serde_json::Value> = serde_json::from_str(&text).unwrap();
    assert!(figures.len() >= 5);
    for (name, theirs) in figures {
        let mesh = sample(&name);
        let close = |a: f64, b: &serde_json::Value| (a - b.as_f64().unwrap()).abs() < 1e-9;
        let (volume, areas) = measure(&mesh);
        assert_eq!(mesh.cells().len() as u64, theirs["cells"].as_u64().unwrap(), "{name}");
        if mesh.is_volume() {
            assert!(close(volume, &theirs["volume"]), "{name}: {volume} {theirs}");
            assert_eq!(areas.len(), theirs["sides"].as_object().unwrap().len(), "{name}");
            assert!(
                areas.iter().all(|(key, area)| close(*area, &theirs["sides"][key.tag.to_string()])),
                "{name}: {areas:?}"
            );
        } else {
            assert!(close(areas.values().sum(), &theirs["volume"]), "{name}: {areas:?} {theirs}");
            let names: BTreeSet<&str> = mesh.physical_names().iter().map(|own| &own.name[..]).collect();
            assert_eq!(names, BTreeSet::from(["inflow", "upper and lower"]));
        }
    }
}

#[test]
fn mfem_meshes_that_cannot_be_read_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let head = "MFEM mesh v1.0\ndimension\n3\nelements\n1\n1 4 0 1 2 3\nboundary\n1\n1 2 0 1 2\nvertices\n4\n";
    let points = "3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let path = folder.path().join("tet.mesh");
    std::fs::write(&path, format!("{head}{points}")).unwrap();
    assert_eq!(formats::read(&path).unwrap().counts()[&Cell::Tet], 1);
    let space =
        |name: &str| format!("nodes\nFiniteElementSpace\nFiniteElementCollection: {name}\nVDim: 3\nOrdering: 1\n");
    let named = |set: &str| {
        let sets =
            format!("\nattribute_sets\n1\n\"a\"{set}\n\nboundary\n1\n1 2 0 1 2\nbdr_attribute_sets\n0\nvertices");
        head.replace("v1.0", "v1.3").replace("\nboundary\n1\n1 2 0 1 2\nvertices", &sets)
    };
    std::fs::write(&path, named(" 1 1") + points + "mfem_mesh_end\n").unwrap();
    assert_eq!(formats::read(&path).unwrap().notes(), [""; 0]);
    let comment = |text: String| {
        [&b"MFEM mesh v1.0\n#\xe9t\xe9\n"[..], text.trim_start_matches("MFEM mesh v1.0\n").as_bytes()].concat()
    };
    std::fs::write(&path, comment(head.to_owned() + points)).unwrap();
    assert_eq!(formats::read(&path).unwrap().notes(), [""; 0]);
    std::fs::write(&path, named(" 1 1") + points).unwrap();
    assert!(formats::read(&path).unwrap().notes()[0].contains("no mfem_mesh_end"));
    for (text, what) in [
        ("MFEM NC mesh v1.0\n".to_owned(), "non-conforming"),
        ("MFEM NURBS mesh v1.0\n".to_owned(), "NURBS"),
        (head.replace("1 4 0", "0 4 0") + points, "attribute 0"),
        (head.replace("1 4 0 1 2 3", "1 9 0 1 2 3") + points, "geometry 9"),
        (head.replace("0 1 2 3", "0 1 2 7") + points, "element 1 refers to node 7"),
        (head.to_owned() + &points.replacen('3', "2", 1), "2 coordinates, and the mesh is of dimension 3"),
        (head.to_owned() + points + "0.5 0.5 0.5\n", "more numbers than announced"),
        (
            head.replace("vertices\n4", "vertices\n3").replace("0 1 2 3", "0 1 2 2") + points,
            "more numbers than announced",
        ),
        (named(" 1 1 2") + points, "a set of attributes does not take one line"),
        (named(" -1") + points, "a set of attributes does not take one line"),
        (head.replace("dimension\n3", "dimension\n1") + points, "dimension 1"),
        (head.to_owned() + "nodes\n", "cut off"),
        (head.replace("1 4 0 1 2 3", "1 4 0 1 2 2") + &space("H1_3D_P1"), "at two corners"),
        (head.to_owned() + &space("H1Pos_3D_P2"), "H1Pos_3D_P2"),
        (head.to_owned() + &space("H1_3D_P9"), "H1_3D_P9"),
        (head.to_owned() + &space("H1_3D_P2"), "do not fit"),
        (head.replace("vertices\n4", "vertices\n99999999") + points, "do not fit"),
        (head.replace("elements\n1", "elements\n88888888"), "do not fit"),
    ] {
        std::fs::write(&path, &text).unwrap();
        let told = formats::read(&path).unwrap_err().to_string();
        assert!(told.contains(what), "{what}: {told}");
    }
}

/// Two tets whose boundary is in part unnamed; the second volume apart, as zones are.
#[test]
fn volumes_that_share_no_points_are_zones_of_su2() {
    let mut parts = Parts::default();
    let node = |n: usize| NodeId::new(n).unwrap();
    for shift in [0.0, 5.0] {
        let corners = [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z];
        parts.points.extend(corners.map(|x| x + shift));
    }
    for (volume, first) in [(1, 0), (2, 4)] {
        parts.push(Cell::Tet, EntityKey::new(3, volume), &[0, 1, 2, 3].map(|n| node(first + n)));
        parts.push(Cell::Triangle, EntityKey::new(2, volume), &[0, 2, 1].map(|n| node(first + n)));
    }
    let mesh = Mesh::new(parts).unwrap();
    let (_folder, path, _) = write(&mesh, "two.su2", None);
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.starts_with("NZONE= 2\nIZONE= 1\nNDIME= 3\nNELEM= 1\n10 0 1 2 3 0\n"), "{text}");
    let again = formats::read(&path).unwrap();
    assert_eq!((again.points(), again.cells().len(), again.sides().len()), (mesh.points(), 2, 2));
}

#[test]
fn physical_only_leaves_out_what_belongs_to_no_group() {
    let mesh = with_a_line(sample("hexpyrtet_p1_msh41b.msh"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.msh");
    let notes = formats::write(&path, &mesh, &WriteOptions { physical_only: true, ..WriteOptions::default() }).unwrap();
    let again = formats::read(&path).unwrap();
    assert!(!again.counts().contains_key(&Cell::Line) && !again.counts().contains_key(&Cell::Point));
    assert_eq!(content(&again), content(&mesh));
    let left_out: usize =
        mesh.blocks().iter().filter(|block| block.cell.dimension() < 2).map(|block| block.tags.len()).sum();
    let told = format!("{left_out} elements below the cells");
    assert!(notes.iter().any(|note| note.starts_with(&told)), "{notes:?}");
}
