//! What every document and every table that a test reads is held to: its published schema, and one proven minimum.

use std::path::Path;

use serde_json::Value;

use super::root;

/// A JSON document that the program wrote to a file.
#[track_caller]
pub fn json(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    document(&text)
}

/// A JSON document that the program wrote.
#[track_caller]
pub fn document(text: &str) -> Value {
    let document: Value = serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"));
    let faults = faults(&document);
    assert!(faults.is_empty(), "{faults:#?} in {document:#}");
    if document["schema"] == "sagitta-report-2" {
        let least = document["cells"].as_array().unwrap().iter().map(|cell| &cell["j_over_jc_min"]);
        let least = least.min_by(|a, b| a.as_f64().unwrap().total_cmp(&b.as_f64().unwrap()));
        assert_eq!(least, document.pointer("/certificate/j_over_jc/lower"), "one proven minimum: {document:#}");
    }
    document
}

/// Where a document differs from its published schema.
pub fn faults(document: &Value) -> Vec<String> {
    let name = document["schema"].as_str().unwrap_or_else(|| panic!("no schema is named in {document:#}"));
    let path = root().join(format!("docs/schema/{name}.json"));
    let schema = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let schema: Value = serde_json::from_str(&schema).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let validator = jsonschema::validator_for(&schema).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    validator.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

/// Checks what the program printed: JSON by its schema; the report of a curved mesh tells one proven minimum in its table and in its
/// last line.
#[track_caller]
pub fn check_stdout(stdout: &str) {
    if stdout.starts_with('{') {
        document(stdout);
    }
    let proven = stdout.lines().find_map(|line| line.strip_prefix("certified: every element valid, J/Jc >= "));
    let table = stdout.lines().skip_while(|line| !(line.starts_with("cell ") && line.contains("J/Jc >=")));
    let rows = table.skip(1).take_while(|line| !line.is_empty());
    let least = rows.map(|row| row.split_whitespace().nth(6).unwrap_or_else(|| panic!("{row}")));
    let least = least.min_by(|a, b| a.parse::<f64>().unwrap().total_cmp(&b.parse().unwrap()));
    if let (Some(proven), Some(least)) = (proven, least) {
        assert_eq!(proven.split(' ').next(), Some(least), "one proven minimum:\n{stdout}");
    }
}
