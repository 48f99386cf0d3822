//! Checks of a document in itself that are not about following ids alone.

use std::collections::HashSet;

use super::elements::each_common;
use super::links::called;
use super::tables::AttributeTable;
use crate::{
    AttributeId, Code, Common, Document, Findings, MeshModel, Origin, ParamVertex, SheetBody, StringBody, VertexRef,
};

/// Every `aref` must be defined.
pub(super) fn attribute_references(document: &Document, table: &AttributeTable<'_>, findings: &mut Findings) {
    let mut check = |aref: Option<AttributeId>, origin: Origin, what: &str| {
        if let Some(id) = aref.filter(|id| !table.contains(*id)) {
            findings.push(Code::DanglingReference, origin, || {
                format!("{what} has aref {id}, which no Attribute or AttributeGroup defines")
            });
        }
    };
    for file in &document.geometry_files {
        check(file.aref, file.origin, "GeometryFile");
        file.references.iter().for_each(|one| check(one.aref, one.origin, "GeometryReference"));
    }
    document.geometry_groups.iter().for_each(|group| check(group.aref, group.origin, "GeometryGroup"));
    document.mesh_files.iter().for_each(|file| check(file.aref, file.origin, "MeshFile"));
    document.transforms.iter().for_each(|transform| check(transform.aref, transform.origin, "Transform"));
    document.linkages.iter().for_each(|linkage| check(linkage.aref, linkage.origin, "MeshElementLinkage"));
    each_common(document, |common, origin| check(common.aref, origin, "a mesh element"));
}

/// Cells that collapse, and parameter vertices that belong to no cell of their container.
pub(super) fn model(model: &MeshModel, findings: &mut Findings) {
    for sheet in &model.sheets {
        let mut points = HashSet::new();
        if let SheetBody::Faces(runs) = &sheet.body {
            for run in runs {
                for (number, face) in run.faces().enumerate() {
                    let word = run.encoding.word(number * face.len());
                    degenerate(face, "a face", &sheet.common, (run.origin, word), findings);
                }
                if !sheet.parameters.is_empty() {
                    points.extend(run.indices.iter().copied());
                }
            }
            vertices(&sheet.parameters, Some(&points), &called("MeshSheet", &sheet.common), findings);
        } else {
            vertices(&sheet.parameters, None, &called("MeshSheet", &sheet.common), findings);
        }
    }
    for string in &model.strings {
        let mut points = HashSet::new();
        if let StringBody::Edges(runs) = &string.body {
            for run in runs {
                for (number, edge) in run.edges().enumerate() {
                    let word = run.encoding.word(number * edge.len());
                    degenerate(&edge, "an edge", &string.common, (run.origin, word), findings);
                }
                if !string.parameters.is_empty() {
                    points.extend(run.indices.iter().copied());
                }
            }
            vertices(&string.parameters, Some(&points), &called("MeshString", &string.common), findings);
        } else {
            vertices(&string.parameters, None, &called("MeshString", &string.common), findings);
        }
    }
    vertices(&model.parameters, None, "MeshModelReference", findings);
}

/// Looks at a cell, which stands at a word of an element's content.
fn degenerate(
    cell: &[u32],
    what: &str,
    container: &Common,
    (origin, word): (Origin, Option<usize>),
    findings: &mut Findings,
) {
    let repeated = cell.iter().enumerate().any(|(i, corner)| cell.iter().take(i).any(|before| before == corner));
    if repeated {
        findings.push_word(Code::DegenerateCell, origin, word, || {
            format!("{what} {cell:?} of {}", called("its container", container))
        });
    }
}

/// `points` are those of the container's cells, where the document tells them.
fn vertices(vertices: &[ParamVertex], points: Option<&HashSet<u32>>, container: &str, findings: &mut Findings) {
    let mut seen = HashSet::with_capacity(vertices.len());
    for vertex in vertices {
        if !seen.insert(&vertex.vertex) {
            findings.push(Code::RepeatedVertex, vertex.origin, || {
                format!("{container} has a second ParamVertex for point {}", vertex.vertex)
            });
        }
        if let (VertexRef::Index(index), Some(points)) = (&vertex.vertex, points)
            && !points.contains(index)
        {
            findings.push(Code::StrayVertex, vertex.origin, || format!("{container} has no cell with point {index}"));
        }
    }
}
