//! Damaged mesh files: what is there is held against every count, and what belongs to nothing is no mesh. Refusals have the place.

use std::path::{Path, PathBuf};

use glam::DVec3;
use sagitta::element::{Cell, Order};
use sagitta::formats;
use sagitta::mesh::{FaceKey, Mesh};
use tempfile::TempDir;

use crate::common::root;

/// A folder for damaged files.
struct Place(TempDir);

impl Place {
    fn new() -> Place {
        Place(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    fn read(&self, name: &str, content: impl AsRef<[u8]>) -> Result<Mesh, String> {
        formats::read(&self.write(name, content)).map_err(|error| error.to_string())
    }

    /// Reads a sample that must be refused with all these words.
    #[track_caller]
    fn refuses(&self, name: &str, content: impl AsRef<[u8]>, needles: &[&str]) {
        let told = self.read(name, content).map_or_else(|told| told, |_| "read".to_owned());
        assert!(told.contains(name) && needles.iter().all(|needle| told.contains(needle)), "{needles:?}: {told}");
    }
}

fn sample(name: &str) -> PathBuf {
    root().join("fixtures/samples").join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(sample(name)).unwrap()
}

/// The text with one piece replaced, which must be there.
#[track_caller]
fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from:?}");
    text.replacen(from, to, 1)
}

/// The number of the line that begins so, counted from 1.
fn line_of(text: &str, begins: &str) -> String {
    let place = text.lines().position(|line| line.starts_with(begins)).unwrap();
    format!("line {}", place + 1)
}

#[test]
fn msh_rows_end_with_their_lines() {
    let place = Place::new();
    let (old, new) = (text("hexpyrtet_p1_msh22a.msh"), text("hexpyrtet_p1_msh41a.msh"));
    // An element of version 2.2 whose entity is missing would take the next line's number as its last node.
    let row = old.lines().find(|line| line.starts_with("6 2 2 ")).unwrap();
    let short: Vec<&str> = row.split(' ').enumerate().filter(|(n, _)| *n != 4).map(|(_, word)| word).collect();
    place.refuses(
        "lost.msh",
        with(&old, row, &short.join(" ")),
        &[&line_of(&old, row), "an element does not take one line"],
    );
    place.refuses("more.msh", with(&old, row, &format!("{row} 1")), &[&line_of(&old, row), "does not take one line"]);
    let node = old.lines().find(|line| line.starts_with("9 ")).unwrap();
    let cut = node.rsplit_once(' ').unwrap().0;
    place.refuses("node.msh", with(&old, node, cut), &[&line_of(&old, node), "a node does not take one line"]);
    let (head, elements) = new.split_at(new.find("$Elements").unwrap());
    let row = elements.lines().nth(3).unwrap().trim_end();
    let cut = row.rsplit_once(' ').unwrap().0;
    let spoilt = with(elements, &format!("\n{row}"), &format!("\n{cut}"));
    place.refuses("new.msh", format!("{head}{spoilt}"), &["an element does not take one line"]);
}

#[test]
fn repeated_numbers_and_doubled_elements_are_told() {
    let place = Place::new();
    let whole = text("hexpyrtet_p1_msh22a.msh");
    let count = whole.split("$Elements\n").nth(1).unwrap().lines().next().unwrap();
    let more = |row: &str| {
        let number: usize = count.parse().unwrap();
        let whole = with(&whole, &format!("$Elements\n{count}\n"), &format!("$Elements\n{}\n", number + 1));
        with(&whole, "$EndElements", &format!("{row}\n$EndElements"))
    };
    let tet = whole.lines().find(|line| line.starts_with("99 4 2 ")).unwrap();
    place.refuses("number.msh", more(tet), &["element 99", "stands twice"]);
    let again = with(tet, "99 ", "999 ");
    place.refuses("double.msh", more(&again), &["element 999", "same corners as element 99"]);
    // The same corners, begun elsewhere.
    let words: Vec<&str> = tet.split(' ').collect();
    let turned = format!("999 {} {} {} {} {}", words[1..5].join(" "), words[7], words[8], words[6], words[5]);
    place.refuses("turned.msh", more(&turned), &["element 999", "same corners as element 99"]);
    // A face in two patches may be meant, and a collapsed cell too.
    let face =
        whole.lines().find(|line| line.starts_with("1 2 2 ")).unwrap().split(' ').skip(5).collect::<Vec<_>>().join(" ");
    let mesh = place.read("two.msh", more(&format!("999 2 2 1 99 {face}"))).unwrap();
    assert!(
        mesh.notes()[0].starts_with("1 boundary elements are in two patches (elements 1 and 999"),
        "{:?}",
        mesh.notes()
    );
    let point = words[7];
    let flat = with(&whole, tet, &format!("{} {point} {point}", words[..7].join(" ")));
    let mesh = place.read("flat.msh", flat).unwrap();
    assert!(mesh.notes()[0].contains("one node at two corners (element 99 is"), "{:?}", mesh.notes());
}

