//! Mesh files of other programs: we find in them what other programs find.
//!
//! What those find stands in `fixtures/samples/figures.json`, made by `tests/judge/figures.py`. `SAGITTA_SAMPLES=DIR` reads
//! further files whose figures stand there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::common::measure::measure;
use sagitta::element::Order;
use sagitta::formats::{self, ReadOptions};
use sagitta::mesh::{EntityKey, Mesh};
use serde_json::Value;

/// Files that are refused, and what is told of them.
const REFUSED: [(&str, &str); 11] = [
    ("ngon.cgns", "/Base/blk-1/Cells: arbitrary polyhedra (NGON_n, NFACE_n), which cannot be curved; export the mesh"),
    ("box_msh40a.msh", "MSH version 4 is not read; save as version 4.1 or 2.2"),
    ("hexpyrtet_p1.unv", "universal file (UNV), which is not read; convert it: gmsh"),
    ("cylprism_p1.unv", "universal file (UNV)"),
    ("circle2d_p1.unv", "universal file (UNV)"),
    // Gmsh puts cells of higher order under VTK's numbers of linear ones.
    ("hexpyrtet_p2.vtk", "cell 217 of type 14 has 14 nodes"),
    ("hexpyrtet_p3.vtk", "cell 1 of type 9 has 16 nodes"),
    ("circle2d_p3.vtk", "cell 297 of type 9 has 16 nodes"),
    ("circle2d_p4.vtk", "cell 297 of type 9 has 25 nodes"),
    ("hexpyrtet_p2_app_raw.vtu", "cell 217 of type 14 has 14 nodes"),
    ("hexpyrtet_p2_ascii.vtu", "cell 217 of type 14 has 14 nodes"),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples")
}

fn files() -> Vec<PathBuf> {
    let mut folders = vec![folder()];
    if let Some(more) = std::env::var_os("SAGITTA_SAMPLES").map(PathBuf::from) {
        folders.extend([more.clone(), more.join("single"), more.join("single_cgns")]);
    }
    let known = ["msh", "cgns", "su2", "vtk", "vtu", "ugrid", "unv", "mesh", "meshb"];
    let mut files: Vec<PathBuf> = folders
        .iter()
        .filter_map(|folder| std::fs::read_dir(folder).ok())
        .flat_map(|entries| entries.map(|entry| entry.unwrap().path()))
        .filter(|file| file.extension().is_some_and(|e| known.iter().any(|known| e == *known)))
        .collect();
    files.sort();
    assert!(files.len() > 60);
    files
}

/// Reading CGNS takes the program itself.
fn read(path: &Path) -> Result<Mesh, formats::Error> {
    formats::read_with(
        path,
        &ReadOptions { reader: Some(env!("CARGO_BIN_EXE_sagitta").into()), ..ReadOptions::default() },
    )
}

fn counts(mesh: &Mesh) -> BTreeMap<String, u64> {
    mesh.counts().into_iter().map(|(cell, count)| (cell.name().to_owned(), count as u64)).collect()
}

fn name(path: &Path) -> String {
    path.file_name().unwrap().to_str().unwrap().to_owned()
}

/// Areas under the keys that the other program uses.
fn areas(mesh: &Mesh, found: BTreeMap<EntityKey, f64>, by: &str) -> BTreeMap<String, f64> {
    let mut areas = BTreeMap::new();
    for (entity, area) in found {
        let key = match by {
            "name" => mesh.names_of(entity).first().cloned().unwrap_or_default(),
            _ => entity.tag.to_string(),
        };
        *areas.entry(key).or_default() += area;
    }
    areas
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs().max(1e-3)
}

