//! Elements that are there twice, are collapsed, or crossed.

use sagitta::mesh::{FaceKey, Mesh};

use super::{Place, text, with};

#[test]
fn repeated_numbers_and_doubled_elements_are_told() {
    let place = Place::new();
    let whole = text("hexpyrtet_p1_msh22a.msh");
    let count = whole.split("$Elements\n").nth(1).unwrap().lines().next().unwrap();
    let more = |row: &str| {
        let number: usize = count.parse().unwrap();
        let whole = with(&whole, &format!("$Elements\n{count}\n"), &format!("$Elements\n{}\n", number + 1));
        with(&whole, "$EndElements", &format!("{row}\n$EndElements"))
    };
    let tet = whole.lines().find(|line| line.starts_with("99 4 2 ")).unwrap();
    place.refuses("number.msh", more(tet), &["element 99", "stands twice"]);
    let again = with(tet, "99 ", "999 ");
    place.refuses("double.msh", more(&again), &["element 999", "same corners as element 99"]);
    // The same corners, begun elsewhere.
    let words: Vec<&str> = tet.split(' ').collect();
    let turned = format!("999 {} {} {} {} {}", words[1..5].join(" "), words[7], words[8], words[6], words[5]);
    place.refuses("turned.msh", more(&turned), &["element 999", "same corners as element 99"]);
    // A face in two patches may be meant, and a collapsed cell too.
    let face =
        whole.lines().find(|line| line.starts_with("1 2 2 ")).unwrap().split(' ').skip(5).collect::<Vec<_>>().join(" ");
    let mesh = place.read("two.msh", more(&format!("999 2 2 1 99 {face}"))).unwrap();
    assert!(
        mesh.notes()[0].starts_with("1 boundary elements are in two patches (elements 1 and 999"),
        "{:?}",
        mesh.notes()
    );
    let point = words[7];
    let flat = with(&whole, tet, &format!("{} {point} {point}", words[..7].join(" ")));
    let mesh = place.read("flat.msh", flat).unwrap();
    assert!(mesh.notes()[0].contains("one node at two corners (element 99 is"), "{:?}", mesh.notes());
}

#[test]
fn crossed_quadrilaterals_are_renumbered_along_their_cells() {
    let place = Place::new();
    let cube = "NDIME= 3\nNELEM= 1\n12 0 1 2 3 4 5 6 7\nNPOIN= 8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\nNMARK= 1\n\
        MARKER_TAG= all\nMARKER_ELEMS= 6\n9 0 1 2 3\n9 4 5 6 7\n9 0 1 5 4\n9 1 2 6 5\n9 2 3 7 6\n9 3 0 4 7\n";
    let whole = place.read("cube.su2", cube).unwrap();
    assert!(whole.notes().is_empty(), "{:?}", whole.notes());
    let crossed = cube.replacen("9 4 5 6 7\n", "9 4 6 5 7\n", 1).replacen("9 3 0 4 7", "9 3 0 7 4", 1);
    let mesh = place.read("crossed.su2", crossed).unwrap();
    assert!(mesh.notes()[0].starts_with("2 of 6 quad elements on the boundary had their corners in crossed order"));
    let keys = |mesh: &Mesh| mesh.sides().iter().map(|side| FaceKey::new(side.corners())).collect::<Vec<_>>();
    assert_eq!(keys(&mesh), keys(&whole));
}
