//! `sagitta curve`.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;

use super::progress::Monitor;
use super::reading::Reading;
use super::values::{fraction, order, positive, seconds};
use crate::associate::Choice;
use crate::cli::exit::{DONE, NOT_CERTIFIED, OFF_CAD, STOPPED};
use crate::cli::files::Files;
use crate::cli::form::{self, Form};
use crate::cli::help::{EXPERT, INPUT, OUTPUT, QUALITY, RUN, WHAT};
use crate::cli::output::{Beside, Failure, message, print, write_json};
use crate::cli::page::{html_name, write_page};
use crate::cli::tips::not_exchanged;
use crate::cli::{input, signals, threads, told};
use crate::curve::{Checkpointing, Curved, Job, Preview, Settings, Trace};
use crate::element::Order;
use crate::formats::{self, Field, Solver, WriteOptions};
use crate::html::Page;
use crate::mesh::{Inconsistent, Mesh};
use crate::report::{Report, Told, face_distances, fields, left_open, measures, report, sweeps, undecided};
use crate::scene::Measures;
use crate::smooth;

/// Options of what is inside of a volume, and of smoothing it: a surface mesh has no use for them.
const NOT_OF_SURFACES: [&str; 12] = [
    "checkpoint",
    "resume",
    "curve_layers",
    "threshold",
    "alpha",
    "engine",
    "trace",
    "max_sweeps",
    "survey_factor",
    "floor",
    "time_limit",
    "direct",
];

