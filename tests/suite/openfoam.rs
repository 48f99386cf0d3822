//! OpenFOAM's meshes: cells made from faces, as text and binary.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use sagitta::element::Cell;
use sagitta::formats;
use sagitta::mesh::{FaceKey, Mesh, NodeId};

use crate::common::measure::measure;
use crate::common::sagitta;
use crate::common::sample::sample;

/// The files of a mesh, by the rules of OpenFOAM's user guide: faces between cells first, the owner the lower of the two.
pub(crate) struct Case {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) faces: Vec<Vec<usize>>,
    pub(crate) owner: Vec<usize>,
    pub(crate) neighbour: Vec<usize>,
    /// Name, first face, number of faces.
    pub(crate) patches: Vec<(String, usize, usize)>,
}

impl Case {
    pub(crate) fn of(mesh: &Mesh) -> Case {
        let mut sides: BTreeMap<FaceKey, Vec<(usize, Vec<NodeId>)>> = BTreeMap::new();
        for (n, cell) in mesh.cells().iter().enumerate() {
            for face in cell.cell.faces() {
                let mut own: Vec<NodeId> = face.corners.iter().map(|&c| cell.nodes[usize::from(c)]).collect();
                if !face.outward {
                    own.reverse();
                }
                own.rotate_left(n % face.corners.len());
                sides.entry(FaceKey::new(&own)).or_default().push((n, own));
            }
        }
        let mut patch_of: BTreeMap<FaceKey, String> = BTreeMap::new();
        for side in mesh.sides().iter() {
            patch_of.insert(FaceKey::new(side.corners()), mesh.label(side.entity));
        }
        let mut inner: Vec<_> = sides.iter().filter(|(_, own)| own.len() == 2).map(|(_, own)| own).collect();
        inner.sort_by_key(|own| (own[0].0, own[1].0));
        let mut case = Case {
            points: mesh.points().iter().map(|x| x.to_array()).collect(),
            faces: Vec::new(),
            owner: Vec::new(),
            neighbour: inner.iter().map(|own| own[1].0).collect(),
            patches: Vec::new(),
        };
        let push = |case: &mut Case, (n, face): &(usize, Vec<NodeId>)| {
            case.faces.push(face.iter().map(|node| node.index()).collect());
            case.owner.push(*n);
        };
        inner.iter().for_each(|own| push(&mut case, &own[0]));
        for name in patch_of.values().collect::<BTreeSet<_>>() {
            let first = case.faces.len();
            let own = sides.iter().filter(|(key, own)| own.len() == 1 && patch_of.get(key) == Some(name));
            own.for_each(|(_, own)| push(&mut case, &own[0]));
            case.patches.push((name.clone(), first, case.faces.len() - first));
        }
        case
    }

