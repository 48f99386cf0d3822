//! The run of the program as its documents tell of it.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use clap::{ArgMatches, Command};

use super::exit::meaning;
use crate::report::Run;

/// The options of the command with their values; set once, before it is run.
static OPTIONS: OnceLock<BTreeMap<String, Vec<String>>> = OnceLock::new();

/// Keeps the options of the command that the arguments choose.
pub(super) fn keep(program: &Command, matches: &ArgMatches) {
    let Some((name, own)) = matches.subcommand() else { return };
    let Some(command) = program.find_subcommand(name) else { return };
    let mut options = BTreeMap::new();
    for argument in command.get_arguments().chain(program.get_arguments().filter(|own| own.is_global_set())) {
        let Ok(Some(values)) = own.try_get_raw(argument.get_id().as_str()) else { continue };
        let name = argument.get_long().unwrap_or(argument.get_id().as_str()).to_owned();
        options.insert(name, values.map(|value| value.to_string_lossy().into_owned()).collect());
    }
    let _ = OPTIONS.set(options); // nothing else sets it
}

/// The run of this program, which ends now with this exit code unless something beside its result goes wrong.
pub(super) fn run(exit_code: u8) -> Run {
    Run {
        command: std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect(),
        options: OPTIONS.get().cloned().unwrap_or_default(),
        exit_code: Some(exit_code),
        reason: Some(meaning(exit_code).to_owned()),
        ..Run::ending_now()
    }
}
