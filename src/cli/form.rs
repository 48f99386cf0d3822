//! Options of commands that write a mesh: how it is written.

use clap::Args;

use crate::formats::{self, Field, WriteOptions, msh};

/// Help of a mesh that is read.
pub(super) fn mesh(what: &str) -> String {
    format!("{what}: {}", formats::readable("or"))
}

/// Help of a mesh that is written.
pub(super) fn output(what: &str) -> String {
    format!("{what}: {}", formats::writable())
}

/// Where a format leaves a choice.
#[derive(Args)]
pub(super) struct Form {
    /// VTU: leave the boundary elements out, for readers that refuse mixed dimensions
    #[arg(long)]
    volume_only: bool,
    /// Version of the MSH file
    #[arg(long, value_name = "4.1|2.2", default_value = "4.1", value_parser = msh_version)]
    msh_version: msh::Version,
    /// MSH: write text rather than binary
    #[arg(long)]
    ascii: bool,
}

impl Form {
    /// The choice, and fields to show.
    pub(super) fn with<'a>(&self, fields: &'a [Field]) -> WriteOptions<'a> {
        WriteOptions {
            msh_version: self.msh_version,
            msh_encoding: if self.ascii { msh::Encoding::Ascii } else { msh::Encoding::Binary },
            volume_only: self.volume_only,
            fields,
        }
    }
}

fn msh_version(text: &str) -> Result<msh::Version, String> {
    match text {
        "4.1" => Ok(msh::Version::V4_1),
        "2.2" => Ok(msh::Version::V2_2),
        _ => Err(format!("{text:?} is no version that is written: give 4.1 or 2.2")),
    }
}
