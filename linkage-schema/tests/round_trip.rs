//! What is written reads back equal, whatever it is; and what is read from damaged files never panics.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, dead_code, missing_docs)]

mod corpus;

use std::path::Path;

use linkage_schema::*;
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

fn text() -> impl Strategy<Value = String> {
    prop_oneof![Just(String::new()), "[a-z/ ]{1,8}", "[\\t\\n\\r &<>\"'\\]é∂\u{1f600}a-c]{0,12}"]
}

fn name() -> impl Strategy<Value = Option<String>> {
    option::of(text())
}

fn attribute_id() -> impl Strategy<Value = AttributeId> {
    (1..=u32::MAX).prop_map(|n| AttributeId::new(n).unwrap())
}

fn geometry_id() -> impl Strategy<Value = GeometryId> {
    (1..=u32::MAX).prop_map(|n| GeometryId::new(n).unwrap())
}

fn transform_id() -> impl Strategy<Value = TransformId> {
    (1..=u32::MAX).prop_map(|n| TransformId::new(n).unwrap())
}

fn mesh_id() -> impl Strategy<Value = MeshId> {
    (1..=u32::MAX).prop_map(|n| MeshId::new(n).unwrap())
}

fn common() -> impl Strategy<Value = Common> {
    (option::of(mesh_id()), name(), option::of(attribute_id()), option::of(geometry_id()))
        .prop_map(|(mid, name, aref, gref)| Common { mid, name: name.map(Into::into), aref, gref })
}

fn encoded(width: usize) -> impl Strategy<Value = (Encoding, Box<[u32]>)> {
    let text = vec(1..=u32::MAX, 1..20).prop_map(|indices| (Encoding::Text, indices));
    let base64 = vec(1..=0x7fff_ffff_u32, 1..20).prop_map(|indices| (Encoding::Base64, indices));
    prop_oneof![text, base64].prop_map(move |(encoding, one)| (encoding, one.repeat(width).into()))
}

fn face_run() -> impl Strategy<Value = FaceRun> {
    let shape = prop_oneof![Just(FaceShape::Triangle), Just(FaceShape::Quad)];
    let faces = shape.prop_flat_map(|shape| (Just(shape), encoded(shape.corners())));
    let origin = Origin::MADE;
    (common(), faces).prop_map(move |(common, (shape, (encoding, indices)))| FaceRun {
        common,
        shape,
        encoding,
        indices,
        origin,
    })
}

fn edge_run() -> impl Strategy<Value = EdgeRun> {
    (common(), encoded(2)).prop_map(|(common, (encoding, indices))| EdgeRun {
        common,
        encoding,
        indices,
        origin: Origin::MADE,
    })
}

fn point_run() -> impl Strategy<Value = PointRun> {
    (common(), encoded(1)).prop_map(|(common, (encoding, indices))| PointRun {
        common,
        encoding,
        indices,
        origin: Origin::MADE,
    })
}

fn entity_run() -> impl Strategy<Value = EntityRun> {
    (common(), text(), vec("[a-z<&/0-9é]{1,6}", 1..4)).prop_map(|(common, etype, references)| EntityRun {
        common,
        etype,
        references,
        origin: Origin::MADE,
    })
}

fn param_vertex() -> impl Strategy<Value = ParamVertex> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    let number = || POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO;
    let parameters = prop_oneof![
        number().prop_map(Parameters::Curve),
        (number(), number()).prop_map(|(u, v)| Parameters::Surface(u, v))
    ];
    let vertex =
        prop_oneof![(1..=u32::MAX).prop_map(|n| n.to_string()), text(), Just("007".to_owned()), Just("+7".to_owned())];
    let vertex = vertex.prop_map(|text| VertexRef::from(text.as_str()));
    (option::of(mesh_id()), vertex, geometry_id(), parameters).prop_map(|(mid, vertex, gref, parameters)| ParamVertex {
        mid,
        vertex,
        gref,
        parameters,
        origin: Origin::MADE,
    })
}

fn sheet() -> impl Strategy<Value = Sheet> {
    let body = prop_oneof![
        vec(face_run(), 0..3).prop_map(SheetBody::Faces),
        vec(entity_run(), 1..3).prop_map(SheetBody::FaceReferences),
        text().prop_map(SheetBody::Reference)
    ];
    (common(), body, vec(param_vertex(), 0..3)).prop_map(|(common, body, parameters)| Sheet {
        common,
        body,
        parameters,
        origin: Origin::MADE,
    })
}

fn string() -> impl Strategy<Value = MeshString> {
    let body = prop_oneof![
        vec(edge_run(), 0..3).prop_map(StringBody::Edges),
        vec(entity_run(), 1..3).prop_map(StringBody::EdgeReferences),
        text().prop_map(StringBody::Reference)
    ];
    (common(), body, vec(param_vertex(), 0..3)).prop_map(|(common, body, parameters)| MeshString {
        common,
        body,
        parameters,
        origin: Origin::MADE,
    })
}

