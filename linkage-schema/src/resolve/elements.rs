//! Mesh elements by id and by name, and the pairs that linkages make of them.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use super::tables::{TransformTable, duplicate};
use crate::{Code, Common, Document, EdgeRun, ElementLinkage, EntityRun, FaceRun, Findings, MeshId, MeshModel};
use crate::{MeshString, Origin, ParamVertex, PointRun, Sheet, SheetBody, StringBody, Transform};

/// A mesh element of the document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeshElement<'a> {
    /// A model.
    Model(&'a MeshModel),
    /// A sheet or a reference to one.
    Sheet(&'a Sheet),
    /// A string or a reference to one.
    String(&'a MeshString),
    /// Faces.
    Faces(&'a FaceRun),
    /// Edges.
    Edges(&'a EdgeRun),
    /// Faces or edges by name.
    Entities(&'a EntityRun),
    /// Points.
    Points(&'a PointRun),
    /// A parameter vertex.
    Vertex(&'a ParamVertex),
}

/// A linkage with what it links.
#[derive(Clone, Copy, Debug)]
pub struct ElementPair<'a> {
    /// The linkage.
    pub linkage: &'a ElementLinkage,
    /// The element that leads, if the document has it.
    pub source: Option<MeshElement<'a>>,
    /// The element that follows, if the document has it.
    pub target: Option<MeshElement<'a>>,
    /// The transform from one to the other.
    pub transform: Option<&'a Transform>,
}

impl<'a> MeshElement<'a> {
    fn common(self) -> Option<&'a Common> {
        Some(match self {
            Self::Model(model) => &model.common,
            Self::Sheet(sheet) => &sheet.common,
            Self::String(string) => &string.common,
            Self::Faces(run) => &run.common,
            Self::Edges(run) => &run.common,
            Self::Entities(run) => &run.common,
            Self::Points(run) => &run.common,
            Self::Vertex(_) => return None,
        })
    }

    fn mid(self) -> Option<MeshId> {
        match self {
            Self::Vertex(vertex) => vertex.mid,
            other => other.common().and_then(|common| common.mid),
        }
    }

    /// Its place.
    pub fn origin(self) -> Origin {
        match self {
            Self::Model(model) => model.origin,
            Self::Sheet(sheet) => sheet.origin,
            Self::String(string) => string.origin,
            Self::Faces(run) => run.origin,
            Self::Edges(run) => run.origin,
            Self::Entities(run) => run.origin,
            Self::Points(run) => run.origin,
            Self::Vertex(vertex) => vertex.origin,
        }
    }
}

/// Calls `visit` with every mesh element of the document.
pub(super) fn each<'a>(document: &'a Document, mut visit: impl FnMut(MeshElement<'a>)) {
    for model in document.mesh_files.iter().flat_map(|file| &file.models) {
        visit(MeshElement::Model(model));
        for sheet in &model.sheets {
            visit(MeshElement::Sheet(sheet));
            sheet.parameters.iter().for_each(|vertex| visit(MeshElement::Vertex(vertex)));
            match &sheet.body {
                SheetBody::Faces(runs) => runs.iter().for_each(|run| visit(MeshElement::Faces(run))),
                SheetBody::FaceReferences(runs) => runs.iter().for_each(|run| visit(MeshElement::Entities(run))),
                SheetBody::Reference(_) => {}
            }
        }
        for string in &model.strings {
            visit(MeshElement::String(string));
            string.parameters.iter().for_each(|vertex| visit(MeshElement::Vertex(vertex)));
            match &string.body {
                StringBody::Edges(runs) => runs.iter().for_each(|run| visit(MeshElement::Edges(run))),
                StringBody::EdgeReferences(runs) => runs.iter().for_each(|run| visit(MeshElement::Entities(run))),
                StringBody::Reference(_) => {}
            }
        }
        model.points.iter().for_each(|run| visit(MeshElement::Points(run)));
        model.parameters.iter().for_each(|vertex| visit(MeshElement::Vertex(vertex)));
    }
}

/// Calls `visit` with the common attributes of every mesh element that has them.
pub(super) fn each_common<'a>(document: &'a Document, mut visit: impl FnMut(&'a Common, Origin)) {
    each(document, |element| {
        if let Some(common) = element.common() {
            visit(common, element.origin());
        }
    });
}

/// Indexes the elements, finds duplicate ids, and follows the linkages.
pub(super) fn pairs<'a>(
    document: &'a Document,
    transforms: &TransformTable<'a>,
    findings: &mut Findings,
) -> Vec<ElementPair<'a>> {
    let mut by_id: HashMap<MeshId, MeshElement<'a>> = HashMap::new();
    let mut by_name: HashMap<&str, MeshElement<'a>> = HashMap::new();
    each(document, |element| {
        if let Some(mid) = element.mid() {
            match by_id.entry(mid) {
                Entry::Occupied(first) => {
                    duplicate("mid", mid.get(), element.origin(), first.get().origin(), findings);
                }
                Entry::Vacant(vacant) => {
                    vacant.insert(element);
                }
            }
        }
        if let Some(name) = element.common().and_then(|common| common.name.as_deref()) {
            by_name.entry(name).or_insert(element);
        }
    });
    let find = |reference: &str| {
        let by_number = || reference.trim().parse().ok().and_then(MeshId::new).and_then(|mid| by_id.get(&mid));
        by_name.get(reference).or_else(by_number).copied()
    };
    let follow = |linkage: &'a ElementLinkage| ElementPair {
        linkage,
        source: find(&linkage.source),
        target: find(&linkage.target),
        transform: linkage.transform.and_then(|id| transforms.get(id)),
    };
    // A linkage that is written again says nothing new, and looking at its sheets again could take long.
    let mut seen = HashSet::new();
    let is_new = |one: &&'a ElementLinkage| seen.insert((&one.source, &one.target, one.transform, one.aref));
    let pairs: Vec<_> = document.linkages.iter().filter(is_new).map(follow).collect();
    pairs.iter().for_each(|pair| check(pair, findings));
    pairs
}

fn check(pair: &ElementPair<'_>, findings: &mut Findings) {
    let linkage = pair.linkage;
    for (side, reference, found) in
        [("source", &linkage.source, pair.source.is_some()), ("target", &linkage.target, pair.target.is_some())]
    {
        if !found {
            findings.push(Code::UnknownMeshElement, linkage.origin, || {
                format!("MeshElementLinkage has the {side} {reference:?}")
            });
        }
    }
    if let (Some(source), Some(target)) = (pair.source, pair.target)
        && std::mem::discriminant(&source) != std::mem::discriminant(&target)
    {
        findings.push(Code::UnequalPair, linkage.origin, || {
            format!(
                "MeshElementLinkage links {:?} with {:?}, which are of different kinds",
                linkage.source, linkage.target
            )
        });
    }
    if let (Some(id), None) = (linkage.transform, pair.transform) {
        findings.push(Code::DanglingReference, linkage.origin, || {
            format!("MeshElementLinkage has xref {id}, which no Transform defines")
        });
    }
}
