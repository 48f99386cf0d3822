//! `sagitta project`.

use std::io::BufReader;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use cad::{Aabb, Foot, Group, Model};
use clap::Args;
use glam::DVec3;

use super::live::Live;
use super::points;
use super::progress::INTERVAL;
use super::reading::in_a_child;
use super::values::{factor, seconds};
use crate::cli::exit::{DONE, NOT_CERTIFIED};
use crate::cli::files::Files;
use crate::cli::help::{INPUT, OUTPUT, RUN};
use crate::cli::input::memory;
use crate::cli::output::{Beside, Failure, message, print, write_json};
use crate::cli::{signals, threads, told};
use crate::formats;
use crate::report::{CadReport, FeetReport, Told};

/// Points that are projected between two looks at the clock.
const CHUNK: usize = 1 << 14;

/// Options of `sagitta project`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    /// The CAD: STEP, IGES or BREP
    cad: PathBuf,
    /// CSV file with columns x, y, z; `-` for stdin
    points: PathBuf,
    /// The CAD entities to project onto, as `sagitta groups` lists them [default: all faces and free edges]
    #[arg(long, value_name = "REF,...", help_heading = INPUT)]
    group: Vec<String>,
    /// CSV file for the feet; `-` for stdout
    #[arg(short, long, value_name = "FEET.csv", default_value = "-", help_heading = OUTPUT)]
    output: PathBuf,
    /// Also write the counts as JSON
    #[arg(long, value_name = "R.json", help_heading = OUTPUT)]
    report: Option<PathBuf>,
    /// Multiply the CAD's coordinates by this factor
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = factor, help_heading = INPUT)]
    cad_scale: f64,
    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads::number, help_heading = RUN)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Seconds after which reading the CAD is abandoned
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = seconds, help_heading = INPUT)]
    cad_timeout: f64,
    /// No progress on stderr
    #[arg(short, long, help_heading = RUN)]
    quiet: bool,
}

/// Projects points onto CAD entities, writes their feet, and prints the report: on stdout, or on stderr where the feet go to stdout.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let streamed = options.output == Path::new("-");
    Files::default()
        .reads("the CAD", Some(&options.cad))
        .reads("the points", Some(&options.points))
        .writes("--output", (!streamed).then_some(&options.output))
        .writes("--report", options.report.as_ref())
        .check()?;
    let live = Live::new(options.quiet);
    let outcome = project(options, &live);
    live.finish();
    let (feet, report) = outcome?;
    let code = if report.unproven == 0 { DONE } else { NOT_CERTIFIED };
    let mut text = Vec::new();
    points::write(&mut text, &feet)?;
    let mut beside = Beside::default();
    if streamed {
        beside.tell(print(std::str::from_utf8(&text)?.trim_end()));
    } else {
        signals::result_is(&options.output, code);
        formats::write_bytes(&options.output, &text)?;
    }
    if let Some(path) = &options.report {
        beside.tell(write_json(path, &Told { document: &report, run: told::run(code) }));
    }
    match (streamed, options.quiet) {
        (false, _) => beside.tell(print(&format!("{report}\nwritten: {}", options.output.display()))),
        (true, false) => message(&report),
        (true, true) => {}
    }
    Ok(beside.exit_code(code))
}

fn project(options: &Options, live: &Live) -> Result<(Vec<Option<Foot>>, FeetReport), Failure> {
    live.text("reading the points".to_owned());
    let xs = read_points(&options.points)?;
    live.text(format!("{} points; reading the CAD", xs.len()));
    let model = Model::read(&options.cad, &in_a_child(options.cad_timeout, options.cad_scale))?;
    let references: Vec<String> = options.group.iter().flat_map(|list| split(list)).map(str::to_owned).collect();
    let entities = model.select(&references)?;
    let group = Group::of(&model, &entities).map_err(|error| format!("{}: {error}", options.cad.display()))?;
    let start = Instant::now();
    let feet = closest(&group, &xs, live);
    let seconds = start.elapsed().as_secs_f64();
    let cad = CadReport::new(&model, options.cad_scale);
    let mut report = FeetReport::new(cad, &references, entities.len(), &feet, seconds);
    report.notes.extend(model.losses());
    report.notes.extend(unit_trap(&xs, &group, report.mean_distance));
    Ok((feet, report))
}

/// The references of a list, without spaces around them: commas between quotation marks separate nothing.
fn split(list: &str) -> Vec<&str> {
    let mut quoted = false;
    let outside = |c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    list.split(outside).map(str::trim).collect()
}

/// Bytes of memory that points and their feet take for each byte of their text, about.
const MEMORY_OF_TEXT: u64 = 8;

fn read_points(path: &Path) -> Result<Vec<DVec3>, Failure> {
    let most = memory(u64::MAX) / MEMORY_OF_TEXT;
    let (name, read) = if path == Path::new("-") {
        ("standard input".to_owned(), points::read(std::io::stdin().lock(), most))
    } else {
        let name = path.display().to_string();
        let file = cad::regular::open(path).map_err(|error| format!("{name}: cannot be read: {error}"))?;
        (name, points::read(BufReader::new(file), most))
    };
    read.map_err(|flaw| format!("{name}, {flaw}").into())
}

/// The feet, chunk by chunk, so that progress can be shown.
fn closest(group: &Group, xs: &[DVec3], live: &Live) -> Vec<Option<Foot>> {
    let mut feet = Vec::with_capacity(xs.len());
    let (start, mut last) = (Instant::now(), Instant::now());
    live.text(format!("projecting {} points", xs.len()));
    for chunk in xs.chunks(CHUNK) {
        feet.extend(group.closest_batch(chunk, &mut []));
        if last.elapsed() >= INTERVAL {
            last = Instant::now();
            let left = start.elapsed().as_secs_f64() / feet.len() as f64 * (xs.len() - feet.len()) as f64;
            live.text(format!("{} of {} points projected, {left:.0} s left", feet.len(), xs.len()));
        }
    }
    feet
}

/// What to say where points and CAD seem to be in different units: the boxes differ by a factor between units, and the points are far off.
fn unit_trap(xs: &[DVec3], group: &Group, mean_distance: f64) -> Option<String> {
    let (ours, theirs) = (Aabb::of_points(xs.iter().copied()).diagonal(), group.bounds().diagonal());
    let factor = cad::unit_factor(ours, theirs).filter(|_| mean_distance > 0.1 * ours.min(theirs))?;
    Some(format!(
        "the points are {ours:.6} across, the CAD {theirs:.6}: if the CAD is in another unit, give --cad-scale {factor}"
    ))
}

#[cfg(test)]
mod tests {
    use super::split;

    #[test]
    fn commas_in_names_separate_nothing() {
        assert_eq!(split("face:1, name:\"A, B\",step:#4"), ["face:1", "name:\"A, B\"", "step:#4"]);
    }
}