#[test]
fn vtu_counts_are_compared() {
    let place = Place::new();
    let whole = text("hexpyrtet_p1_ascii.vtu");
    place.read("whole.vtu", &whole).unwrap();
    for (from, to, needle) in [
        ("NumberOfPoints=\"67\"", "NumberOfPoints=\"5\"", "announces 5 points of a piece, but has 67"),
        ("NumberOfCells=\"220\"", "NumberOfCells=\"221\"", "announces 221 cells of a piece, but has 220"),
        ("NumberOfCells=\"220\"", "NumberOfCells=\"many\"", "many"),
        ("</VTKFile>", "", "ends inside the XML"),
    ] {
        place.refuses("counts.vtu", with(&whole, from, to), &["byte", needle]);
    }
    // Spoils the first value of an array.
    let spoilt = |name: &str, change: &dyn Fn(&str) -> String| {
        let array = whole.find(&format!("Name=\"{name}\"")).unwrap();
        let start = array + whole[array..].find('>').unwrap() + 1;
        let end = start + whole[start..].find('<').unwrap();
        format!("{}{}{}", &whole[..start], change(whole[start..end].trim()), &whole[end..])
    };
    let first =
        |by: &'static str| move |values: &str| format!("{by} {}", values.split_once(char::is_whitespace).unwrap().1);
    for (name, by) in [("connectivity", "nan"), ("connectivity", "0.5"), ("connectivity", "1e300"), ("types", "-9.5")] {
        place.refuses("value.vtu", spoilt(name, &first(by)), &["value.vtu, byte", by]);
    }
    place.refuses("negative.vtu", spoilt("connectivity", &first("-1")), &["refers to node -1"]);
    place.refuses(
        "long.vtu",
        spoilt("connectivity", &|values| format!("{values} 1 2 3")),
        &["nodes of cells of a piece"],
    );
    place.refuses(
        "short.vtu",
        spoilt("CellEntityIds", &|values| values.split_once(' ').unwrap().1.into()),
        &["CellEntityIds has 219"],
    );
    // Whole numbers as reals are whole numbers; other reals tell no patches apart.
    let same = place.read("real.vtu", spoilt("CellEntityIds", &|values| values.replace('1', "1.0"))).unwrap();
    assert_eq!(same.sides().iter().map(|side| side.entity).collect::<std::collections::BTreeSet<_>>().len(), 2);
    let unused = place.read("half.vtu", spoilt("CellEntityIds", &first("0.5"))).unwrap();
    assert!(unused.notes().iter().any(|note| note.contains("CellEntityIds is not used")), "{:?}", unused.notes());
    // What is empty within an array does not end it.
    let key = with(&whole, "Name=\"types\"", "Name=\"types\" info=\"1\"");
    let at = key.find("info=\"1\"").unwrap();
    let at = at + key[at..].find('>').unwrap() + 1;
    let keyed = format!("{}<InformationKey name=\"x\" location=\"y\"/>{}", &key[..at], &key[at..]);
    assert_eq!(
        place.read("keyed.vtu", keyed).unwrap().cells().len(),
        place.read("whole.vtu", &whole).unwrap().cells().len()
    );
}

