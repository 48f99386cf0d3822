//! Nektar++'s XML: written, read again, packed, damaged.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::{Path, PathBuf};

use base64::Engine;
use glam::DVec3;
use sagitta::element::{Cell, interior_start, lattice};
use sagitta::formats::{self, WriteOptions, solver};
use sagitta::mesh::{Mesh, NodeId};

use crate::common::measure::measure;
use crate::common::sample::{curved, sample};
use crate::common::{fixture, sagitta};

const ZOO: &str = "hexpyrtet_p1_msh41b.msh";
const PRISMS: &str = "cylprism_p1_msh41b.msh";

struct Written {
    _folder: tempfile::TempDir,
    path: PathBuf,
    notes: Vec<String>,
}

fn write(mesh: &Mesh) -> Written {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.xml");
    let notes = formats::write_for(&path, mesh, solver::by_name("nektar").unwrap(), &WriteOptions::default()).unwrap();
    Written { _folder: folder, path, notes }
}

/// Cells and sides by name: the bits of their nodes' coordinates as a set, of cells those on the boundary alone.
fn content(mesh: &Mesh) -> BTreeMap<(Cell, String), BTreeSet<Vec<[u64; 3]>>> {
    let mut found: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    for block in mesh.blocks().iter().filter(|block| block.cell.dimension() + 1 >= mesh.dimension()) {
        let is_solid = block.cell.dimension() == 3;
        let kept =
            if is_solid { interior_start(block.cell, mesh.order()) } else { block.cell.node_count(mesh.order()) };
        for nodes in block.elements(mesh.order()) {
            let mut points: Vec<_> = mesh.points_of(&nodes[..kept]).map(|x| x.to_array().map(f64::to_bits)).collect();
            points.sort_unstable();
            found.entry((block.cell, mesh.names_of(block.entity).join(","))).or_default().insert(points);
        }
    }
    found
}

#[test]
fn cells_sides_and_names_come_back_bit_for_bit() {
    for (name, p) in [(ZOO, 1), (ZOO, 2), (PRISMS, 1), (PRISMS, 2), (PRISMS, 3), (PRISMS, 4)] {
        let mesh = curved(name, p);
        let written = write(&mesh);
        let again = formats::read(&written.path).unwrap();
        assert_eq!(content(&again), content(&mesh), "{name} P{p}");
        assert_eq!((again.order().get(), again.counts()), (p, mesh.counts()), "{name} P{p}");
        let told = written.notes.iter().any(|note| note.contains("where the faces put them"));
        let has_inside = mesh.cells().iter().any(|cell| interior_start(cell.cell, mesh.order()) < cell.nodes.len());
        assert_eq!(told, has_inside, "{name} P{p}: {:?}", written.notes);
        // From then on nothing changes: elements begin where Nektar++ wants it, and their insides are its own.
        let second = write(&again);
        let third = write(&formats::read(&second.path).unwrap());
        assert!(
            std::fs::read(&second.path).unwrap() == std::fs::read(&third.path).unwrap(),
            "{name} P{p}: other bytes"
        );
    }
}

/// In every element a triangle's last corner, where Nektar++ collapses it, has the highest number; elements stand the right way round.
#[test]
fn neighbours_collapse_a_triangle_at_the_same_corner() {
    let triangles = |cell: Cell| -> &[[usize; 3]] {
        match cell {
            Cell::Tet => &[[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]],
            Cell::Pyramid => &[[0, 1, 4], [1, 2, 4], [3, 2, 4], [0, 3, 4]],
            Cell::Prism => &[[0, 2, 1], [3, 5, 4]],
            _ => &[],
        }
    };
    for mesh in [sample(ZOO), sample(PRISMS), formats::read(&fixture("weeble_hybrid", "msh")).unwrap()] {
        let again = formats::read(&write(&mesh).path).unwrap();
        assert!(again.notes().iter().all(|note| !note.contains("renumbered")), "{:?}", again.notes());
        let mut seen = 0;
        for cell in again.cells().iter() {
            for triangle in triangles(cell.cell) {
                let [a, b, c] = triangle.map(|corner| cell.nodes[corner]);
                assert!(c > a && c > b, "{} {}", cell.cell, cell.tag);
                seen += 1;
            }
        }
        assert!(seen > 100);
        let [before, after] = [&mesh, &again].map(|mesh| measure(mesh).0);
        assert!((before - after).abs() < 1e-12 * before.abs());
    }
}

