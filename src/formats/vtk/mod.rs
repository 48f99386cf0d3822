//! VTK: XML unstructured grids (VTU) read and written, legacy files read.

mod array;
mod compressed;
mod grid;
mod legacy;
mod write;
mod xml;

pub(super) use legacy::read as read_legacy;
pub(super) use write::write;
pub(super) use xml::read as read_xml;
