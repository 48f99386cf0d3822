//! `sagitta check`.

use std::path::PathBuf;

use clap::Args;
use glam::DVec3;

use super::{form, input, told};
use crate::certify::{self, Certificate, NotCertifiable, Settings};
use crate::cli::exit::{DONE, NOT_CERTIFIED};
use crate::cli::files::Files;
use crate::cli::help::{INPUT, OUTPUT};
use crate::cli::output::{Beside, Failure, print, write_json};
use crate::cli::page::{html_name, write_page};
use crate::formats::{self, WriteOptions};
use crate::html::Page;
use crate::mesh::Mesh;
use crate::report::{CheckReport, measure_fields};
use crate::scene::Measures;

/// Options of `sagitta check`.
#[derive(Args)]
pub(super) struct Options {
    #[arg(help = form::mesh("A mesh of order 1 to 4, written by any program"))]
    mesh: PathBuf,
    /// The linear mesh that it was made from: the reference of its Jacobians [default: each element's own corners]
    #[arg(long, value_name = "P1MESH", help_heading = INPUT)]
    linear: Option<PathBuf>,
    #[cfg(feature = "cad")]
    #[command(flatten)]
    room: super::with_cad::Room,
    /// Also write what is proven as JSON
    #[arg(long, value_name = "R.json", help_heading = OUTPUT)]
    report: Option<PathBuf>,
    /// Also write a page for any browser: all figures, and the mesh in space with its worst elements
    #[arg(long, value_name = "FILE.html", value_parser = html_name, help_heading = OUTPUT)]
    html: Option<PathBuf>,
    /// Also write the mesh with the measures of its elements as fields: .vtu, .vtm or .vtkhdf for ParaView, .msh with views for Gmsh
    #[arg(long, value_name = "FILE", value_parser = fields_name, help_heading = OUTPUT)]
    fields: Option<PathBuf>,
}

/// The name of a file of fields.
fn fields_name(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    if formats::shows_fields(&path, None) || formats::is_msh(&path) {
        Ok(path)
    } else {
        Err(format!("{text:?} is no name of a file with fields: .vtu, .vtm, .vtkhdf or .msh"))
    }
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
        let files = Files::of_mesh(&self.mesh)
            .reads("--linear", self.linear.as_ref())
            .writes("--report", self.report.as_ref())
            .writes("--html", self.html.as_ref())
            .writes_meshes_beside("--fields", self.fields.as_ref());
        #[cfg(feature = "cad")]
        let files = self.room.files(files);
        files
    }
}

impl Options {
    /// The measures of the elements, where a file is asked for that tells of them.
    fn measures(&self, mesh: &Mesh, linear_corners: Option<&[DVec3]>, certificate: &Certificate) -> Measures {
        if self.report.is_none() && self.html.is_none() && self.fields.is_none() {
            return Measures::default();
        }
        // The certificate has sharpened the smallest.
        Measures { j_over_jc: certificate.minima.clone(), ..Measures::of(mesh, linear_corners) }
    }
}

/// Certifies a mesh and prints what is proven.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    options.files().check()?;
    let mesh = input::mesh(&options.mesh)?;
    let unperturbed = input::linear_corners(&options.mesh, &mesh, options.linear.as_deref())?;
    let certificate = certify::check(&mesh, mesh.points(), unperturbed.as_deref(), &Settings::default())
        .map_err(|cause| Refused { mesh: options.mesh.display().to_string(), cause })?;
    let measures = options.measures(&mesh, unperturbed.as_deref(), &certificate);
    let code = if certificate.holds() { DONE } else { NOT_CERTIFIED };
    #[cfg_attr(not(feature = "cad"), expect(unused_mut))]
    let mut report = CheckReport::new(&options.mesh, &mesh, &certificate, &measures, told::run(code));
    #[cfg(feature = "cad")]
    {
        report.association = options.room.look(&options.mesh, &mesh)?;
    }
    let mut beside = Beside::default();
    if let Some(path) = &options.report {
        beside.tell(write_json(path, &report));
    }
    if let Some(path) = &options.fields {
        let fields = measure_fields(&mesh, &measures);
        beside.tell(
            formats::write(path, &mesh, &WriteOptions { fields: &fields, ..WriteOptions::default() }).map(|_| ()),
        );
    }
    if let Some(path) = &options.html {
        let page = Page::new(&report, &mesh, &measures)?;
        #[cfg(feature = "cad")]
        let distances = options.room.face_distances(&mesh)?;
        #[cfg(not(feature = "cad"))]
        let distances: rustc_hash::FxHashMap<crate::mesh::FaceKey, f64> = rustc_hash::FxHashMap::default();
        beside.tell(write_page(path, &page.text(|face| distances.get(&face).copied())?));
    }
    beside.tell(print(&report.to_string()));
    Ok(beside.exit_code(code))
}