/// What a file says of triangles: vertex numbers from edges, the last the highest, and the curve's corners there.
#[test]
fn curves_begin_and_end_at_their_vertices() {
    let text = std::fs::read_to_string(&write(&curved(PRISMS, 3)).path).unwrap();
    let rows = |section: &str, tag: &str| -> Vec<(String, Vec<f64>)> {
        let inside =
            text.split_once(&format!("<{section}>")).unwrap().1.split_once(&format!("</{section}>")).unwrap().0;
        let own = inside.lines().filter(|line| line.trim_start().starts_with(&format!("<{tag} ")));
        own.map(|line| {
            let (head, rest) = line.split_once('>').unwrap();
            let body = rest.split_once('<').unwrap().0;
            (head.to_owned(), body.split_whitespace().map(|word| word.parse().unwrap()).collect())
        })
        .collect()
    };
    let number = |head: &str, name: &str| -> usize {
        head.split_once(&format!(" {name}=\"")).unwrap().1.split_once('"').unwrap().0.parse().unwrap()
    };
    let vertices: Vec<Vec<f64>> = rows("VERTEX", "V").into_iter().map(|(_, x)| x).collect();
    let edges: Vec<[usize; 2]> =
        rows("EDGE", "E").iter().map(|(_, ends)| [ends[0] as usize, ends[1] as usize]).collect();
    assert!(edges.iter().all(|[a, b]| a < b));
    let curves = rows("CURVED", "E");
    assert_eq!(curves.len(), edges.len(), "no edge is straight");
    for (head, x) in curves {
        let [a, b] = edges[number(&head, "EDGEID")];
        assert_eq!((x.len(), &x[..3], &x[9..]), (12, &vertices[a][..], &vertices[b][..]), "{head}");
    }
    let faces: BTreeMap<usize, Vec<usize>> = ["T", "Q"]
        .iter()
        .flat_map(|tag| rows("FACE", tag))
        .map(|(head, own)| (number(&head, "ID"), own.iter().map(|&edge| edge as usize).collect()))
        .collect();
    for (head, x) in rows("CURVED", "F") {
        let own = &faces[&number(&head, "FACEID")];
        let begin = |n: usize| {
            let next = edges[own[(n + 1) % own.len()]];
            *edges[own[n]].iter().find(|end| !next.contains(end)).unwrap()
        };
        let corners: Vec<usize> = (0..own.len()).map(begin).collect();
        let places = if own.len() == 3 { vec![0, 1, 2] } else { vec![0, 3, 15, 12] };
        for (&corner, place) in corners.iter().zip(places) {
            assert_eq!(&x[3 * place..3 * place + 3], &vertices[corner][..], "{head}");
        }
        assert!(own.len() == 4 || corners.iter().max() == corners.last(), "{head}");
    }
}

#[test]
fn plane_meshes_are_the_same() {
    let mesh = sample("circle2d_p2_msh22a.msh");
    let again = formats::read(&write(&mesh).path).unwrap();
    let distance = |a: &Mesh, b: &Mesh| (measure(a).1.values().sum::<f64>() - measure(b).1.values().sum::<f64>()).abs();
    assert_eq!((again.counts(), again.order()), (mesh.counts(), mesh.order()));
    assert!(distance(&again, &mesh) < 1e-13);
    let names = |mesh: &Mesh| mesh.physical_names().iter().map(|own| own.name.clone()).collect::<BTreeSet<String>>();
    assert_eq!(names(&again), names(&mesh));
}

