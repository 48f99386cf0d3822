//! Hostile files: they cost an error, and neither the machine nor what stands in other files.

use std::io::Write;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::common::{fixture, root, sagitta};

fn place() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn write(dir: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = dir.path().join(name);
    std::fs::write(&path, content).unwrap();
    path
}

/// Runs a command that must end soon with one line on stderr that has the words.
#[track_caller]
fn refused<const N: usize>(arguments: [std::ffi::OsString; N], needles: &[&str]) {
    let start = Instant::now();
    let told = sagitta(&arguments).expect(2).stderr;
    assert!(told.lines().count() == 1 && needles.iter().all(|needle| told.contains(needle)), "{needles:?}: {told}");
    assert!(start.elapsed() < Duration::from_secs(30), "{arguments:?} took {:?}", start.elapsed());
}

#[test]
fn pipes_and_devices_are_not_waited_for() {
    let dir = place();
    let (msh, step, xml) = (dir.path().join("f.msh"), dir.path().join("f.step"), dir.path().join("f.xml"));
    for pipe in [&msh, &step, &xml] {
        assert!(Command::new("mkfifo").arg(pipe).status().unwrap().success());
    }
    let (mesh, cad) = (fixture("plate", "msh"), fixture("plate", "step"));
    let out = dir.path().join("out.msh");
    let what = "not a regular file";
    refused(args!["info", msh], &["f.msh", what]);
    refused(args!["check", msh], &["f.msh", what]);
    refused(args!["convert", msh, "-o", out], &["f.msh", what]);
    refused(args!["curve", "-q", msh, "--cad", cad, "--order", "2", "-o", out], &["f.msh", what]);
    refused(args!["curve", "-q", mesh, "--cad", step, "--order", "2", "-o", out], &["f.step", what]);
    refused(args!["curve", "-q", mesh, "--cad", cad, "--linkage", xml, "--order", "2", "-o", out], &["f.xml", what]);
    refused(args!["groups", step], &["f.step", what]);
    refused(args!["project", "-q", cad, msh], &["f.msh", what]);
    for device in ["/dev/zero", "/dev/stdin"] {
        refused(args!["info", device], &[device, what]);
        refused(args!["project", "-q", cad, device], &[device, what]);
    }
}

#[test]
fn files_that_no_memory_holds_are_refused_at_once() {
    let dir = place();
    for name in ["a.msh", "a.lb8.ugrid", "a.vtu", "a.su2", "a.x", "a.cgns"] {
        let path = dir.path().join(name);
        let mut file = std::fs::File::create(&path).unwrap();
        let head: &[u8] = match name {
            "a.msh" => b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
            "a.vtu" => b"<VTKFile type=\"UnstructuredGrid\">",
            "a.su2" => b"NDIME= 3\n",
            "a.cgns" => b"\x89HDF\r\n\x1a\n",
            _ => b"",
        };
        file.write_all(head).unwrap();
        file.set_len(1 << 42).unwrap();
        refused(args!["info", path], &[name, "--memory-limit"]);
    }
    let mesh = fixture("weeble", "msh");
    sagitta(args!["info", mesh, "--memory-limit", "64M"]).expect(0);
    for wrong in ["0", "1M", "many"] {
        let told = sagitta(args!["info", mesh, "--memory-limit", wrong]).expect(2).stderr;
        assert!(told.contains("--memory-limit") && told.contains("64M"), "{told}");
    }
}

/// A VTU file of compressed points.
fn vtu(compressor: &str, points: u64, size: u64, block: &[u8]) -> Vec<u8> {
    let head = format!(
        "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"{compressor}\">\
         <UnstructuredGrid><Piece NumberOfPoints=\"{points}\" NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" Name=\"Points\" \
         NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_"
    );
    let header: Vec<u8> = [1, size, 0, block.len() as u64].into_iter().flat_map(u64::to_le_bytes).collect();
    [head.as_bytes(), &header, block].concat()
}

