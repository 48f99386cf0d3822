//! The models of a document: sheets, strings and points, zone by zone.

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroU32;

use linkage_schema::{
    Common, EdgeRun, Encoding, FaceRun, FaceShape, MeshModel, MeshString, Origin, PointRun, Sheet, SheetBody,
    StringBody,
};

use super::TooLarge;
use super::geometry::Ids;
use super::patches::{Runs, patches, push, union};
use crate::associate::{Candidate, Candidates, Numbering, Part, paths};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

/// The models, and where the patches went.
pub(super) struct Models {
    /// One a zone, or one for all.
    pub(super) all: Vec<MeshModel>,
    /// The names of each patch's sheets.
    pub(super) sheets: BTreeMap<EntityKey, Vec<String>>,
}

impl Models {
    pub(super) fn new(
        candidates: &Candidates,
        mesh: &Mesh,
        boundary: &Boundary,
        numbering: &Numbering<'_>,
        ids: &Ids,
    ) -> Result<Models, TooLarge> {
        let writer = Writer { mesh, boundary, numbering, ids };
        let sheets = writer.named_sheets(with_periodic(patches(candidates, boundary), mesh, boundary));
        let mut names: BTreeMap<EntityKey, Vec<String>> = BTreeMap::new();
        for (entity, name, ..) in &sheets {
            names.entry(*entity).or_default().push(name.clone());
        }
        let mut all = Vec::new();
        for part in numbering.parts() {
            let own = sheets.iter().filter(|(_, _, of, _)| *of == part);
            let model = MeshModel {
                reference: numbering.reference(part).into(),
                common: Common::default(),
                sheets: own.map(|(_, name, _, runs)| writer.sheet(part, name, runs)).collect::<Result<_, _>>()?,
                strings: writer.strings(part, candidates)?,
                points: writer.points(part, candidates)?,
                parameters: Vec::new(),
                origin: Origin::MADE,
            };
            all.push(model);
        }
        Ok(Models { all, sheets: names })
    }
}

/// Adds the faces of periodic patches that lie on nothing: a pair is of whole patches.
fn with_periodic<'a>(
    mut patches: BTreeMap<EntityKey, Runs<'a>>,
    mesh: &Mesh,
    boundary: &Boundary,
) -> BTreeMap<EntityKey, Runs<'a>> {
    let pairs = mesh.periodic().iter().filter(|pair| pair.slave.is_surface());
    let periodic: BTreeSet<EntityKey> = pairs.flat_map(|pair| [pair.slave, EntityKey::new(2, pair.master)]).collect();
    for entity in periodic {
        let runs = patches.entry(entity).or_default();
        let linked: BTreeSet<usize> = runs.iter().flat_map(|(_, faces)| faces.iter().copied()).collect();
        let others = (0..boundary.faces.len()).filter(|face| boundary.faces[*face].entity == entity);
        others.filter(|face| !linked.contains(face)).for_each(|face| push(runs, &[], face));
        if runs.is_empty() {
            patches.remove(&entity);
        }
    }
    patches
}

/// A patch's faces in a part of the mesh, with the name of their sheet.
type NamedSheet<'a> = (EntityKey, String, Part, Runs<'a>);

struct Writer<'a> {
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    numbering: &'a Numbering<'a>,
    ids: &'a Ids,
}