#[test]
fn legacy_vtk_counts_are_compared() {
    let place = Place::new();
    let (old, new) = (text("cylprism_p1.vtk"), text("hexpyrtet_p1_legacy51_ascii.vtk"));
    let line = |text: &str, word: &str| text.lines().find(|line| line.starts_with(word)).unwrap().to_owned();
    for (whole, word, needle) in [
        (&old, "CELLS ", "cells (CELLS)"),
        (&old, "CELL_DATA ", "cells (CELL_DATA)"),
        (&old, "CELL_TYPES ", "line"),
        (&old, "POINTS ", "line"),
        (&new, "CELLS ", "line"),
        (&new, "CELL_DATA ", "cells (CELL_DATA)"),
    ] {
        let row = line(whole, word);
        let words: Vec<&str> = row.split(' ').collect();
        let fewer = words[1].parse::<u64>().unwrap() - 1;
        let spoilt = with(whole, &row, &format!("{} {fewer} {}", words[0], words[2..].join(" ")));
        place.refuses("counts.vtk", spoilt, &[needle]);
    }
    let twice =
        format!("{old}\n{}\n1 2 3\n", with(&line(&old, "POINTS "), " ", " 1 double x").split(" x").next().unwrap());
    place.refuses("twice.vtk", twice, &["POINTS occurs twice"]);
    // Metadata without end take no stack.
    let meta = format!("{old}\nFIELD f 1\n{}", "METADATA\n\n".repeat(200_000));
    place.refuses("meta.vtk", meta, &["ends inside a field's array"]);
}

/// The lattice points of VTK's hexahedron of 27 nodes (`vtkTriQuadraticHexahedron`), which is the same in files of all versions.
const HEX27: [[u8; 3]; 27] = [
    [0, 0, 0],
    [2, 0, 0],
    [2, 2, 0],
    [0, 2, 0],
    [0, 0, 2],
    [2, 0, 2],
    [2, 2, 2],
    [0, 2, 2], // corners
    [1, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 1, 0],
    [1, 0, 2],
    [2, 1, 2],
    [1, 2, 2],
    [0, 1, 2], // edges below and above
    [0, 0, 1],
    [2, 0, 1],
    [2, 2, 1],
    [0, 2, 1], // upright edges
    [0, 1, 1],
    [2, 1, 1],
    [1, 0, 1],
    [1, 2, 1],
    [1, 1, 0],
    [1, 1, 2],
    [1, 1, 1], // faces, centre
];

#[test]
fn the_hexahedron_of_27_nodes_has_one_order_in_all_versions() {
    let place = Place::new();
    let points: Vec<String> = HEX27.iter().map(|x| x.map(|x| x.to_string()).join(" ")).collect();
    let nodes: Vec<String> = (0..27).map(|n| n.to_string()).collect();
    for version in ["2.0", "4.2", "5.1"] {
        let cells = match version {
            "5.1" => {
                format!("CELLS 2 27\nOFFSETS vtktypeint64\n0 27\nCONNECTIVITY vtktypeint64\n{}\n", nodes.join(" "))
            }
            _ => format!("CELLS 1 28\n27 {}\n", nodes.join(" ")),
        };
        let file = format!(
            "# vtk DataFile Version {version}\nhex\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 27 double\n{}\n{cells}CELL_TYPES 1\n29\n",
            points.join("\n")
        );
        check_hex(&place.read("hex.vtk", file).unwrap(), version);
    }
    for version in ["0.1", "2.2"] {
        let array = |kind: &str, name: &str, values: String| {
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"3\" format=\"ascii\">{values}</DataArray>"
            )
        };
        let file = format!(
            "<VTKFile type=\"UnstructuredGrid\" version=\"{version}\"><UnstructuredGrid><Piece NumberOfPoints=\"27\" NumberOfCells=\"1\">\
             <Points>{}</Points><Cells>{}{}{}</Cells></Piece></UnstructuredGrid></VTKFile>",
            array("Float64", "Points", points.join(" ")),
            array("Int64", "connectivity", nodes.join(" ")),
            array("Int64", "offsets", "27".into()),
            array("UInt8", "types", "29".into()),
        );
        check_hex(&place.read("hex.vtu", file).unwrap(), version);
    }
}

/// Every node of the hex must lie where its lattice has it.
fn check_hex(mesh: &Mesh, version: &str) {
    let hex = mesh.elements_of(Cell::Hex).iter().next().unwrap();
    let lattice = sagitta::element::lattice(Cell::Hex, Order::new(2).unwrap());
    for (node, at) in hex.nodes.iter().zip(lattice) {
        assert_eq!(mesh.points()[node.index()], DVec3::from(at.map(f64::from)), "version {version}");
    }
}

