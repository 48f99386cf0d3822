//! SU2: sections that are missing, or there twice.

use super::{Place, text, with};

#[test]
fn sections_of_su2_stand_once() {
    let place = Place::new();
    let su2 = text("hexpyrtet_p1.su2");
    place.refuses("twice.su2", with(&su2, "NDIME= 3", "NDIME= 3\nNDIME= 2"), &["line 2", "NDIME= stands twice"]);
    let (cells, points) = (su2.find("NELEM").unwrap(), su2.find("NPOIN").unwrap());
    place.refuses("none.su2", [&su2[..cells], &su2[points..]].concat(), &["NELEM= is missing"]);
}
