//! `sagitta groups`.

use std::fmt::Write;
use std::path::PathBuf;

use cad::{Aabb, Label, Model};
use clap::Args;
use serde::Serialize;

use super::reading::in_a_child;
use super::values::positive;
use crate::cli::exit::DONE;
use crate::cli::output::{Failure, print};

/// Name and version of the JSON document.
const SCHEMA: &str = "sagitta-groups-1";

/// Options of `sagitta groups`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    /// A CAD file: STEP, IGES or BREP
    cad: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Seconds after which reading the CAD is given up
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = positive)]
    cad_timeout: f64,
}

/// What references of a CAD file may mean.
#[derive(Serialize)]
struct Listing {
    schema: &'static str,
    path: String,
    format: String,
    unit: String,
    metres_per_unit: Option<f64>,
    faces: Vec<Entity>,
    edges: Vec<Entity>,
    vertices: Vec<Entity>,
    groups: Vec<Ready>,
    /// What is missing or malformed in the file.
    losses: Option<String>,
}

#[derive(Serialize)]
struct Entity {
    /// `face:7`.
    id: String,
    /// `step:#17@4/2`, `iges:D19`; empty where the file has none.
    reference: String,
    name: String,
    kind: String,
    /// Smallest and largest corner.
    bounds: [[f64; 3]; 2],
    /// Edges of a face, faces of an edge.
    neighbours: Vec<String>,
}

#[derive(Serialize)]
struct Ready {
    /// `group:NAME`, or the group's own reference where it has no name.
    reference: String,
    name: String,
    members: Vec<String>,
}

/// Lists the entities and the ready groups of a CAD file.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let model = Model::read(&options.cad, &in_a_child(options.cad_timeout, 1.0))?;
    let listing = listing(&model);
    print(&if options.json { serde_json::to_string_pretty(&listing)? } else { listing.text()? })?;
    Ok(DONE)
}

fn listing(model: &Model) -> Listing {
    let faces = model.faces().iter().map(|face| {
        Entity::new(face.id.to_string(), &face.label, face.kind.to_string(), face.bounds, words(&face.edges))
    });
    let edges = model.edges().iter().map(|edge| {
        Entity::new(edge.id.to_string(), &edge.label, edge.kind.to_string(), edge.bounds, words(&edge.faces))
    });
    let vertices = model.vertices().iter().map(|vertex| {
        let place = Aabb::of_points([vertex.point]);
        Entity::new(vertex.id.to_string(), &vertex.label, "point".to_owned(), place, Vec::new())
    });
    let groups = model.groups().iter().map(|group| Ready {
        reference: if group.name.is_empty() {
            group.reference.clone()
        } else {
            format!("group:{}", quoted(&group.name))
        },
        name: group.name.clone(),
        members: words(&group.members),
    });
    Listing {
        schema: SCHEMA,
        path: model.path().display().to_string(),
        format: model.format().to_string(),
        unit: model.unit().name.clone(),
        metres_per_unit: model.unit().metres,
        faces: faces.collect(),
        edges: edges.collect(),
        vertices: vertices.collect(),
        groups: groups.collect(),
        losses: model.losses(),
    }
}

fn words<I: ToString>(ids: &[I]) -> Vec<String> {
    ids.iter().map(ToString::to_string).collect()
}

/// A name as references take it.
fn quoted(name: &str) -> String {
    if name.contains([' ', ',']) { format!("\"{name}\"") } else { name.to_owned() }
}

impl Entity {
    fn new(id: String, label: &Label, kind: String, bounds: Aabb, neighbours: Vec<String>) -> Entity {
        let bounds = [bounds.min, bounds.max].map(|corner| corner.to_array());
        Entity { id, reference: label.reference.clone(), name: label.name.clone(), kind, bounds, neighbours }
    }
}

impl Listing {
    fn text(&self) -> Result<String, std::fmt::Error> {
        let mut text = String::new();
        let metres = self.metres_per_unit.map_or_else(String::new, |m| format!(" ({m} m)"));
        writeln!(text, "{}: {}, unit {}{metres}", self.path, self.format, self.unit)?;
        for (title, entities) in [("faces", &self.faces), ("edges", &self.edges), ("vertices", &self.vertices)] {
            writeln!(text, "{} {title}", entities.len())?;
            for e in entities {
                let name = if e.name.is_empty() { String::new() } else { format!("name:{}", quoted(&e.name)) };
                let line =
                    format!("  {:<11} {:<11} {:<16} {name:<20} {}", e.id, e.kind, e.reference, e.neighbours.join(" "));
                writeln!(text, "{}", line.trim_end())?;
            }
        }
        writeln!(text, "{} groups", self.groups.len())?;
        for group in &self.groups {
            writeln!(text, "  {}: {}", group.reference, group.members.join(" "))?;
        }
        if let Some(losses) = &self.losses {
            writeln!(text, "note: {losses}")?;
        }
        Ok(text.trim_end().to_owned())
    }
}
