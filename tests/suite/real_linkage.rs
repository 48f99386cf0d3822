//! Cadence's own linkage files, right and made worse. They are no part of the project: `SAGITTA_MESHLINK` says where they are.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::common::{fixture, sagitta, warn};
use linkage_schema::Code;

/// The folder of the files; `None`, said aloud, where it is not named.
fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("SAGITTA_MESHLINK").filter(|folder| !folder.is_empty()).map(PathBuf::from);
    if folder.is_none() {
        warn("SAGITTA_MESHLINK is not set: Cadence's own files are NOT validated");
    }
    folder
}

/// Exit code, and codes and lines of what is found.
fn validate(linkage: &Path, more: &[OsString]) -> (i32, Vec<(String, usize)>) {
    let outcome = sagitta(args!["validate", linkage, "--json"].into_iter().chain(more.iter().cloned()));
    let json: serde_json::Value = serde_json::from_str(&outcome.stdout).expect(&outcome.stderr);
    let findings = json["findings"].as_array().unwrap().iter();
    let found = findings.map(|f| (f["code"].as_str().unwrap().to_owned(), f["line"].as_u64().unwrap_or(0) as usize));
    (outcome.code.unwrap(), found.collect())
}

/// What becomes of an element.
enum Change {
    /// An attribute gets another value.
    Set(&'static str, &'static str),
    /// An attribute goes.
    Drop(&'static str),
    /// The content becomes another.
    Content(fn(&str) -> String),
    /// The element gets another name.
    Rename(&'static str),
    /// Lines are added before the end of the file; the element is of no matter. SHEET, OTHER and STRING are names of the first ones.
    Append(&'static str),
}
use Change::{Append, Content, Drop, Rename, Set};

/// Where the finding stands.
enum At {
    /// On the line that was changed.
    Changed,
    /// At the start tag of such an element, the last one before the change.
    Within(&'static str),
}
use At::{Changed, Within};

/// An element by name and number, what becomes of it, what is found where, and what else follows from it.
type Defect = (&'static str, usize, Change, Code, At, &'static [Code]);

/// Place of the nth start tag of an element.
fn start(text: &str, element: &str, nth: usize) -> usize {
    let open = format!("<{element}");
    let found = text
        .match_indices(&open)
        .filter(|(at, name)| text[at + name.len()..].starts_with(|c: char| c.is_ascii_whitespace() || c == '>'));
    found.map(|(at, _)| at).nth(nth).unwrap_or_else(|| panic!("no <{element}> number {nth}"))
}

fn changed(text: &str, element: &str, nth: usize, change: &Change) -> String {
    if let Append(lines) = change {
        let name = |element, nth| {
            let tag = &text[start(text, element, nth)..];
            let open = tag.find(" name=\"").unwrap() + 7;
            &tag[open..open + tag[open..].find('"').unwrap()]
        };
        let lines = lines.replace("SHEET", name("MeshSheet", 0)).replace("OTHER", name("MeshSheet", 1));
        let lines = lines.replace("STRING", name("MeshString", 0));
        return text.replacen("</MeshLink>", &format!("{lines}\n</MeshLink>"), 1);
    }
    let from = start(text, element, nth);
    let to = from + text[from..].find('>').unwrap();
    let tag = &text[from..to];
    let value = |name: &str| {
        let at = tag.find(&format!(" {name}=\"")).unwrap_or_else(|| panic!("{tag} has no {name}"));
        let open = at + name.len() + 3;
        (at, open, open + tag[open..].find('"').unwrap())
    };
    let tag = match change {
        Set(name, new) => {
            let (_, open, end) = value(name);
            format!("{}{new}{}", &tag[..open], &tag[end..])
        }
        Drop(name) => {
            let (at, _, end) = value(name);
            format!("{}{}", &tag[..at], &tag[end + 1..])
        }
        Rename(new) => tag.replacen(element, new, 1),
        Content(_) | Append(_) => tag.to_owned(),
    };
    let end = to + text[to..].find("</").unwrap();
    let content = match change {
        Content(change) => change(&text[to + 1..end]),
        _ => text[to + 1..end].to_owned(),
    };
    let rest = match change {
        Rename(new) => text[end..].replacen(&format!("</{element}>"), &format!("</{new}>"), 1),
        _ => text[end..].to_owned(),
    };
    format!("{}{tag}>{content}{rest}", &text[..from])
}

/// Makes the file worse in every way of the table; every defect is found at its line, and nothing else.
fn spoil(file: &Path, more: &[OsString], table: &[Defect]) {
    let good = std::fs::read_to_string(file).unwrap();
    let (code, known) = validate(file, more);
    assert_eq!(code, 0, "{known:?}");
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join(file.file_name().unwrap());
    let mut problems = Vec::new();
    for (element, nth, change, wanted, at, follows) in table {
        let text = changed(&good, element, *nth, change);
        let first = good.bytes().zip(text.bytes()).position(|(a, b)| a != b).unwrap();
        let place = match at {
            Changed => first,
            Within(container) => text[..first].rfind(&format!("<{container} ")).unwrap(),
        };
        let line = 1 + text[..place].matches('\n').count();
        std::fs::write(&path, &text).unwrap();
        let (code, found) = validate(&path, more);
        let what = format!("{element} {nth}, {} expected at {line}", wanted.id());
        if !found.contains(&(wanted.id().to_owned(), line)) {
            problems.push(format!("{what}: {found:?}"));
        }
        let expected = |own: &str| {
            own == wanted.id()
                || follows.iter().any(|code| code.id() == own)
                || known.iter().any(|(code, _)| code == own)
        };
        problems.extend(found.iter().filter(|(own, _)| !expected(own)).map(|alarm| format!("{what}: {alarm:?}")));
        let is_note = wanted.severity() == linkage_schema::Severity::Note;
        if code != i32::from(!is_note) {
            problems.push(format!("{what}: exit code {code}"));
        }
    }
    assert!(problems.is_empty(), "{}:\n{}", file.display(), problems.join("\n"));
}

/// The first index of a content becomes another.
fn first_index(content: &str, new: &str) -> String {
    let at = content.find(|c: char| c.is_ascii_digit()).unwrap();
    let length = content[at..].find(|c: char| !c.is_ascii_digit()).unwrap_or(content.len() - at);
    format!("{}{new}{}", &content[..at], &content[at + length..])
}

/// The first face, or pair of faces' indices, stands twice: the second line of the content is as the first.
fn second_line_as_first(content: &str) -> String {
    let mut lines: Vec<&str> = content.split('\n').collect();
    lines[2] = lines[1];
    lines.join("\n")
}

/// Half of the content without the first edge's end and the second one's begin: two points are no longer joined.
fn gap(content: &str) -> String {
    let mut words: Vec<&str> = content.split_whitespace().collect();
    // 1 2 2 3 3 4 ... becomes 1 2 1 2 3 4 ...: the second edge is the first once more.
    (words[2], words[3]) = (words[0], words[1]);
    words.join(" ")
}

/// Defects of a file of unstructured or structured faces alike.
const COMMON: &[Defect] = &[
    ("Attribute", 1, Set("attid", "1"), Code::DuplicateId, Changed, &[Code::DanglingReference]),
    ("Attribute", 1, Drop("attid"), Code::MissingAttribute, Changed, &[Code::DanglingReference]),
    ("AttributeGroup", 0, Set("attid", "1"), Code::DuplicateId, Changed, &[Code::DanglingReference]),
    ("AttributeGroup", 0, Content(|c| format!("{c} 99")), Code::DanglingReference, Changed, &[]),
    ("AttributeGroup", 0, Content(|c| format!("{c} x")), Code::BadIndex, Changed, &[]),
    ("AttributeGroup", 0, Content(|c| format!("{c} {c}")), Code::RepeatedMember, Changed, &[]),
    ("GeometryFile", 0, Set("aref", "99"), Code::DanglingReference, Changed, &[]),
    ("GeometryFile", 0, Drop("filename"), Code::MissingAttribute, Changed, &[Code::DanglingReference]),
    ("GeometryReference", 1, Set("gid", "1"), Code::DuplicateId, Changed, &[Code::DanglingReference]),
    ("GeometryReference", 1, Set("gid", "0"), Code::BadAttribute, Changed, &[Code::DanglingReference]),
    ("GeometryReference", 1, Set("gid", "two"), Code::BadAttribute, Changed, &[Code::DanglingReference]),
    ("GeometryReference", 1, Drop("ref"), Code::MissingAttribute, Changed, &[Code::DanglingReference]),
    ("GeometryGroup", 0, Set("gid", "1"), Code::DuplicateId, Changed, &[Code::DanglingReference]),
    ("GeometryGroup", 0, Drop("gid"), Code::MissingAttribute, Changed, &[Code::DanglingReference]),
    ("GeometryGroup", 0, Content(|c| format!("{c} 999")), Code::DanglingReference, Changed, &[]),
    ("GeometryGroup", 0, Content(|c| format!("{c} {c}")), Code::RepeatedMember, Changed, &[]),
    ("MeshFile", 0, Set("aref", "99"), Code::DanglingReference, Changed, &[]),
    ("MeshFile", 0, Drop("filename"), Code::MissingAttribute, Changed, &[Code::OtherMeshFile]),
    ("MeshModelReference", 0, Drop("ref"), Code::MissingAttribute, Changed, &[]),
    ("MeshSheet", 0, Set("gref", "999"), Code::DanglingReference, Changed, &[]),
    ("MeshSheet", 0, Set("gref", "x"), Code::BadAttribute, Changed, &[]),
    ("MeshString", 0, Set("gref", "999"), Code::DanglingReference, Changed, &[]),
    ("ParamVertex", 3, Set("gref", "999"), Code::DanglingReference, Changed, &[]),
    ("ParamVertex", 3, Drop("gref"), Code::MissingAttribute, Changed, &[]),
    ("ParamVertex", 3, Drop("vref"), Code::MissingAttribute, Changed, &[]),
    ("ParamVertex", 3, Drop("dim"), Code::MissingAttribute, Changed, &[]),
    ("ParamVertex", 3, Set("dim", "3"), Code::BadDimension, Changed, &[]),
    ("ParamVertex", 3, Set("vref", "99999"), Code::StrayVertex, Changed, &[]),
    ("ParamVertex", 3, Content(|_| "nan 1".to_owned()), Code::BadNumber, Changed, &[]),
    ("ParamVertex", 3, Content(|_| "1".to_owned()), Code::BadNumber, Changed, &[]),
    ("MeshFace", 0, Set("count", "1000000000"), Code::CountTooLarge, Changed, LOST),
    ("MeshFace", 0, Set("count", "1"), Code::ExtraContent, Changed, LOST),
    ("MeshFace", 0, Set("count", "-1"), Code::BadAttribute, Changed, LOST),
    ("MeshFace", 0, Set("etype", "Tri6"), Code::UnknownType, Changed, LOST),
    ("MeshFace", 0, Drop("etype"), Code::MissingAttribute, Changed, LOST),
    ("MeshFace", 0, Set("format", "lzw"), Code::UnknownFormat, Changed, LOST),
    ("MeshFace", 0, Content(|c| first_index(c, "0")), Code::BadIndex, Changed, LOST),
    ("MeshFace", 0, Content(|c| first_index(c, "x")), Code::BadIndex, Changed, LOST),
    ("MeshFace", 0, Content(|c| first_index(c, "99999999999")), Code::BadIndex, Changed, LOST),
    ("MeshFace", 0, Content(second_line_as_first), Code::RepeatedFace, Changed, LOST),
    ("MeshFace", 0, Rename("MeshFaces"), Code::UnknownElement, Changed, LOST),
    ("MeshEdge", 0, Set("etype", "Edge3"), Code::UnknownType, Changed, LOST),
    ("MeshEdge", 0, Set("count", "99"), Code::CountTooLarge, Changed, LOST),
    ("MeshEdge", 0, Set("count", "1"), Code::ExtraContent, Changed, LOST),
    ("MeshLink", 0, Set("xmlns", "http://www.pointwise.com/meshlink"), Code::ForeignNamespace, Changed, &[]),
    ("", 0, Append("<Transform xid=\"1\">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0</Transform>"), Code::BadTransform, Changed, &[]),
    (
        "",
        0,
        Append("<Transform xid=\"1\" aref=\"99\">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</Transform>"),
        Code::DanglingReference,
        Changed,
        &[],
    ),
    (
        "",
        0,
        Append("<MeshElementLinkage sourceEntityRef=\"nobody\" targetEntityRef=\"SHEET\"/>"),
        Code::UnknownMeshElement,
        Changed,
        &[],
    ),
    (
        "",
        0,
        Append("<MeshElementLinkage sourceEntityRef=\"SHEET\" targetEntityRef=\"99\"/>"),
        Code::UnknownMeshElement,
        Changed,
        &[],
    ),
    (
        "",
        0,
        Append("<MeshElementLinkage sourceEntityRef=\"SHEET\" targetEntityRef=\"OTHER\" xref=\"7\"/>"),
        Code::DanglingReference,
        Changed,
        &[],
    ),
    (
        "",
        0,
        Append("<MeshElementLinkage sourceEntityRef=\"SHEET\" targetEntityRef=\"OTHER\" aref=\"99\"/>"),
        Code::DanglingReference,
        Changed,
        &[],
    ),
    (
        "",
        0,
        Append("<MeshElementLinkage sourceEntityRef=\"SHEET\" targetEntityRef=\"STRING\"/>"),
        Code::UnequalPair,
        Changed,
        &[],
    ),
    ("", 0, Append("<MeshElementLinkage targetEntityRef=\"OTHER\"/>"), Code::MissingAttribute, Changed, &[]),
    ("", 0, Append("<Nonsense/>"), Code::UnknownElement, Changed, &[]),
];

/// What follows where faces or edges are lost: points and strings without them, patches in part.
const LOST: &[Code] =
    &[Code::StrayVertex, Code::StringWithoutSheet, Code::PartlyCovered, Code::BrokenString, Code::EmptyElement];

#[test]
fn the_wing_alone() {
    let Some(folder) = folder() else { return };
    let file = folder.join("oneraM6.xml");
    assert_eq!(validate(&file, &[]).1.len(), 1);
    spoil(&file, &[], COMMON);
    spoil(
        &file,
        &[],
        &[
            ("AttributeGroup", 0, Content(|c| format!("{c} 5")), Code::CyclicGroup, Changed, &[]),
            ("GeometryGroup", 1, Content(|c| format!("{c} 3")), Code::NestedGroup, Changed, &[]),
            ("ParamVertex", 0, Set("gref", "3"), Code::GroupAsEntity, Changed, &[]),
            ("ParamVertex", 1, Set("vref", "1"), Code::RepeatedVertex, Changed, &[]),
            ("MeshFace", 0, Set("format", "base64"), Code::BadBase64, Changed, LOST),
            ("MeshEdge", 0, Content(gap), Code::BrokenString, Within("MeshString"), LOST),
            ("MeshEdge", 0, Content(|c| first_index(c, "2")), Code::DegenerateCell, Changed, LOST),
            ("MeshEdge", 0, Content(|c| first_index(c, "0")), Code::BadIndex, Changed, LOST),
        ],
    );
}

#[test]
fn the_sphere_with_its_mesh() {
    let Some(folder) = folder() else { return };
    let [file, mesh] = ["sphere_ml.xml", "sphere.x"].map(|name| folder.join(name));
    let more = args!["--mesh", mesh];
    let (_, notes) = validate(&file, &more);
    let codes: std::collections::BTreeSet<&str> = notes.iter().map(|(code, _)| &code[..]).collect();
    assert!(codes.into_iter().eq([Code::UnknownMeshName.id(), Code::UnreadableGeometry.id()]), "{notes:?}");
    let told = sagitta(args!["validate", file, "--mesh", mesh, "--json"]).expect(0).stdout;
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    let coverage = told["coverage"].as_array().unwrap();
    assert!(coverage.len() == 6 && coverage.iter().all(|patch| patch["linked"] == 4), "{coverage:#?}");
    spoil(&file, &more, COMMON);
    spoil(
        &file,
        &more,
        &[
            ("MeshFace", 0, Content(|c| first_index(c, "44")), Code::IndexBeyondMesh, Changed, LOST),
            ("MeshFace", 1, Content(|c| first_index(c, "7")), Code::NotInMesh, Changed, LOST),
            ("MeshEdge", 0, Content(|c| first_index(c, "27")), Code::EdgeNotInMesh, Changed, LOST),
            ("MeshPointReference", 0, Content(|c| first_index(c, "28")), Code::IndexBeyondMesh, Changed, &[]),
            ("MeshPointReference", 0, Content(|c| first_index(c, "14")), Code::StrayPoint, Changed, &[]),
            ("ParamVertex", 0, Set("vref", "28"), Code::IndexBeyondMesh, Changed, &[]),
            ("MeshPointReference", 0, Set("gref", "999"), Code::DanglingReference, Changed, &[]),
            ("GeometryGroup", 0, Content(|c| format!("{c} 22")), Code::NestedGroup, Changed, &[]),
        ],
    );
    let dir = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(&file).unwrap();
    let path = dir.path().join("sphere_ml.xml");
    // Another mesh, as another file.
    let (code, found) = validate(&file, &args!["--mesh", fixture("cylinder_bl", "msh")]);
    let has = |found: &[(String, usize)], code: Code| found.iter().any(|(own, _)| own == code.id());
    assert!(code == 1 && has(&found, Code::OtherMesh) && has(&found, Code::OtherMeshFile), "{found:?}");
    // Counted from 2.
    std::fs::write(&path, crate::common::linkage::renumbered(&good, 1)).unwrap();
    let (code, found) = validate(&path, &more);
    let line = 1 + good[..start(&good, "MeshModelReference", 0)].matches('\n').count();
    assert!(code == 1 && found.contains(&(Code::IndexBase.id().to_owned(), line)), "{found:?}");
    // Cut off.
    std::fs::write(&path, &good[..good.len() / 2]).unwrap();
    let (code, found) = validate(&path, &more);
    let last = 1 + good[..good.len() / 2].matches('\n').count();
    assert_eq!((code, found), (1, vec![(Code::Unreadable.id().to_owned(), last)]));
}
