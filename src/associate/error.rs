//! Why a mesh could not be associated with its CAD.

use glam::DVec3;

use super::Teller;

/// Mesh and CAD do not belong together, or not as candidate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum AssociateError {
    /// CAD and mesh differ in unit.
    #[error(
        "mesh and CAD differ in size by a factor of about {factor}: the mesh's bounding-box diagonal is {mesh:.6}, the CAD's {cad:.6}; \
         if the CAD is in another unit, give --cad-scale {factor} (or --cad-scale auto)"
    )]
    Scale { mesh: f64, cad: f64, factor: f64 },
    /// CAD and mesh differ in size, and by no factor between units.
    #[error(
        "mesh and CAD differ in size by a factor of about {factor:.6}, which is no ratio of known units: the bounding-box diagonal is {mesh:.6} of what is associated of the mesh, {cad:.6} of the CAD; they do not seem to belong together (--cad-scale F takes any factor)"
    )]
    Size { mesh: f64, cad: f64, factor: f64 },
    /// CAD and mesh lie apart.
    #[error(
        "mesh and CAD are in different positions: the centres of their bounding boxes are {distance:.6} apart, the mesh's diagonal is {mesh:.6}; translate one of them"
    )]
    Place { mesh: f64, distance: f64 },
    /// A tag or number that means another place on this CAD.
    #[error(
        "{label} is associated with {entities}, but {count} of its {of} points are not on it: the farthest, node {node} at {at}, is \
         {distance:.3e} away (limit {limit:.3e}). {}raise --max-offset if the mesh is this far off its CAD", teller.off()
    )]
    Off {
        label: String,
        entities: String,
        count: usize,
        of: usize,
        node: u64,
        at: DVec3,
        distance: f64,
        limit: f64,
        teller: Teller,
    },
    /// A tag that is another entity's number on this CAD.
    #[error("{label} is associated with {entities}, but its points, though near it, lie on {other}: {}", teller.elsewhere())]
    Elsewhere { label: String, entities: String, other: String, teller: Teller },
    /// An edge between two surfaces with no CAD edge.
    #[error(
        "the mesh edge {a}-{b} lies between {first} and {second}, but on no CAD edge that they share: associate it with a curve {}, or mesh both sides as one surface", teller.place()
    )]
    NoCurve { a: u64, b: u64, first: String, second: String, teller: Teller },
    /// A mesh beside the CAD, not on it.
    #[error(
        "no part of the mesh is associated with the CAD: {label} runs beside it, up to {distance:.3e} off; if the mesh was made on this CAD, give \
         --tolerance {tolerance:.1e}"
    )]
    Apart { label: String, distance: f64, tolerance: f64 },
    /// CAD geometry that cannot be asked.
    #[error("{label}: {cause}")]
    Group { label: String, cause: String },
    /// Nothing to do.
    #[error(
        "no part of the mesh is associated with the CAD: {}", teller.nothing(*surfaces, *faces)
    )]
    Nothing { surfaces: usize, faces: usize, teller: Teller },
}

/// What to do about it, by who said it.
impl Teller {
    /// Points are not on what they are said to be on; what to do, but for raising the limit.
    fn off(self) -> &'static str {
        match self {
            Self::Tags => "The numbers may belong to another CAD file; give a linkage file, or ",
            Self::Linkage => {
                "The linkage may be of another CAD file or of another mesh; correct it (sagitta validate lists all that does \
                 not hold), or "
            }
            Self::Geometry => "",
        }
    }

    /// Points are on another entity.
    fn elsewhere(self) -> &'static str {
        match self {
            Self::Tags | Self::Geometry => "the numbers belong to another CAD file; give a linkage file",
            Self::Linkage => "the linkage belongs to another CAD file; give the one that it names, or correct it",
        }
    }

    /// Where an edge is to be associated with a curve.
    fn place(self) -> &'static str {
        match self {
            Self::Tags | Self::Geometry => "by a linkage file",
            Self::Linkage => "in the linkage file",
        }
    }

    fn nothing(self, surfaces: usize, faces: usize) -> String {
        match self {
            Self::Tags => format!(
                "of its {surfaces} surface entities none has the number of a CAD face (1 to {faces}); give a linkage file"
            ),
            Self::Linkage => format!(
                "of the {surfaces} sheets of the linkage none names one of the CAD's {faces} faces; is it of another CAD file?"
            ),
            Self::Geometry => format!("none of its faces lies on one of the CAD's {faces} faces"),
        }
    }
}

impl AssociateError {
    /// Whether this says of entity tags that they are not the CAD's numbers, rather than that a few points are off.
    pub(super) fn tags_are_of_no_use(&self) -> bool {
        match self {
            Self::Off { count, of, .. } => 2 * count > *of,
            Self::Group { .. } => false,
            // A box of another size or place may be that of other entities than meant.
            _ => true,
        }
    }
}
