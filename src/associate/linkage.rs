//! The candidates of a MeshLink file.

use std::path::{Path, PathBuf};

use cad::{EntityId, Model, ReferenceError};
use linkage_schema::{Document, Entity, GeometryFile, ModelLinks, Resolution, Target};

use super::{
    Candidate, Candidates, NotPeriodic, Numbering, Part, Teller, UnknownZone, periodic_records, periodic_sheets,
};
use crate::element::Cell;
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

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
    /// It links several mesh files, of which none is the one to be curved.
    #[error("{}: links the mesh files {named}, and none of them is {}; give the mesh that it was written for", file.display(), mesh.display())]
    OtherMeshes {
        /// The linkage file.
        file: PathBuf,
        /// The names of its mesh files.
        named: String,
        /// The mesh.
        mesh: PathBuf,
    },
    /// A mesh model that is called as no zone is.
    #[error("{place}: {source}")]
    Zone {
        /// File, line and column.
        place: String,
        /// The name, and those of the zones.
        source: UnknownZone,
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
    #[error("{place}: {cause}; correct the transform, or the elements that it pairs")]
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

/// A MeshLink document, with the names of the files by which it and its mesh are called.
#[derive(Clone, Debug)]
pub struct Linkage {
    /// The document.
    pub document: Document,
    /// The file that it is in: messages name it.
    pub file: PathBuf,
    /// The file of the mesh: a document may link several, by name.
    pub mesh_file: PathBuf,
}

impl Linkage {
    /// Reads a linkage file for the mesh in the file `mesh_file`.
    ///
    /// # Errors
    /// [`LinkageError::Read`], [`LinkageError::Refused`].
    pub fn read(file: &Path, mesh_file: &Path) -> Result<Linkage, LinkageError> {
        let document = linkage_schema::read_path(file)?.accept()?;
        Ok(Linkage { document, file: file.to_owned(), mesh_file: mesh_file.to_owned() })
    }
}

/// Looks up what a linkage says of a mesh and its CAD.
///
/// # Errors
/// [`LinkageError`].
pub fn linked(linkage: &Linkage, mesh: &Mesh, boundary: &Boundary, model: &Model) -> Result<Candidates, LinkageError> {
    let Linkage { document, file: path, mesh_file } = linkage;
    let resolution = linkage_schema::resolve(document).accept(path)?;
    if resolution.models.is_empty() {
        return Err(LinkageError::Empty { file: path.to_owned() });
    }
    let models = models_of(&resolution, mesh_file);
    if models.is_empty() && document.mesh_files.len() > 1 {
        let named = document.mesh_files.iter().map(|file| &file.filename[..]).collect::<Vec<_>>().join(", ");
        return Err(LinkageError::OtherMeshes { file: path.to_owned(), named, mesh: mesh_file.to_owned() });
    }
    let models = if models.is_empty() { resolution.models.iter().collect() } else { models };
    let numbering = Numbering::new(mesh);
    let geometry = own_geometry(document, model.path());
    let reader = Reader { path, mesh, boundary, model, numbering: &numbering, geometry: &geometry, part: Part::Whole };
    let trusted = document.geometry_files.iter().any(|file| same_file(&file.filename, model.path()));
    let mut candidates = Candidates { trusted, teller: Teller::Linkage, ..Candidates::default() };
    candidates.notes.extend(not_given(path, document, &geometry));
    for links in models {
        reader.within(links)?.model(links, &mut candidates)?;
    }
    for pair in &resolution.pairs {
        let Some(sheets) = periodic_sheets(pair, &resolution) else { continue };
        let node = |model: &linkage_schema::MeshModel, index: u32| {
            numbering.node(numbering.part(&model.reference).ok()?, index.into())
        };
        let records = periodic_records(pair, sheets, mesh, boundary, &node);
        let place = || reader.place(pair.linkage.origin);
        candidates.periodic.extend(records.map_err(|cause| LinkageError::Periodic { place: place(), cause })?);
    }
    Ok(candidates.of_sides(boundary))
}

/// The models of a mesh file, as far as the document names that file.
#[must_use]
pub fn models_of<'r, 'a>(resolution: &'r Resolution<'a>, mesh_file: &Path) -> Vec<&'r ModelLinks<'a>> {
    resolution.models.iter().filter(|links| same_file(&links.file.filename, mesh_file)).collect()
}

/// The geometry files of a document that a CAD file can stand for: those of its name, or all where none has it.
#[must_use]
pub fn own_geometry<'d>(document: &'d Document, cad: &Path) -> Vec<&'d GeometryFile> {
    let named: Vec<_> = document.geometry_files.iter().filter(|file| same_file(&file.filename, cad)).collect();
    if named.is_empty() { document.geometry_files.iter().collect() } else { named }
}

/// A note on geometry files beside the one that was given.
fn not_given(path: &Path, document: &Document, own: &[&GeometryFile]) -> Option<String> {
    let others = document.geometry_files.iter().filter(|file| !own.iter().any(|own| std::ptr::eq(*own, *file)));
    let others = others.map(|file| &file.filename[..]).collect::<Vec<_>>().join(", ");
    let what = "names further CAD files; what is linked to them counts as not linked";
    (!others.is_empty()).then(|| format!("{} {what}: {others}", path.display()))
}

/// Whether a document means this file: it has the same name, in whatever folder; documents may leave the extension out.
#[must_use]
pub fn same_file(named: &str, path: &Path) -> bool {
    // A path in the document may be another system's: compare what follows the last separator of either kind.
    let name = named.rsplit(['/', '\\']).next().unwrap_or(named);
    [path.file_name(), path.file_stem()].into_iter().flatten().any(|own| own.to_string_lossy() == name)
}