    /// Writes the case; whole numbers of `label` bits where it is binary.
    fn write(&self, folder: &Path, binary: Option<usize>) -> PathBuf {
        let mesh = folder.join("constant/polyMesh");
        std::fs::create_dir_all(&mesh).unwrap();
        let header = |class: &str| {
            let (format, label) = binary.map_or(("ascii", 32), |label| ("binary", label));
            format!(
                "/*---*\\\n  a banner with FoamFile in it? no\n\\*---*/\nFoamFile\n{{\n    version 2.0;\n    format {format};\n    \
                 arch \"LSB;label={label};scalar=64\";\n    class {class};\n    object x;\n}}\n// * * *\n\n"
            )
        };
        let labels = |values: &[usize]| -> Vec<u8> {
            let mut bytes = format!("{}\n(", values.len()).into_bytes();
            for value in values {
                match binary {
                    None => bytes.extend(format!("\n{value}").into_bytes()),
                    Some(64) => bytes.extend((*value as i64).to_le_bytes()),
                    Some(_) => bytes.extend((*value as i32).to_le_bytes()),
                }
            }
            bytes.extend(b")\n");
            bytes
        };
        let file = |name: &str, class: &str, content: Vec<u8>| {
            std::fs::write(mesh.join(name), [header(class).into_bytes(), content].concat()).unwrap();
        };
        let mut points = format!("{}\n(", self.points.len()).into_bytes();
        for x in &self.points {
            match binary {
                None => points.extend(format!("\n({:?} {:?} {:?})", x[0], x[1], x[2]).into_bytes()),
                Some(_) => x.iter().for_each(|x| points.extend(x.to_le_bytes())),
            }
        }
        points.extend(b")\n");
        file("points", "vectorField", points);
        if binary.is_some() {
            let mut starts = vec![0];
            self.faces.iter().for_each(|face| starts.push(starts.last().unwrap() + face.len()));
            file("faces", "faceCompactList", [labels(&starts), labels(&self.faces.concat())].concat());
        } else {
            let mut text = format!("{}\n(\n", self.faces.len());
            for face in &self.faces {
                let corners: Vec<String> = face.iter().map(usize::to_string).collect();
                writeln!(text, "{}({})", face.len(), corners.join(" ")).unwrap();
            }
            file("faces", "faceList", format!("{text})\n").into_bytes());
        }
        file("owner", "labelList", labels(&self.owner));
        file("neighbour", "labelList", labels(&self.neighbour));
        let mut text = format!("{}\n(\n", self.patches.len());
        for (name, first, count) in &self.patches {
            writeln!(text, "    {name}\n    {{\n        type patch; // or wall\n        inGroups 1(walls);\n        nFaces {count};\n        startFace {first};\n    }}").unwrap();
        }
        // The list of patches is text in any case.
        let text_header = header("polyBoundaryMesh").replace("binary", "ascii");
        std::fs::write(mesh.join("boundary"), format!("{text_header}{text})\n")).unwrap();
        folder.to_owned()
    }
}

/// Cells as sets of their corners, sides by name as sets of theirs.
pub(crate) fn content(mesh: &Mesh) -> BTreeMap<(Cell, String), BTreeSet<Vec<[u64; 3]>>> {
    let mut found: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    for block in mesh.blocks().iter().filter(|block| block.cell.dimension() >= 2) {
        let name = if block.cell.dimension() == 2 { mesh.label(block.entity) } else { String::new() };
        for nodes in block.elements(mesh.order()) {
            let mut points: Vec<_> = mesh.points_of(nodes).map(|x| x.to_array().map(f64::to_bits)).collect();
            points.sort_unstable();
            found.entry((block.cell, name.clone())).or_default().insert(points);
        }
    }
    found
}

#[test]
fn cells_are_made_from_faces() {
    for name in ["hexpyrtet_p1_msh41b.msh", "cylprism_p1_msh41b.msh"] {
        let mesh = sample(name);
        for binary in [None, Some(32), Some(64)] {
            let folder = tempfile::tempdir().unwrap();
            let case = Case::of(&mesh).write(folder.path(), binary);
            let again = formats::read(&case).unwrap();
            assert_eq!(content(&again), content(&mesh), "{name} {binary:?}");
            assert!((measure(&again).0 - measure(&mesh).0).abs() < 1e-13);
            assert!(again.notes().is_empty(), "{:?}", again.notes());
            std::fs::write(case.join("case.foam"), "").unwrap();
            for path in ["case.foam", "constant/polyMesh", "constant/polyMesh/faces"] {
                assert_eq!(formats::read(&case.join(path)).unwrap(), again, "{path}");
            }
        }
    }
}

#[test]
fn the_program_takes_the_cases_folder() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::of(&sample("hexpyrtet_p1_msh41b.msh")).write(folder.path(), None);
    let told = sagitta(args!["info", case]).expect(0).stdout;
    assert!(told.contains("8 hex, 4 pyramid") && told.contains("faces farfield"), "{told}");
    let out = folder.path().join("out.msh");
    sagitta(args!["convert", case, "-o", out]).expect(0);
    assert_eq!(formats::read(&out).unwrap().cells().len(), 122);
}