impl Writer<'_> {
    /// The first part that has all these nodes.
    fn part(&self, nodes: &[NodeId]) -> Option<Part> {
        self.numbering.parts().find(|&part| nodes.iter().all(|&node| self.numbering.index(part, node).is_some()))
    }

    /// The patches, cut at the borders of zones, each with a name of its own.
    fn named_sheets<'c>(&self, patches: BTreeMap<EntityKey, Runs<'c>>) -> Vec<NamedSheet<'c>> {
        let mut alike: BTreeMap<String, usize> = BTreeMap::new();
        patches.keys().for_each(|&entity| *alike.entry(self.mesh.label(entity)).or_default() += 1);
        let mut sheets = Vec::new();
        for (entity, runs) in patches {
            let label = self.mesh.label(entity);
            let name = if alike[&label] > 1 { format!("{label}/{entity}") } else { label };
            let mut cut: Vec<(Part, Runs<'c>)> = Vec::new();
            for (entities, face) in
                runs.iter().flat_map(|(entities, faces)| faces.iter().map(|&face| (*entities, face)))
            {
                let Some(part) = self.part(&self.boundary.corners[face]) else { continue };
                match cut.iter_mut().find(|(own, _)| *own == part) {
                    Some((_, runs)) => push(runs, entities, face),
                    None => cut.push((part, vec![(entities, vec![face])])),
                }
            }
            let several = cut.len() > 1;
            for (part, runs) in cut {
                let zone = self.numbering.reference(part).rsplit('/').next().unwrap_or_default();
                let name = if several { format!("{name}@{zone}") } else { name.clone() };
                sheets.push((entity, name, part, runs));
            }
        }
        sheets
    }

    fn sheet(&self, part: Part, name: &str, runs: &Runs<'_>) -> Result<Sheet, TooLarge> {
        // Faces without geometry would inherit the sheet's.
        let is_whole = runs.iter().all(|(entities, _)| !entities.is_empty());
        let gref = self.ids.gref(&union(runs)).filter(|_| is_whole);
        let mut body = Vec::new();
        for (entities, faces) in runs {
            for shape in [FaceShape::Triangle, FaceShape::Quad] {
                let own = faces.iter().map(|&f| &self.boundary.corners[f]).filter(|c| c.len() == shape.corners());
                let indices = self.indices(part, own.flatten())?;
                let own_gref = self.ids.gref(entities).filter(|&own| Some(own) != gref);
                if !indices.is_empty() {
                    let common = Common { gref: own_gref, ..Common::default() };
                    let (encoding, origin) = (Encoding::Text, Origin::MADE);
                    body.push(FaceRun { common, shape, encoding, indices, origin });
                }
            }
        }
        Ok(Sheet {
            common: Common { name: Some(name.into()), gref, ..Common::default() },
            body: SheetBody::Faces(body),
            parameters: Vec::new(),
            origin: Origin::MADE,
        })
    }

    fn strings(&self, part: Part, candidates: &Candidates) -> Result<Vec<MeshString>, TooLarge> {
        let mut strings = Vec::new();
        for candidate in candidates.strings.iter().filter(|candidate| !candidate.entities.is_empty()) {
            let edges: Vec<[NodeId; 2]> =
                candidate.items.iter().copied().filter(|ends| self.part(ends) == Some(part)).collect();
            let paths = paths(&edges);
            for (number, path) in paths.iter().enumerate() {
                let name = if paths.len() > 1 {
                    format!("{}/{}", candidate.label, number + 1)
                } else {
                    candidate.label.clone()
                };
                let indices = self.indices(part, path.iter().flatten())?;
                let run =
                    EdgeRun { common: Common::default(), encoding: Encoding::Text, indices, origin: Origin::MADE };
                let gref = self.ids.gref(&candidate.entities);
                strings.push(MeshString {
                    common: Common { name: Some(name.into()), gref, ..Common::default() },
                    body: StringBody::Edges(vec![run]),
                    parameters: Vec::new(),
                    origin: Origin::MADE,
                });
            }
        }
        Ok(strings)
    }

    fn points(&self, part: Part, candidates: &Candidates) -> Result<Vec<PointRun>, TooLarge> {
        let linked = candidates.points.iter().filter(|candidate| !candidate.entities.is_empty());
        let run = |candidate: &Candidate<NodeId>| {
            let own = candidate.items.iter().filter(|node| self.part(&[**node]) == Some(part));
            Ok(PointRun {
                common: Common { gref: self.ids.gref(&candidate.entities), ..Common::default() },
                encoding: Encoding::Text,
                indices: self.indices(part, own)?,
                origin: Origin::MADE,
            })
        };
        let runs: Vec<PointRun> = linked.map(run).collect::<Result<_, _>>()?;
        Ok(runs.into_iter().filter(|run| !run.indices.is_empty()).collect())
    }

    fn indices<'n>(&self, part: Part, nodes: impl IntoIterator<Item = &'n NodeId>) -> Result<Box<[u32]>, TooLarge> {
        // Only nodes of the part are asked for.
        nodes.into_iter().filter_map(|&node| self.numbering.index(part, node)).map(small).collect()
    }
}

fn small(index: u64) -> Result<u32, TooLarge> {
    let small = u32::try_from(index).ok().and_then(NonZeroU32::new).map(NonZeroU32::get);
    small.ok_or(TooLarge(index))
}