#[test]
fn ugrid_bytes_behind_the_cells_are_told() {
    let place = Place::new();
    let whole = std::fs::read(sample("hexpyrtet_p1.lb8.ugrid")).unwrap();
    let mut fewer = whole.clone();
    assert_ne!(&fewer[24..28], &[0; 4]);
    fewer[24..28].fill(0); // no hexes
    place.refuses("fewer.lb8.ugrid", &fewer, &["more cells follow than the header counts"]);
    place.refuses("zeros.lb8.ugrid", [0; 1000], &["counts no nodes"]);
    let more = [&whole[..], &[0; 1000]].concat();
    let mesh = place.read("more.lb8.ugrid", more).unwrap();
    assert!(mesh.notes().iter().any(|note| note.contains("what follows the cells")), "{:?}", mesh.notes());
    let none = place.read("whole.lb8.ugrid", &whole).unwrap();
    assert!(!none.notes().iter().any(|note| note.contains("what follows")), "{:?}", none.notes());
}

#[test]
fn gmf_keywords_hold_what_they_announce() {
    let place = Place::new();
    let mut whole = std::fs::read(sample("cylprism_p1.meshb")).unwrap();
    let word = |whole: &[u8], at: usize| u32::from_le_bytes(whole[at..at + 4].try_into().unwrap());
    // Mark, version, Dimension with the next keyword's place and the dimension; then Vertices, the next keyword's place, their number.
    let wide = if word(&whole, 4) >= 3 { 8 } else { 4 };
    let vertices = 12 + wide + 4;
    assert_eq!(word(&whole, vertices), 4);
    let count = vertices + 4 + wide;
    let fewer = word(&whole, count) - 1;
    whole[count..count + 4].copy_from_slice(&fewer.to_le_bytes());
    place.refuses("fewer.meshb", &whole, &["byte", "bytes follow that belong to nothing"]);
}

/// A copy of a CGNS sample, changed.
fn cgns(place: &Place, name: &str, change: impl FnOnce(&hdf5_metno::File)) -> Result<Mesh, String> {
    let path = place.0.path().join(name);
    std::fs::copy(sample("hexpyrtet_p1.cgns"), &path).unwrap();
    let file = hdf5_metno::File::open_rw(&path).unwrap();
    change(&file);
    file.close().unwrap();
    formats::read(&path).map_err(|error| error.to_string())
}

/// Paths of a file's groups of a depth.
fn groups(file: &hdf5_metno::File, depth: usize) -> Vec<String> {
    let mut paths = vec![String::new()];
    for _ in 0..depth {
        paths = paths
            .into_iter()
            .flat_map(|path| {
                let own = if path.is_empty() { "/" } else { &path };
                let names = file.group(own).unwrap().member_names().unwrap();
                names
                    .into_iter()
                    .filter(|name| !name.starts_with(' '))
                    .map(move |name| format!("{path}/{name}"))
                    .collect::<Vec<_>>()
            })
            .filter(|path| file.group(path).is_ok())
            .collect();
    }
    paths
}

fn zone(file: &hdf5_metno::File) -> String {
    groups(file, 2).into_iter().find(|path| file.group(&format!("{path}/ZoneType")).is_ok()).unwrap()
}

#[test]
fn cgns_counts_are_compared() {
    let place = Place::new();
    cgns(&place, "whole.cgns", |_| ()).unwrap();
    let told = cgns(&place, "cells.cgns", |file| {
        let counts = file.dataset(&format!("{}/ data", zone(file))).unwrap();
        let mut values = counts.read_raw::<i64>().unwrap();
        values[1] += 1;
        counts.write_raw(&values).unwrap();
    })
    .unwrap_err();
    assert!(
        told.contains("cells.cgns, node /") && told.contains("the zone counts 123 cells, and its sections have 122"),
        "{told}"
    );
    // A base of surfaces that comes first is not the mesh.
    let mesh = cgns(&place, "bases.cgns", |file| {
        let base = groups(file, 1).into_iter().find(|path| zone(file).starts_with(&format!("{path}/"))).unwrap();
        let other = file.create_group("0surface").unwrap();
        for name in ["label", "name", "type"] {
            let text: hdf5_metno::types::FixedAscii<33> = file
                .group(&base)
                .unwrap()
                .attr(name)
                .unwrap()
                .read_scalar::<hdf5_metno::types::FixedAscii<33>>()
                .unwrap();
            other.new_attr::<hdf5_metno::types::FixedAscii<33>>().create(name).unwrap().write_scalar(&text).unwrap();
        }
        other.new_dataset::<i32>().shape([2]).create(" data").unwrap().write_raw(&[2, 3]).unwrap();
        file.link_hard(&zone(file), "/0surface/zone").unwrap();
    })
    .unwrap();
    assert_eq!(mesh.cells().len(), 122);
    assert!(mesh.notes().iter().any(|note| note.contains("2 bases")), "{:?}", mesh.notes());
}

