//! Faces, edges and points of the file that the mesh does not have, or not on its boundary.

use linkage_schema::{
    Code, Encoding, EntityLink, Findings, ModelLinks, Origin, PointRun, SheetLinks, StringLinks, VertexRef,
};
use rustc_hash::FxHashSet;

use super::called;
use super::linked_mesh::LinkedMesh;
use crate::mesh::{FaceKey, NodeId, PhysicalName};

pub(super) fn check(linked: &LinkedMesh<'_>, models: &[&ModelLinks<'_>], findings: &mut Findings) {
    let mut inner = None;
    let mut linked_faces: FxHashSet<usize> = FxHashSet::default();
    for links in models {
        let linked = linked.within(links.model);
        let runs = links.sheets.iter().flat_map(|sheet| &sheet.faces).map(|link| link.run);
        linked_faces.extend(runs.flat_map(|run| run.faces()).filter_map(|face| linked.face(face)));
    }
    for links in models {
        let linked = &linked.within(links.model);
        links.sheets.iter().for_each(|sheet| faces(linked, sheet, &mut inner, findings));
        links.strings.iter().for_each(|string| edges(linked, string, &linked_faces, findings));
        for point in &links.points {
            beyond(linked, (&point.run.indices, point.run.encoding), "MeshPointReference", point.run.origin, findings);
            points(linked, point.run, findings);
        }
        names(linked, links, findings);
        vertices(linked, links, findings);
    }
}

/// Parameter vertices of points that the mesh does not have, where no faces or edges beside them say so.
fn vertices(linked: &LinkedMesh<'_>, links: &ModelLinks<'_>, findings: &mut Findings) {
    let sheets = links.sheets.iter().filter(|sheet| sheet.faces.is_empty()).flat_map(SheetLinks::parameters);
    let strings = links.strings.iter().filter(|string| string.edges.is_empty()).flat_map(StringLinks::parameters);
    for vertex in sheets.chain(strings).chain(&links.model.parameters) {
        let VertexRef::Index(index) = vertex.vertex else { continue };
        if linked.node(index).is_none() {
            findings.push(Code::IndexBeyondMesh, vertex.origin, || {
                format!("ParamVertex refers to point {index}; the mesh's points go up to {}", linked.last())
            });
        }
    }
}

/// Indices that the mesh does not have.
fn beyond(
    linked: &LinkedMesh<'_>,
    (indices, encoding): (&[u32], Encoding),
    who: &str,
    origin: Origin,
    findings: &mut Findings,
) {
    // Zeros are found by reading.
    let mut missing = indices.iter().enumerate().filter(|&(_, &index)| index > 0 && linked.node(index).is_none());
    if let Some((word, first)) = missing.next() {
        findings.push_word(Code::IndexBeyondMesh, origin, encoding.word(word), || {
            let count = 1 + missing.count();
            format!(
                "{who} has {count} indices of nodes that the mesh does not have, the first is {first}; the mesh's go up to {}",
                linked.last()
            )
        });
    }
}

fn faces(linked: &LinkedMesh<'_>, sheet: &SheetLinks<'_>, inner: &mut Option<Inner>, findings: &mut Findings) {
    let who = called("MeshSheet", sheet.name());
    for link in &sheet.faces {
        let origin = link.run.origin;
        beyond(linked, (&link.run.indices, link.run.encoding), &who, origin, findings);
        let (mut nowhere, mut inside): (Vec<_>, Vec<_>) = Default::default();
        for (number, face) in link.run.faces().enumerate() {
            let nodes: Option<Vec<NodeId>> = face.iter().map(|&index| linked.node(index)).collect();
            let Some(nodes) = nodes else { continue };
            match linked.face(face) {
                Some(found) if linked.sides[found].cells > 1 => inside.push((number, face)),
                Some(_) => {}
                None if inner.get_or_insert_with(|| Inner::new(linked)).has(&nodes) => inside.push((number, face)),
                None => nowhere.push((number, face)),
            }
        }
        if let Some((number, first)) = nowhere.first() {
            findings.push_word(Code::NotInMesh, origin, link.run.encoding.word(number * first.len()), || {
                format!("{who} has {} faces that the mesh does not have, the first is {first:?}", nowhere.len())
            });
        }
        if let Some((number, first)) = inside.first() {
            findings.push_word(Code::InteriorFace, origin, link.run.encoding.word(number * first.len()), || {
                format!("{who} has {} faces inside the volume, the first is {first:?}", inside.len())
            });
        }
    }
}

