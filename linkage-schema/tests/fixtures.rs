//! The linkage files of the fixtures are read, resolved and written without any finding.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};

use linkage_schema::{read, read_path, resolve, write};

fn linkage_files() -> Vec<PathBuf> {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures");
    let cases = fs::read_dir(fixtures).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir());
    let files = cases.flat_map(|case| fs::read_dir(case).unwrap().map(|entry| entry.unwrap().path()));
    let mut found: Vec<PathBuf> = files.filter(|file| file.to_string_lossy().ends_with(".meshlink.xml")).collect();
    found.sort();
    found
}

#[test]
fn every_fixture_is_clean_and_survives_writing() {
    let files = linkage_files();
    assert!(files.len() >= 11, "{files:?}");
    for file in files {
        let reading = read_path(&file).unwrap();
        assert!(reading.findings.is_empty(), "{}: {:?}", file.display(), reading.findings);
        let resolution = resolve(&reading.document);
        assert!(resolution.findings.is_empty(), "{}: {:?}", file.display(), resolution.findings);
        let mut bytes = Vec::new();
        write(&reading.document, &mut bytes).unwrap();
        assert_eq!(read(bytes.as_slice(), &file).unwrap().document, reading.document, "{}", file.display());
    }
}

#[test]
fn the_weeble_says_what_its_generator_knew() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/weeble/weeble.meshlink.xml");
    let document = read_path(&file).unwrap().accept().unwrap();
    let resolution = resolve(&document);
    let model = &resolution.models[0];
    assert_eq!(resolution.attribute(model.file.aref, "mesh format"), Some("Gmsh MSH 4.1"));
    assert_eq!(resolution.attribute(document.geometry_files[0].aref, "geometry format"), Some("STEP"));
    let sheets: Vec<_> = model
        .sheets
        .iter()
        .map(|sheet| (sheet.name().unwrap(), sheet.faces[0].entities()[0].reference, sheet.faces[0].run.faces().len()))
        .collect();
    let wanted = [
        ("wall/face-2", "face-2", 151),
        ("wall/face-3", "face-3", 146),
        ("wall/face-4", "face-4", 57),
        ("farfield/face-1", "face-1", 320),
    ];
    assert_eq!(sheets, wanted);
    assert_eq!((model.strings.len(), model.points.len()), (6, 6));
}