#[derive(Clone, Copy)]
struct Reader<'a> {
    path: &'a Path,
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    model: &'a Model,
    numbering: &'a Numbering<'a>,
    geometry: &'a [&'a GeometryFile],
    part: Part,
}

impl Reader<'_> {
    /// The reader of a model's indices.
    fn within(self, links: &ModelLinks) -> Result<Self, LinkageError> {
        let place = || self.place(links.model.origin);
        let part = self.numbering.part(&links.model.reference);
        Ok(Reader { part: part.map_err(|source| LinkageError::Zone { place: place(), source })?, ..self })
    }

    fn model(&self, links: &ModelLinks, candidates: &mut Candidates) -> Result<(), LinkageError> {
        self.named(links, candidates)?;
        // The cells of a plane mesh lie on one face or none: nothing depends on it.
        let sheets = if self.boundary.plane.is_some() { &[][..] } else { &links.sheets[..] };
        for sheet in sheets {
            for run in &sheet.faces {
                let label = format!("sheet {:?}", sheet.name().unwrap_or(""));
                let place = self.place(run.run.origin);
                let faces = run.run.faces().map(|face| self.face(face, &place, &label));
                let items = faces.collect::<Result<_, _>>()?;
                let entities = self.entities(run.entities(), &place, &label)?;
                push(&mut candidates.sheets, Candidate { label, items, entities });
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
                push(&mut candidates.strings, Candidate { label, items, entities });
            }
        }
        for point in &links.points {
            let place = self.place(point.run.origin);
            let label = "point".to_owned();
            let nodes = point.run.indices.iter().map(|&index| self.node(index, &place, &label));
            let items = nodes.collect::<Result<_, _>>()?;
            let entities = self.entities(point.entities(), &place, &label)?;
            push(&mut candidates.points, Candidate { label, items, entities });
        }
        Ok(())
    }

    /// Sheets and strings that are called by the names which the mesh file gives to sets of faces and edges.
    fn named(&self, links: &ModelLinks, candidates: &mut Candidates) -> Result<(), LinkageError> {
        let known = |entity: EntityKey, name: &str| self.mesh.names_of(entity).iter().any(|own| own == name);
        let faces = |name: &str| -> Vec<usize> {
            let all = 0..self.boundary.faces.len();
            all.filter(|&face| known(self.boundary.faces[face].entity, name)).collect()
        };
        for sheet in &links.sheets {
            let label = format!("sheet {:?}", sheet.name().unwrap_or(""));
            let place = self.place(sheet.sheet.origin);
            let some = (!sheet.named.is_empty()).then_some("faces");
            let named = Named { label, place, name: sheet.reference, some, target: sheet.target.as_deref() };
            candidates.sheets.extend(self.by_name(named, faces, &mut candidates.notes)?);
        }
        let edges = |name: &str| -> Vec<[NodeId; 2]> {
            let blocks = self.mesh.blocks().iter().filter(|block| block.cell == Cell::Line);
            let own = blocks.filter(|block| known(block.entity, name));
            own.flat_map(|block| block.elements(self.mesh.order()).map(|ends| [ends[0], ends[1]])).collect()
        };
        for string in &links.strings {
            let label = format!("string {:?}", string.name().unwrap_or(""));
            let place = self.place(string.string.origin);
            let some = (!string.named.is_empty()).then_some("edges");
            let named = Named { label, place, name: string.reference, some, target: string.target.as_deref() };
            candidates.strings.extend(self.by_name(named, edges, &mut candidates.notes)?);
        }
        Ok(())
    }

    /// The candidate of what is called by name, with the `items` of the name; a note where there is none.
    fn by_name<T>(
        &self,
        named: Named<'_>,
        items: impl Fn(&str) -> Vec<T>,
        notes: &mut Vec<String>,
    ) -> Result<Option<Candidate<T>>, LinkageError> {
        let Named { label, place, name, some, target } = named;
        let mut unknown = |what: &str| {
            notes
                .push(format!("{place}: {label} refers to {what} by name, which the mesh file does not have; ignored"));
        };
        let Some(name) = name else {
            some.map(unknown);
            return Ok(None);
        };
        let entities = self.entities(target.map_or(&[], |target| &target.entities[..]), &place, &label)?;
        let items = items(name);
        if items.is_empty() {
            unknown(&format!("{name:?}"));
            return Ok(None);
        }
        Ok(Some(Candidate { label, items, entities }))
    }

    fn place(&self, origin: linkage_schema::Origin) -> String {
        match origin.position() {
            Some(position) => format!("{}:{}:{}", self.path.display(), position.line, position.column),
            None => self.path.display().to_string(),
        }
    }

    fn node(&self, index: u32, place: &str, label: &str) -> Result<NodeId, LinkageError> {
        self.numbering.node(self.part, index.into()).ok_or_else(|| LinkageError::Node {
            place: place.to_owned(),
            label: label.to_owned(),
            index,
            last: self.numbering.last(self.part),
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
        for entity in entities.iter().filter(|entity| self.geometry.iter().any(|own| std::ptr::eq(*own, entity.file))) {
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

/// Appends a candidate, or lengthens the last one of the same name on the same geometry.
fn push<T>(candidates: &mut Vec<Candidate<T>>, candidate: Candidate<T>) {
    match candidates.last_mut() {
        Some(last) if last.label == candidate.label && last.entities == candidate.entities => {
            last.items.extend(candidate.items)
        }
        _ => candidates.push(candidate),
    }
}

/// A sheet or string that a linkage file calls by name, or some items of it.
struct Named<'n> {
    label: String,
    place: String,
    /// The name of the whole.
    name: Option<&'n str>,
    /// What is called by names one by one, where anything is.
    some: Option<&'static str>,
    target: Option<&'n Target<'n>>,
}