/// A hex whose faces are given and whose middle is elsewhere: what is proven and written is the mesh as the solver has it.
#[test]
fn curving_for_nektar_certifies_what_nektar_has() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.xml");
    let [mesh, cad] = ["msh", "step"].map(|ending| fixture("cylinder_bl", ending));
    let [mesh, cad, path] = [&mesh, &cad, &out].map(|path| path.to_str().unwrap());
    let done = sagitta(["curve", mesh, "--cad", cad, "--order", "2", "--for", "nektar", "-o", path, "--quiet"]);
    assert_eq!(done.code, Some(0), "{}{}", done.stdout, done.stderr);
    assert!(done.stdout.contains("are where Nektar++ 5 makes them from the faces"), "{}", done.stdout);
    let checked = sagitta(["check", path]);
    assert_eq!(checked.code, Some(0), "{}{}", checked.stdout, checked.stderr);
    assert!(!done.stdout.contains("have no place in the file: its reader"), "it is that mesh already: {}", done.stdout);
}

#[test]
fn what_nektar_cannot_have_is_refused() {
    let refused = |mesh: &Mesh| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mesh.xml");
        formats::write_for(&path, mesh, solver::by_name("nektar").unwrap(), &WriteOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert!(refused(&curved(ZOO, 3)).contains("no pyramid of P3"));
    // Two prisms that stand across one another: the edges of one join the triangle of the other.
    let at = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 1, 1], [1, 0, 1], [2, 0, 1], [2, 2, 1]];
    let points: Vec<DVec3> = at.iter().map(|x| DVec3::from(x.map(f64::from))).collect();
    let mut parts = sagitta::mesh::Parts { points, ..Default::default() };
    let nodes = |own: [usize; 6]| own.map(|n| NodeId::new(n).unwrap());
    let key = sagitta::mesh::EntityKey::new(3, 1);
    parts.push(Cell::Prism, key, &nodes([0, 1, 2, 3, 5, 4]));
    // Its edges join the triangles of the first: 1 to 2 and 5 to 4.
    parts.push(Cell::Prism, key, &nodes([1, 5, 6, 2, 4, 7]));
    let told = refused(&Mesh::new(parts).unwrap());
    assert!(told.contains("collapses another edge than its neighbours"), "{told}");
}

fn read_text(name: &str, text: &str) -> Result<Mesh, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    formats::read(&path).map_err(|error| error.to_string())
}

fn packed(numbers: &[[u8; 8]]) -> String {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(numbers.as_flattened()).unwrap();
    base64::engine::general_purpose::STANDARD.encode(encoder.finish().unwrap())
}