#[test]
fn what_is_no_standard_cell_is_refused_with_its_number_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = sample("hexpyrtet_p1_msh41b.msh");
    let refused = |spoil: &dyn Fn(&mut Case)| {
        let mut case = Case::of(&mesh);
        spoil(&mut case);
        formats::read(&case.write(folder.path(), None)).unwrap_err().to_string()
    };
    // Two tets that share a face become one polyhedron of six triangles.
    let told = refused(&|case| {
        let is_tet = |n: usize| case.owner.iter().chain(&case.neighbour).filter(|&&own| own == n).count() == 4;
        let face = (0..case.neighbour.len()).find(|&f| is_tet(case.owner[f]) && is_tet(case.neighbour[f])).unwrap();
        let (kept, gone) = (case.owner[face], case.neighbour.remove(face));
        case.owner.remove(face);
        case.faces.remove(face);
        case.owner.iter_mut().chain(&mut case.neighbour).filter(|own| **own == gone).for_each(|own| *own = kept);
        case.patches.iter_mut().for_each(|patch| patch.1 -= 1);
    });
    assert!(told.contains("6 faces (6 of 3 corners)") && told.contains("near ("), "{told}");
    assert!(told.contains("polyhedra cannot be curved"), "{told}");
    let told = refused(&|case| case.faces[3][0] = 9999);
    assert!(told.contains("faces, line") && told.contains("9999"), "{told}");
    let told = refused(&|case| case.owner[3] = 900_000_000);
    assert!(told.contains("face 3 names owner 900000000"), "{told}");
    let told = refused(&|case| case.owner.truncate(5));
    assert!(told.contains("5 owners for"), "{told}");
    let told = refused(&|case| case.patches[0].2 = 4000);
    assert!(told.contains("boundary, line") && told.contains("the patch farfield has the faces"), "{told}");
}

#[test]
fn cut_and_foreign_files_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::of(&sample("cylprism_p1_msh41b.msh"));
    for binary in [None, Some(32)] {
        for name in ["points", "faces", "owner", "neighbour", "boundary"] {
            let path = case.write(folder.path(), binary).join("constant/polyMesh").join(name);
            let bytes = std::fs::read(&path).unwrap();
            for part in [1, 30, 60, 90] {
                std::fs::write(&path, &bytes[..bytes.len() * part / 100]).unwrap();
                let told = formats::read(folder.path()).unwrap_err().to_string();
                assert!(told.contains(name), "{name} {part}: {told}");
            }
            std::fs::write(&path, String::from_utf8_lossy(&bytes).replace("class ", "class other")).unwrap();
            assert!(formats::read(folder.path()).is_err());
            std::fs::remove_file(&path).unwrap();
            assert!(formats::read(folder.path()).is_err(), "{name}");
        }
    }
    case.write(folder.path(), None);
    let points = folder.path().join("constant/polyMesh/points");
    let text = std::fs::read_to_string(&points).unwrap();
    std::fs::write(&points, text.replacen("273\n(", "2730000000\n(", 1)).unwrap();
    let told = formats::read(folder.path()).unwrap_err().to_string();
    assert!(told.contains("2730000000 points do not fit"), "{told}");
    std::fs::write(&points, text.replace("LSB", "MSB")).unwrap();
    assert!(formats::read(folder.path()).unwrap_err().to_string().contains("big-endian"));
}

/// Whoever unpacks a case of others may find a pipe in it.
#[test]
fn a_pipe_in_the_place_of_a_file_is_not_waited_for() {
    let dir = tempfile::tempdir().unwrap();
    Case::of(&sample("hexpyrtet_p1_msh41a.msh")).write(dir.path(), None);
    for name in ["points", "owner", "neighbour", "boundary"] {
        let file = dir.path().join("constant/polyMesh").join(name);
        let kept = std::fs::read(&file).unwrap();
        std::fs::remove_file(&file).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&file).status().unwrap().success());
        let told = sagitta(args!["info", dir.path()]).expect(2).stderr;
        assert!(told.contains(name) && told.contains("not a regular file"), "{told}");
        std::fs::remove_file(&file).unwrap();
        std::fs::write(&file, kept).unwrap();
    }
    sagitta(args!["info", dir.path()]).expect(0);
}