/// Options of `sagitta curve`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    #[arg(help = form::mesh("The linear mesh"))]
    mesh: PathBuf,
    /// The CAD that the mesh was made on: STEP, IGES or BREP
    #[arg(long, value_name = "FILE", help_heading = INPUT)]
    cad: PathBuf,
    /// MeshLink file that links mesh and CAD [default: the mesh's entity tags where they are the CAD's numbers, else geometry]
    #[arg(long, value_name = "LINK.xml", help_heading = INPUT)]
    linkage: Option<PathBuf>,
    /// Polynomial order of the curved mesh: 2, 3 or 4
    #[arg(long, value_name = "P", value_parser = order, help_heading = WHAT)]
    order: Order,
    #[arg(short, long, value_name = "OUT", required_unless_present = "dry_run", help = form::output("The curved mesh; given again it is written again, in another format, and --for is for the first"), help_heading = OUTPUT)]
    output: Vec<PathBuf>,
    /// The mesh is one of triangles and quadrilaterals on CAD faces, without a volume: its nodes are put on the CAD and fitted to it, and
    /// its faces proven free of folds, on the CAD's side; nothing is smoothed
    #[arg(long, conflicts_with_all = NOT_OF_SURFACES, help_heading = WHAT)]
    surface: bool,
    /// Report which patches lie on which CAD faces, and stop there
    #[arg(long, help_heading = WHAT)]
    dry_run: bool,
    /// Curve these patches only: physical names or surface numbers
    #[arg(long, value_name = "PATCH,...", value_delimiter = ',', conflicts_with = "straight", help_heading = WHAT)]
    curve: Vec<String>,
    /// Leave these patches straight
    #[arg(long, value_name = "PATCH,...", value_delimiter = ',', help_heading = WHAT)]
    straight: Vec<String>,
    /// Also write the report as JSON
    #[arg(long, value_name = "R.json", help_heading = OUTPUT)]
    report: Option<PathBuf>,
    /// Also write a page for any browser: all figures, and the mesh in space with its worst elements
    #[arg(long, value_name = "FILE.html", value_parser = html_name, conflicts_with = "dry_run", help_heading = OUTPUT)]
    html: Option<PathBuf>,
    /// Write the fields of a VTU file into MSH files as well, as views of Gmsh
    #[arg(long, help_heading = OUTPUT, hide_short_help = true)]
    msh_views: bool,
    /// Write the boundary faces that belong to the CAD and are not on it as a mesh to look at: a group a cause, and their distance
    #[arg(long, value_name = "FILE.vtu", help_heading = OUTPUT, hide_short_help = true)]
    open_faces: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Ignore the mesh's entity tags
    #[arg(long, help_heading = INPUT, hide_short_help = true)]
    ignore_tags: bool,
    /// How far a node may be from its CAD entity where geometry decides [default: 1e-5 of the mesh's bounding-box diagonal, at most a tenth of the shortest edge at the node; a wider one where that leaves faces open]
    #[arg(long, value_name = "T", value_parser = positive, help_heading = INPUT, hide_short_help = true)]
    tolerance: Option<f64>,
    /// How far a linear node may be from its CAD entity, as a fraction of the mesh's bounding-box diagonal
    #[arg(long, value_name = "FRACTION", default_value_t = 1e-3, value_parser = positive, help_heading = EXPERT, hide_short_help = true)]
    max_offset: f64,
    /// Keep all linear nodes where they are
    #[arg(long, help_heading = EXPERT, hide_short_help = true)]
    freeze_linear: bool,
    /// Keep nodes on curved walls where projection put them
    #[arg(long, help_heading = EXPERT, hide_short_help = true)]
    freeze_walls: bool,
    /// Begin at the order itself [default: curve to P2 first, and begin each order where the one below ended]
    #[arg(long, help_heading = EXPERT, hide_short_help = true)]
    direct: bool,
    /// Curve this many layers of elements off curved walls, and leave those beyond straight; `auto`: as far as the walls'
    /// displacement reaches
    #[arg(long, value_name = "auto|N", default_value = "auto", value_parser = layers, help_heading = WHAT)]
    curve_layers: Layers,
    /// Smooth elements whose cost is below this (0 to 1), in a plane mesh those 0.05 above it as well
    #[arg(long, value_name = "0..1", default_value_t = 0.8, value_parser = fraction, help_heading = QUALITY)]
    threshold: f64,
    /// Weight of shape against size, equation (2); lower it to 0.3 where Jacobians stay small [default: (p-1)/p]
    #[arg(long, value_name = "0..1", value_parser = fraction, help_heading = QUALITY)]
    alpha: Option<f64>,
    /// What moves the nodes: L-BFGS on all active nodes together, or the paper's engine, to compare with
    #[arg(long, value_enum, value_name = "ENGINE", default_value_t, help_heading = EXPERT, hide_short_help = true)]
    engine: smooth::Engine,
    /// Write the costs after each sweep, with the time, as CSV
    #[arg(long, value_name = "T.csv", help_heading = OUTPUT, hide_short_help = true)]
    trace: Option<PathBuf>,
    /// Largest number of sweeps at each order; one over less than a twentieth of the nodes counts as less, a quarter at least
    #[arg(long, value_name = "N", default_value_t = 200, help_heading = QUALITY)]
    max_sweeps: usize,
    /// Divisions of an edge at which costs are surveyed in the end, in multiples of the order
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u8).range(1..=16), help_heading = EXPERT, hide_short_help = true)]
    survey_factor: u8,
    /// Least costs for which walls stay on the CAD: where an element stays below, the wall nodes that make it so may leave the CAD
    #[arg(long, value_name = "0..1", default_value_t = 0.1, value_parser = fraction, help_heading = QUALITY, hide_short_help = true)]
    floor: f64,
    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads::number, help_heading = RUN)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Write nothing, and end with exit code 4, where boundary faces that belong to the CAD are not on it
    #[arg(long, help_heading = OUTPUT)]
    require_all: bool,
    /// Write the mesh even if not all elements are proven valid and all walls free of folds
    #[arg(long, help_heading = OUTPUT, hide_short_help = true)]
    keep_invalid: bool,
    #[command(flatten)]
    form: Form,
    /// Seconds after which smoothing ends, at six tenths of them where elements are inverted, so that recovery has the rest; orders below end within their share of those; the mesh as it is then is certified and written
    #[arg(long, value_name = "S", value_parser = seconds, help_heading = RUN)]
    time_limit: Option<f64>,
    /// Keep the state of the smoothing in this file, to resume from after a crash or the end of a job
    #[arg(long, value_name = "FILE", help_heading = RUN, hide_short_help = true)]
    checkpoint: Option<PathBuf>,
    /// Least number of sweeps between checkpoints, which are written at the end of rounds of 10 to 40 sweeps
    #[arg(long, value_name = "N", default_value_t = 20, requires = "checkpoint", help_heading = RUN, hide_short_help = true)]
    checkpoint_every: usize,
    /// Resume from a checkpoint, to the same bytes as without the interruption
    #[arg(long, value_name = "FILE", help_heading = RUN, hide_short_help = true)]
    resume: Option<PathBuf>,
    /// No progress on stderr
    #[arg(short, long, help_heading = RUN)]
    quiet: bool,
}

/// The number of `--curve-layers`; `None` is `auto`.
#[derive(Clone, Copy, Debug)]
struct Layers(Option<NonZeroUsize>);

fn layers(text: &str) -> Result<Layers, String> {
    if text == "auto" {
        return Ok(Layers(None));
    }
    let number = text.parse::<NonZeroUsize>();
    number.map(|number| Layers(Some(number))).map_err(|_| format!("{text:?} is neither auto nor a number from 1"))
}

