//! Ids and what refers to them.

use linkage_schema::Code;

use super::{Case, case, model, root, sheet};

pub(super) fn references() -> Vec<Case> {
    use Code::*;
    let face = "<MeshFace etype='Tri3'>1 2 3</MeshFace>";
    vec![
        case(
            "dangling-gref-sheet",
            model(&format!("<MeshSheet gref='9'>{face}</MeshSheet>")),
            false,
            &[(DanglingReference, 4)],
        ),
        case(
            "dangling-gref-face",
            sheet("<MeshFace etype='Tri3' gref='9'>1 2 3</MeshFace>"),
            false,
            &[(DanglingReference, 5)],
        ),
        case(
            "dangling-gref-string",
            model("<MeshString gref='9'><MeshEdge etype='Edge2'>1 2</MeshEdge></MeshString>"),
            false,
            &[(DanglingReference, 4)],
        ),
        case(
            "dangling-gref-point",
            model("<MeshPointReference gref='9'>1</MeshPointReference>"),
            false,
            &[(DanglingReference, 4)],
        ),
        case(
            "dangling-gref-vertex",
            model("<ParamVertex vref='1' gref='9' dim='1'>0</ParamVertex>"),
            false,
            &[(DanglingReference, 4)],
        ),
        case("dangling-aref", root("<GeometryFile filename='x' aref='7'/>"), false, &[(DanglingReference, 3)]),
        case(
            "dangling-aref-mesh",
            model("<MeshPointReference gref='1' aref='7'>1</MeshPointReference>"),
            false,
            &[(DanglingReference, 4)],
        ),
        case("aref-to-geometry", root("<GeometryFile filename='x' aref='1'/>"), false, &[(DanglingReference, 3)]),
        case(
            "dangling-xref",
            root("<MeshElementLinkage sourceEntityRef='a' targetEntityRef='b' xref='1'/>"),
            false,
            &[(UnknownMeshElement, 3), (UnknownMeshElement, 3), (DanglingReference, 3)],
        ),
        case("dangling-member", root("<GeometryGroup gid='4'>1 8</GeometryGroup>"), true, &[(DanglingReference, 3)]),
        case(
            "dangling-attribute-member",
            root("<AttributeGroup attid='4'>8</AttributeGroup>"),
            true,
            &[(DanglingReference, 3)],
        ),
        case(
            "duplicate-gid",
            root("<GeometryFile filename='b'>\n<GeometryReference gid='1' ref='again'/></GeometryFile>"),
            false,
            &[(DuplicateId, 4)],
        ),
        case("duplicate-gid-group", root("<GeometryGroup gid='1'>2</GeometryGroup>"), false, &[(DuplicateId, 3)]),
        case(
            "duplicate-attid",
            root("<Attribute attid='1'/>\n<AttributeGroup attid='1'/>"),
            false,
            &[(DuplicateId, 4)],
        ),
        case(
            "duplicate-xid",
            root(&"<Transform xid='1'>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</Transform>\n".repeat(2)),
            false,
            &[(DuplicateId, 4)],
        ),
        case(
            "duplicate-mid",
            model(
                "<MeshPointReference mid='1'>1</MeshPointReference>\n<MeshPointReference mid='1'>2</MeshPointReference>",
            ),
            false,
            &[(DuplicateId, 5)],
        ),
        case("nested-group", root("<GeometryGroup gid='4'>3</GeometryGroup>"), true, &[(NestedGroup, 3)]),
        case("self-group", root("<GeometryGroup gid='4'>4</GeometryGroup>"), true, &[(NestedGroup, 3)]),
        case("empty-group", root("<GeometryGroup gid='4'/>"), true, &[(EmptyElement, 3)]),
        case("repeated-member", root("<GeometryGroup gid='4'>1 1</GeometryGroup>"), true, &[(RepeatedMember, 3)]),
        case(
            "repeated-attribute",
            root("<Attribute attid='1'>x</Attribute><AttributeGroup attid='2'>1 1</AttributeGroup>"),
            true,
            &[(RepeatedMember, 3)],
        ),
        case(
            "linkage-of-two-kinds",
            model(&format!(
                "<MeshSheet name='s' gref='1'>{face}</MeshSheet><MeshString name='e' gref='2'><MeshEdge etype='Edge2'>1 2</MeshEdge></MeshString>"
            ))
            .replace("</MeshLink>", "<MeshElementLinkage sourceEntityRef='s' targetEntityRef='e'/></MeshLink>"),
            true,
            &[(UnequalPair, 6)],
        ),
        case(
            "cyclic-attributes",
            root("<AttributeGroup attid='1'>2</AttributeGroup><AttributeGroup attid='2'>1</AttributeGroup>"),
            true,
            &[(CyclicGroup, 3), (CyclicGroup, 3)],
        ),
        case(
            "group-as-entity",
            model("<ParamVertex vref='1' gref='3' dim='2'>0 0</ParamVertex>"),
            true,
            &[(GroupAsEntity, 4)],
        ),
        case("degenerate-face", sheet("<MeshFace etype='Tri3'>1 2 1</MeshFace>"), true, &[(DegenerateCell, 5)]),
        case(
            "vertex-twice",
            sheet(&format!("{}{face}", "<ParamVertex vref='1' gref='1' dim='2'>0 0</ParamVertex>\n".repeat(2))),
            true,
            &[(RepeatedVertex, 6)],
        ),
        case(
            "vertex-of-no-face",
            sheet(&format!("<ParamVertex vref='4' gref='1' dim='2'>0 0</ParamVertex>{face}")),
            true,
            &[(StrayVertex, 5)],
        ),
        case("transform-short", root("<Transform xid='1'>1 0 0</Transform>"), true, &[(BadTransform, 3)]),
    ]
}
