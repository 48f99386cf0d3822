//! The published JSON Schemas are those of the program.

use std::collections::BTreeMap;

use crate::common::documents::faults;
use crate::common::{names_in, root};

/// File names and texts of all schemas.
fn made() -> BTreeMap<String, String> {
    let text = |schema| serde_json::to_string_pretty(&schema).unwrap() + "\n";
    sagitta::report::schemas().into_iter().map(|(name, schema)| (format!("{name}.json"), text(schema))).collect()
}

#[test]
fn published_schemas_are_those_of_the_program() {
    let folder = root().join("docs/schema");
    let made = made();
    assert_eq!(names_in(&folder), made.keys().cloned().collect::<Vec<_>>(), "`make schema` writes them");
    for (name, text) in made {
        let published = std::fs::read_to_string(folder.join(&name)).unwrap();
        assert!(
            published == text,
            "docs/schema/{name} is out of date: `make schema` writes it; should its version rise?"
        );
    }
}

/// A document that lacks a key, or has a number that is none, does not pass.
#[test]
fn schemas_refuse_what_is_wrong() {
    let good = serde_json::json!({
        "schema": "sagitta-check-2", "version": "0", "run": {"date": "2026-12-01T13:05:59Z", "command": [], "options": {}, "exit_code": 0, "reason": "done"},
        "units": {"length": null, "angle": "degree", "time": "second", "memory": "byte"}, "mesh": "m", "order": 2, "certified": true, "cells": [],
        "certificate": {
            "j_over_jc": {"lower": null, "upper": null}, "scaled_jacobian": {"lower": 0.5, "upper": 0.5}, "worst": [],
        }, "measures": [], "lowest": [], "notes": [],
    });
    assert_eq!(faults(&good), [""; 0]);
    let mut without = good.clone();
    without.as_object_mut().unwrap().remove("order");
    let mut with_nan = good;
    with_nan["order"] = serde_json::Value::Null;
    assert!([without, with_nan].iter().all(|document| faults(document).len() == 1));
}

/// `make schema`.
#[test]
#[ignore = "writes docs/schema"]
fn write() {
    let folder = root().join("docs/schema");
    std::fs::create_dir_all(&folder).unwrap();
    for name in names_in(&folder) {
        std::fs::remove_file(folder.join(name)).unwrap();
    }
    made().iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).unwrap());
}
