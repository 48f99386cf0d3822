//! The claims of a MeshLink file.

use std::path::{Path, PathBuf};

use cad::{EntityId, Model, ReferenceError};
use linkage_schema::{Entity, ModelLinks};
use rustc_hash::FxHashMap;

use super::{Boundary, Claimed, Claims, NotPeriodic, periodic_records, periodic_sheets};
use crate::element::Order;
use crate::mesh::{EntityKey, Mesh, NodeId};

/// Why a linkage file could not be used with this mesh and CAD. Every variant names the file and the place.
#[derive(Debug, thiserror::Error)]
pub enum LinkageError {
    /// Not readable, or not MeshLink.
    #[error(transparent)]
    Read(#[from] linkage_schema::ReadError),
    /// MeshLink with errors of its own.
    #[error(transparent)]
    Refused(#[from] linkage_schema::Refused),
    /// It links no mesh.
    #[error("{}: links nothing: it has no MeshModelReference", file.display())]
    Empty {
        /// The linkage file.
        file: PathBuf,
    },
    /// A reference to nothing in the CAD.
    #[error("{place}: {label} {source}")]
    Reference {
        /// File, line and column.
        place: String,
        /// The sheet, string or point.
        label: String,
        /// What is wrong with the reference.
        source: ReferenceError,
    },
    /// A node number that the mesh lacks.
    #[error("{place}: {label} refers to node {index}, but the mesh has no such node (its numbers go up to {last})")]
    Node {
        /// File, line and column.
        place: String,
        /// The sheet, string or point.
        label: String,
        /// The number in the linkage file.
        index: u32,
        /// The mesh's largest number.
        last: u64,
    },
    /// A periodic pair that is none.
    #[error("{place}: {cause}; correct the transform, or what it pairs")]
    Periodic {
        /// File, line and column.
        place: String,
        /// What does not correspond.
        cause: NotPeriodic,
    },
    /// A face that is no boundary face.
    #[error("{place}: {label} has a face with the nodes {nodes:?}, which is no boundary face of the mesh")]
    Face {
        /// File, line and column.
        place: String,
        /// The sheet.
        label: String,
        /// The nodes, by number.
        nodes: Vec<u32>,
    },
}

/// Reads a linkage file and looks its references and node numbers up.
///
/// # Errors
/// [`LinkageError`].
pub fn read_linkage(path: &Path, mesh: &Mesh, boundary: &Boundary, model: &Model) -> Result<Claims, LinkageError> {
    let document = linkage_schema::read_path(path)?.accept()?;
    let resolution = linkage_schema::resolve(&document).accept(path)?;
    if resolution.models.is_empty() {
        return Err(LinkageError::Empty { file: path.to_owned() });
    }
    let numbers = mesh.node_tags.iter().zip(0..).filter_map(|(&tag, n)| Some((tag, NodeId::new(n).ok()?))).collect();
    let reader = Reader { path, mesh, boundary, model, numbers };
    let mut claims = Claims { trusted: names(&document, model.path()), ..Claims::default() };
    for links in &resolution.models {
        reader.model(links, &mut claims)?;
    }
    for pair in &resolution.pairs {
        let Some(sheets) = periodic_sheets(pair, &resolution) else { continue };
        let node = |index: u32| reader.numbers.get(&u64::from(index)).copied();
        let records = periodic_records(pair, sheets, mesh, boundary, &node);
        let place = || reader.place(pair.linkage.origin);
        claims.periodic.extend(records.map_err(|cause| LinkageError::Periodic { place: place(), cause })?);
    }
    Ok(claims)
}

/// Whether every CAD file that the document names has the name of this one.
fn names(document: &linkage_schema::Document, cad: &Path) -> bool {
    !document.geometry_files.is_empty() && document.geometry_files.iter().all(|file| same_file(&file.filename, cad))
}

/// Whether a document means this file: it has the same name, in whatever folder; documents may leave the extension out.
#[must_use]
pub fn same_file(named: &str, path: &Path) -> bool {
    // A path in the document may be another system's: compare what follows the last separator of either kind.
    let name = named.rsplit(['/', '\\']).next().unwrap_or(named);
    [path.file_name(), path.file_stem()].into_iter().flatten().any(|own| own.to_string_lossy() == name)
}

struct Reader<'a> {
    path: &'a Path,
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    model: &'a Model,
    numbers: FxHashMap<u64, NodeId>,
}

impl Reader<'_> {
    fn model(&self, links: &ModelLinks, claims: &mut Claims) -> Result<(), LinkageError> {
        self.named(links, claims)?;
        for sheet in &links.sheets {
            for run in &sheet.faces {
                let label = format!("sheet {:?}", sheet.name().unwrap_or(""));
                let place = self.place(run.run.origin);
                let faces = run.run.faces().map(|face| self.face(face, &place, &label));
                let items = faces.collect::<Result<_, _>>()?;
                let entities = self.entities(run.entities(), &place, &label)?;
                push(&mut claims.sheets, Claimed { label, items, entities });
            }
        }
        for string in &links.strings {
            for run in &string.edges {
                let label = format!("string {:?}", string.name().unwrap_or(""));
                let place = self.place(run.run.origin);
                let edges = run.run.edges().map(|[a, b]| {
                    Ok::<_, LinkageError>([self.node(a, &place, &label)?, self.node(b, &place, &label)?])
                });
                let items = edges.collect::<Result<_, _>>()?;
                let entities = self.entities(run.entities(), &place, &label)?;
                push(&mut claims.strings, Claimed { label, items, entities });
            }
        }
        for point in &links.points {
            let place = self.place(point.run.origin);
            let label = "point".to_owned();
            let nodes = point.run.indices.iter().map(|&index| self.node(index, &place, &label));
            let items = nodes.collect::<Result<_, _>>()?;
            let entities = self.entities(point.entities(), &place, &label)?;
            push(&mut claims.points, Claimed { label, items, entities });
        }
        Ok(())
    }

