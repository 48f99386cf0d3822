//! From a file to a model: in this process, or in a child that malformed files may crash.

mod assemble;
mod format;
pub(crate) mod import;
mod payload;
pub(crate) mod reader;
