//! What is wrong with a CGNS file's content.

use crate::formats::error::{Flaw, Place};

/// What can be wrong with a node of a CGNS file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum CgnsFault {
    #[error("no {label} {name} in this node")]
    Missing { label: &'static str, name: &'static str },
    #[error(
        "no coordinate {name} among {found:?}; only Cartesian ones are read: export the mesh with CoordinateX, CoordinateY, CoordinateZ"
    )]
    Coordinates { name: &'static str, found: String },
    #[error("{0}")]
    Told(String),
    #[error("the file ends here, and its head says that it has {0} bytes: it was cut off; copy or write it again")]
    Cut(u64),
    #[error("the HDF5 library cannot read the head of the file: {0}")]
    Head(String),
    #[error("reading took longer than {0} s and was ended at this node: a malformed file")]
    Slow(u64),
    #[error("reading needs more than {0} MB of memory from this node on: a malformed file")]
    Memory(u64),
    #[error("reading it gives more than {0} MB: a malformed file")]
    TooMuch(u64),
    #[error("the HDF5 library failed at this node or behind it ({0}): the file is malformed")]
    Crash(String),
    #[error("its data are not {0}: the file is damaged")]
    NotNumbers(&'static str),
    #[error(
        "the file has no CGNSBase_t: it is an empty CGNS file, or one of the many other kinds of HDF5 files (MED, netCDF, Exodus, ...), which are not read"
    )]
    NoBase,
    #[error("the base has no zone")]
    NoZone,
    #[error("the base has cells of dimension {0}; 2 and 3 are read")]
    Dimension(i64),
    #[error("a zone of type {0:?}; structured and unstructured zones are read")]
    ZoneType(String),
    #[error(
        "{points} points and {cells} cells along axis {axis} are no size of a structured zone: the file is damaged"
    )]
    Size { axis: usize, points: i64, cells: i64 },
    #[error("{0} is no range of the zone's indices, or does not match the other zone's: the file is damaged")]
    IndexRange(&'static str),
    #[error("joins points that are up to {0:.1e} apart: its ranges or its Transform are wrong")]
    Apart(f64),
    #[error("{0:?} does not map the axes of one zone to those of another: the file is damaged")]
    Transform(Vec<i64>),
    #[error("{what} has {found} values where {needed} are needed: the file is damaged")]
    Length { what: &'static str, found: usize, needed: u64 },
    #[error("the zone counts {needed} cells, and its sections have {found}: the file is damaged")]
    Cells { found: usize, needed: u64 },
    #[error("elements {first} to {last}: not a range of element numbers")]
    Range { first: i64, last: i64 },
    #[error("element numbers {0} belong to two sections: the file is damaged")]
    Overlap(u64),
    #[error(
        "arbitrary polyhedra (NGON_n, NFACE_n), which cannot be curved; export the mesh with standard elements (tets, pyramids, prisms, hexes)"
    )]
    Polyhedra,
    #[error(
        "element type {0} leaves out interior nodes (serendipity); export complete elements, or linear ones, from which curved ones are made"
    )]
    Incomplete(i64),
    #[error("element type {0} is not a CGNS element of order 1 to 4")]
    UnknownType(i64),
    #[error("refers to zone {0:?}, which the base does not have")]
    UnknownZone(String),
    #[error("lists {found} points but {donors} of the other zone")]
    Unpaired { found: usize, donors: usize },
}

crate::formats::error::own!(CgnsFault);

/// What the library says of a file that it does not open, with the place: where the file ends, if it is too short, else its head.
pub(super) fn unopened(cause: &str) -> Flaw {
    let number = |name: &str| cause.split(name).nth(1)?.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok();
    match (number(" eof = "), number("stored_eof = ")) {
        (Some(end), Some(announced)) => Flaw::new(Place::Byte(end), CgnsFault::Cut(announced)),
        _ => Flaw::new(Place::Byte(0), CgnsFault::Head(cause.to_owned())),
    }
}
