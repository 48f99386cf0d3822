//! Elements and attributes that are missing, unknown, or not where the format has them.

use linkage_schema::Code;

use super::{Case, FULL, case, model, root, sheet};

pub(super) fn structure() -> Vec<Case> {
    use Code::*;
    vec![
        case("no-namespace", "<MeshLink version='1.0'/>".into(), false, &[(ForeignNamespace, 1)]),
        case("wrong-namespace", FULL.replace("cadence.com", "pointwise.com"), false, &[(ForeignNamespace, 3)]),
        case(
            "doctype",
            "<!DOCTYPE MeshLink>\n<MeshLink version='1.0' xmlns='https://cadence.com'/>".into(),
            true,
            &[(Doctype, 1)],
        ),
        case("no-version", "<MeshLink xmlns='https://cadence.com'/>".into(), false, &[(MissingAttribute, 1)]),
        case("unknown-element", root("<Sheet><Inner/></Sheet>"), false, &[(UnknownElement, 3)]),
        case("misplaced-element", root("<MeshSheet/>"), false, &[(UnknownElement, 3)]),
        case("element-in-text", root("<Attribute attid='1'>a<b/>c</Attribute>"), false, &[(UnknownElement, 3)]),
        case(
            "element-in-leaf",
            root("<MeshElementLinkage sourceEntityRef='a' targetEntityRef='b'><x/></MeshElementLinkage>"),
            false,
            &[(UnknownElement, 3), (UnknownMeshElement, 3), (UnknownMeshElement, 3)],
        ),
        case("unknown-attribute", root("<Attribute attid='1' colour='red'/>"), false, &[(UnknownAttribute, 3)]),
        case("stray-text", root("text"), false, &[(StrayText, 2)]),
        case("no-filename", root("<GeometryFile/>"), false, &[(MissingAttribute, 3)]),
        case(
            "no-ref",
            root("<GeometryFile filename='a'><GeometryReference gid='9'/></GeometryFile>"),
            false,
            &[(MissingAttribute, 3)],
        ),
        case("no-gid", root("<GeometryGroup>1</GeometryGroup>"), false, &[(MissingAttribute, 3)]),
        case("no-vref", model("<ParamVertex gref='1' dim='1'>0</ParamVertex>"), false, &[(MissingAttribute, 4)]),
        case("no-gref", model("<ParamVertex vref='1' dim='1'>0</ParamVertex>"), false, &[(MissingAttribute, 4)]),
        case("no-dim", model("<ParamVertex vref='1' gref='1'>0</ParamVertex>"), false, &[(MissingAttribute, 4)]),
        case("no-etype", sheet("<MeshFace>1 2 3</MeshFace>"), false, &[(MissingAttribute, 5)]),
        case("id-zero", root("<Attribute attid='0'/>"), false, &[(BadAttribute, 3)]),
        case("id-word", root("<Attribute attid='one'/>"), false, &[(BadAttribute, 3)]),
        case("id-negative", root("<Attribute attid='-1'/>"), false, &[(BadAttribute, 3)]),
        case("id-beyond-32-bits", root("<Attribute attid='99999999999999999999999'/>"), true, &[(BadAttribute, 3)]),
        case(
            "vertex-behind-face",
            sheet("<MeshFace etype='Tri3'>1 2 3</MeshFace>\n<ParamVertex vref='1' gref='1' dim='2'>0 0</ParamVertex>"),
            false,
            &[(OutOfOrder, 6)],
        ),
        case(
            "faces-and-references",
            sheet("<MeshFace etype='Tri3'>1 2 3</MeshFace>\n<MeshFaceReference etype='x'>1</MeshFaceReference>"),
            false,
            &[(MixedContents, 4)],
        ),
        case("empty-sheet", sheet(""), false, &[(EmptyElement, 4)]),
        case("empty-string", model("<MeshString/>"), false, &[(EmptyElement, 4)]),
        case("no-model", root("<MeshFile filename='x'/>"), false, &[(EmptyElement, 3)]),
        case(
            "face-in-reference",
            model("<MeshSheetReference ref='a'><MeshFace etype='Tri3'>1 2 3</MeshFace></MeshSheetReference>"),
            false,
            &[(UnknownElement, 4)],
        ),
        case(
            "nested-sheet",
            sheet("<MeshSheet/>\n<MeshFace etype='Tri3'>1 2 3</MeshFace>"),
            false,
            &[(UnknownElement, 5)],
        ),
    ]
}
