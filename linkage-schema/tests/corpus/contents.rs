//! Contents that are not what their element says.

use linkage_schema::Code;

use super::{Case, case, model, root, sheet};

pub(super) fn contents() -> Vec<Case> {
    use Code::*;
    vec![
        case("unknown-face-type", sheet("<MeshFace etype='Tri6'>1 2 3 4 5 6</MeshFace>"), true, &[(UnknownType, 5)]),
        case(
            "unknown-edge-type",
            model("<MeshString><MeshEdge etype='Edge3'>1 2 3</MeshEdge></MeshString>"),
            true,
            &[(UnknownType, 4)],
        ),
        case(
            "unknown-format",
            sheet("<MeshFace etype='Tri3' format='lzw'>1 2 3</MeshFace>"),
            true,
            &[(UnknownFormat, 5)],
        ),
        case("index-zero", sheet("<MeshFace etype='Tri3' count='2'>\n1 2 3\n0 1 2</MeshFace>"), true, &[(BadIndex, 7)]),
        case("index-negative", sheet("<MeshFace etype='Tri3'>-1 2 3</MeshFace>"), true, &[(BadIndex, 5)]),
        case("index-word", sheet("<MeshFace etype='Tri3'>1 two 3</MeshFace>"), true, &[(BadIndex, 5)]),
        case("index-fraction", sheet("<MeshFace etype='Tri3'>1 2.0 3</MeshFace>"), true, &[(BadIndex, 5)]),
        case("index-too-large", sheet("<MeshFace etype='Tri3'>1 2 4294967296</MeshFace>"), true, &[(BadIndex, 5)]),
        case(
            "count-giant",
            sheet("<MeshFace etype='Tri3' count='1000000000'>1 2 3</MeshFace>"),
            true,
            &[(CountTooLarge, 5)],
        ),
        case(
            "count-endless",
            sheet("<MeshFace etype='Tri3' count='9999999999999999999999'>1 2 3</MeshFace>"),
            true,
            &[(CountTooLarge, 5)],
        ),
        case(
            "count-large",
            sheet("<MeshFace etype='Tri3' count='2'>1 2 3 4 5</MeshFace>"),
            true,
            &[(CountTooLarge, 5)],
        ),
        case(
            "count-small",
            sheet("<MeshFace etype='Tri3' count='1'>1 2 3 4 5 6</MeshFace>"),
            true,
            &[(ExtraContent, 5)],
        ),
        case("count-zero", sheet("<MeshFace etype='Tri3' count='0'>1 2 3</MeshFace>"), false, &[(BadAttribute, 5)]),
        case("face-empty", sheet("<MeshFace etype='Tri3'/>"), true, &[(CountTooLarge, 5)]),
        case(
            "references-too-few",
            sheet("<MeshFaceReference etype='x' count='3'>a b</MeshFaceReference>"),
            true,
            &[(CountTooLarge, 5)],
        ),
        case(
            "base64-alphabet",
            sheet("<MeshFace etype='Tri3' format='base64'>AQAA*AIAAAADAAAA</MeshFace>"),
            true,
            &[(BadBase64, 5)],
        ),
        case(
            "base64-cut",
            sheet("<MeshFace etype='Tri3' format='base64'>AQAAAAIAAAADAAA</MeshFace>"),
            true,
            &[(BadBase64, 5)],
        ),
        case(
            "base64-half-integer",
            sheet("<MeshFace etype='Tri3' format='base64'>AQAAAAIAAAADAA==</MeshFace>"),
            true,
            &[(BadBase64, 5)],
        ),
        case(
            "base64-zero",
            sheet("<MeshFace etype='Tri3' format='base64'>AAAAAAIAAAADAAAA</MeshFace>"),
            true,
            &[(BadIndex, 5)],
        ),
        case(
            "base64-negative",
            sheet("<MeshFace etype='Tri3' format='base64'>/////wIAAAADAAAA</MeshFace>"),
            true,
            &[(BadIndex, 5)],
        ),
        case(
            "base64-edge",
            model("<MeshString><MeshEdge etype='Edge2' format='base64'>AQAAAAIAAAA=</MeshEdge></MeshString>"),
            true,
            &[(UnusualBase64, 4)],
        ),
        case(
            "parameter-word",
            model("<ParamVertex vref='1' gref='1' dim='1'>half</ParamVertex>"),
            true,
            &[(BadNumber, 4)],
        ),
        case(
            "parameter-nan",
            model("<ParamVertex vref='1' gref='1' dim='1'>nan</ParamVertex>"),
            true,
            &[(BadNumber, 4)],
        ),
        case(
            "parameter-missing",
            model("<ParamVertex vref='1' gref='1' dim='2'>0.5</ParamVertex>"),
            true,
            &[(BadNumber, 4)],
        ),
        case(
            "parameter-extra",
            model("<ParamVertex vref='1' gref='1' dim='1'>0.5 1</ParamVertex>"),
            true,
            &[(ExtraContent, 4)],
        ),
        case(
            "dimension-three",
            model("<ParamVertex vref='1' gref='1' dim='3'>0 0 0</ParamVertex>"),
            true,
            &[(BadDimension, 4)],
        ),
        case("group-member-word", root("<GeometryGroup gid='4'>1 x</GeometryGroup>"), false, &[(BadIndex, 3)]),
        case("group-member-zero", root("<GeometryGroup gid='4'>1 0</GeometryGroup>"), false, &[(BadIndex, 3)]),
    ]
}
