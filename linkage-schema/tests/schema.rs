//! `linkage.xsd` against the corpus, by xmllint where it is installed. The documents are left in the target directory for
//! `compare_schemas.sh`, which compares our schema with the published one.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, dead_code, missing_docs)]

mod corpus;

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use corpus::{cases, mutations::mutations};

/// The names of the files in `directory` that the schema accepts; `None` where there is no xmllint.
fn accepted(directory: &Path) -> Option<HashSet<String>> {
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("linkage.xsd");
    let mut files: Vec<PathBuf> = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let output = Command::new("xmllint").arg("--noout").arg("--schema").arg(schema).args(files).output();
    let Ok(output) = output else {
        eprintln!("xmllint is not installed (Debian: libxml2-utils): the schema was not tested");
        return None;
    };
    let log = String::from_utf8_lossy(&output.stderr).into_owned();
    let valid = log.lines().filter_map(|line| line.strip_suffix(" validates"));
    Some(valid.filter_map(|file| Path::new(file).file_name()).map(|name| name.to_string_lossy().into_owned()).collect())
}

fn fresh_directory(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if directory.exists() {
        fs::remove_dir_all(&directory).unwrap();
    }
    fs::create_dir_all(&directory).unwrap();
    directory
}

#[test]
fn the_schema_accepts_and_refuses_what_the_table_says() {
    let directory = fresh_directory("linkage-corpus");
    for case in cases() {
        fs::write(directory.join(format!("{}.xml", case.name)), &case.text).unwrap();
    }
    let full = linkage_schema::read(corpus::FULL.as_bytes(), Path::new("full.xml")).unwrap().document;
    linkage_schema::write_path(&full, &directory.join("written.xml")).unwrap();
    let Some(accepted) = accepted(&directory) else { return };
    assert!(accepted.contains("written.xml"), "the writer's own document is refused");
    for case in cases() {
        assert_eq!(accepted.contains(&format!("{}.xml", case.name)), case.schema, "{}:\n{}", case.name, case.text);
    }
}

/// What the schema refuses, the reader or the resolver must find; the other way round there is much that no schema sees.
#[test]
fn what_the_schema_refuses_is_found() {
    let directory = fresh_directory("linkage-mutations");
    for (name, text) in mutations() {
        fs::write(directory.join(format!("{name}.xml")), text).unwrap();
    }
    let Some(accepted) = accepted(&directory) else { return };
    let mut refused = 0;
    for (name, text) in mutations() {
        let clean = linkage_schema::read(text.as_bytes(), Path::new(&name)).is_ok_and(|reading| {
            reading.findings.is_empty() && linkage_schema::resolve(&reading.document).findings.is_empty()
        });
        if !accepted.contains(&format!("{name}.xml")) {
            refused += 1;
            assert!(!clean, "the schema refuses {name}, nothing was found:\n{text}");
        }
    }
    assert!(refused > 100 && !accepted.is_empty(), "{refused} refused, {} accepted", accepted.len());
}
