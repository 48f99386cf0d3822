//! VTU: counts, numbers, tags, and where arrays stand.

use super::{Place, sample, text, with};

#[test]
fn vtu_counts_are_compared() {
    let place = Place::new();
    let whole = text("hexpyrtet_p1_ascii.vtu");
    place.read("whole.vtu", &whole).unwrap();
    for (from, to, needle) in [
        ("NumberOfPoints=\"67\"", "NumberOfPoints=\"5\"", "announces 5 points of a piece, but has 67"),
        ("NumberOfCells=\"220\"", "NumberOfCells=\"221\"", "announces 221 cells of a piece, but has 220"),
        ("NumberOfCells=\"220\"", "NumberOfCells=\"many\"", "many"),
        ("</VTKFile>", "", "ends inside the XML"),
    ] {
        place.refuses("counts.vtu", with(&whole, from, to), &["byte", needle]);
    }
    // Spoils the first value of an array.
    let spoilt = |name: &str, change: &dyn Fn(&str) -> String| {
        let array = whole.find(&format!("Name=\"{name}\"")).unwrap();
        let start = array + whole[array..].find('>').unwrap() + 1;
        let end = start + whole[start..].find('<').unwrap();
        format!("{}{}{}", &whole[..start], change(whole[start..end].trim()), &whole[end..])
    };
    let first =
        |by: &'static str| move |values: &str| format!("{by} {}", values.split_once(char::is_whitespace).unwrap().1);
    for (name, by) in [("connectivity", "nan"), ("connectivity", "0.5"), ("connectivity", "1e300"), ("types", "-9.5")] {
        place.refuses("value.vtu", spoilt(name, &first(by)), &["value.vtu, byte", by]);
    }
    place.refuses("negative.vtu", spoilt("connectivity", &first("-1")), &["refers to node -1"]);
    place.refuses(
        "long.vtu",
        spoilt("connectivity", &|values| format!("{values} 1 2 3")),
        &["nodes of cells of a piece"],
    );
    // The place is the end of the piece.
    let short = spoilt("CellEntityIds", &|values| values.split_once(' ').unwrap().1.into());
    let end = format!("byte {}:", short.find("</Piece>").unwrap());
    place.refuses("short.vtu", short, &["CellEntityIds has 219", &end]);
    // Whole numbers as reals are whole numbers; other reals tell no patches apart.
    let same = place.read("real.vtu", spoilt("CellEntityIds", &|values| values.replace('1', "1.0"))).unwrap();
    assert_eq!(same.sides().iter().map(|side| side.entity).collect::<std::collections::BTreeSet<_>>().len(), 2);
    let unused = place.read("half.vtu", spoilt("CellEntityIds", &first("0.5"))).unwrap();
    assert!(unused.notes().iter().any(|note| note.contains("CellEntityIds is not used")), "{:?}", unused.notes());
    // What is empty within an array does not end it.
    let key = with(&whole, "Name=\"types\"", "Name=\"types\" info=\"1\"");
    let at = key.find("info=\"1\"").unwrap();
    let at = at + key[at..].find('>').unwrap() + 1;
    let keyed = format!("{}<InformationKey name=\"x\" location=\"y\"/>{}", &key[..at], &key[at..]);
    assert_eq!(
        place.read("keyed.vtu", keyed).unwrap().cells().len(),
        place.read("whole.vtu", &whole).unwrap().cells().len()
    );
}

/// What is behind a damaged tag is not read: the file is refused.
#[test]
fn damaged_tags_of_vtu_are_refused() {
    let place = Place::new();
    let vtu = text("hexpyrtet_p1_ascii.vtu");
    for (from, to, needle) in [
        (" NumberOfCells=\"220\"", "", "NumberOfCells"),
        (" NumberOfPoints=\"67\"", " Number", "XML is damaged"),
        // Which version it is decides on the order of a hex' nodes.
        ("version=\"1.0\"", "\"1.0\"", "XML is damaged"),
        ("version=\"1.0\"", "version=\"1.O\"", "expected version, as 2.2, found \"1.O\""),
        ("version=\"1.0\"", "version=\"\"", "expected version"),
        ("type=\"UnstructuredGrid\"", "kind=\"UnstructuredGrid\"", "expected type: UnstructuredGrid"),
        ("\"LittleEndian\"", "\"LittleEndiam\"", "expected byte_order: LittleEndian or BigEndian"),
        ("\"UInt64\"", "\"UInt46\"", "expected header_type: UInt32 or UInt64"),
        ("version=", "versi^n=", "\"versi^n\" is no attribute"),
        ("version=", "1version=", "\"1version\" is no attribute"),
        (" version=", "version=", "cannot be told apart"),
        ("<Points>", "<Points x=\"<\">", "XML is damaged"),
        ("<Points>", "<Points\u{1}>", "a character that no XML has"),
        ("<Points>", "<?xml version=\"1.0\"?><Points>", "a declaration that does not stand first"),
        ("<Points>", "<Points>&amp;", "a reference or CDATA"),
        ("<Points>", "<Points>0.5", "expected a tag, found \"0.5\""),
        ("</VTKFile>", "</VTKFile><VTKFile></VTKFile>", "behind the end"),
    ] {
        let at = vtu.find("<VTKFile").unwrap(); // the XML's own version stands before
        place.refuses("tag.vtu", [&vtu[..at], &with(&vtu[at..], from, to)].concat(), &["byte", needle]);
    }
    place.refuses("xml.vtu", with(&vtu, "version=\"1.0\"", "version=\"1_0\""), &["byte 0", "version \"1_0\""]);
    // What XML's text may not have may not stand in comments either, whose bytes nobody reads.
    let comment = |bytes: &[u8]| [vtu.as_bytes(), b"<!-- ", bytes, b" -->"].concat();
    place.read("comment.vtu", comment("café &c <x".as_bytes())).unwrap();
    for bytes in [&b"caf\xe9"[..], b"\0", b"\x1b"] {
        place.refuses("comment.vtu", comment(bytes), &["byte", "a character that no XML has"]);
    }
    // Numbers in references and CDATA would be lost.
    let end = vtu.find("</DataArray>").unwrap();
    for more in ["&#49;", "<![CDATA[ 1]]>"] {
        let spoilt = [&vtu[..end], more, &vtu[end..]].concat();
        place.refuses("lost.vtu", spoilt, &["byte", "a reference or CDATA"]);
    }
}

