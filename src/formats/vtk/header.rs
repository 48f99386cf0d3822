//! What the outermost tag of a VTU file says of all its arrays.

use super::compressed::Compressor;
use super::fault::VtkFault;
use crate::formats::error::Fault;

/// The attributes of `VTKFile`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Header {
    /// Major and minor number; the order of a hex' nodes depends on it.
    pub(super) version: Option<(u32, u32)>,
    /// Whether numbers begin with their most significant byte; what is not said is not guessed where arrays are bytes.
    pub(super) big_endian: Option<bool>,
    /// Whether the lengths before arrays have 8 bytes, not 4.
    pub(super) long_lengths: bool,
    pub(super) compressor: Option<Compressor>,
}

impl Header {
    /// From the attributes' values, by name.
    ///
    /// # Errors
    /// [`Fault::Unexpected`] where a value is none of those that VTK writes; a compressor that is not known.
    pub(super) fn new(attribute: impl Fn(&str) -> Option<String>) -> Result<Header, Fault> {
        let unexpected =
            |what, found: String| -> Fault { Fault::Unexpected { what, found: found.chars().take(40).collect() } };
        let kind = attribute("type").unwrap_or_default();
        if kind != "UnstructuredGrid" {
            return Err(unexpected("type: UnstructuredGrid", kind));
        }
        let either = |name: &str, words: [&str; 2], what: &'static str| match attribute(name) {
            None => Ok(None),
            Some(word) if word == words[0] => Ok(Some(false)),
            Some(word) if word == words[1] => Ok(Some(true)),
            Some(other) => Err(unexpected(what, other)),
        };
        let version = attribute("version").map(|word| {
            let (major, minor) = word.trim().split_once('.').unwrap_or((word.trim(), "0"));
            let version = major.parse().and_then(|major| minor.parse().map(|minor| (major, minor)));
            version.map_err(|_| unexpected("version, as 2.2", word.clone()))
        });
        let compressor = attribute("compressor")
            .map(|name| Compressor::of(&name).ok_or_else(|| VtkFault::Compressed(format!("{name} is not known"))));
        Ok(Header {
            version: version.transpose()?,
            big_endian: either("byte_order", ["LittleEndian", "BigEndian"], "byte_order: LittleEndian or BigEndian")?,
            long_lengths: either("header_type", ["UInt32", "UInt64"], "header_type: UInt32 or UInt64")?
                .unwrap_or(false),
            compressor: compressor.transpose()?,
        })
    }
}
