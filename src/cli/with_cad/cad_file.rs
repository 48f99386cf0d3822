//! The CAD beside a mesh that is looked at: how far the mesh is from it.

use std::path::{Path, PathBuf};

use cad::{EntityId, Group, Model};
use clap::Args;
use rustc_hash::FxHashMap;

use super::reading::Reading;
use crate::cli::files::Files;
use crate::cli::help::INPUT;
use crate::cli::output::Failure;
use crate::mesh::{FaceKey, Mesh};
use crate::picture::Distances;
use crate::scene::face_distances;

/// The CAD that distances are taken to: those to the closest of all its faces and free edges.
#[derive(Args)]
pub(in crate::cli) struct CadFile {
    /// The CAD that the mesh lies on: STEP, IGES or BREP
    #[arg(long, value_name = "FILE", help_heading = INPUT)]
    cad: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
}

impl CadFile {
    /// Whether there is one.
    pub(in crate::cli) fn is_given(&self) -> bool {
        self.cad.is_some()
    }

    /// Adds the files that are read.
    pub(in crate::cli) fn files(&self, files: Files) -> Files {
        files.reads("--cad", self.cad.as_ref())
    }

    /// Has something done with distances to the CAD, where there is one.
    pub(in crate::cli) fn with_distances<R>(&self, work: impl FnOnce(Option<Distances>) -> R) -> Result<R, Failure> {
        match &self.cad {
            Some(path) => with_distances(path, &self.reading, |distances| work(Some(distances))),
            None => Ok(work(None)),
        }
    }

    /// The largest distance of each boundary face from the CAD, by its corners; none without CAD.
    pub(in crate::cli) fn face_distances(&self, mesh: &Mesh) -> Result<FxHashMap<FaceKey, f64>, Failure> {
        self.with_distances(|distances| distances.map(|own| face_distances(mesh, own)).unwrap_or_default())
    }
}

/// Has something done with distances to a CAD file.
pub(super) fn with_distances<R>(
    path: &Path,
    reading: &Reading,
    work: impl FnOnce(Distances) -> R,
) -> Result<R, Failure> {
    if reading.scale().is_none() {
        return Err(format!("{}: --cad-scale auto is for curving; give the factor", path.display()).into());
    }
    let model = Model::read(path, &reading.options())?;
    let free = model.edges().iter().filter(|edge| edge.faces.is_empty() && !edge.degenerate);
    let faces = model.faces().iter().map(|face| EntityId::from(face.id));
    let all: Vec<EntityId> = faces.chain(free.map(|edge| edge.id.into())).collect();
    let group = Group::of(&model, &all).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(work(&|points| points.iter().map(|&x| group.distance(x)).collect()))
}
