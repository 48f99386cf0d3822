//! What is wrong with an OpenFOAM mesh.

/// What can be wrong with an OpenFOAM mesh beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum FoamFault {
    #[error("there is no FoamFile header: it is none of OpenFOAM's files, or packed")]
    Header,
    #[error("numbers of {what} are of {bits} bits, and 32 or 64 are read")]
    Width { what: &'static str, bits: String },
    #[error("the file is big-endian (arch MSB), which is not read; foamFormatConvert writes it as text")]
    BigEndian,
    #[error("the class is {found:?}, and {wanted} is read")]
    Class { found: String, wanted: &'static str },
    #[error("face {face} names {what} {wrong}, and there are {count}")]
    Unknown { face: usize, what: &'static str, wrong: i64, count: usize },
    #[error("{owners} owners for {faces} faces: the files are of different meshes")]
    Owners { owners: usize, faces: usize },
    #[error("{neighbours} neighbours for {faces} faces: the files are of different meshes")]
    Neighbours { neighbours: usize, faces: usize },
    #[error(
        "cell {cell} near {at} has {faces}: it is none of tet, pyramid, prism and hex, and {others} more are none; polyhedra cannot be curved: mesh with standard cells (no castellation levels, no polyDualMesh)"
    )]
    Polyhedron { cell: usize, at: String, faces: String, others: usize },
    #[error("the patch {name} has the faces {first} to {last}, and there are {count}")]
    Patch { name: String, first: i64, last: i64, count: usize },
    #[error("the patch {name} has no {entry}")]
    Entry { name: String, entry: &'static str },
}

crate::formats::error::own!(FoamFault);
