//! What is wrong with a Nektar++ mesh.

/// What can be wrong with a Nektar++ file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum NektarFault {
    #[error("there is no GEOMETRY: the file is a session's, and its mesh is another file")]
    NoGeometry,
    #[error(
        "the mesh is in the HDF5 file {0:?}, which is not read; NekMesh IN.xml OUT.xml:xml:uncompress writes it as XML"
    )]
    Hdf5(String),
    #[error("DIM is {0:?}; meshes of dimension 2 and 3 are read")]
    Dimension(String),
    #[error("{section} {id} has no attribute {attribute}, or it is no whole number")]
    Attribute { section: &'static str, id: String, attribute: &'static str },
    #[error("{attribute} of VERTEX is {found:?}, which is no number: put its value there")]
    Scale { attribute: &'static str, found: String },
    #[error("{section} is packed as {found:?}; B64Z-LittleEndian and B64Z-BigEndian are read")]
    Packing { section: &'static str, found: String },
    #[error("{section} cannot be unpacked ({cause}): the file is damaged")]
    Packed { section: &'static str, cause: String },
    #[error("{section} {id} is of {letter}, which is none of T, Q, A, P, R and H")]
    Letter { section: &'static str, id: i64, letter: String },
    #[error("{section} {id} is there twice")]
    Twice { section: &'static str, id: i64 },
    #[error("{section} {id} names {what} {wrong}, which there is not")]
    Unknown { section: &'static str, id: i64, what: &'static str, wrong: i64 },
    #[error("{section} {id}: its {what} do not close round it: the file is damaged")]
    Open { section: &'static str, id: i64, what: &'static str },
    #[error("{section} {id} has {found} numbers, and should have {wanted}")]
    Length { section: &'static str, id: i64, found: usize, wanted: usize },
    #[error("the curve of {what} {id} has {found} points, and {announced} are announced")]
    Points { what: &'static str, id: i64, found: usize, announced: usize },
    #[error("the curve of {what} {id} has {found} points, which is none of P1 to P4: write the mesh at one of these")]
    Order { what: &'static str, id: i64, found: usize },
    #[error("the curve of {what} {id} has points of {kind:?}, which are not read here; write it with PolyEvenlySpaced")]
    Kind { what: &'static str, id: i64, kind: String },
    #[error("the pyramids' geometry beyond P2 is not one of polynomials that this program has: write the mesh at P2")]
    Pyramids,
    #[error("composite {id} holds {found:?}, which is no list of T, Q, A, P, R, H, F or E with numbers in brackets")]
    Composite { id: i64, found: String },
    #[error(
        "the elements take {needed} MB of memory at their order, and the limit is {limit} MB; raise it (--memory-limit)"
    )]
    Memory { needed: u64, limit: u64 },
}

crate::formats::error::own!(NektarFault);
