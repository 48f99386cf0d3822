//! Small documents, good and broken, each with what must be found in it.

mod contents;
pub(crate) mod mutations;
mod references;
mod structure;

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
    [good(), broken(), structure::structure(), contents::contents(), references::references()]
        .into_iter()
        .flatten()
        .collect()
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
