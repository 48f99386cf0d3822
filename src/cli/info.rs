//! `sagitta info`.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use cad::Aabb;
use clap::Args;

use crate::cli::exit::DONE;
use crate::cli::output::{Failure, bounds, print};
use crate::element::Cell;
use crate::formats;
use crate::mesh::{Mesh, Skin};

/// Options of `sagitta info`.
#[derive(Args)]
pub(super) struct Options {
    /// A CAD, mesh or linkage file
    file: PathBuf,
    /// Seconds after which reading CAD is abandoned
    #[cfg(feature = "cad")]
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = super::with_cad::seconds)]
    cad_timeout: f64,
}

/// Describes a file; its kind is found by its content.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let path = &options.file;
    let text = match kind(path)? {
        Kind::Mesh => mesh(&super::input::mesh(path)?)?,
        Kind::Linkage => linkage(path)?,
        Kind::Cad => cad_model(options)?,
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
    if formats::is_mesh(path)? {
        return Ok(Kind::Mesh);
    }
    let mut head = Vec::new();
    let open = cad::regular::open(path).and_then(|file| file.take(4096).read_to_end(&mut head));
    open.map_err(|error| format!("{}: cannot be read: {error}", path.display()))?;
    let text = head.trim_ascii_start();
    Ok(match text {
        [b'<', ..] | [0xef, 0xbb, 0xbf, b'<', ..] => Kind::Linkage,
        _ => Kind::Cad,
    })
}

fn mesh(mesh: &Mesh) -> Result<String, Failure> {
    let mut text = format!("mesh of order {}, {} nodes\n", mesh.order(), mesh.points().len());
    writeln!(text, "  {}", bounds(Aabb::of_points(mesh.points().iter().copied())))?;
    let counts: BTreeMap<&str, usize> = mesh.counts().into_iter().map(|(cell, count)| (cell.name(), count)).collect();
    let counts: Vec<String> = counts.iter().map(|(cell, count)| format!("{count} {cell}")).collect();
    writeln!(text, "  elements: {}", counts.join(", "))?;
    let mut patches: BTreeMap<_, usize> = BTreeMap::new();
    let inside = mesh.cell_blocks().filter(|_| !mesh.is_volume());
    for block in mesh.side_blocks().chain(inside) {
        let noun = if block.cell == Cell::Line { "edges" } else { "faces" };
        *patches.entry((block.entity, noun)).or_default() += block.tags.len();
    }
    for ((entity, noun), count) in patches {
        writeln!(text, "  {entity}: {count} {noun} {}", mesh.names_of(entity).join(","))?;
    }
    let skin = Skin::of(mesh).notes(mesh);
    for note in mesh.notes().iter().chain(&skin) {
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

#[cfg(feature = "cad")]
fn cad_model(options: &Options) -> Result<String, Failure> {
    super::with_cad::describe(&options.file, options.cad_timeout)
}

#[cfg(not(feature = "cad"))]
fn cad_model(options: &Options) -> Result<String, Failure> {
    let path = options.file.display();
    Err(format!(
        "{path}: neither a mesh nor a linkage file; CAD is read by a sagitta that was built with the feature cad"
    )
    .into())
}