/// A quadrilateral with one edge of P2, as text and packed either way.
#[test]
fn packed_sections_are_those_of_text() {
    let head = r#"<NEKTAR><GEOMETRY DIM="2" SPACE="2">"#;
    let tail = r#"<COMPOSITE><C ID="5" NAME="air &amp; water"> Q[0] </C><C ID="1"> E[1-2,0] </C></COMPOSITE><DOMAIN> C[5] </DOMAIN></GEOMETRY></NEKTAR>"#;
    let x = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, -0.25, 0.0]];
    let edges: [[i64; 2]; 4] = [[0, 1], [1, 2], [3, 2], [0, 3]];
    let mut text = format!("{head}<VERTEX>");
    (0..4).for_each(|n| text += &format!("<V ID=\"{n}\"> {} {} {} </V>", x[n][0], x[n][1], x[n][2]));
    text += "</VERTEX><EDGE>";
    edges.iter().enumerate().for_each(|(n, [a, b])| text += &format!("<E ID=\"{n}\"> {a} {b} </E>"));
    text += "</EDGE><ELEMENT><Q ID=\"0\"> 0 1 2 3 </Q></ELEMENT><CURVED><E ID=\"0\" EDGEID=\"0\" NUMPOINTS=\"3\" TYPE=\"PolyEvenlySpaced\">";
    [0, 4, 1].iter().for_each(|&n: &usize| text += &format!(" {} {} {}", x[n][0], x[n][1], x[n][2]));
    text += &format!("</E></CURVED>{tail}");
    let plain = read_text("plain.xml", &text).unwrap();
    assert_eq!((plain.order().get(), plain.cells().len(), plain.sides().len()), (2, 1, 3));
    let entity = plain.cells().iter().next().unwrap().entity;
    assert_eq!((entity.tag, plain.label(entity)), (5, "air & water".to_owned()));
    // The middle of the element follows from its edges: half of how far the edge's is.
    let quad = plain.cells().iter().next().unwrap().nodes;
    let middle = lattice(Cell::Quad, plain.order()).iter().position(|at| *at == [1, 1, 0]).unwrap();
    let middle = plain.points_of(quad).nth(middle).unwrap();
    assert!(middle.distance(DVec3::new(1.0, 0.5 - 0.125, 0.0)) < 1e-15, "{middle}");
    for big in [false, true] {
        let whole = |n: i64| if big { n.to_be_bytes() } else { n.to_le_bytes() };
        let real = |x: f64| if big { x.to_be_bytes() } else { x.to_le_bytes() };
        let how = if big { "B64Z-BigEndian" } else { "B64Z-LittleEndian" };
        let section = |numbers: Vec<[u8; 8]>| packed(&numbers);
        let row = |n: usize| [whole(n as i64), real(x[n][0]), real(x[n][1]), real(x[n][2])];
        let vertices = section((0..4).flat_map(row).collect());
        let edges = section(edges.iter().enumerate().flat_map(|(n, [a, b])| [n as i64, *a, *b].map(whole)).collect());
        let quad = section([0, 0, 1, 2, 3].map(whole).to_vec());
        let info = section([0, 0, 3, 0, 0, 17].map(whole).to_vec());
        let index = section([0, 1, 2].map(whole).to_vec());
        let points = section([0, 4, 1].into_iter().flat_map(row).collect());
        let text = format!(
            "{head}<VERTEX COMPRESSED=\"{how}\">{vertices}</VERTEX><EDGE COMPRESSED=\"{how}\">{edges}</EDGE>\
             <ELEMENT><Q COMPRESSED=\"{how}\">{quad}</Q></ELEMENT><CURVED COMPRESSED=\"{how}\"><E>{info}</E>\
             <DATAPOINTS ID=\"0\"><INDEX>{index}</INDEX><POINTS>{points}</POINTS></DATAPOINTS></CURVED>{tail}"
        );
        assert_eq!(read_text("packed.xml", &text).unwrap(), plain, "{how}");
        let told = read_text("packed.xml", &text.replace(how, "B64Z-Sideways")).unwrap_err();
        assert!(told.contains("VERTEX is packed as \"B64Z-Sideways\""), "{told}");
        let told = read_text("packed.xml", &text.replace(&vertices, &vertices[..vertices.len() - 12])).unwrap_err();
        assert!(told.contains("VERTEX cannot be unpacked"), "{told}");
    }
}

