//! `sagitta info`.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use cad::{Aabb, Health, Kind as EntityKind, Model, ReadOptions};
use clap::Args;

use super::curve::positive;
use super::{DONE, Failure, print};
use crate::formats;
use crate::mesh::Mesh;

/// Options of `sagitta info`.
#[derive(Args)]
pub(super) struct Options {
    /// A CAD, mesh or linkage file
    file: PathBuf,
    /// Seconds after which reading CAD is given up
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = positive)]
    cad_timeout: f64,
}

/// Tells what a file holds; its kind is found by its content.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let path = &options.file;
    let text = match kind(path)? {
        Kind::Mesh => mesh(&formats::read(path)?)?,
        Kind::Linkage => linkage(path)?,
        Kind::Cad => {
            let timeout = Duration::from_secs_f64(options.cad_timeout);
            model(&Model::read(path, &ReadOptions { timeout, ..ReadOptions::default() })?)?
        }
    };
    print(&format!("{}: {}", path.display(), text.trim_end()))?;
    Ok(DONE)
}

enum Kind {
    Mesh,
    Linkage,
    Cad,
}

/// The kind of a file by its first bytes.
fn kind(path: &Path) -> Result<Kind, Failure> {
    use std::io::Read;
    let mut head = Vec::new();
    let open = std::fs::File::open(path).and_then(|file| file.take(4096).read_to_end(&mut head));
    open.map_err(|error| format!("{}: cannot be read: {error}", path.display()))?;
    let text = head.trim_ascii_start();
    if formats::is_mesh(path)? {
        return Ok(Kind::Mesh);
    }
    Ok(match text {
        [b'<', ..] | [0xef, 0xbb, 0xbf, b'<', ..] => Kind::Linkage,
        _ => Kind::Cad,
    })
}

fn bounds(bounds: Aabb) -> String {
    let [a, b] = [bounds.min, bounds.max];
    format!("box ({}, {}, {}) to ({}, {}, {})", a.x, a.y, a.z, b.x, b.y, b.z)
}

fn mesh(mesh: &Mesh) -> Result<String, Failure> {
    let mut text = format!("mesh of order {}, {} nodes\n", mesh.order, mesh.points.len());
    writeln!(text, "  {}", bounds(Aabb::of_points(mesh.points.iter().copied())))?;
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for block in &mesh.blocks {
        *counts.entry(block.cell.name()).or_default() += block.tags.len();
    }
    let counts: Vec<String> = counts.iter().map(|(cell, count)| format!("{count} {cell}")).collect();
    writeln!(text, "  elements: {}", counts.join(", "))?;
    let mut patches: BTreeMap<_, usize> = BTreeMap::new();
    for (_, block) in mesh.blocks_of(2) {
        *patches.entry(block.entity).or_default() += block.tags.len();
    }
    for (entity, faces) in patches {
        writeln!(text, "  {entity}: {faces} faces {}", mesh.names_of(entity).join(","))?;
    }
    for note in &mesh.notes {
        writeln!(text, "  note: {note}")?;
    }
    Ok(text)
}

fn linkage(path: &Path) -> Result<String, Failure> {
    let reading = linkage_schema::read_path(path)?;
    let mut text = String::from("MeshLink document\n");
    for file in &reading.document.geometry_files {
        writeln!(text, "  CAD file {:?}: {} references", file.filename, file.references.len())?;
    }
    writeln!(text, "  geometry groups: {}", reading.document.geometry_groups.len())?;
    let resolution = linkage_schema::resolve(&reading.document);
    for links in &resolution.models {
        writeln!(text, "  mesh file {:?}:", links.file.filename)?;
        for sheet in &links.sheets {
            let faces: usize = sheet.faces.iter().map(|run| run.run.faces().len()).sum();
            writeln!(text, "    sheet {:?}: {faces} faces", sheet.name().unwrap_or(""))?;
        }
        let edges: usize = links.strings.iter().flat_map(|s| &s.edges).map(|run| run.run.edges().len()).sum();
        writeln!(text, "    {} strings with {edges} edges, {} points", links.strings.len(), links.points.len())?;
    }
    for finding in reading.findings.iter().chain(resolution.findings.iter()) {
        writeln!(text, "  {finding}")?;
    }
    Ok(text)
}

fn model(model: &Model) -> Result<String, Failure> {
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
    flaws(&mut text, &health)?;
    Ok(text)
}

fn by_kind(counts: &BTreeMap<EntityKind, usize>) -> String {
    let counts: Vec<String> = counts.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    if counts.is_empty() { String::new() } else { format!(": {}", counts.join(", ")) }
}

/// What may spoil a projection.
fn flaws(text: &mut String, health: &Health) -> std::fmt::Result {
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
    for dropped in &health.dropped {
        writeln!(text, "  dropped by the reader: {dropped}")?;
    }
    for warning in &health.warnings {
        writeln!(text, "  warning: {warning}")?;
    }
    Ok(())
}
