//! `sagitta check --cad`: where the CAD leaves the elements of a linear mesh little room, before anything is curved.

use std::path::{Path, PathBuf};

use clap::Args;
use rustc_hash::FxHashMap;

use super::cad_file::with_distances;
use super::reading::Reading;
use super::values::order;
use crate::associate::Summary;
use crate::cli::files::Files;
use crate::cli::help::INPUT;
use crate::cli::input;
use crate::cli::output::Failure;
use crate::cli::tips::not_exchanged;
use crate::curve::{Job, Settings};
use crate::element::Order;
use crate::mesh::{FaceKey, Mesh};
use crate::scene::face_distances;

/// The CAD that a linear mesh is looked at with.
#[derive(Args)]
pub(in crate::cli) struct Room {
    /// The CAD that a linear mesh was made on: also tell which elements no curving can make valid on it, and where there is little room
    #[arg(long, value_name = "FILE", conflicts_with = "linear", help_heading = INPUT)]
    cad: Option<PathBuf>,
    /// MeshLink file that links mesh and CAD
    #[arg(long, value_name = "LINK.xml", requires = "cad", help_heading = INPUT)]
    linkage: Option<PathBuf>,
    /// The order that the mesh is to be curved to: 2, 3 or 4
    #[arg(long, value_name = "P", default_value = "2", requires = "cad", value_parser = order, help_heading = INPUT)]
    order: Order,
    #[command(flatten)]
    reading: Reading,
}

/// A curved mesh where a linear one is asked for.
#[derive(Debug, thiserror::Error)]
#[error("{mesh}: of order {order}: --cad looks at the linear mesh, before it is curved")]
struct NotLinear {
    mesh: String,
    order: Order,
}

impl Room {
    /// Adds the files that are read.
    pub(in crate::cli) fn files(&self, files: Files) -> Files {
        files.reads("--cad", self.cad.as_ref()).reads("--linkage", self.linkage.as_ref())
    }

    /// The largest distance of each boundary face from the CAD, by its corners; none without CAD.
    pub(in crate::cli) fn face_distances(&self, mesh: &Mesh) -> Result<FxHashMap<FaceKey, f64>, Failure> {
        match &self.cad {
            Some(path) => with_distances(path, &self.reading, |distances| face_distances(mesh, distances)),
            None => Ok(FxHashMap::default()),
        }
    }

    /// What lies on what, and where there is little room; nothing without CAD.
    pub(in crate::cli) fn look(&self, path: &Path, mesh: &Mesh) -> Result<Option<Summary>, Failure> {
        let Some(cad) = &self.cad else { return Ok(None) };
        not_exchanged(path, cad)?;
        if mesh.order() > Order::LINEAR {
            return Err(NotLinear { mesh: path.display().to_string(), order: mesh.order() }.into());
        }
        let job = Job {
            mesh: path.to_owned(),
            cad: cad.clone(),
            linkage: self.linkage.clone(),
            cad_scale: self.reading.scale(),
            reading: self.reading.options(),
            mesh_reading: input::reading(),
            solver: None,
            settings: Settings::new(self.order),
        };
        Ok(Some(job.association()?.summary))
    }
}
