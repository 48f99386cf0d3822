//! Every document of the corpus gives exactly the findings it must, at their lines.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, dead_code, missing_docs)]

mod corpus;

use std::path::Path;

use corpus::{Case, Expect, cases};
use linkage_schema::{Code, Finding, read, resolve};

fn found(case: &Case) -> Result<Vec<(Code, u32)>, String> {
    let reading = read(case.text.as_bytes(), Path::new("case.xml")).map_err(|error| error.to_string())?;
    let place = |finding: &Finding| (finding.code, finding.position().map_or(0, |position| position.line.get()));
    let mut all: Vec<_> = reading.findings.iter().map(place).collect();
    all.extend(resolve(&reading.document).findings.iter().map(place));
    Ok(all)
}

#[test]
fn every_defect_is_found_at_its_line_and_nothing_else() {
    for case in cases() {
        match (&case.expect, found(&case)) {
            (Expect::Findings(wanted), Ok(got)) => assert_eq!(got, *wanted, "{}:\n{}", case.name, case.text),
            (Expect::Fatal(message), Err(got)) => {
                assert!(got.starts_with("case.xml:") && got.contains(message), "{}: {got}", case.name);
            }
            (Expect::Findings(_), Err(got)) => panic!("{}: {got}", case.name),
            (Expect::Fatal(_), Ok(got)) => panic!("{}: read, with {got:?}", case.name),
        }
    }
}

#[test]
fn no_prefix_of_a_document_panics_or_passes() {
    for end in 0..corpus::FULL.trim_end().len() {
        assert!(read(&corpus::FULL.as_bytes()[..end], Path::new("cut.xml")).is_err(), "cut at {end}");
    }
}

#[test]
fn long_attributes_and_deep_nests_are_refused() {
    let long = corpus::root(&format!("<Attribute attid='1' name='{}'/>", "x".repeat(1 << 20)));
    let error = read(long.as_bytes(), Path::new("long.xml")).unwrap_err().to_string();
    assert!(error.contains("long.xml:3:1: an attribute of Attribute has 1048576 bytes"), "{error}");

    let deep = corpus::root(&"<x>".repeat(1000));
    let error = read(deep.as_bytes(), Path::new("deep.xml")).unwrap_err().to_string();
    assert!(error.contains("nested deeper than 32"), "{error}");
}

#[test]
fn findings_of_one_kind_are_kept_up_to_a_limit_and_all_counted() {
    let vertices = "<ParamVertex vref='1' gref='1' dim='3'>0</ParamVertex>\n".repeat(5000);
    let reading = read(corpus::model(&vertices).as_bytes(), Path::new("many.xml")).unwrap();
    assert_eq!(reading.findings.count(Code::BadDimension), 5000);
    assert_eq!(reading.findings.iter().count(), linkage_schema::Findings::KEPT);
    assert_eq!(reading.findings.errors(), 5000);
    let error = reading.accept().unwrap_err().to_string();
    assert!(error.starts_with("many.xml:4:1: error ML208: ") && error.contains("and 4999 more"), "{error}");
}

#[test]
fn a_missing_file_is_named() {
    let error = linkage_schema::read_path(Path::new("/nowhere/a.xml")).unwrap_err().to_string();
    assert!(error.starts_with("/nowhere/a.xml: cannot open"), "{error}");
}

#[test]
fn a_wide_encoding_is_named() {
    let wide: Vec<u8> = corpus::FULL.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let error = read(wide.as_slice(), Path::new("wide.xml")).unwrap_err().to_string();
    assert!(error.contains("iconv"), "{error}");
}

#[test]
fn codes_are_unique_and_in_order() {
    let ids: Vec<&str> = Code::ALL.iter().map(|code| code.id()).collect();
    assert!(ids.windows(2).all(|pair| pair[0] < pair[1]), "{ids:?}");
}
