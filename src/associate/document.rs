//! Claims as a MeshLink document.

use std::collections::BTreeMap;
use std::num::NonZeroU32;
use std::path::Path;

use cad::{EntityId, Model};
use linkage_schema::{
    Attribute, AttributeId, Common, Document, EdgeRun, Encoding, FaceRun, FaceShape, GeometryFile, GeometryGroup,
    GeometryId, GeometryReference, MeshFile, MeshModel, MeshString, Origin, PointRun, Sheet, SheetBody, StringBody,
};

use super::{Boundary, Claims, paths};
use crate::mesh::{EntityKey, Mesh, NodeId};

/// A mesh that MeshLink's 32-bit indices cannot speak of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("node number {0} is beyond {max}, the largest that MeshLink can write; renumber the mesh's nodes", max = u32::MAX)]
pub struct TooLarge(u64);

/// The document that says what the claims say.
///
/// One sheet a patch, on its CAD face or on the group of its CAD faces, each run of its faces on the one that holds them; one string a
/// connected path on a CAD edge. Points are the mesh's node numbers; entities are written as `face-3`, `edge-2`, `vertex-1`.
///
/// # Errors
/// [`TooLarge`].
pub fn document(
    claims: &Claims,
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    mesh_file: &Path,
) -> Result<Document, TooLarge> {
    let mut builder = Builder { mesh, references: BTreeMap::new(), groups: BTreeMap::new() };
    builder.number(claims, boundary);
    let own = Origin::MADE;
    let mesh_model = MeshModel {
        reference: "volume".into(),
        common: Common::default(),
        sheets: builder.sheets(claims, boundary)?,
        strings: builder.strings(claims)?,
        points: builder.points(claims)?,
        parameters: Vec::new(),
        origin: own,
    };
    let attribute = |number: u32, name: &str, value: String| {
        let id = AttributeId::new(number)?;
        Some(Attribute { id, name: Some(name.into()), value, origin: own })
    };
    let generator = format!("sagitta {}", env!("CARGO_PKG_VERSION"));
    let attributes =
        [attribute(1, "mesh generator", generator), attribute(2, "geometry format", model.format().to_string())];
    let (references, geometry_groups) = builder.geometry();
    Ok(Document {
        version: "1.0".into(),
        attributes: attributes.into_iter().flatten().collect(),
        geometry_files: vec![GeometryFile {
            filename: file_name(model.path()),
            aref: AttributeId::new(2),
            references,
            origin: own,
        }],
        geometry_groups,
        mesh_files: vec![MeshFile {
            filename: file_name(mesh_file),
            aref: None,
            models: vec![mesh_model],
            origin: own,
        }],
        ..Document::default()
    })
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// `face-3`, as Gmsh's numbers are written.
fn reference(entity: EntityId) -> String {
    entity.to_string().replace(':', "-")
}

struct Builder<'a> {
    mesh: &'a Mesh,
    references: BTreeMap<EntityId, GeometryId>,
    groups: BTreeMap<Vec<EntityId>, (GeometryId, String)>,
}

/// Faces of one patch: its targets, each with its faces.
type Runs<'a> = Vec<(&'a [EntityId], Vec<usize>)>;

/// The patches of the claims, each with its runs.
fn patches<'a>(claims: &'a Claims, boundary: &Boundary) -> BTreeMap<EntityKey, Runs<'a>> {
    let mut patches: BTreeMap<EntityKey, Runs<'a>> = BTreeMap::new();
    for sheet in claims.sheets.iter().filter(|sheet| !sheet.entities.is_empty()) {
        for &face in &sheet.items {
            let runs = patches.entry(boundary.faces[face].entity).or_default();
            match runs.iter_mut().find(|(entities, _)| *entities == &sheet.entities[..]) {
                Some((_, faces)) => faces.push(face),
                None => runs.push((&sheet.entities, vec![face])),
            }
        }
    }
    patches
}

/// All entities of a patch, ascending, each once.
fn union(runs: &Runs<'_>) -> Vec<EntityId> {
    let mut all: Vec<EntityId> = runs.iter().flat_map(|(entities, _)| entities.iter().copied()).collect();
    all.sort_unstable();
    all.dedup();
    all
}