fn compare(file: &str, mesh: &Mesh, theirs: &Value) {
    let counted = counts(mesh);
    let cells: BTreeMap<String, u64> = serde_json::from_value(theirs["cells"].clone()).unwrap();
    for (cell, count) in &cells {
        assert_eq!(counted.get(cell), Some(count), "{file}: {cell}");
    }
    if let Some(nodes) = theirs["nodes"].as_u64() {
        assert_eq!(mesh.points().len() as u64, nodes, "{file}: nodes");
    }
    let (volume, found) = measure(mesh);
    let tolerance = theirs["tolerance"].as_f64().unwrap_or(1e-9);
    let expected = theirs["volume"].as_f64().unwrap();
    // meshio's UGRID reader takes text as single precision, and sums in the file's precision.
    let single = file == "hexpyrtet_p1.ugrid" || file.contains("b4.ugrid");
    let tolerance = if single { 1e-6 } else { tolerance };
    assert!(close(volume, expected, tolerance), "{file}: volume {volume}, theirs {expected}");
    let Some(expected) = theirs["areas"].as_object() else { return };
    // The area of a curved face is no polynomial: quadratures differ.
    let tolerance = if mesh.order() > Order::LINEAR { tolerance.max(1e-7) } else { tolerance };
    if !mesh.is_volume() {
        let (ours, theirs) = (found.values().sum::<f64>(), expected[""].as_f64().unwrap());
        assert!(close(ours, theirs, tolerance), "{file}: area {ours}, theirs {theirs}");
        return;
    }
    let mut ours = areas(mesh, found, theirs["by"].as_str().unwrap());
    // Gmsh numbers the patches of a CGNS file that names none by itself.
    if file == "rust_hexa27.cgns" {
        ours = ours.into_values().map(|area| ("2".to_owned(), area)).collect();
    }
    assert_eq!(ours.len(), expected.len(), "{file}: patches {:?}, theirs {:?}", ours.keys(), expected.keys());
    for (patch, area) in expected {
        let (ours, theirs) = (ours.get(patch).copied().unwrap_or(f64::NAN), area.as_f64().unwrap());
        assert!(close(ours, theirs, tolerance), "{file}: area of {patch} {ours}, theirs {theirs}");
    }
}

#[test]
fn files_hold_for_us_what_they_hold_for_other_programs() {
    let figures: Value = serde_json::from_slice(&std::fs::read(folder().join("figures.json")).unwrap()).unwrap();
    let (mut compared, mut alone) = (0, Vec::new());
    for path in files() {
        let file = name(&path);
        if REFUSED.iter().any(|(refused, _)| *refused == file) {
            continue;
        }
        let mesh = match read(&path) {
            Err(error) if error.to_string().contains("adf2hdf, which rewrites it, is not installed") => {
                crate::common::warn(&format!("adf2hdf (Debian package cgns-convert) is missing: {file} is NOT read"));
                continue;
            }
            read => read.unwrap_or_else(|error| panic!("{error}")),
        };
        let theirs = &figures[&file];
        assert!(theirs.is_object(), "{file} has figures");
        if theirs["unread"].is_array() {
            alone.push(file);
        } else if file.starts_with("structured") {
            // Gmsh makes faces of all sides of zones, and joins no zone to itself.
            let hexes = theirs["cells"]["hex"].as_u64();
            assert_eq!(counts(&mesh).get("hex").copied(), hexes, "{file}");
            assert_eq!(hexes.map(|_| mesh.points().len() as u64), hexes.and(theirs["nodes"].as_u64()), "{file}");
            let area = theirs["areas"][""].as_f64();
            let (volume, found) = measure(&mesh);
            let (ours, wanted) =
                area.map_or((volume, theirs["volume"].as_f64().unwrap()), |area| (found.values().sum(), area));
            assert!(close(ours, wanted, 1e-9), "{file}: {ours}, theirs {wanted}");
            compared += 1;
        } else if !file.starts_with("partitioned") {
            // Partitioned files hold elements between the parts, which only they have.
            compare(&file, &mesh, theirs);
            compared += 1;
        }
    }
    println!("{compared} files compared; read by us alone: {alone:?}");
    assert!(compared >= 55 && alone.len() < 15, "{compared}, {alone:?}");
}

#[test]
fn what_is_refused_is_told_with_a_remedy() {
    let mut refused = 0;
    for path in files() {
        let Some((_, told)) = REFUSED.iter().find(|(file, _)| *file == name(&path)) else { continue };
        let error = read(&path).unwrap_err().to_string();
        assert!(error.starts_with(path.to_str().unwrap()) && error.contains(told), "{error}");
        refused += 1;
    }
    assert!(refused >= 3);
}

#[test]
fn prisms_that_are_numbered_the_other_way_round_are_turned_and_it_is_told() {
    for file in ["cylprism_p1.su2", "cylprism_p1.vtk", "cylprism_p1_ascii.vtu"] {
        let mesh = read(&folder().join(file)).unwrap();
        let told = "294 of 294 prism cells were numbered the other way round (negative volume) and were renumbered";
        assert_eq!(mesh.notes(), [told], "{file}");
        assert!(
            sagitta::certify::mesh(&mesh, mesh.points(), None, &sagitta::certify::Settings::default()).holds(),
            "{file}"
        );
    }
    assert!(read(&folder().join("cylprism_p1.lb8.ugrid")).unwrap().notes().is_empty());
}

