//! `sagitta explain`.

use clap::Args;
use linkage_schema::Code;

use crate::cli::exit::DONE;
use crate::cli::output::{Failure, print};

/// Options of `sagitta explain`.
#[derive(Args)]
pub(super) struct Options {
    /// Codes such as ML302 [default: all]
    codes: Vec<String>,
}

/// A code that does not exist.
#[derive(Debug, thiserror::Error)]
#[error("there is no code {0:?}; `sagitta explain` lists all")]
struct UnknownCode(String);

/// Prints what codes of findings mean.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    if options.codes.is_empty() {
        let lines =
            Code::ALL.iter().map(|code| format!("{code} {:<7} {}", code.severity().to_string(), code.meaning()));
        print(&lines.collect::<Vec<_>>().join("\n"))?;
        return Ok(DONE);
    }
    for text in &options.codes {
        let code = Code::from_id(text).ok_or_else(|| UnknownCode(text.clone()))?;
        print(&format!("{code} ({})\n{}\nRemedy: {}.", code.severity(), code.meaning(), code.remedy()))?;
    }
    Ok(DONE)
}
