//! MeshLink documents: which entity of a CAD file each wall face, edge and point of a mesh lies on.
//!
//! A mesh generator knows on which surface it put a triangle; a mesh file does not say. MeshLink is the XML format
//! that says it, beside the mesh. This crate reads, writes and resolves such documents. It knows neither CAD nor mesh:
//! references are strings, points are numbers.
//!
//! ```text
//!  file ──read──► Document + Findings ──resolve──► Resolution: sheets, strings, points with their CAD entities
//!                    │                                 + Findings (dangling, duplicate, nested, ...)
//!                    └──write──► file
//! ```
//!
//! * [`read_path`], [`read`]: a stream becomes a [`Document`]; what is not XML or not MeshLink is a [`ReadError`], all else
//!   that is wrong is a [`Finding`] with its place, so that one run tells all. [`Reading::accept`] refuses what has errors.
//! * [`resolve`]: ids become what they stand for, `gref` is inherited, groups are flattened.
//! * [`write`](write()): the document as text; reading it again gives an equal document.
//! * `linkage.xsd`, also as [`SCHEMA`], describes the format for other tools.
//!
//! ```
//! let text = r#"<MeshLink version="1.0" xmlns="https://cadence.com">
//!   <GeometryFile filename="plate.step"><GeometryReference gid="1" ref="face-1"/></GeometryFile>
//!   <MeshFile filename="plate.msh"><MeshModelReference ref="fluid">
//!     <MeshSheet name="wall" gref="1"><MeshFace etype="Tri3" count="2">1 2 3  2 4 3</MeshFace></MeshSheet>
//!   </MeshModelReference></MeshFile>
//! </MeshLink>"#;
//! let reading = linkage_schema::read(text.as_bytes(), "plate.xml".as_ref())?;
//! let document = reading.accept()?;
//! let resolution = linkage_schema::resolve(&document);
//! for sheet in &resolution.models[0].sheets {
//!     for run in &sheet.faces {
//!         let entities: Vec<&str> = run.entities().iter().map(|entity| entity.reference).collect();
//!         assert_eq!(entities, ["face-1"]);
//!         assert_eq!(run.run.faces().collect::<Vec<_>>(), [[1, 2, 3], [2, 4, 3]]);
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod cursor;
mod document;
mod error;
mod finding;
mod id;
mod mesh;
mod origin;
mod read;
mod resolve;
mod vocabulary;
mod words;
mod write;

pub use document::{Attribute, AttributeGroup, Document, ElementLinkage};
pub use document::{GeometryFile, GeometryGroup, GeometryReference, Transform};
pub use error::{ReadError, Refused, WriteError};
pub use finding::{Code, Finding, Findings, Severity};
pub use id::{AttributeId, GeometryId, MeshId, TransformId};
pub use mesh::{Common, EdgeRun, Encoding, EntityRun, FaceRun, FaceShape, MeshFile, MeshModel, MeshString};
pub use mesh::{ParamVertex, Parameters, PointRun, Sheet, SheetBody, StringBody, VertexRef};
pub use origin::{Origin, Position};
pub use read::{Reading, read, read_path};
pub use resolve::{EdgeLink, ElementPair, Entity, EntityLink, FaceLink, MeshElement, ModelLinks, PointLink};
pub use resolve::{Resolution, SheetLinks, StringLinks, Target, resolve};
pub use write::{write, write_path};

/// The namespace of MeshLink documents. Readers match by local name; writers use this one.
pub const NAMESPACE: &str = "https://cadence.com";

/// The XML Schema of the format, in this project's own words (`linkage-schema/linkage.xsd`).
pub const SCHEMA: &str = include_str!("../linkage.xsd");
