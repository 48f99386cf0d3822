//! Options of commands that write a mesh: how it is written.

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

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
    #[arg(long, value_name = "VERSION", value_enum, default_value_t)]
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

impl ValueEnum for msh::Version {
    fn value_variants<'a>() -> &'a [msh::Version] {
        &msh::Version::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}