impl Options {
    fn patches(&self) -> Choice {
        match (&self.curve[..], &self.straight[..]) {
            ([], []) => Choice::All,
            ([], straight) => Choice::Straight(straight.to_vec()),
            (curve, _) => Choice::Curve(curve.to_vec()),
        }
    }

    /// The meshes that are written.
    fn outputs(&self) -> impl Iterator<Item = &PathBuf> {
        self.output.iter().filter(|_| !self.dry_run)
    }

    fn files(&self) -> Files {
        let written = |path: &Option<PathBuf>| path.clone().filter(|_| !self.dry_run);
        Files::of_mesh(&self.mesh)
            .reads("--cad", Some(&self.cad))
            .reads("--linkage", self.linkage.as_ref())
            .reads("--resume", self.resume.as_ref())
            .writes_mesh(self.outputs().next(), self.form.solver())
            .writes_meshes_beside("--output", self.outputs().skip(1))
            .writes("--report", self.report.as_ref())
            .writes("--html", self.html.as_ref())
            .writes("--open-faces", self.open_faces.as_ref())
            .writes("--trace", written(&self.trace))
            .writes("--checkpoint", written(&self.checkpoint))
    }

    /// Whether the options go together, and the files with them.
    fn check(&self) -> Result<(), Failure> {
        self.files().check()?;
        self.form.check(&self.output)?;
        if self.msh_views && !self.output.iter().any(|path| formats::is_msh(path)) {
            return Err("--msh-views is for an MSH file, and none is written; leave it away".into());
        }
        not_exchanged(&self.mesh, &self.cad)
    }

    /// Whether a file is asked for that tells of the measures of the elements.
    fn tells_measures(&self) -> bool {
        let first = self.outputs().take(1).any(|path| self.shows_fields(path, self.form.solver()));
        let shown = first || self.outputs().skip(1).any(|path| self.shows_fields(path, None));
        shown || self.report.is_some() || self.html.is_some()
    }

    /// Whether fields are written into this file.
    fn shows_fields(&self, path: &Path, solver: Option<&Solver>) -> bool {
        formats::shows_fields(path, solver) || self.msh_views && solver.is_none() && formats::is_msh(path)
    }

    fn job(&self) -> Job {
        Job {
            mesh: self.mesh.clone(),
            cad: self.cad.clone(),
            linkage: self.linkage.clone(),
            cad_scale: self.reading.scale(),
            reading: self.reading.options(),
            mesh_reading: input::reading(),
            solver: self.output.first().cloned().zip(self.form.solver()),
            settings: self.settings(),
        }
    }

    /// How many orders are curved at most, one after another.
    fn orders(&self) -> usize {
        let at_once = self.direct || self.surface || self.engine == smooth::Engine::Gradient;
        if at_once { 1 } else { self.order.get() - 1 }
    }

    fn settings(&self) -> Settings {
        Settings {
            patches: self.patches(),
            surface: self.surface,
            order: self.order,
            by_tags: !self.ignore_tags,
            tolerance: self.tolerance,
            max_offset: self.max_offset,
            freeze_linear: self.freeze_linear,
            freeze_walls: self.freeze_walls,
            direct: self.direct,
            curve_layers: self.curve_layers.0,
            floor: self.floor,
            smoothing: smooth::Settings {
                threshold: self.threshold,
                alpha: self.alpha,
                max_sweeps: self.max_sweeps,
                survey_factor: usize::from(self.survey_factor),
                engine: self.engine,
            },
            resume: self.resume.clone(),
        }
    }
}

