//! The `sagitta` program: see [`sagitta::cli`].
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    sagitta::cli::run(std::env::args_os().collect())
}
