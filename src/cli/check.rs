//! `sagitta check`.

use std::path::PathBuf;

use clap::Args;
use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::certify::{self, Settings};
use crate::cli::exit::{DONE, NOT_CERTIFIED};
use crate::cli::output::{Failure, print, write_json};
use crate::formats;
use crate::mesh::Mesh;
use crate::report::CheckReport;

/// Options of `sagitta check`.
#[derive(Args)]
pub(super) struct Options {
    /// A mesh of order 1 to 4, ours or not
    mesh: PathBuf,
    /// The linear mesh it was made from, to measure its Jacobians against; else each element's own corners serve
    #[arg(long, value_name = "P1MESH")]
    linear: Option<PathBuf>,
    /// Write the findings as JSON too
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
}

/// A linear mesh that is not the one that the curved mesh was made from.
#[derive(Debug, thiserror::Error)]
#[error("{linear}: not the linear mesh of {curved}: {why}")]
struct NotItsLinear {
    linear: String,
    curved: String,
    why: String,
}

/// Certifies a mesh and tells what was found.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let mesh = formats::read(&options.mesh)?;
    let unperturbed = match &options.linear {
        None => None,
        Some(path) => {
            let linear = formats::read(path)?;
            let matched = corners(&mesh, &linear).map_err(|why| NotItsLinear {
                linear: path.display().to_string(),
                curved: options.mesh.display().to_string(),
                why,
            })?;
            Some(matched)
        }
    };
    let certificate = certify::mesh(&mesh, mesh.points(), unperturbed.as_deref(), &Settings::default());
    let report = CheckReport::new(&options.mesh, &mesh, &certificate);
    if let Some(path) = &options.report {
        write_json(path, &report)?;
    }
    print(&report.to_string())?;
    Ok(if certificate.holds() { DONE } else { NOT_CERTIFIED })
}

/// The linear mesh's points by the nodes of the curved mesh, which have the same numbers.
fn corners(curved: &Mesh, linear: &Mesh) -> Result<Vec<DVec3>, String> {
    let counts = |mesh: &Mesh| [("cells", mesh.cells().len()), ("elements on the boundary", mesh.sides().len())];
    for ((what, own), (_, theirs)) in counts(curved).into_iter().zip(counts(linear)) {
        if own != theirs {
            return Err(format!("it has {theirs} {what}, the curved mesh has {own}"));
        }
    }
    let by_tag: FxHashMap<u64, usize> = linear.node_tags().iter().enumerate().map(|(n, &tag)| (tag, n)).collect();
    let mut points = curved.points().to_vec();
    for corner in curved.cells().iter().flat_map(|cell| cell.corners()) {
        let tag = curved.node_tags()[corner.index()];
        let known = by_tag.get(&tag).ok_or_else(|| format!("it has no node {tag}"))?;
        points[corner.index()] = linear.points()[*known];
    }
    Ok(points)
}