#[test]
fn arrays_expand_to_what_they_announce_and_no_more() {
    let dir = place();
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    let piece = vec![0; 1 << 20];
    (0..192).for_each(|_| packer.write_all(&piece).unwrap());
    let bomb = packer.finish().unwrap();
    assert!(bomb.len() < 1 << 18);
    for (name, compressor) in [
        ("zlib.vtu", "vtkZLibDataCompressor"),
        ("lzma.vtu", "vtkLZMADataCompressor"),
        ("lz4.vtu", "vtkLZ4DataCompressor"),
    ] {
        // More than the piece's points need, more than a file of this length can mean, more than the block holds.
        let path = write(&dir, name, vtu(compressor, 1, 192 << 20, &bomb));
        refused(args!["info", path], &[name, "201326592 bytes when expanded, but no more than 24"]);
        let path = write(&dir, name, vtu(compressor, (192 << 20) / 24, 192 << 20, &bomb));
        refused(args!["info", path], &[name, "201326592 bytes when expanded"]);
    }
    let path = write(&dir, "less.vtu", vtu("vtkZLibDataCompressor", 1, 24, &bomb));
    refused(args!["info", path], &["less.vtu", "24 bytes of a block, but has 25"]);
}

/// A copy of a CGNS sample, changed, and a name of one of its groups that holds text.
fn cgns(dir: &TempDir, name: &str, change: impl FnOnce(&hdf5_metno::File, &str)) -> PathBuf {
    let path = dir.path().join(name);
    std::fs::copy(root().join("fixtures/samples/mixed_bc.cgns"), &path).unwrap();
    let file = hdf5_metno::File::open_rw(&path).unwrap();
    let base = file.member_names().unwrap().into_iter().find(|name| name == "Base").unwrap();
    change(&file, &format!("/{base}"));
    file.close().unwrap();
    path
}

/// The first node of the zone's coordinates, by its path.
fn coordinate(file: &hdf5_metno::File, base: &str) -> String {
    let zones = file.group(base).unwrap().member_names().unwrap();
    let zone = zones.into_iter().find(|zone| file.group(&format!("{base}/{zone}/GridCoordinates")).is_ok()).unwrap();
    format!("{base}/{zone}/GridCoordinates/CoordinateX")
}

#[test]
fn cgns_files_hand_nothing_on_from_other_files() {
    let dir = place();
    let secret = write(&dir, "secret", "root:x:0:0:root:/root:/bin/bash\n".repeat(1 << 12));
    let other = cgns(&dir, "other.cgns", |_, _| ());
    let (secret, other) = (secret.to_str().unwrap(), other.to_str().unwrap());
    sagitta(args!["info", other]).expect(0);
    let external = cgns(&dir, "external.cgns", |file, base| {
        let node = coordinate(file, base);
        let set = format!("{node}/ data");
        let length = file.dataset(&set).unwrap().size();
        file.unlink(&set).unwrap();
        let group = file.group(&node).unwrap();
        let builder = group.new_dataset::<f64>().with_dcpl(|plist| plist.external(secret, 0, length * 8));
        builder.shape([length]).create(" data").unwrap();
    });
    refused(
        args!["info", external],
        &["external.cgns, node /Base/", "/CoordinateX", "of another file, which is not followed"],
    );
    let link = cgns(&dir, "link.cgns", |file, base| {
        let node = coordinate(file, base);
        file.unlink(&node).unwrap();
        file.link_external(other, &node, &node).unwrap();
    });
    refused(args!["info", link], &["link.cgns, node /Base/", "a link to a node of another file"]);
    let through = cgns(&dir, "through.cgns", |file, base| {
        let node = coordinate(file, base);
        file.unlink(&node).unwrap();
        file.link_external(other, "/", "/ door").unwrap();
        file.link_soft(&format!("/ door{node}"), &node).unwrap();
    });
    refused(args!["info", through], &["through.cgns, node /Base/", "a link to a node of another file"]);
    let array = cgns(&dir, "array.cgns", |file, base| {
        let set = format!("{}/ data", coordinate(file, base));
        file.unlink(&set).unwrap();
        file.link_external(other, &set, &set).unwrap();
    });
    refused(args!["info", array], &["array.cgns, node /Base/", "an array of another file"]);
    // A link within the file is followed.
    let within = cgns(&dir, "within.cgns", |file, base| {
        let node = coordinate(file, base);
        file.relink(&node, "/ elsewhere").unwrap();
        file.link_soft("/ elsewhere", &node).unwrap();
    });
    sagitta(args!["info", within]).expect(0);
}

