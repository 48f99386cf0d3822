//! Why there is no curved mesh.

use std::path::Path;

use super::checkpoint::CheckpointError;
use crate::associate::{AssociateError, ClassifyError, LinkageError, UnknownPatch};
use crate::element::Order;
use crate::formats;
use crate::mesh::{ElementId, Elements, TooMany};

/// Elements that an error lists by number.
const LISTED: usize = 10;

/// Why a mesh in memory was not curved.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The linkage does not fit the mesh or the CAD; the message names its file.
    #[error(transparent)]
    Linkage(#[from] LinkageError),
    /// The checkpoint cannot be gone on from; the message names its file.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// Mesh and CAD do not belong together.
    #[error(transparent)]
    Associate(Box<AssociateError>),
    /// The curved mesh has more nodes than can be numbered.
    #[error(transparent)]
    TooMany(#[from] TooMany),
    /// A patch was named that the mesh does not have.
    #[error(transparent)]
    UnknownPatch(#[from] UnknownPatch),
    /// Nothing to curve.
    #[error(
        "has no volume elements (tets, pyramids, prisms, hexes), nor triangles or quadrilaterals that all lie in one plane: nothing to curve; if it is a mesh of faces on CAD surfaces, --surface curves it"
    )]
    NoCells,
    /// Not a mesh of faces on curved surfaces.
    #[error("{0}: leave --surface away")]
    NotSurface(&'static str),
    /// Faces that lean over against the others on their CAD face.
    #[error(
        "{count} faces lie upside down on their CAD face, against most others there: {listed}; turn or repair them first"
    )]
    UpsideDown {
        /// How many faces.
        count: usize,
        /// The first of them, by kind and number.
        listed: String,
    },
    /// Nothing to curve onto.
    #[error("has no faces: nothing to curve onto")]
    NoFaces,
    /// Curved already.
    #[error("is of order {order} already; give the linear mesh")]
    NotLinear {
        /// The mesh's order.
        order: Order,
    },
    /// Boundary elements whose edges cross.
    #[error(
        "{count} boundary elements have the corners of a cell's side in an order in which their edges cross: {listed}; write their corners in order round"
    )]
    Crossed {
        /// How many elements.
        count: usize,
        /// The first of them, by kind and number.
        listed: String,
    },
    /// The linear mesh is invalid.
    #[error("the linear mesh is itself inverted in {count} elements: {listed}; repair it first")]
    Inverted {
        /// How many elements.
        count: usize,
        /// The first of them, by kind and number.
        listed: String,
    },
}

/// The first of some elements, by kind and number.
pub(super) fn listed(elements: &Elements, some: &[ElementId]) -> String {
    let named = some.iter().take(LISTED).map(|&id| format!("{} {}", elements.cell(id), elements.get(id).tag));
    let more = if some.len() > LISTED { ", ..." } else { "" };
    named.collect::<Vec<_>>().join(", ") + more
}

impl From<ClassifyError> for Error {
    fn from(error: ClassifyError) -> Error {
        match error {
            ClassifyError::Linkage(error) => error.into(),
            ClassifyError::Associate(cause) => Error::Associate(Box::new(cause)),
        }
    }
}

/// Why there is no curved mesh of a job. Every message names the file it is about.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// The mesh file.
    #[error(transparent)]
    Mesh(#[from] formats::Error),
    /// The CAD file.
    #[error(transparent)]
    Cad(#[from] cad::ReadError),
    /// What was read cannot be curved.
    #[error("{about}{cause}")]
    Curve {
        /// The files that it is about, where the cause does not name them.
        about: String,
        /// Why.
        cause: Box<Error>,
    },
}

impl JobError {
    /// An error with the names of the files that it is about.
    pub(super) fn new(cause: Error, mesh: &Path, cad: &Path, linkage: Option<&Path>) -> JobError {
        let (mesh, cad) = (mesh.display(), cad.display());
        let about = match (&cause, linkage) {
            (Error::Linkage(_) | Error::Checkpoint(_), _) => String::new(),
            (Error::Associate(_), Some(linkage)) => format!("{} for {mesh} and {cad}: ", linkage.display()),
            (Error::Associate(_), None) => format!("{mesh} and {cad}: "),
            (Error::NoFaces, _) => format!("{cad}: "),
            _ => format!("{mesh}: "),
        };
        JobError::Curve { about, cause: Box::new(cause) }
    }
}
