//! How the CAD is read: options that several commands share.

use std::time::Duration;

use cad::child::this_program;
use cad::{ReadOptions, Reader};
use clap::Args;

use super::values::{factor, seconds};
use crate::cli::help::INPUT;
use crate::cli::input::memory;

/// Options of reading CAD.
#[derive(Args)]
pub(super) struct Reading {
    /// Multiply the CAD's coordinates by this factor; `auto` finds the ratio of units that fits
    #[arg(long, value_name = "F|auto", default_value = "1", value_parser = scale, help_heading = INPUT)]
    cad_scale: Scale,
    /// Seconds after which reading the CAD is abandoned
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = seconds, help_heading = INPUT, hide_short_help = true)]
    cad_timeout: f64,
}

/// The factor of `--cad-scale`; `None` is `auto`.
#[derive(Clone, Copy, Debug)]
struct Scale(Option<f64>);

fn scale(text: &str) -> Result<Scale, String> {
    if text == "auto" { Ok(Scale(None)) } else { factor(text).map(|factor| Scale(Some(factor))) }
}

impl Reading {
    /// The factor; `None` is the one that fits.
    pub(super) fn scale(&self) -> Option<f64> {
        self.cad_scale.0
    }

    /// What reading needs to know, with the given factor or none yet.
    pub(super) fn options(&self) -> ReadOptions {
        in_a_child(self.cad_timeout, self.scale().unwrap_or(1.0))
    }
}

/// This very program reads the CAD in a child process, which a malformed file may crash.
pub(super) fn in_a_child(timeout: f64, scale: f64) -> ReadOptions {
    let reader = Reader::new(this_program());
    let memory_limit = memory(reader.memory_limit);
    let reader = Reader { timeout: Duration::from_secs_f64(timeout), memory_limit, ..reader };
    ReadOptions { scale, reader: Some(reader) }
}