#[test]
fn a_tree_that_repeats_itself_is_bounded() {
    let dir = place();
    let path = cgns(&dir, "tree.cgns", |file, base| {
        // Each level has the next twenty times: 20^8 paths lead to the last.
        let family = |parent: &hdf5_metno::Group, name: &str| {
            let group = parent.create_group(name).unwrap();
            let text = |name: &str, text: &str| {
                let value = hdf5_metno::types::FixedAscii::<33>::from_ascii(text).unwrap();
                let attribute = group.new_attr::<hdf5_metno::types::FixedAscii<33>>().create(name).unwrap();
                attribute.write_scalar(&value).unwrap();
            };
            text("label", "Family_t");
            text("name", name);
            text("type", "MT");
            group
        };
        let mut group = family(&file.group(base).unwrap(), "deep");
        for _ in 0..8 {
            let next = family(&group, "n0");
            let own = next.name();
            (1..20).for_each(|n| group.link_hard(&own, &format!("n{n}")).unwrap());
            group = next;
        }
    });
    refused(args!["info", path], &["tree.cgns, node /Base/deep/n0", "far larger than the file"]);
}

#[test]
fn names_of_groups_take_no_lines() {
    let dir = place();
    let sample = root().join("fixtures/samples/hexpyrtet_p1_msh22a.msh");
    let text = std::fs::read_to_string(sample).unwrap();
    assert!(text.contains("\"wall\""));
    let path = write(&dir, "names.msh", text.replacen("\"wall\"", "\"a\tb\"c\"", 1));
    let out = dir.path().join("out.msh");
    sagitta(args!["convert", path, "-o", out, "--ascii"]).expect(0);
    let told = sagitta(args!["info", out]).expect(0).stdout;
    assert!(told.contains("a_b_c"), "{told}");
    assert!(sagitta(args!["info", path]).expect(0).stdout.contains("characters that no name can have"));
}

/// Two blocks in Fortran's records of single precision, which by their length are also one block of C's double precision.
fn ambiguous() -> Vec<u8> {
    let record = |words: Vec<[u8; 4]>| {
        let length = (4 * words.len() as u32).to_le_bytes();
        [length.to_vec(), words.concat(), length.to_vec()].concat()
    };
    let sizes: [[u32; 3]; 2] = [[3, 4, 3], [2, 3, 4]];
    let mut bytes = record(vec![2_u32.to_le_bytes()]);
    bytes.extend(record(sizes.iter().flatten().map(|n| n.to_le_bytes()).collect()));
    for (b, [ni, nj, nk]) in sizes.into_iter().enumerate() {
        let at = |axis: usize| {
            (0..ni * nj * nk).map(move |n| {
                [n % ni, n / ni % nj, n / (ni * nj)][axis] as f32 + 10.0 * (b * usize::from(axis == 0)) as f32
            })
        };
        bytes.extend(record((0..3).flat_map(at).map(f32::to_le_bytes).collect()));
    }
    bytes
}

#[test]
fn a_grid_that_is_written_in_two_ways_is_asked_for() {
    let dir = place();
    let path = write(&dir, "grid.xyz", ambiguous());
    refused(args!["info", path], &["grid.xyz", "lr4,several", "lb8,one", " or as ", "--plot3d-layout"]);
    let told = sagitta(args!["info", path, "--plot3d-layout", "lr4,several"]).expect(0).stdout;
    assert!(told.contains("18 hex"), "{told}");
    refused(args!["info", path, "--plot3d-layout", "b8,one"], &["grid.xyz", "not b8,one"]);
    let told = sagitta(args!["info", path, "--plot3d-layout", "x"]).expect(2).stderr;
    assert!(told.contains("--plot3d-layout") && told.contains("lr4,several"), "{told}");
}

#[test]
fn a_brep_file_is_refused_with_its_line() {
    let dir = place();
    let brep = "DBRep_DrawableShape\n\nCASCADE Topology V3, (c) Open Cascade\nLocations 0\nCurve2ds 0\nCurves 1\n1 0 0 0 1 0 0 \n\
        Polygon3D 0\nPolygonOnTriangulations 0\nSurfaces x\n";
    let path = write(&dir, "cut.brep", brep);
    let told = sagitta(args!["info", path]).expect(2).stderr;
    assert!(told.contains("cut.brep") && told.contains("line "), "{told}");
}

/// An endless list of points is bounded by the memory that reading may take.
#[test]
fn points_without_end_are_not_gathered() {
    let cad = fixture("plate", "step");
    let output = Command::new(env!("CARGO_BIN_EXE_sagitta"))
        .args(args!["project", cad, "-", "--memory-limit", "64M"])
        .stdin(std::fs::File::open("/dev/zero").unwrap())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("--memory-limit"), "{told}");
}
