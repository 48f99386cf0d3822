//! GMF: keywords and what they announce.

use super::{Place, sample, text, with};

#[test]
fn gmf_keywords_hold_what_they_announce() {
    let place = Place::new();
    let mut whole = std::fs::read(sample("cylprism_p1.meshb")).unwrap();
    let word = |whole: &[u8], at: usize| u32::from_le_bytes(whole[at..at + 4].try_into().unwrap());
    // Mark, version, Dimension with the next keyword's place and the dimension; then Vertices, the next keyword's place, their number.
    let wide = if word(&whole, 4) >= 3 { 8 } else { 4 };
    let vertices = 12 + wide + 4;
    assert_eq!(word(&whole, vertices), 4);
    let count = vertices + 4 + wide;
    let fewer = word(&whole, count) - 1;
    whole[count..count + 4].copy_from_slice(&fewer.to_le_bytes());
    place.refuses("fewer.meshb", &whole, &["byte", "bytes follow that belong to nothing"]);
}

/// What is behind a damaged keyword is not read: that is told.
#[test]
fn damaged_keywords_of_gmf_are_told() {
    let place = Place::new();
    let gmf = text("hexpyrtet_p1.mesh");
    let told = place.notes("word.mesh", with(&gmf, "Tetrahedra", "Tetrahedro"));
    assert!(told.contains("the keyword Tetrahedro, which is not known, is not used"), "{told}");
    let told = place.notes("end.mesh", &gmf[..gmf.rfind("End").unwrap()]);
    assert!(told.contains("no keyword End"), "{told}");
    assert!(!place.notes("whole.mesh", gmf).contains("keyword"));
}

/// Numbers belong to the keyword before them; before the first there is none.
#[test]
fn numbers_before_the_first_keyword_of_gmf_are_refused() {
    let place = Place::new();
    let gmf = text("hexpyrtet_p1.mesh");
    let at = gmf.find("Dimension").unwrap();
    for spoilt in ["2\n", "0.5 7 ", "-1\n# a remark\n"] {
        let spoilt = [&gmf[..at], spoilt, &gmf[at..]].concat();
        place.refuses("before.mesh", spoilt, &["line", "a keyword (more numbers than announced"]);
    }
    let told = place.notes("remark.mesh", [&gmf[..at], "# 2 remarks\n", &gmf[at..]].concat());
    assert!(!told.contains("keyword"), "{told}");
    // Nobody reads what comments say, in whatever encoding.
    let (before, behind) = gmf.as_bytes().split_at(at);
    let latin1 = [&b"#\xe9t\xe9\n"[..], before, b"#\xe9t\xe9 2\n", behind].concat();
    assert_eq!(place.notes("latin1.mesh", latin1), told);
}
