//! Serves the reading child process alone: `cad-reader __read-cad FILE`. Tests and benchmarks of the crate use it.

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().collect();
    match arguments.as_slice() {
        [_, command, path] if command == cad::READER_SUBCOMMAND => cad::serve_reader(Path::new(path)),
        _ => {
            eprintln!("usage: cad-reader {} FILE", cad::READER_SUBCOMMAND);
            ExitCode::from(2)
        }
    }
}
