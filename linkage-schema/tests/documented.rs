//! The table of codes in the documentation is the one in the code.
#![allow(clippy::unwrap_used, missing_docs)]

use linkage_schema::Code;

#[test]
fn the_documented_codes_are_all_codes() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/findings.md");
    let text = std::fs::read_to_string(path).unwrap();
    let documented: Vec<&str> = text.lines().filter(|line| line.starts_with("| ML")).collect();
    let row = |code: &Code| format!("| {} | {} | {} |", code.id(), code.severity(), code.meaning());
    let known: Vec<String> = Code::ALL.iter().map(row).collect();
    assert_eq!(documented, known, "{path}");
}