fn mesh_file() -> impl Strategy<Value = MeshFile> {
    let parts = (vec(sheet(), 0..3), vec(string(), 0..3), vec(point_run(), 0..3), vec(param_vertex(), 0..3));
    let model = (text(), common(), parts).prop_map(|(reference, common, (sheets, strings, points, parameters))| {
        MeshModel { reference, common, sheets, strings, points, parameters, origin: Origin::MADE }
    });
    (text(), option::of(attribute_id()), vec(model, 1..3)).prop_map(|(filename, aref, models)| MeshFile {
        filename,
        aref,
        models,
        origin: Origin::MADE,
    })
}

fn geometry_file() -> impl Strategy<Value = GeometryFile> {
    let reference = (geometry_id(), text(), name(), option::of(attribute_id()))
        .prop_map(|(id, reference, name, aref)| GeometryReference { id, reference, name, aref, origin: Origin::MADE });
    (text(), option::of(attribute_id()), vec(reference, 0..3)).prop_map(|(filename, aref, references)| GeometryFile {
        filename,
        aref,
        references,
        origin: Origin::MADE,
    })
}

fn document() -> impl Strategy<Value = Document> {
    let origin = Origin::MADE;
    let attribute =
        (attribute_id(), name(), text()).prop_map(move |(id, name, value)| Attribute { id, name, value, origin });
    let attribute_group = (attribute_id(), name(), vec(attribute_id(), 0..3))
        .prop_map(move |(id, name, members)| AttributeGroup { id, name, members, origin });
    let group = (geometry_id(), name(), option::of(attribute_id()), vec(geometry_id(), 0..3))
        .prop_map(move |(id, name, aref, members)| GeometryGroup { id, name, aref, members, origin });
    let transform = (transform_id(), name(), option::of(attribute_id()), text())
        .prop_map(move |(id, name, aref, content)| Transform { id, name, aref, content, origin });
    let linkage = (text(), text(), option::of(transform_id()), option::of(attribute_id()), name()).prop_map(
        move |(source, target, transform, aref, name)| ElementLinkage { source, target, transform, aref, name, origin },
    );
    let first =
        (text(), vec(attribute, 0..3), vec(attribute_group, 0..3), vec(geometry_file(), 0..3), vec(group, 0..3));
    let second = (vec(mesh_file(), 0..3), vec(transform, 0..3), vec(linkage, 0..3));
    (first, second).prop_map(move |(first, (mesh_files, transforms, linkages))| {
        let (version, attributes, attribute_groups, geometry_files, geometry_groups) = first;
        Document {
            version,
            attributes,
            attribute_groups,
            geometry_files,
            geometry_groups,
            mesh_files,
            transforms,
            linkages,
            origin,
        }
    })
}

fn written(document: &Document) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(document, &mut bytes).unwrap();
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_written_document_reads_back_equal(document in document()) {
        let bytes = written(&document);
        let reading = read(bytes.as_slice(), Path::new("written.xml")).unwrap();
        prop_assert_eq!(reading.findings.errors(), 0, "{:?}", reading.findings);
        prop_assert_eq!(&reading.document, &document);
        prop_assert_eq!(written(&reading.document), bytes);
        resolve(&document);
    }

    #[test]
    fn a_damaged_document_never_panics(edits in vec((0..corpus::FULL.len(), any::<u8>(), 0..3), 1..6)) {
        let mut bytes = corpus::FULL.as_bytes().to_vec();
        for (at, byte, kind) in edits {
            let at = at % bytes.len();
            match kind {
                0 => bytes[at] = byte,
                1 => drop(bytes.remove(at)),
                _ => bytes.insert(at, b"<>&\"'/=!?[]0-"[usize::from(byte) % 13]),
            }
        }
        if let Ok(reading) = read(bytes.as_slice(), Path::new("damaged.xml")) {
            resolve(&reading.document);
        }
    }
}

#[test]
fn the_full_document_reads_back_equal() {
    let document = read(corpus::FULL.as_bytes(), Path::new("full.xml")).unwrap().accept().unwrap();
    let again = read(written(&document).as_slice(), Path::new("again.xml")).unwrap();
    assert!(again.findings.is_empty());
    assert_eq!(again.document, document);
}

#[test]
fn a_long_run_reads_back_in_both_encodings() {
    for encoding in [Encoding::Text, Encoding::Base64] {
        let indices: Box<[u32]> = (1..=30_000).collect();
        let run =
            FaceRun { common: Common::default(), shape: FaceShape::Triangle, encoding, indices, origin: Origin::MADE };
        let sheet = Sheet {
            common: Common::default(),
            body: SheetBody::Faces(vec![run]),
            parameters: vec![],
            origin: Origin::MADE,
        };
        let model = MeshModel {
            reference: String::new(),
            common: Common::default(),
            sheets: vec![sheet],
            strings: vec![],
            points: vec![],
            parameters: vec![],
            origin: Origin::MADE,
        };
        let file = MeshFile { filename: String::new(), aref: None, models: vec![model], origin: Origin::MADE };
        let document = Document { mesh_files: vec![file], ..Document::default() };
        let reading = read(written(&document).as_slice(), Path::new("long.xml")).unwrap();
        assert_eq!(reading.document, document);
    }
}

#[test]
fn what_the_format_cannot_say_is_refused() {
    let bad = |document: &Document| write(document, Vec::new()).unwrap_err().to_string();
    let version = Document { version: "\u{1}".into(), ..Document::default() };
    assert!(bad(&version).contains("XML has no character"), "{}", bad(&version));
}