#[test]
fn ugrid_names_come_from_the_mapbc_file() {
    let mesh = read(&folder().join("hexpyrtet_p1.lb8.ugrid")).unwrap();
    let text = std::fs::read_to_string(folder().join("hexpyrtet_p1.mapbc")).unwrap();
    let mut named = 0;
    for line in text.lines().skip(1).filter(|line| !line.contains("V_")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let key = EntityKey::new(2, words[0].parse().unwrap());
        assert_eq!(mesh.names_of(key), [words[2]]);
        named += 1;
    }
    assert_eq!(named, 10);
    // Without it, the numbers stay, and it is told.
    let dir = tempfile::tempdir().unwrap();
    let copy = dir.path().join("mesh.lb8.ugrid");
    std::fs::copy(folder().join("hexpyrtet_p1.lb8.ugrid"), &copy).unwrap();
    let bare = read(&copy).unwrap();
    assert!(bare.notes().iter().any(|note| note.contains("no .mapbc file")), "{:?}", bare.notes());
    assert!(bare.physical_names().iter().all(|name| name.dimension == 3) && bare.entities().len() == 11);
    // A name that says another kind is not believed, and the kind that fits is told.
    let wrong = dir.path().join("mesh.b8.ugrid");
    std::fs::copy(folder().join("hexpyrtet_p1.lb8.ugrid"), &wrong).unwrap();
    let told = read(&wrong).unwrap_err().to_string();
    assert!(told.contains("its name says b8") && told.contains("it looks like lb8"), "{told}");
    // No word in the name: the sizes tell.
    for kind in ["b8", "lb8", "b4", "lb4", "r8", "lr8", "lb8l"] {
        let plain = dir.path().join("plain.ugrid");
        std::fs::copy(folder().join(format!("hexpyrtet_p1.{kind}.ugrid")), &plain).unwrap();
        let found = read(&plain).unwrap();
        let far = mesh.points().iter().zip(found.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(far <= if kind.ends_with('4') { 1e-7 } else { 0.0 }, "{kind}: {far}");
        assert_eq!(found.blocks(), mesh.blocks(), "{kind}");
    }
}

#[test]
fn cgns_conditions_are_found_by_list_range_vertices_and_family() {
    for file in ["mixed_bc.cgns", "mixed_bc_pre34_nooffset.cgns"] {
        let mesh = read(&folder().join(file)).unwrap();
        let kinds: BTreeMap<&str, (&str, usize)> = mesh
            .conditions()
            .iter()
            .map(|condition| {
                let faces = mesh.blocks().iter().filter(|block| block.entity == condition.entity);
                (condition.name.as_str(), (condition.kind.as_str(), faces.map(|block| block.tags.len()).sum()))
            })
            .collect();
        assert_eq!(kinds["wall_list"], ("BCWallViscous", 2), "{file}");
        assert_eq!(kinds["far_range"], ("BCFarfield", 3), "{file}");
        assert_eq!(kinds["direct_elementrange"], ("BCSymmetryPlane", 4), "{file}");
        // Its one face belongs to the list.
        assert!(mesh.notes().iter().any(|note| note.contains("vertex_list: has no face")), "{:?}", mesh.notes());
        let mut names: Vec<&str> = mesh.physical_names().iter().map(|name| name.name.as_str()).collect();
        names.sort_unstable();
        assert_eq!(names, ["Far", "Wall", "direct_elementrange", "fluid"], "{file}");
    }
}

/// A grid of 2 x 1 x 1 cells in two blocks, written in every way.
#[test]
fn plot3d_is_read_in_every_way_it_is_written() {
    let dir = tempfile::tempdir().unwrap();
    // Two unit cubes side by side along x.
    let block = |start: f64| -> Vec<[f64; 3]> {
        (0..8).map(|n| [start + f64::from(n & 1), f64::from(n >> 1 & 1), f64::from(n >> 2)]).collect()
    };
    let blocks = [block(0.0), block(1.0)];
    let mut ways = 0;
    for several in [false, true] {
        for (text, records) in [(true, false), (false, false), (false, true)] {
            for (short, big, blanks) in [0, 1, 2, 3, 4, 5, 6, 7].map(|n| (n & 1 != 0, n & 2 != 0, n & 4 != 0)) {
                let used = if several { &blocks[..] } else { &blocks[..1] };
                let content = if text {
                    grid_text(used, several, blanks)
                } else {
                    grid_bytes(used, several, records, short, big, blanks)
                };
                let path = dir.path().join("grid.x");
                std::fs::write(&path, content).unwrap();
                let mesh =
                    read(&path).unwrap_or_else(|e| panic!("{several} {text} {records} {short} {big} {blanks}: {e}"));
                let (volume, areas) = measure(&mesh);
                assert!((volume - used.len() as f64).abs() < 1e-12, "{volume}");
                assert_eq!(mesh.points().len(), if several { 12 } else { 8 });
                assert_eq!(areas.len(), if several { 10 } else { 6 }, "the common side is no patch");
                assert_eq!(mesh.zones().len(), if several { 2 } else { 0 });
                ways += 1;
            }
        }
    }
    assert_eq!(ways, 48);
    let mesh = read(&dir.path().join("grid.x")).unwrap();
    assert_eq!(mesh.zones()[1].name, "/Base/blk-2");
    let far = mesh.points()[mesh.zones()[1].nodes[7].index()];
    assert_eq!(far.to_array(), [2.0, 1.0, 1.0], "the last point of the second block");
    assert_eq!(mesh.names_of(EntityKey::new(2, 1)), ["blk-1_imin"]);
    assert_eq!(mesh.order(), Order::LINEAR);
}

fn grid_text(blocks: &[Vec<[f64; 3]>], several: bool, blanks: bool) -> Vec<u8> {
    let mut text = if several { format!("{}\n", blocks.len()) } else { String::new() };
    blocks.iter().for_each(|_| text += "2 2 2\n");
    for block in blocks {
        // As Fortran repeats numbers.
        let x = block[0][0];
        text += &format!("{x} {} {x} {} {x} {} {x} {}\n", x + 1.0, x + 1.0, x + 1.0, x + 1.0);
        text += "2*0.0 2*1.0 2*0.0D+00 2*1.0\n4*0 4*1\n";
        text += if blanks { "8*1\n" } else { "" };
    }
    text.into_bytes()
}

fn grid_bytes(blocks: &[Vec<[f64; 3]>], several: bool, records: bool, short: bool, big: bool, blanks: bool) -> Vec<u8> {
    let int = |n: i32| if big { n.to_be_bytes() } else { n.to_le_bytes() }.to_vec();
    let real = |x: f64| match (short, big) {
        (false, true) => x.to_be_bytes().to_vec(),
        (false, false) => x.to_le_bytes().to_vec(),
        (true, true) => (x as f32).to_be_bytes().to_vec(),
        (true, false) => (x as f32).to_le_bytes().to_vec(),
    };
    let record = |content: Vec<u8>| {
        let marker = if records { int(content.len() as i32) } else { Vec::new() };
        [marker.clone(), content, marker].concat()
    };
    let mut bytes = if several { record(int(blocks.len() as i32)) } else { Vec::new() };
    bytes.extend(record(blocks.iter().flat_map(|_| [2, 2, 2]).flat_map(int).collect()));
    for block in blocks {
        let mut content: Vec<u8> = (0..3).flat_map(|axis| block.iter().map(move |x| x[axis])).flat_map(real).collect();
        content.extend(block.iter().filter(|_| blanks).flat_map(|_| int(1)));
        bytes.extend(record(content));
    }
    bytes
}

/// Two zones that list their common points become one mesh; each keeps its own numbers. Neither has boundary elements: the
/// faces of the conditions come from the cells.
#[test]
fn zones_are_joined_and_conditions_on_vertices_find_their_faces() {
    let mesh = read(&folder().join("two_zones.cgns")).unwrap();
    assert_eq!((mesh.points().len(), mesh.cells().len(), mesh.sides().len()), (12, 2, 2));
    let names: Vec<&str> = mesh.zones().iter().map(|zone| zone.name.as_str()).collect();
    assert_eq!(names, ["/Base/left", "/Base/right"]);
    let [left, right] = [0, 1].map(|n| &mesh.zones()[n].nodes);
    assert_eq!((left.len(), right.len()), (8, 8));
    assert_eq!([left[1], left[2], left[6], left[5]], [right[0], right[3], right[7], right[4]], "the common side");
    let (volume, areas) = measure(&mesh);
    assert!(
        (volume - 2.0).abs() < 1e-11 && areas.values().all(|area| (area - 1.0).abs() < 1e-11),
        "{volume} {areas:?}"
    );
    let sides: BTreeMap<&str, f64> = mesh
        .conditions()
        .iter()
        .map(|condition| {
            let block = mesh.blocks().iter().find(|block| block.entity == condition.entity).unwrap();
            (condition.kind.as_str(), mesh.points_of(&block.nodes).map(|x| x.x).sum::<f64>() / 4.0)
        })
        .collect();
    assert!(sides["BCInflow"] == 0.0 && (sides["BCOutflow"] - 2.0).abs() < 1e-11, "{sides:?}");
    assert!(mesh.notes().is_empty(), "{:?}", mesh.notes());
}