#[test]
fn crossed_quadrilaterals_are_renumbered_along_their_cells() {
    let place = Place::new();
    let cube = "NDIME= 3\nNELEM= 1\n12 0 1 2 3 4 5 6 7\nNPOIN= 8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\nNMARK= 1\n\
        MARKER_TAG= all\nMARKER_ELEMS= 6\n9 0 1 2 3\n9 4 5 6 7\n9 0 1 5 4\n9 1 2 6 5\n9 2 3 7 6\n9 3 0 4 7\n";
    let whole = place.read("cube.su2", cube).unwrap();
    assert!(whole.notes().is_empty(), "{:?}", whole.notes());
    let crossed = cube.replacen("9 4 5 6 7\n", "9 4 6 5 7\n", 1).replacen("9 3 0 4 7", "9 3 0 7 4", 1);
    let mesh = place.read("crossed.su2", crossed).unwrap();
    assert!(mesh.notes()[0].starts_with("2 of 6 quad elements on the boundary had their corners in crossed order"));
    let keys = |mesh: &Mesh| mesh.sides().iter().map(|side| FaceKey::new(side.corners())).collect::<Vec<_>>();
    assert_eq!(keys(&mesh), keys(&whole));
}

#[test]
fn names_are_latin1_where_they_are_no_utf8() {
    let place = Place::new();
    let whole = text("hexpyrtet_p1_msh22a.msh");
    let at = whole.find("\"wall\"").unwrap() + 1;
    let bytes = [&whole.as_bytes()[..at], b"caf\xe9", &whole.as_bytes()[at + 4..]].concat();
    let mesh = place.read("latin1.msh", bytes).unwrap();
    assert!(mesh.physical_names().iter().any(|name| name.name == "café"), "{:?}", mesh.physical_names());
    // CGNS keeps text as numbers of 8 bits, with a sign or without.
    let path = place.0.path().join("latin1.cgns");
    formats::write(&path, &mesh, &formats::WriteOptions::default()).unwrap();
    assert!(formats::read(&path).unwrap().physical_names().iter().any(|name| name.name == "café"));
    let back = place.0.path().join("back.msh");
    formats::write(&back, &mesh, &formats::WriteOptions::default()).unwrap();
    assert_eq!(formats::read(&back).unwrap().physical_names(), mesh.physical_names());
}

/// A folder is no file, but may be recognised.
#[test]
fn foreign_meshes_are_named_with_a_remedy() {
    let place = Place::new();
    let case = place.0.path().join("case");
    std::fs::create_dir_all(case.join("constant/polyMesh")).unwrap();
    std::fs::write(case.join("constant/polyMesh/faces"), "").unwrap();
    let hdf5: &[u8] = b"\x89HDF\r\n\x1a\n";
    let adf: &[u8] = b"\x01\x02\x03\x04ADF Database Version";
    let foreign: [(&str, &[u8], &str, &str); 17] = [
        ("dollar.bdf", b"$ made by a mesher\nBEGIN BULK\nGRID,1,,0.,0.,0.\n", "Nastran", "gmsh"),
        ("section.bdf", b"$NODES of the wing\nGRID           1              0.      0.      0.\n", "Nastran", "gmsh"),
        ("lower.nas", b"$\ngrid,1,,0.,0.,0.\n", "Nastran", "gmsh"),
        ("comments.bdf", b"$ nothing but comments\n$ for pages\n", "Nastran", "gmsh"),
        ("fluent.msh", b"(0 \"made by\")\n(2 3)\n", "Fluent", "CGNS"),
        ("bare.msh", b"(2 3)\n(10 (0 1 8 0 3))\n", "Fluent", "CGNS"),
        ("a.msh.h5", hdf5, "Fluent", "CGNS"),
        ("points", b"/*---*\\\nFoamFile\n{\n}\n", "OpenFOAM", "polyhedra"),
        ("a.stl", b"solid a\n facet normal 0 0 1\n", "STL", "STEP"),
        ("b.stl", &[0x20; 100], "STL", "STEP"),
        ("a.inp", b"** comment\n*HEADING\n", "Abaqus", "meshio"),
        ("a.unv", b"    -1\n  2411\n", "UNV", "gmsh"),
        ("a.med", hdf5, "MED", "gmsh"),
        ("a.ccm", adf, "CCM", "CGNS"),
        ("a.msh.gz", &[0x1f, 0x8b, 8, 0], "compressed", "unpack"),
        ("a.mesh", b"MFEM NURBS mesh v1.0\n", "MFEM", "SetCurvature"),
        ("a.exo", b"CDF\x01\x00", "Exodus", "meshio"),
    ];
    let mut files: Vec<(PathBuf, &str, &str)> =
        foreign.iter().map(|&(name, content, kind, remedy)| (place.write(name, content), kind, remedy)).collect();
    files.push((case, "OpenFOAM", "another format"));
    for (path, kind, remedy) in files {
        for command in ["info", "check"] {
            let told = crate::common::sagitta(args![command, path]).expect(2).stderr;
            let name = Path::new(&path).file_name().unwrap().to_str().unwrap();
            assert!([name, kind, remedy].iter().all(|word| told.contains(word)), "{command} {name}: {told}");
        }
    }
}

