//! `sagitta report`.

use std::io::Read;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;

use super::{form, input, signals};
use crate::cli::exit::DONE;
use crate::cli::files::Files;
use crate::cli::help::{INPUT, OUTPUT};
use crate::cli::output::{Beside, Failure, print};
use crate::cli::page::{html_name, write_page};
use crate::html::Page;
use crate::mesh::Mesh;
use crate::scene::Measures;

/// Options of `sagitta report`.
#[derive(Args)]
pub(super) struct Options {
    /// The JSON report of `curve` or `check`
    #[arg(value_name = "R.json")]
    report: PathBuf,
    #[arg(help = form::mesh("The mesh that it is of"))]
    mesh: PathBuf,
    /// The page to write, for any browser
    #[arg(short, long, value_name = "FILE.html", value_parser = html_name, help_heading = OUTPUT)]
    output: PathBuf,
    /// The linear mesh that it was made from: the reference of the Jacobians that colours show [default: each element's own corners]
    #[arg(long, value_name = "P1MESH", help_heading = INPUT)]
    linear: Option<PathBuf>,
    #[cfg(feature = "cad")]
    #[command(flatten)]
    cad: super::with_cad::CadFile,
}

/// The longest report that is read, in bytes.
const LONGEST: u64 = 1 << 30;

/// Makes a page of a report and its mesh.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let files = Files::of_mesh(&options.mesh)
        .reads("the report", Some(&options.report))
        .reads("--linear", options.linear.as_ref())
        .writes("--output", Some(&options.output));
    #[cfg(feature = "cad")]
    let files = options.cad.files(files);
    files.check()?;
    let report = read(&options.report)?;
    let mesh = input::mesh(&options.mesh)?;
    fits(&report, &mesh).map_err(|why| {
        let (report, mesh) = (options.report.display(), options.mesh.display());
        format!("{report}: not the report of {mesh}: {why}; give the mesh that was written or checked with it")
    })?;
    let linear = input::linear_corners(&options.mesh, &mesh, options.linear.as_deref())?;
    let measures = Measures::of(&mesh, linear.as_deref());
    let page = Page { report, mesh: &mesh, measures: &measures };
    #[cfg(feature = "cad")]
    let distances = options.cad.face_distances(&mesh)?;
    #[cfg(not(feature = "cad"))]
    let distances: rustc_hash::FxHashMap<crate::mesh::FaceKey, f64> = rustc_hash::FxHashMap::default();
    signals::result_is(&options.output, DONE);
    write_page(&options.output, &page.text(|face| distances.get(&face).copied())?)?;
    let mut beside = Beside::default();
    beside.tell(print(&format!("written: {}", options.output.display())));
    Ok(beside.exit_code(DONE))
}

fn read(path: &Path) -> Result<Value, Failure> {
    let name = path.display();
    let unreadable = |error: std::io::Error| format!("{name}: cannot be read: {error}");
    let mut text = String::new();
    let file = cad::regular::open(path).map_err(unreadable)?;
    file.take(LONGEST).read_to_string(&mut text).map_err(unreadable)?;
    let report: Value =
        serde_json::from_str(&text).map_err(|error| format!("{name}: no JSON: {error}; give a file of --report"))?;
    let schema = report.get("schema").and_then(Value::as_str).unwrap_or_default();
    if schema.starts_with("sagitta-report-") || schema.starts_with("sagitta-check-") {
        return Ok(report);
    }
    Err(format!("{name}: neither a report of curve nor one of check; give a file that `sagitta curve --report` or `sagitta check --report` wrote").into())
}

/// Whether a report can be of a mesh: order and numbers of cells.
fn fits(report: &Value, mesh: &Mesh) -> Result<(), String> {
    let order = u64::from(u8::from(mesh.order()));
    let told = report.get("order").and_then(Value::as_u64);
    if told != Some(order) {
        let told = told.map_or_else(|| "no order".to_owned(), |told| format!("order {told}"));
        return Err(format!("it tells of {told}, the mesh is of order {order}"));
    }
    let counts = mesh.counts();
    for (cell, &count) in counts.iter().filter(|(cell, _)| cell.dimension() == mesh.dimension()) {
        let mut cells = report.get("cells").and_then(Value::as_array).into_iter().flatten();
        let own = cells.find(|own| own.get("cell").and_then(Value::as_str) == Some(cell.name()));
        let told = own.and_then(|own| own.get("count")).and_then(Value::as_u64).unwrap_or(0);
        if told != count as u64 {
            return Err(format!("it tells of {told} cells {cell}, the mesh has {count}"));
        }
    }
    Ok(())
}
