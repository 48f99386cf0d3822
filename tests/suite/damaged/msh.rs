//! Gmsh MSH: rows and lines, sections, the header.

use super::{Place, line_of, text, with};

#[test]
fn msh_rows_end_with_their_lines() {
    let place = Place::new();
    let (old, new) = (text("hexpyrtet_p1_msh22a.msh"), text("hexpyrtet_p1_msh41a.msh"));
    // An element of version 2.2 whose entity is missing would take the next line's number as its last node.
    let row = old.lines().find(|line| line.starts_with("6 2 2 ")).unwrap();
    let short: Vec<&str> = row.split(' ').enumerate().filter(|(n, _)| *n != 4).map(|(_, word)| word).collect();
    place.refuses(
        "lost.msh",
        with(&old, row, &short.join(" ")),
        &[&line_of(&old, row), "an element does not take one line"],
    );
    place.refuses("more.msh", with(&old, row, &format!("{row} 1")), &[&line_of(&old, row), "does not take one line"]);
    let node = old.lines().find(|line| line.starts_with("9 ")).unwrap();
    let cut = node.rsplit_once(' ').unwrap().0;
    place.refuses("node.msh", with(&old, node, cut), &[&line_of(&old, node), "a node does not take one line"]);
    let (head, elements) = new.split_at(new.find("$Elements").unwrap());
    let row = elements.lines().nth(3).unwrap().trim_end();
    let cut = row.rsplit_once(' ').unwrap().0;
    let spoilt = with(elements, &format!("\n{row}"), &format!("\n{cut}"));
    place.refuses("new.msh", format!("{head}{spoilt}"), &["an element does not take one line"]);
}

/// What is behind a damaged keyword is not read: that is told, or the file refused, where it is part of the mesh.
#[test]
fn damaged_words_of_msh_are_told() {
    let place = Place::new();
    let msh = text("hexpyrtet_p1_msh41a.msh");
    place.refuses("name.msh", with(&msh, "\"wall\"", "\"wall\" 1"), &["line 7", "quoted name"]);
    let row = msh.lines().skip_while(|line| *line != "$Entities").nth(2).unwrap();
    let spoilt = with(row, row.split(' ').nth(2).unwrap(), "nan");
    place.refuses("box.msh", with(&msh, row, &spoilt), &["an entity's box", "NaN"]);
    let renamed = with(&with(&msh, "$PhysicalNames", "$PhysicalName"), "$EndPhysicalNames", "$EndPhysicalName");
    let told = place.notes("section.msh", renamed);
    assert!(told.contains("a section $PhysicalName, which is not known, is not used"), "{told}");
}

#[test]
fn the_header_of_msh_has_three_words() {
    let place = Place::new();
    for sample in ["hexpyrtet_p1_msh22a.msh", "hexpyrtet_p1_msh41a.msh"] {
        let whole = text(sample);
        let header = whole.lines().nth(1).unwrap();
        let (version, rest) = header.split_once(' ').unwrap();
        for spoilt in [format!("{header} 1"), format!("{version} 1 {rest}"), version.to_owned(), format!("{version} 0")]
        {
            let needles = ["line 2", "version, 0 or 1, and data size", spoilt.as_str()];
            place.refuses("header.msh", with(&whole, header, &spoilt), &needles);
        }
        place.refuses("size.msh", with(&whole, header, &format!("{version} 0 4")), &["line 2", "4"]);
        place.refuses("version.msh", with(&whole, header, &format!("{version}1 0 8")), &["line 2", version]);
    }
}