#[test]
fn damage_is_told_with_place_and_thing() {
    let text = std::fs::read_to_string(&write(&curved(PRISMS, 2)).path).unwrap();
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let told = read_text("bad.xml", &text.replacen(from, to, 1)).unwrap_err();
        assert!(told.contains("bad.xml, byte "), "{told}");
        told
    };
    assert!(refused("DIM=\"3\"", "DIM=\"4\"").contains("DIM is \"4\""));
    assert!(refused("<V ID=\"7\">", "<V ID=\"6\">").contains("VERTEX 6 is there twice"));
    assert!(refused("<E ID=\"0\"> ", "<E ID=\"0\"> 900000 ").contains("EDGE 0 has 3 numbers"));
    let end = text.split_once("<E ID=\"0\"> ").unwrap().1.split(' ').next().unwrap().to_owned();
    let told = refused(&format!("<E ID=\"0\"> {end} "), "<E ID=\"0\"> 900000 ");
    assert!(told.contains("EDGE 0 names vertex 900000"), "{told}");
    assert!(refused("NUMPOINTS=\"3\"", "NUMPOINTS=\"4\"").contains("has 3 points, and 4 are announced"));
    assert!(refused("EDGEID=\"0\"", "EDGEID=\"900000\"").contains("900000"));
    assert!(refused("TYPE=\"PolyEvenlySpaced\"", "TYPE=\"Odd\"").contains("points of \"Odd\""));
    assert!(refused("F[", "F[900000,").contains("names side 900000"));
    assert!(refused("F[", "F[0-4000000000,").contains("COMPOSITE"));
    assert!(refused("F[", "Z[").contains("no list of"));
    assert!(refused("<R ID=\"0\">", "<H ID=\"0\">").contains("XML is damaged"));
    assert!(refused("</NEKTAR>", "").contains("the file ends inside"));
    let first = text.split_once("<R ID=\"0\"> ").unwrap().1.split(' ').next().unwrap().to_owned();
    let told =
        refused(&format!("<R ID=\"0\"> {first} "), &format!("<R ID=\"0\"> {} ", first.parse::<usize>().unwrap() + 1));
    assert!(told.contains("ELEMENT 0: its faces do not close round it"), "{told}");
    let session = "<?xml version=\"1.0\"?><NEKTAR><CONDITIONS/></NEKTAR>";
    assert!(read_text("session.xml", session).unwrap_err().contains("there is no GEOMETRY"));
    let hdf5 = "<NEKTAR><GEOMETRY DIM=\"3\" SPACE=\"3\" HDF5FILE=\"m.nekg\"/></NEKTAR>";
    assert!(read_text("h.xml", hdf5).unwrap_err().contains("HDF5 file \"m.nekg\""));
}

/// Every cut and a change of every hundredth byte end in an error or a mesh, not in a crash.
#[test]
fn no_damage_crashes() {
    let bytes = std::fs::read(&write(&sample(ZOO)).path).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.xml");
    for at in (0..bytes.len()).step_by(97) {
        std::fs::write(&path, &bytes[..at]).unwrap();
        assert!(formats::read(&path).is_err(), "cut at {at}");
        let mut changed = bytes.clone();
        changed[at] = if changed[at] == b'9' { b'1' } else { b'9' };
        std::fs::write(&path, &changed).unwrap();
        let _ = formats::read(&path);
    }
}

/// Meshes of Nektar++'s own tests: volume and area are what a script finds that shares no code with the program.
#[test]
fn real_files_have_the_measures_that_an_independent_script_finds() {
    let real = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/nektar").join(name);
        formats::read(&path).unwrap()
    };
    for (name, count, volume, area) in [
        ("prism_deformed.xml", 3, 1.6, 9.669_849_982_130_405),
        ("tet_curved.xml", 24, 5.097_658_610_843_549, 18.245_035_414_215_83),
    ] {
        let mesh = real(name);
        let (ours, areas) = measure(&mesh);
        assert_eq!((mesh.cells().len(), mesh.order().get()), (count, 2), "{name}");
        assert!(
            (ours - volume).abs() < 1e-12 && (areas.values().sum::<f64>() - area).abs() < 1e-6,
            "{name}: {ours} {areas:?}"
        );
        assert!(mesh.notes().is_empty(), "{name}: {:?}", mesh.notes());
    }
    let packed = real("packed_p4.xml");
    let counts: Vec<usize> = [Cell::Hex, Cell::Prism].iter().map(|cell| packed.counts()[cell]).collect();
    assert_eq!((counts, packed.order().get(), packed.points().len()), (vec![1, 2], 4, 225));
    assert!(sagitta::certify::mesh(&packed, packed.points(), None, &sagitta::certify::Settings::default()).holds());
    assert!(sagitta::mesh::Skin::of(&packed).unmarked.is_empty());
}

/// A MeshLink file ends in `.xml` too.
#[test]
fn a_linkage_file_is_no_mesh() {
    let told = formats::read(&fixture("weeble", "meshlink.xml")).unwrap_err().to_string();
    assert!(told.contains("not a VTU or Nektar++ mesh"), "{told}");
}