    /// Sheets and strings that are called by the names which the mesh file gives to sets of faces and edges.
    fn named(&self, links: &ModelLinks, claims: &mut Claims) -> Result<(), LinkageError> {
        let unknown = |place: String, label: &str, what: &str| {
            format!("{place}: {label} calls {what} by name, which the mesh file does not have; not used")
        };
        let known = |entity: EntityKey, name: &str| self.mesh.names_of(entity).iter().any(|own| own == name);
        for sheet in &links.sheets {
            let label = format!("sheet {:?}", sheet.name().unwrap_or(""));
            let place = self.place(sheet.sheet.origin);
            if let Some(name) = sheet.reference {
                let faces = 0..self.boundary.faces.len();
                let items: Vec<usize> = faces.filter(|&f| known(self.boundary.faces[f].entity, name)).collect();
                let entities = sheet.target.as_deref().map_or(&[][..], |target| &target.entities);
                let entities = self.entities(entities, &place, &label)?;
                if items.is_empty() {
                    claims.notes.push(unknown(place, &label, &format!("{name:?}")));
                } else {
                    claims.sheets.push(Claimed { label, items, entities });
                }
            } else if !sheet.named.is_empty() {
                claims.notes.push(unknown(place, &label, "faces"));
            }
        }
        for string in &links.strings {
            let label = format!("string {:?}", string.name().unwrap_or(""));
            let place = self.place(string.string.origin);
            if let Some(name) = string.reference {
                let blocks = self.mesh.blocks_of(1).filter(|(_, block)| known(block.entity, name));
                let edges = blocks.flat_map(|(_, block)| block.elements(Order::LINEAR).map(|ends| [ends[0], ends[1]]));
                let items: Vec<[NodeId; 2]> = edges.collect();
                let entities = string.target.as_deref().map_or(&[][..], |target| &target.entities);
                let entities = self.entities(entities, &place, &label)?;
                if items.is_empty() {
                    claims.notes.push(unknown(place, &label, &format!("{name:?}")));
                } else {
                    claims.strings.push(Claimed { label, items, entities });
                }
            } else if !string.named.is_empty() {
                claims.notes.push(unknown(place, &label, "edges"));
            }
        }
        Ok(())
    }

    fn place(&self, origin: linkage_schema::Origin) -> String {
        match origin.position() {
            Some(position) => format!("{}:{}:{}", self.path.display(), position.line, position.column),
            None => self.path.display().to_string(),
        }
    }

    fn node(&self, index: u32, place: &str, label: &str) -> Result<NodeId, LinkageError> {
        self.numbers.get(&u64::from(index)).copied().ok_or_else(|| LinkageError::Node {
            place: place.to_owned(),
            label: label.to_owned(),
            index,
            last: self.numbers.keys().copied().max().unwrap_or(0),
        })
    }

    fn face(&self, indices: &[u32], place: &str, label: &str) -> Result<usize, LinkageError> {
        let nodes = indices.iter().map(|&index| self.node(index, place, label)).collect::<Result<Vec<_>, _>>()?;
        self.boundary.face(&nodes).ok_or_else(|| LinkageError::Face {
            place: place.to_owned(),
            label: label.to_owned(),
            nodes: indices.to_vec(),
        })
    }

    fn entities(&self, entities: &[Entity], place: &str, label: &str) -> Result<Vec<EntityId>, LinkageError> {
        let mut all = Vec::new();
        for entity in entities {
            let found = self.model.resolve(entity.reference).map_err(|source| LinkageError::Reference {
                place: place.to_owned(),
                label: label.to_owned(),
                source,
            })?;
            all.extend(found);
        }
        Ok(all)
    }
}

/// Appends a claim, or lengthens the last one of the same name on the same geometry.
fn push<T>(claims: &mut Vec<Claimed<T>>, claim: Claimed<T>) {
    match claims.last_mut() {
        Some(last) if last.label == claim.label && last.entities == claim.entities => last.items.extend(claim.items),
        _ => claims.push(claim),
    }
}
