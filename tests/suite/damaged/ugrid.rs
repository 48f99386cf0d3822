//! UGRID: what stands behind the cells.

use super::{Place, sample};

#[test]
fn ugrid_bytes_behind_the_cells_are_told() {
    let place = Place::new();
    let whole = std::fs::read(sample("hexpyrtet_p1.lb8.ugrid")).unwrap();
    let mut fewer = whole.clone();
    assert_ne!(&fewer[24..28], &[0; 4]);
    fewer[24..28].fill(0); // no hexes
    place.refuses("fewer.lb8.ugrid", &fewer, &["more cells follow than the header counts"]);
    place.refuses("zeros.lb8.ugrid", [0; 1000], &["counts no nodes"]);
    let more = [&whole[..], &[0; 1000]].concat();
    let mesh = place.read("more.lb8.ugrid", more).unwrap();
    assert!(mesh.notes().iter().any(|note| note.contains("what follows the cells")), "{:?}", mesh.notes());
    let none = place.read("whole.lb8.ugrid", &whole).unwrap();
    assert!(!none.notes().iter().any(|note| note.contains("what follows")), "{:?}", none.notes());
}

/// Fewer bytes than a number has are no number, and are told; so is what stands behind the last record.
#[test]
fn parts_of_a_number_behind_the_cells_of_ugrid_are_told() {
    let place = Place::new();
    for (ending, tail) in [("b4", 3), ("b8", 1), ("b8", 3), ("lb4", 2), ("lb8", 3), ("lb8l", 7), ("r8", 1), ("lr8", 5)]
    {
        let name = format!("hexpyrtet_p1.{ending}.ugrid");
        let whole = std::fs::read(sample(&name)).unwrap();
        let told = place.notes(&name, &whole);
        assert!(!told.contains("what follows"), "{name}: {told}");
        let told = place.notes(&name, [&whole[..], &[1; 8][..tail]].concat());
        assert!(told.contains("what follows the cells"), "{name}, {tail} bytes: {told}");
    }
}