/// What is behind a damaged keyword or tag is not read: that is told, or the file refused, where it is part of the mesh.
#[test]
fn what_a_damaged_keyword_would_lose_is_told() {
    let place = Place::new();
    let vtu = text("hexpyrtet_p1_ascii.vtu");
    for (from, to, needle) in [
        (" NumberOfCells=\"220\"", "", "NumberOfCells"),
        (" NumberOfPoints=\"67\"", " Number", "XML is damaged"),
        // Which version it is decides on the order of a hex' nodes.
        ("version=\"1.0\"", "\"1.0\"", "XML is damaged"),
        ("<Points>", "<Points>0.5", "expected a tag, found \"0.5\""),
        ("</VTKFile>", "</VTKFile><VTKFile></VTKFile>", "behind the end"),
    ] {
        let at = vtu.find("<VTKFile").unwrap(); // the XML's own version stands before
        place.refuses("tag.vtu", [&vtu[..at], &with(&vtu[at..], from, to)].concat(), &["byte", needle]);
    }
    let vtk = text("hexpyrtet_p1.vtk");
    place.refuses("version.vtk", with(&vtk, "Version 2.0", "Ver"), &["line 1", "Version"]);
    let missing = |section: &str| format!("the section {section} is missing");
    place.refuses("head.vtk", &vtk[..vtk.find("POINTS").unwrap()], &["line", &missing("POINTS")]);
    place.refuses("points.vtk", &vtk[..vtk.find("CELLS").unwrap()], &["line", &missing("CELLS")]);
    place.refuses("types.vtk", &vtk[..vtk.find("CELL_TYPES").unwrap()], &["line", &missing("CELL_TYPES")]);
    let su2 = text("hexpyrtet_p1.su2");
    place.refuses("twice.su2", with(&su2, "NDIME= 3", "NDIME= 3\nNDIME= 2"), &["line 2", "NDIME= stands twice"]);
    let (cells, points) = (su2.find("NELEM").unwrap(), su2.find("NPOIN").unwrap());
    place.refuses("none.su2", [&su2[..cells], &su2[points..]].concat(), &["NELEM= is missing"]);
    let msh = text("hexpyrtet_p1_msh41a.msh");
    place.refuses("name.msh", with(&msh, "\"wall\"", "\"wall\" 1"), &["line 7", "quoted name"]);
    let row = msh.lines().skip_while(|line| *line != "$Entities").nth(2).unwrap();
    let spoilt = with(row, row.split(' ').nth(2).unwrap(), "nan");
    place.refuses("box.msh", with(&msh, row, &spoilt), &["an entity's box", "NaN"]);
    let notes = |name: &str, content: String| place.read(name, content).unwrap().notes().join("; ");
    let renamed = with(&with(&msh, "$PhysicalNames", "$PhysicalName"), "$EndPhysicalNames", "$EndPhysicalName");
    assert!(notes("section.msh", renamed).contains("a section $PhysicalName, which is not known, is not used"));
    let gmf = text("hexpyrtet_p1.mesh");
    let told = notes("word.mesh", with(&gmf, "Tetrahedra", "Tetrahedro"));
    assert!(told.contains("the keyword Tetrahedro, which is not known, is not used"), "{told}");
    let told = notes("end.mesh", gmf[..gmf.rfind("End").unwrap()].to_owned());
    assert!(told.contains("no keyword End"), "{told}");
    assert!(!notes("whole.mesh", gmf).contains("keyword"));
}
