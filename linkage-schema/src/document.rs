//! The document: attributes, geometry, transforms and linkages. The mesh side is in [`mesh`](crate::mesh).

use crate::{AttributeId, GeometryId, MeshFile, Origin, TransformId};

/// A whole MeshLink file. Elements of one kind keep their order; the order among kinds carries no meaning and is not kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The version the file claims, usually `1.0`.
    pub version: String,
    /// Named values that other elements refer to.
    pub attributes: Vec<Attribute>,
    /// Sets of attributes and of such sets.
    pub attribute_groups: Vec<AttributeGroup>,
    /// CAD files and their entities.
    pub geometry_files: Vec<GeometryFile>,
    /// Sets of CAD entities.
    pub geometry_groups: Vec<GeometryGroup>,
    /// Mesh files and what is linked in them.
    pub mesh_files: Vec<MeshFile>,
    /// Transforms, for periodic pairs.
    pub transforms: Vec<Transform>,
    /// Pairs of mesh elements of which one follows the other.
    pub linkages: Vec<ElementLinkage>,
    /// The root element.
    pub origin: Origin,
}

/// A value that the writing program wanted to tell; known names are `geometry format`, `model size`, `mesh format`,
/// `mesh filetype`, `linkage type`.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Its id.
    pub id: AttributeId,
    /// What the value is.
    pub name: Option<String>,
    /// The value, as it stands in the file.
    pub value: String,
    /// Its place.
    pub origin: Origin,
}

/// A set of attributes under one id; it may contain other sets.
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeGroup {
    /// Its id, from the same space as those of the attributes.
    pub id: AttributeId,
    /// Its name.
    pub name: Option<String>,
    /// Attributes and groups.
    pub members: Vec<AttributeId>,
    /// Its place.
    pub origin: Origin,
}

/// A CAD file and the entities of it that the document speaks of.
#[derive(Clone, Debug, PartialEq)]
pub struct GeometryFile {
    /// The path as written: possibly absolute, possibly of another machine.
    pub filename: String,
    /// Attributes of the file.
    pub aref: Option<AttributeId>,
    /// Its entities.
    pub references: Vec<GeometryReference>,
    /// Its place.
    pub origin: Origin,
}

/// One entity of a CAD file.
#[derive(Clone, Debug, PartialEq)]
pub struct GeometryReference {
    /// Its id.
    pub id: GeometryId,
    /// How the entity is called in the CAD file.
    pub reference: String,
    /// A name for people; the reference where none is given.
    pub name: Option<String>,
    /// Attributes of the entity.
    pub aref: Option<AttributeId>,
    /// Its place.
    pub origin: Origin,
}

/// A set of CAD entities under one id; no set contains another.
#[derive(Clone, Debug, PartialEq)]
pub struct GeometryGroup {
    /// Its id, from the same space as those of the references.
    pub id: GeometryId,
    /// Its name.
    pub name: Option<String>,
    /// Attributes of the group.
    pub aref: Option<AttributeId>,
    /// The references.
    pub members: Vec<GeometryId>,
    /// Its place.
    pub origin: Origin,
}

/// A transform, commonly a 4x4 matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Transform {
    /// Its id.
    pub id: TransformId,
    /// Its name.
    pub name: Option<String>,
    /// Attributes of the transform.
    pub aref: Option<AttributeId>,
    /// The content as it stands in the file.
    pub content: String,
    /// Its place.
    pub origin: Origin,
}

impl Transform {
    /// The content as 16 finite numbers, in the file's order.
    ///
    /// Writers disagree whether the translation is elements 3, 7, 11 (column vectors) or 12, 13, 14 (row vectors, as in
    /// files seen in the wild): try both against the nodes.
    pub fn matrix(&self) -> Option<[f64; 16]> {
        let numbers: Option<Vec<f64>> = self
            .content
            .split_ascii_whitespace()
            .map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()))
            .collect();
        numbers?.try_into().ok()
    }
}

/// One mesh element follows another, for example the two sides of a periodic domain.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementLinkage {
    /// Name or `mid` of the element that leads.
    pub source: String,
    /// Name or `mid` of the element that follows.
    pub target: String,
    /// The transform from one to the other.
    pub transform: Option<TransformId>,
    /// Attributes of the linkage; `linkage type` tells its kind.
    pub aref: Option<AttributeId>,
    /// Its name.
    pub name: Option<String>,
    /// Its place.
    pub origin: Origin,
}