/// How bytes and nodes stand in a file is said by its outermost tag, which may leave out what does not matter.
#[test]
fn the_order_of_bytes_and_nodes_of_vtu_is_not_guessed() {
    let place = Place::new();
    let text = text("hexpyrtet_p1_ascii.vtu");
    let untold = with(&text, " byte_order=\"LittleEndian\"", "");
    place.read("text.vtu", with(&untold, "Grid\" version=\"1.0\"", "Grid\"")).unwrap();
    let without = |sample: &str, words: &str| {
        let whole = std::fs::read(super::sample(sample)).unwrap();
        let at = whole.windows(words.len()).position(|window| window == words.as_bytes()).unwrap();
        [&whole[..at], &whole[at + words.len()..]].concat()
    };
    let bytes = without("hexpyrtet_p1_app_raw.vtu", " byte_order=\"LittleEndian\"");
    place.refuses("order.vtu", bytes, &["byte", "does not say their order (byte_order of VTKFile)"]);
    place.refuses("version.vtu", without("hex_p3.vtu", " version=\"2.2\""), &["byte", "the file says none (version"]);
}

/// Text is told from bytes, and the place of appended arrays is known: neither is guessed.
#[test]
fn arrays_of_vtu_say_their_form_and_place() {
    let place = Place::new();
    let whole = text("hexpyrtet_p1_ascii.vtu");
    for array in ["CellEntityIds", "Points", "connectivity", "offsets", "types"] {
        let tag = &whole[whole.find(&format!("Name=\"{array}\"")).unwrap()..];
        let tag = &tag[..tag.find('>').unwrap()];
        for form in ["", "format=\"\"", "format=\"asci\"", "format=\"Appended\"", "formal=\"ascii\""] {
            let spoilt = with(&whole, tag, &with(tag, "format=\"ascii\"", form));
            place.refuses("form.vtu", spoilt, &["byte", "expected format: ascii, binary or appended"]);
        }
        // Text that is said to be base64 is none.
        place.refuses("inline.vtu", with(&whole, tag, &with(tag, "\"ascii\"", "\"binary\"")), &["byte"]);
    }
    let whole = std::fs::read(sample("hexpyrtet_p1_app_raw.vtu")).unwrap();
    let xml = whole.windows(13).position(|window| window == b"<AppendedData").unwrap();
    let (xml, appended) = (std::str::from_utf8(&whole[..xml]).unwrap(), &whole[xml..]);
    for (n, _) in xml.match_indices("offset=\"") {
        let number = &xml[n + 8..][..xml[n + 8..].find('"').unwrap()];
        for spoilt in ["", "-1", "0.5", "x", "99999999999999999999"] {
            let xml = format!("{}offset=\"{spoilt}\"{}", &xml[..n], &xml[n + 9 + number.len()..]);
            let spoilt = [xml.as_bytes(), appended].concat();
            place.refuses("offset.vtu", spoilt, &["byte", "reading an array's offset"]);
        }
        let lost = [&xml.as_bytes()[..n], &xml.as_bytes()[n + 9 + number.len()..], appended].concat();
        place.refuses("lost.vtu", lost, &["byte", "reading an array's offset"]);
        let beyond = format!("{}offset=\"{}\"{}", &xml[..n], appended.len(), &xml[n + 9 + number.len()..]);
        place.refuses("beyond.vtu", [beyond.as_bytes(), appended].concat(), &["byte", "ends inside an array"]);
    }
}