fn edges(linked: &LinkedMesh<'_>, string: &StringLinks<'_>, faces: &FxHashSet<usize>, findings: &mut Findings) {
    let who = called("MeshString", string.name());
    let (mut all, mut bounding) = (0, 0);
    for link in &string.edges {
        beyond(linked, (&link.run.indices, link.run.encoding), &who, link.run.origin, findings);
        let mut nowhere: Vec<(usize, [u32; 2])> = Vec::new();
        for (number, ends) in link.run.edges().enumerate() {
            match linked.edge(ends) {
                Some(edge) => {
                    all += 1;
                    bounding += usize::from(linked.boundary.edge_faces[edge].iter().any(|face| faces.contains(face)));
                }
                None if ends.iter().all(|&index| linked.node(index).is_some()) => nowhere.push((number, ends)),
                None => {}
            }
        }
        if let Some((number, first)) = nowhere.first() {
            findings.push_word(
                Code::EdgeNotInMesh,
                link.run.origin,
                link.run.encoding.word(number * first.len()),
                || format!("{who} has {} edges that no face of the mesh has, the first is {first:?}", nowhere.len()),
            );
        }
    }
    if bounding < all && linked.boundary.plane.is_none() {
        findings.push(Code::StringWithoutSheet, string.string.origin, || {
            format!("{} of the {all} edges of {who} are edges of no linked face", all - bounding)
        });
    }
}

fn points(linked: &LinkedMesh<'_>, run: &PointRun, findings: &mut Findings) {
    let on_boundary: FxHashSet<NodeId> = linked.boundary.corners.iter().flatten().copied().collect();
    let stray = |index: &u32| linked.node(*index).is_some_and(|node| !on_boundary.contains(&node));
    if let Some((word, first)) = run.indices.iter().enumerate().find(|(_, index)| stray(index)) {
        findings.push_word(Code::StrayPoint, run.origin, run.encoding.word(word), || {
            format!("MeshPointReference has point {first}, inside the volume")
        });
    }
}

/// What is called by name can only be found under the names that the mesh has.
fn names(linked: &LinkedMesh<'_>, links: &ModelLinks<'_>, findings: &mut Findings) {
    let known = |name: &str, kind: fn(&PhysicalName) -> bool| {
        linked.mesh.physical_names().iter().any(|own| kind(own) && own.name == name)
    };
    for sheet in &links.sheets {
        let whole = sheet.reference.filter(|name| !known(name, PhysicalName::is_of_surfaces));
        let whole = whole.map(|name| (sheet.sheet.origin, name));
        unknown_names(&called("MeshSheet", sheet.name()), whole, &sheet.named, "faces", findings);
    }
    for string in &links.strings {
        let whole = string.reference.filter(|name| !known(name, PhysicalName::is_of_curves));
        let whole = whole.map(|name| (string.string.origin, name));
        unknown_names(&called("MeshString", string.name()), whole, &string.named, "edges", findings);
    }
}

/// A finding for the unknown name of a whole sheet or string, and for each run of items that it calls by name.
fn unknown_names(
    who: &str,
    whole: Option<(Origin, &str)>,
    runs: &[EntityLink<'_>],
    noun: &str,
    findings: &mut Findings,
) {
    let runs = runs.iter().map(|link| (link.run.origin, format!("{} {noun}", link.run.references.len())));
    for (origin, what) in runs.chain(whole.map(|(origin, name)| (origin, format!("{name:?}")))) {
        findings.push(Code::UnknownMeshName, origin, || {
            format!("{who} refers to {what} by name, which this mesh file does not have")
        });
    }
}

/// The sides of all cells.
struct Inner(FxHashSet<FaceKey>);

impl Inner {
    fn new(linked: &LinkedMesh<'_>) -> Inner {
        Inner(linked.mesh.cells().iter().flat_map(|cell| cell.sides()).collect())
    }

    fn has(&self, corners: &[NodeId]) -> bool {
        self.0.contains(&FaceKey::new(corners))
    }
}
