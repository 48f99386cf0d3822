//! Names that are no UTF-8.

use sagitta::formats;

use super::{Place, text};

#[test]
fn names_are_latin1_where_they_are_no_utf8() {
    let place = Place::new();
    let whole = text("hexpyrtet_p1_msh22a.msh");
    let at = whole.find("\"wall\"").unwrap() + 1;
    let bytes = [&whole.as_bytes()[..at], b"caf\xe9", &whole.as_bytes()[at + 4..]].concat();
    let mesh = place.read("latin1.msh", bytes).unwrap();
    assert!(mesh.physical_names().iter().any(|name| name.name == "café"), "{:?}", mesh.physical_names());
    // CGNS keeps text as numbers of 8 bits, with a sign or without.
    let path = place.0.path().join("latin1.cgns");
    formats::write(&path, &mesh, &formats::WriteOptions::default()).unwrap();
    assert!(formats::read(&path).unwrap().physical_names().iter().any(|name| name.name == "café"));
    let back = place.0.path().join("back.msh");
    formats::write(&back, &mesh, &formats::WriteOptions::default()).unwrap();
    assert_eq!(formats::read(&back).unwrap().physical_names(), mesh.physical_names());
}
