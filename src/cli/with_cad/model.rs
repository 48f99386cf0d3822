//! A CAD file as `sagitta info` describes it.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use cad::{FaceId, Health, Kind, Model};

use super::reading::in_a_child;
use crate::cli::output::{Failure, bounds};

/// What a CAD file holds, in words.
pub(in crate::cli) fn describe(path: &Path, timeout: f64) -> Result<String, Failure> {
    let model = Model::read(path, &in_a_child(timeout, 1.0))?;
    let (faces, edges) = (model.faces(), model.edges());
    let unit = model.unit();
    let metres = unit.metres.map_or_else(String::new, |m| format!(" ({m} m)"));
    let mut text = format!("{}, unit {}{metres}\n", model.format(), unit.name);
    writeln!(text, "  {}", bounds(model.bounds()))?;
    let health = model.health();
    writeln!(text, "  {} faces{}", faces.len(), by_kind(&health.faces))?;
    writeln!(text, "  {} edges{}", edges.len(), by_kind(&health.edges))?;
    writeln!(text, "  {} vertices", health.vertices)?;
    for face in faces {
        let label = &face.label;
        let name = if label.name.is_empty() { String::new() } else { format!("{:?}", label.name) };
        let line = format!("  {} {} {} {name}", face.id, face.kind, label.reference);
        writeln!(text, "{}", line.trim_end())?;
    }
    for group in model.groups() {
        let members: Vec<String> = group.members.iter().map(ToString::to_string).collect();
        let name = if group.name.is_empty() { &group.reference } else { &group.name };
        writeln!(text, "  group {name:?}: {}", members.join(", "))?;
    }
    flaws(&mut text, &health, &model.duplicate_faces())?;
    Ok(text)
}

fn by_kind(counts: &BTreeMap<Kind, usize>) -> String {
    let counts: Vec<String> = counts.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    if counts.is_empty() { String::new() } else { format!(": {}", counts.join(", ")) }
}

/// What may spoil a projection.
fn flaws(text: &mut String, health: &Health, duplicates: &[[FaceId; 2]]) -> std::fmt::Result {
    let list = |items: &mut dyn Iterator<Item = String>| items.collect::<Vec<_>>().join(", ");
    let mut entities = |what: &str, ids: &[cad::EdgeId]| match ids {
        [] => Ok(()),
        _ => writeln!(text, "  {what}: {}", list(&mut ids.iter().map(ToString::to_string))),
    };
    entities("open edges", &health.open_edges)?;
    entities("free edges", &health.free_edges)?;
    entities("tiny edges", &health.tiny_edges)?;
    for doubled in &health.doubled_edges {
        writeln!(text, "  one edge in several pieces: {}", list(&mut doubled.iter().map(ToString::to_string)))?;
    }
    for face in &health.tiny_faces {
        writeln!(text, "  tiny face: {face}")?;
    }
    for (face, fault) in &health.trims {
        writeln!(text, "  boundary of {face}: {fault}")?;
    }
    for crease in &health.creases {
        writeln!(text, "  {crease}")?;
    }
    for [one, other] in duplicates {
        writeln!(text, "  {one} and {other} are the same face twice")?;
    }
    for dropped in &health.dropped {
        writeln!(text, "  dropped by the reader: {dropped}")?;
    }
    for warning in &health.warnings {
        writeln!(text, "  warning: {warning}")?;
    }
    Ok(())
}