/// Curves a mesh, writes it, and prints the report.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    options.check()?;
    let job = options.job();
    let Some(output) = options.outputs().next() else {
        return dry_run(&job, options);
    };
    let limit = options.time_limit.map(Duration::from_secs_f64);
    let mut monitor = Monitor::new(options.quiet, limit, options.order, options.orders());
    let mut trace = Trace::new(&mut monitor);
    let mut checkpointing = Checkpointing::new(&mut trace, options.checkpoint.clone(), options.checkpoint_every);
    let curved = job.run(&mut checkpointing);
    let kept = checkpointing.failure().map_or(Ok(()), Err);
    let curved = match curved {
        Ok(curved) => curved,
        Err(error) => {
            monitor.finish();
            return Err(error.into());
        }
    };
    // The mesh first; and the rest also where the mesh could not be written.
    let missing = missing(options, &curved).filter(|_| !options.keep_invalid);
    signals::result_is(output, exit_code(options, &curved));
    let measures = if options.tells_measures() { measures(&curved) } else { Measures::default() };
    let written = if missing.is_none() { write(options, output, &curved, &measures) } else { Ok(Vec::new()) };
    let traced = options.trace.as_ref().map_or(Ok(()), |path| trace.write(path, &curved.smoothed));
    let swept = sweeps(&trace.sweeps(&curved.smoothed));
    monitor.finish();
    let mut beside = Beside::default();
    beside.tell(kept);
    beside.tell(traced);
    let mut further = Vec::new();
    for path in options.outputs().skip(1).filter(|_| missing.is_none()) {
        let fields = if options.shows_fields(path, None) { fields(&curved, &measures) } else { Vec::new() };
        match options.form.write_beside(path, &curved.mesh, &fields) {
            Ok(notes) => further.push((path, notes)),
            Err(error) => beside.tell(Err(error)),
        }
    }
    if let Some(path) = &options.open_faces {
        beside.tell(write_left_open(path, left_open(&curved)));
    }
    let mut report = report(&job, &curved, &measures, told::run(exit_code(options, &curved)));
    report.sweeps = swept;
    if let Some(path) = &options.report {
        beside.tell(write_json(path, &report));
    }
    if let Some(path) = &options.html {
        beside.tell(page(path, &report, &curved, &measures));
    }
    let stop = monitor.stop.map_or_else(String::new, |stop| format!("\n{stop}"));
    beside.tell(print(&format!("{report}{stop}")));
    let notes = written?;
    let written = output.display();
    match missing {
        Some(why) => message(format_args!("sagitta: {written}: not written, as {why} (--keep-invalid writes it)")),
        None => {
            let notes: String = notes.iter().map(|note| format!("note: {note}\n")).collect();
            beside.tell(print(&format!("{notes}written: {written}")));
            for (path, notes) in further {
                let notes: String = notes.iter().map(|note| format!("note: {note}\n")).collect();
                beside.tell(print(&format!("{notes}written: {}", path.display())));
            }
        }
    }
    Ok(beside.exit_code(exit_code(options, &curved)))
}

/// What of all that is asked for a mesh does not have.
fn missing(options: &Options, curved: &Curved) -> Option<&'static str> {
    if !curved.is_certified() {
        Some("not all elements are proven valid and all walls free of folds")
    } else if options.require_all && !is_all_on_cad(curved) {
        Some("not all boundary faces that belong to the CAD are on it")
    } else {
        None
    }
}

fn is_all_on_cad(curved: &Curved) -> bool {
    curved.off_cad.is_empty() && curved.open_faces.is_empty()
}

/// Prints which patches lie on which CAD faces.
fn dry_run(job: &Job, options: &Options) -> Result<u8, Failure> {
    let Preview { summary, linear, boundary, open_faces } = job.association()?;
    let mut beside = Beside::default();
    if let Some(path) = &options.report {
        beside.tell(write_json(path, &Told { document: &summary, run: told::run(DONE) }));
    }
    if let Some(path) = &options.open_faces {
        beside.tell(write_left_open(path, undecided(&linear, &boundary, &open_faces)));
    }
    beside.tell(print(&summary.to_string()));
    Ok(beside.exit_code(DONE))
}

/// Writes the faces that are not on the CAD, where there are any.
fn write_left_open(path: &Path, faces: Result<(Mesh, Vec<Field>), Inconsistent>) -> Result<(), Failure> {
    let (mesh, fields) = faces?;
    if mesh.blocks().is_empty() {
        message(format_args!("sagitta: {}: not written, as no boundary face is left open", path.display()));
        return Ok(());
    }
    formats::write(path, &mesh, &WriteOptions { fields: &fields, ..WriteOptions::default() })?;
    Ok(())
}

/// Writes the page.
fn page(path: &Path, report: &Report, curved: &Curved, measures: &Measures) -> Result<(), Failure> {
    let distances = face_distances(curved);
    let page = Page::new(report, &curved.mesh, measures)?;
    write_page(path, &page.text(|face| distances.get(&face).copied())?)
}

/// Writes the mesh; returns notes.
fn write(options: &Options, output: &Path, curved: &Curved, measures: &Measures) -> Result<Vec<String>, Failure> {
    let fields =
        if options.shows_fields(output, options.form.solver()) { fields(curved, measures) } else { Vec::new() };
    Ok(options.form.write(output, &curved.mesh, &fields)?)
}

fn exit_code(options: &Options, curved: &Curved) -> u8 {
    if missing(options, curved).is_some() {
        NOT_CERTIFIED
    } else if curved.smoothed.stopped {
        STOPPED
    } else if !is_all_on_cad(curved) {
        OFF_CAD
    } else {
        DONE
    }
}
