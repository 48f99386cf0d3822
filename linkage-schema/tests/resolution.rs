//! What references come to.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, dead_code, missing_docs)]

mod corpus;

use std::path::Path;

use linkage_schema::*;

fn document(text: &str) -> Document {
    read(text.as_bytes(), Path::new("a.xml")).unwrap().accept().unwrap()
}

fn names<'a>(entities: &[Entity<'a>]) -> Vec<&'a str> {
    entities.iter().map(|entity| entity.reference).collect()
}

#[test]
fn faces_and_edges_inherit_geometry_and_may_override_it() {
    let document = document(corpus::FULL);
    let resolution = resolve(&document).accept(Path::new("a.xml")).unwrap();
    let model = &resolution.models[0];
    assert_eq!((model.file.filename.as_str(), model.model.reference.as_str()), ("plate.ugrid", "volume"));

    let wall = &model.sheets[0];
    assert_eq!(wall.name(), Some("wall"));
    let faces: Vec<_> =
        wall.faces.iter().map(|link| (link.run.faces().collect::<Vec<_>>(), names(link.entities()))).collect();
    assert_eq!(faces[0], (vec![&[1, 2, 3][..], &[2, 4, 3]], vec!["face-1", "face-2"]));
    assert_eq!(faces[1], (vec![&[2, 4, 5, 6][..]], vec!["face-2"]));
    assert_eq!(faces[2], (vec![&[1, 2, 3][..]], vec!["face-1", "face-2"]));
    assert_eq!(wall.parameters()[0].parameters, Parameters::Surface(0.5, -1e-3));

    let edges: Vec<_> = model.strings[0]
        .edges
        .iter()
        .map(|link| (link.run.edges().collect::<Vec<_>>(), names(link.entities())))
        .collect();
    assert_eq!(edges, [(vec![[1, 2], [2, 4]], vec!["edge-1"]), (vec![[4, 5]], vec!["edge-1"])]);
    assert_eq!((&*model.points[0].run.indices, names(model.points[0].entities())), (&[1, 2][..], vec!["edge-1"]));
}

#[test]
fn sheets_by_name_and_by_reference_are_told_apart() {
    let document = document(corpus::FULL);
    let resolution = resolve(&document);
    let model = &resolution.models[0];
    assert_eq!(model.sheets[1].named[0].run.references, ["upper", "lower"]);
    assert_eq!(names(model.sheets[1].named[0].entities()), ["face-1"]);
    assert_eq!((model.sheets[2].reference, model.sheets[2].name()), (Some("/Base/zone/wall"), Some("s")));
    assert!(model.strings[1].target.is_none() && !model.strings[1].named[0].entities().is_empty());
    assert_eq!(model.strings[2].reference, Some("rim-2"));
}

#[test]
fn a_model_s_geometry_is_not_inherited() {
    let text = corpus::root(
        "<MeshFile filename='a'><MeshModelReference ref='m' gref='1'><MeshSheet><MeshFace etype='Tri3'>1 2 3</MeshFace></MeshSheet>\
         </MeshModelReference></MeshFile>",
    );
    let document = document(&text);
    assert!(resolve(&document).models[0].sheets[0].faces[0].entities().is_empty());
}

#[test]
fn attributes_are_found_through_groups_of_groups() {
    let document = document(corpus::FULL);
    let resolution = resolve(&document);
    let aref = document.mesh_files[0].aref;
    assert_eq!(resolution.attribute(aref, "mesh format"), Some("UGRID & more"));
    assert_eq!(resolution.attributes(aref).len(), 2);
    assert_eq!(resolution.attribute(None, "mesh format"), None);
}

#[test]
fn linkages_find_their_elements_by_name_and_by_mid() {
    let document = document(corpus::FULL);
    let resolution = resolve(&document);
    let pair = &resolution.pairs[0];
    assert!(matches!(pair.source, Some(MeshElement::Sheet(sheet)) if sheet.common.name.as_deref() == Some("wall")));
    assert!(matches!(pair.target, Some(MeshElement::Sheet(Sheet { body: SheetBody::Reference(_), .. }))));
    assert_eq!(pair.transform.and_then(Transform::matrix).map(|matrix| matrix[12]), Some(5.0));
}

#[test]
fn a_group_with_several_files_tells_the_file_of_each_entity() {
    let text = "<MeshLink version='1.0' xmlns='https://cadence.com'><GeometryGroup gid='9' name='both'>2 1</GeometryGroup>\
        <GeometryFile filename='a.step'><GeometryReference gid='1' ref='f'/></GeometryFile>\
        <GeometryFile filename='b.step'><GeometryReference gid='2' ref='f'/></GeometryFile></MeshLink>";
    let document = document(text);
    let resolution = resolve(&document);
    let target = resolution.target(GeometryId::new(9).unwrap()).unwrap();
    let files: Vec<_> = target.entities.iter().map(|entity| entity.file.filename.as_str()).collect();
    assert_eq!((target.group, target.name, files), (true, Some("both"), vec!["b.step", "a.step"]));
}

#[test]
fn every_element_knows_its_place() {
    let document = document(corpus::FULL);
    let at = |origin: Origin| origin.position().unwrap().to_string();
    let model = &document.mesh_files[0].models[0];
    assert_eq!(at(document.origin), "3:1");
    assert_eq!(at(document.geometry_files[0].references[1].origin), "10:5");
    assert_eq!(at(model.sheets[0].parameters[0].origin), "20:9");
    let SheetBody::Faces(runs) = &model.sheets[0].body else { panic!("faces") };
    assert_eq!(at(runs[2].origin), "23:9");
    assert_eq!(at(document.linkages[0].origin), "49:3");
}