impl Builder<'_> {
    /// Gives every entity, and every set of several, its id.
    fn number(&mut self, claims: &Claims, boundary: &Boundary) {
        let mut sets: BTreeMap<Vec<EntityId>, String> = BTreeMap::new();
        for (entity, runs) in patches(claims, boundary) {
            sets.entry(union(&runs)).or_insert_with(|| self.mesh.label(entity));
            for (entities, _) in runs {
                sets.entry(entities.to_vec()).or_default();
            }
        }
        let others = claims.strings.iter().map(|s| &s.entities).chain(claims.points.iter().map(|p| &p.entities));
        for entities in others {
            sets.entry(entities.clone()).or_default();
        }
        let mut ids = (1..=u32::MAX).filter_map(GeometryId::new);
        for &entity in sets.keys().flatten() {
            if !self.references.contains_key(&entity)
                && let Some(id) = ids.next()
            {
                self.references.insert(entity, id);
            }
        }
        for (set, name) in sets.into_iter().filter(|(set, _)| set.len() > 1) {
            if let Some(id) = ids.next() {
                self.groups.insert(set, (id, name));
            }
        }
    }

    fn gref(&self, entities: &[EntityId]) -> Option<GeometryId> {
        match entities {
            [only] => self.references.get(only).copied(),
            several => self.groups.get(several).map(|(id, _)| *id),
        }
    }

    fn index(&self, node: NodeId) -> Result<u32, TooLarge> {
        let tag = self.mesh.node_tags[node.index()];
        let known = u32::try_from(tag).ok().and_then(NonZeroU32::new).map(NonZeroU32::get);
        known.ok_or(TooLarge(tag))
    }

    fn indices<'n>(&self, nodes: impl IntoIterator<Item = &'n NodeId>) -> Result<Box<[u32]>, TooLarge> {
        nodes.into_iter().map(|&node| self.index(node)).collect()
    }

    fn sheets(&self, claims: &Claims, boundary: &Boundary) -> Result<Vec<Sheet>, TooLarge> {
        let patches = patches(claims, boundary);
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        patches.keys().for_each(|&entity| *names.entry(self.mesh.label(entity)).or_default() += 1);
        let mut sheets = Vec::new();
        for (entity, runs) in patches {
            let label = self.mesh.label(entity);
            let name = if names[&label] > 1 { format!("{label}/{entity}") } else { label };
            let gref = self.gref(&union(&runs));
            let mut body = Vec::new();
            for (entities, faces) in runs {
                for shape in [FaceShape::Triangle, FaceShape::Quad] {
                    let own = faces.iter().map(|&f| &boundary.corners[f]).filter(|c| c.len() == shape.corners());
                    let indices = self.indices(own.flatten())?;
                    let own_gref = self.gref(entities).filter(|&own| Some(own) != gref);
                    if !indices.is_empty() {
                        let common = Common { gref: own_gref, ..Common::default() };
                        let (encoding, origin) = (Encoding::Text, Origin::MADE);
                        body.push(FaceRun { common, shape, encoding, indices, origin });
                    }
                }
            }
            sheets.push(Sheet {
                common: Common { name: Some(name.into()), gref, ..Common::default() },
                body: SheetBody::Faces(body),
                parameters: Vec::new(),
                origin: Origin::MADE,
            });
        }
        Ok(sheets)
    }

    fn strings(&self, claims: &Claims) -> Result<Vec<MeshString>, TooLarge> {
        let mut strings = Vec::new();
        for claim in claims.strings.iter().filter(|claim| !claim.entities.is_empty()) {
            let paths = paths(&claim.items);
            for (number, path) in paths.iter().enumerate() {
                let part =
                    if paths.len() > 1 { format!("{}/{}", claim.label, number + 1) } else { claim.label.clone() };
                let indices = self.indices(path.iter().flatten())?;
                let run =
                    EdgeRun { common: Common::default(), encoding: Encoding::Text, indices, origin: Origin::MADE };
                strings.push(MeshString {
                    common: Common { name: Some(part.into()), gref: self.gref(&claim.entities), ..Common::default() },
                    body: StringBody::Edges(vec![run]),
                    parameters: Vec::new(),
                    origin: Origin::MADE,
                });
            }
        }
        Ok(strings)
    }

    fn points(&self, claims: &Claims) -> Result<Vec<PointRun>, TooLarge> {
        let linked = claims.points.iter().filter(|claim| !claim.entities.is_empty());
        let run = |claim: &super::Claimed<NodeId>| {
            Ok(PointRun {
                common: Common { gref: self.gref(&claim.entities), ..Common::default() },
                encoding: Encoding::Text,
                indices: self.indices(&claim.items)?,
                origin: Origin::MADE,
            })
        };
        linked.map(run).collect()
    }

    fn geometry(self) -> (Vec<GeometryReference>, Vec<GeometryGroup>) {
        let references = &self.references;
        let mut singles: Vec<GeometryReference> = references
            .iter()
            .map(|(&entity, &id)| GeometryReference {
                id,
                reference: reference(entity),
                name: None,
                aref: None,
                origin: Origin::MADE,
            })
            .collect();
        singles.sort_by_key(|single| single.id);
        let group = |(members, (id, name)): (&Vec<EntityId>, &(GeometryId, String))| GeometryGroup {
            id: *id,
            name: Some(name.clone()).filter(|name| !name.is_empty()),
            aref: None,
            members: members.iter().filter_map(|entity| references.get(entity).copied()).collect(),
            origin: Origin::MADE,
        };
        let mut groups: Vec<GeometryGroup> = self.groups.iter().map(group).collect();
        groups.sort_by_key(|group| group.id);
        (singles, groups)
    }
}
