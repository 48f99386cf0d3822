//! `sagitta link`.

use std::path::PathBuf;

use cad::{Model, ReadOptions};
use clap::Args;

use super::curve::positive;
use super::{DONE, Failure, print, write_json};
use crate::associate::{self, Boundary, Claims, Tolerance, associate, infer};
use crate::formats;

/// A point may be this far from what its tag names; share of the mesh's box.
const MAX_OFFSET: f64 = 1e-3;

/// Options of `sagitta link`.
#[derive(Args)]
pub(super) struct Options {
    /// The linear mesh: MSH, CGNS, UGRID, SU2, VTU, legacy VTK or PLOT3D
    mesh: PathBuf,
    /// The CAD it was made on: STEP, IGES or BREP
    #[arg(long, value_name = "FILE")]
    cad: PathBuf,
    /// The MeshLink file
    #[arg(short, long, value_name = "LINK.xml")]
    output: PathBuf,
    /// How far a node may be from its CAD entity [default: 1e-5 of the mesh's box, and a tenth of the shortest edge at the node]
    #[arg(long, value_name = "T", value_parser = positive)]
    tolerance: Option<f64>,
    /// Take no notice of the mesh's entity tags
    #[arg(long)]
    ignore_tags: bool,
    /// Write what was found, and what not, as JSON too
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
}

/// A mesh that is not on the CAD.
#[derive(Debug, thiserror::Error)]
#[error(
    "{mesh} and {cad}: no face of the mesh lies on the CAD within tolerance; the mesh's box is {size:.6} across, the CAD's {cad_size:.6}: \
     are both in one unit and place? If the mesh is off its CAD, raise --tolerance"
)]
struct Nothing {
    mesh: String,
    cad: String,
    size: f64,
    cad_size: f64,
}

/// Ties a mesh to its CAD and writes the linkage.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    formats::check_folder(&options.output)?;
    let mesh = formats::read(&options.mesh)?;
    let model = Model::read(&options.cad, &ReadOptions::default())?;
    let boundary = Boundary::new(&mesh);
    let tags = Claims::by_tags(&mesh, &boundary, &model);
    let tags_hold = !options.ignore_tags && associate(&mesh, &boundary, &model, &tags, MAX_OFFSET).is_ok();
    let (claims, inference, source) = if tags_hold {
        (tags, None, "the mesh's entity tags")
    } else {
        let tolerance = options.tolerance.map_or_else(|| Tolerance::of(&mesh), Tolerance::fixed);
        let mut inference = infer(&mesh, &boundary, &model, &tolerance);
        (std::mem::take(&mut inference.claims), Some(inference), "geometry")
    };
    if claims.sheets.is_empty() {
        return Err(Box::new(Nothing {
            mesh: options.mesh.display().to_string(),
            cad: options.cad.display().to_string(),
            size: cad::Aabb::of_points(mesh.points.iter().copied()).diagonal(),
            cad_size: model.diagonal(),
        }));
    }
    let written = associate::document(&claims, &mesh, &boundary, &model, &options.mesh)?;
    let mut text = Vec::new();
    linkage_schema::write(&written.document, &mut text)?;
    formats::write_bytes(&options.output, &text)?;
    let mut summary = associate::summary(source, &mesh, &boundary, &model, &claims, inference.as_ref());
    summary.notes.extend(mesh.notes.iter().cloned().chain(model.losses()).chain(written.notes));
    if let Some(path) = &options.report {
        write_json(path, &summary)?;
    }
    print(&format!("{summary}\nwritten: {}", options.output.display()))?;
    Ok(DONE)
}
