//! `sagitta check`.

use std::path::PathBuf;

use clap::Args;

use super::{form, input};
use crate::certify::{self, NotCertifiable, Settings};
use crate::cli::exit::{DONE, NOT_CERTIFIED};
use crate::cli::files::Files;
use crate::cli::output::{Beside, Failure, print, write_json};
use crate::mesh::{self, linear_positions};
use crate::report::CheckReport;

/// Options of `sagitta check`.
#[derive(Args)]
pub(super) struct Options {
    #[arg(help = form::mesh("A mesh of order 1 to 4, written by any program"))]
    mesh: PathBuf,
    /// The linear mesh that it was made from: the reference of its Jacobians [default: each element's own corners]
    #[arg(long, value_name = "P1MESH")]
    linear: Option<PathBuf>,
    #[cfg(feature = "cad")]
    #[command(flatten)]
    room: super::with_cad::Room,
    /// Also write what is proven as JSON
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
}

/// A linear mesh that is not the one that the curved mesh was made from.
#[derive(Debug, thiserror::Error)]
#[error("{linear}: not the linear mesh of {curved}: {why}")]
struct NotItsLinear {
    linear: String,
    curved: String,
    why: mesh::NotItsLinear,
}

/// A mesh of which nothing can be proven.
#[derive(Debug, thiserror::Error)]
#[error("{mesh}: {cause}")]
struct Refused {
    mesh: String,
    cause: NotCertifiable,
}

impl Options {
    fn files(&self) -> Files {
        let files =
            Files::of_mesh(&self.mesh).reads("--linear", self.linear.as_ref()).writes("--report", self.report.as_ref());
        #[cfg(feature = "cad")]
        let files = self.room.files(files);
        files
    }
}

/// Certifies a mesh and prints what is proven.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    options.files().check()?;
    let mesh = input::mesh(&options.mesh)?;
    let unperturbed = match &options.linear {
        None => None,
        Some(path) => {
            let linear = input::mesh(path)?;
            let matched = linear_positions(&mesh, &linear).map_err(|why| NotItsLinear {
                linear: path.display().to_string(),
                curved: options.mesh.display().to_string(),
                why,
            })?;
            Some(matched)
        }
    };
    let certificate = certify::check(&mesh, mesh.points(), unperturbed.as_deref(), &Settings::default())
        .map_err(|cause| Refused { mesh: options.mesh.display().to_string(), cause })?;
    #[cfg_attr(not(feature = "cad"), expect(unused_mut))]
    let mut report = CheckReport::new(&options.mesh, &mesh, &certificate);
    #[cfg(feature = "cad")]
    {
        report.association = options.room.look(&options.mesh, &mesh)?;
    }
    let mut beside = Beside::default();
    if let Some(path) = &options.report {
        beside.tell(write_json(path, &report));
    }
    beside.tell(print(&report.to_string()));
    Ok(beside.exit_code(if certificate.holds() { DONE } else { NOT_CERTIFIED }))
}
