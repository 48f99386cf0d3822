//! The periodic pairs of a MeshLink file, as a mesh file would have them.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat4};
use linkage_schema::{ElementPair, MeshElement, MeshModel, Resolution, Sheet, SheetBody};
use rustc_hash::FxHashMap;

use crate::mesh::periodic::{maps, matched};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId, Periodic};

/// Two sheets that are said to correspond and do not.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "sheet {source_name:?} with {masters} points and sheet {target:?} with {slaves} do not correspond under {transform}"
)]
pub struct NotPeriodic {
    source_name: String,
    target: String,
    masters: usize,
    slaves: usize,
    transform: String,
}

/// A sheet of a periodic pair, and the model in which its points are counted.
#[derive(Clone, Copy, Debug)]
pub struct PeriodicSheet<'a> {
    sheet: &'a Sheet,
    model: &'a MeshModel,
}

/// Whether a linkage is a periodic pair of sheets: it says so, or says nothing and has a transform.
#[must_use]
pub fn periodic_sheets<'a>(pair: &ElementPair<'a>, resolution: &Resolution<'a>) -> Option<[PeriodicSheet<'a>; 2]> {
    let kind = resolution.attribute(pair.linkage.aref, "linkage type");
    let is_periodic = kind.map_or(pair.transform.is_some(), |kind| kind.eq_ignore_ascii_case("periodic"));
    let in_model = |element: Option<MeshElement<'a>>| {
        let Some(MeshElement::Sheet(sheet)) = element else { return None };
        let holds = |model: &&'a MeshModel| model.sheets.iter().any(|own| std::ptr::eq(own, sheet));
        let model = resolution.models.iter().map(|links| links.model).find(holds)?;
        Some(PeriodicSheet { sheet, model })
    };
    Some([in_model(pair.source)?, in_model(pair.target)?]).filter(|_| is_periodic)
}

/// The pairs of mesh entities that a pair of sheets makes; `node` says what an index means in a model.
///
/// # Errors
/// [`NotPeriodic`].
pub fn periodic_records(
    pair: &ElementPair<'_>,
    [source, target]: [PeriodicSheet<'_>; 2],
    mesh: &Mesh,
    boundary: &Boundary,
    node: &dyn Fn(&MeshModel, u32) -> Option<NodeId>,
) -> Result<Vec<Periodic>, NotPeriodic> {
    let [masters, slaves] = [source, target].map(|side| nodes(side, node));
    let middle = |nodes: &[NodeId]| mesh.points_of(nodes).sum::<glam::DVec3>() / nodes.len().max(1) as f64;
    let candidates = match pair.transform.and_then(|transform| transform.matrix()) {
        Some(numbers) => maps(&numbers),
        None => vec![DAffine3::from_translation(middle(&slaves) - middle(&masters))],
    };
    let name = |side: PeriodicSheet<'_>| side.sheet.common.name.as_deref().unwrap_or("").to_owned();
    let Some((map, pairs)) = matched(mesh, &masters, &slaves, &candidates) else {
        let transform = pair.transform.map_or("a shift".to_owned(), |t| format!("transform {}", t.id));
        let (masters, slaves) = (masters.len(), slaves.len());
        return Err(NotPeriodic { source_name: name(source), target: name(target), masters, slaves, transform });
    };
    let affine = DMat4::from(map).transpose().to_cols_array().to_vec();
    let leads: FxHashMap<NodeId, NodeId> = pairs.into_iter().collect();
    let mut records: BTreeMap<(EntityKey, i32), BTreeMap<NodeId, NodeId>> = BTreeMap::new();
    for corners in faces(target, node) {
        let images: Option<Vec<NodeId>> = corners.iter().map(|n| leads.get(n).copied()).collect();
        let Some((slave, master)) = boundary.face(&corners).zip(images.and_then(|images| boundary.face(&images)))
        else {
            continue;
        };
        let key = (boundary.faces[slave].entity, boundary.faces[master].entity.tag);
        records.entry(key).or_default().extend(corners.iter().map(|n| (*n, leads[n])));
    }
    let record = |((slave, master), pairs): ((EntityKey, i32), BTreeMap<NodeId, NodeId>)| Periodic {
        slave,
        master,
        affine: affine.clone(),
        pairs: pairs.into_iter().collect(),
    };
    Ok(records.into_iter().map(record).collect())
}

fn faces(side: PeriodicSheet<'_>, node: &dyn Fn(&MeshModel, u32) -> Option<NodeId>) -> Vec<Vec<NodeId>> {
    let SheetBody::Faces(runs) = &side.sheet.body else { return Vec::new() };
    let corners = |face: &[u32]| face.iter().map(|&index| node(side.model, index)).collect::<Option<Vec<_>>>();
    runs.iter().flat_map(|run| run.faces().filter_map(corners)).collect()
}

fn nodes(side: PeriodicSheet<'_>, node: &dyn Fn(&MeshModel, u32) -> Option<NodeId>) -> Vec<NodeId> {
    let mut nodes: Vec<NodeId> = faces(side, node).into_iter().flatten().collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
