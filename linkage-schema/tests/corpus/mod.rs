//! Small documents, good and broken, each with what must be found in it.

use linkage_schema::Code;

/// What must come of a document.
pub(crate) enum Expect {
    /// Reading and resolving find these, at these lines, and nothing else.
    Findings(&'static [(Code, u32)]),
    /// Reading stops; the message contains this.
    Fatal(&'static str),
}

/// A document of the table.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) text: String,
    /// Whether a schema of the format accepts it.
    pub(crate) schema: bool,
    pub(crate) expect: Expect,
}

/// The document with every element of the format.
pub(crate) const FULL: &str = include_str!("../full.xml");

/// Line 1: root. Line 2: geometry 1, 2, group 3. From line 3: `inside`.
pub(crate) fn root(inside: &str) -> String {
    format!(
        "<MeshLink version=\"1.0\" xmlns=\"https://cadence.com\">\n\
         <GeometryFile filename=\"a.step\"><GeometryReference gid=\"1\" ref=\"f1\"/><GeometryReference gid=\"2\" \
         ref=\"f2\"/></GeometryFile><GeometryGroup gid=\"3\">1 2</GeometryGroup>\n{inside}\n</MeshLink>\n"
    )
}

/// Line 3: model. From line 4: `inside`.
pub(crate) fn model(inside: &str) -> String {
    root(&format!(
        "<MeshFile filename=\"a.msh\"><MeshModelReference ref=\"m\">\n{inside}\n</MeshModelReference></MeshFile>"
    ))
}

/// Line 4: a sheet on geometry 1. From line 5: `inside`.
pub(crate) fn sheet(inside: &str) -> String {
    model(&format!("<MeshSheet name=\"wall\" gref=\"1\">\n{inside}\n</MeshSheet>"))
}

fn case(name: &'static str, text: String, schema: bool, found: &'static [(Code, u32)]) -> Case {
    Case { name, text, schema, expect: Expect::Findings(found) }
}

fn fatal(name: &'static str, text: impl Into<String>, message: &'static str) -> Case {
    Case { name, text: text.into(), schema: false, expect: Expect::Fatal(message) }
}

/// All documents.
pub(crate) fn cases() -> Vec<Case> {
    [good(), broken(), structure(), contents(), references()].into_iter().flatten().collect()
}

fn good() -> Vec<Case> {
    vec![
        case("full", FULL.into(), true, &[]),
        case("crlf", FULL.replace('\n', "\r\n"), true, &[]),
        case("byte-order-mark", format!("\u{feff}{FULL}"), true, &[]),
        case("prefixed", "<ml:MeshLink xmlns:ml='https://cadence.com' version='1.0'/>".into(), true, &[]),
        case("ids-with-blanks", root("<Transform xid=' +07 '>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</Transform>"), true, &[]),
        case(
            "indices-on-many-lines",
            sheet("<MeshFace etype='Tri3' count='2'>\n1\n2\t3 2\n\n4 3</MeshFace>"),
            true,
            &[],
        ),
        case(
            "cdata",
            sheet("<MeshFace etype='Tri3' format='base64'><![CDATA[AQAAAAIA\nAAADAAAA]]></MeshFace>"),
            true,
            &[],
        ),
        case("comment-in-content", sheet("<MeshFace etype='Tri3'>1 <!-- -->2 &#51;</MeshFace>"), true, &[]),
        case("group-behind-use", model("<MeshPointReference gref='3'>1</MeshPointReference>"), true, &[]),
        case("empty-root", "<MeshLink version='1.0' xmlns='https://cadence.com'/>".into(), true, &[]),
    ]
}

fn broken() -> Vec<Case> {
    let wide: Vec<u8> = vec![b'<', b'?'];
    let bomb = "<!DOCTYPE MeshLink [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;&a;'>]>\n";
    vec![
        fatal("empty", "", "not an XML file"),
        fatal("blank", "  \n ", "not an XML file"),
        fatal("not-xml", "$MeshFormat\n4.1 0 8\n", "not an XML file (it begins with '$')"),
        fatal("unclosed-start", String::from_utf8_lossy(&wide).into_owned(), "1:3"),
        fatal("not-meshlink", "<?xml version='1.0'?>\n<VTKFile/>", "2:1: the root element is VTKFile, not MeshLink"),
        fatal("truncated-in-element", FULL[..FULL.len() / 2].to_owned(), "truncated"),
        fatal(
            "truncated-in-tag",
            "<MeshLink version='1.0'>\n<GeometryFile filena",
            "inside MeshLink, which began at 1:1",
        ),
        fatal("truncated-in-comment", "<MeshLink version='1.0'><!-- ", "inside MeshLink"),
        fatal(
            "truncated-at-end",
            FULL.trim_end().trim_end_matches("</MeshLink>"),
            "inside MeshLink, which began at 3:1",
        ),
        fatal("wrong-end-tag", "<MeshLink version='1.0'>\n</GeometryFile>", "the XML is broken"),
        fatal("second-root", "<MeshLink version='1.0'/>\n<MeshLink version='1.0'/>", "2:1"),
        fatal("text-behind-root", "<MeshLink version='1.0'/>\nmore", "text outside the root element"),
        fatal("attribute-twice", "<MeshLink version='1.0' version='2'/>", "the XML is broken"),
        fatal("entity", root("<Attribute attid='1'>&secret;</Attribute>"), "3:22: entity &secret;"),
        fatal("entity-in-attribute", root("<Attribute attid='1' name='&x;'/>"), "entity &x;"),
        fatal("bomb", format!("{bomb}<MeshLink version='&b;'/>"), "entity &b;"),
        fatal("character-zero", root("<Attribute attid='1'>&#0;</Attribute>"), "the XML is broken"),
        fatal("latin-1", "<?xml version='1.0' encoding='ISO-8859-1'?><MeshLink version='1'/>", "not UTF-8"),
        fatal("depth", "<a>".repeat(9), "the root element is a"),
    ]
}

fn structure() -> Vec<Case> {
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

fn contents() -> Vec<Case> {
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

fn references() -> Vec<Case> {
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

/// The full document with one thing changed: a line left out or doubled, an attribute left out or given another value, an
/// element renamed. For comparing verdicts of two schemas.
pub(crate) fn mutations() -> Vec<(String, String)> {
    let lines: Vec<&str> = FULL.lines().collect();
    let mut all = Vec::new();
    let mut with = |kind: &str, number: usize, replacement: &str| {
        let text: Vec<&str> =
            lines.iter().enumerate().map(|(i, line)| if i == number { replacement } else { line }).collect();
        all.push((format!("{kind}-line-{}", number + 1), text.join("\n")));
    };
    for (number, line) in lines.iter().enumerate().skip(2) {
        with("without", number, "");
        with("twice", number, &format!("{line}\n{line}"));
        with("moved-in", number, &format!("<Attribute attid='99'/>{line}"));
        with("text-before", number, &format!("word {line}"));
        with("renamed", number, &line.replace("<Mesh", "<mesh").replace("<Geometry", "<geometry"));
        with("emptied", number, &line.replace(|c: char| c.is_ascii_digit(), ""));
        for (place, (at, _)) in line.match_indices("=\"").enumerate() {
            let name_at = line[..at].rfind(' ').map_or(0, |blank| blank + 1);
            let end = line[at + 2..].find('"').map_or(line.len(), |length| at + 2 + length);
            let (head, name, tail) = (&line[..name_at], &line[name_at..at], &line[end + 1..]);
            with(&format!("no-attribute-{place}"), number, &format!("{head}{tail}"));
            with(&format!("other-attribute-{place}"), number, &format!("{head}x{name}=\"1\"{tail}"));
            for (kind, value) in
                [("zero", "0"), ("word", "x"), ("sign", " +3 "), ("negative", "-1"), ("dangling", "77"), ("empty", "")]
            {
                with(&format!("{kind}-{place}"), number, &format!("{head}{name}=\"{value}\"{tail}"));
            }
        }
    }
    all
}
