#![allow(clippy::unwrap_used)]
//! What SU2's own solver reads, and what no solver could.

use std::io::Cursor;

use super::file::read;
use crate::element::{Cell, Order, lattice};
use crate::mesh::Mesh;

/// A cube, its lower side a marker of its own.
const CUBE: &str = "NDIME= 3\nNELEM= 1\n12 0 1 2 3 4 5 6 7 0\nNPOIN= 8\n0 0 0 0\n1 0 0 1\n1 1 0 2\n0 1 0 3\n0 0 1 4\n1 0 1 5\n1 1 1 6\n\
    0 1 1 7\nNMARK= 2\nMARKER_TAG= lower\nMARKER_ELEMS= 1\n9 0 1 2 3\nMARKER_TAG= rest\nMARKER_ELEMS= 2\n9 4 5 6 7\n9 0 1 5 4\n";

fn parsed(text: &str) -> Result<Mesh, String> {
    read(Cursor::new(text), text.len() as u64).map_err(|flaw| flaw.of("m.su2").to_string())
}

/// What is told of the cube where a piece of it is another.
fn told(from: &str, to: &str) -> String {
    assert!(CUBE.contains(from), "{from}");
    parsed(&CUBE.replacen(from, to, 1)).unwrap_err()
}

#[test]
fn sections_that_are_of_no_use_are_passed_over_and_told() {
    let more = "MARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 2\nSEND_TO= 1\n1 0 0\n1 1 0\n\
        NPERIODIC= 1\nPERIODIC_INDEX= 0\n0 0 0\n0 0 90\n0 0 0\nFFD_NBOX= 1\nFFD_TAG= BOX\nFFD_CORNER_POINTS= 2\n-1\t-1\t0\n2 -1 0\n";
    let mesh = parsed(&(CUBE.replacen("NMARK= 2", "NMARK= 3", 1) + more)).unwrap();
    assert_eq!(mesh.counts()[&Cell::Quad], 3);
    assert_eq!(mesh.notes().len(), 3, "{:?}", mesh.notes());
    for name in ["SEND_RECEIVE", "PERIODIC", "FFD"] {
        assert!(mesh.notes().iter().any(|note| note.contains(name)), "{name}: {:?}", mesh.notes());
    }
}

#[test]
fn zones_number_their_points_apart() {
    let zone = |n: usize| format!("IZONE= {n}\n{CUBE}");
    let both = format!("NZONE= 2\n{}{}", zone(1), zone(2).replace("lower", "other"));
    let mesh = parsed(&both).unwrap();
    assert_eq!((mesh.points().len(), mesh.cells().len(), mesh.sides().len()), (16, 2, 6));
    let second = mesh.cells().iter().nth(1).unwrap();
    assert!(second.nodes.iter().all(|node| node.index() >= 8));
    let names: Vec<&str> = mesh.physical_names().iter().map(|name| name.name.as_str()).collect();
    assert!(["lower", "other", "rest"].iter().all(|name| names.contains(name)), "{names:?}");
    let one = parsed(&format!("NZONE= 2\n{}", zone(1))).unwrap_err();
    let ahead = parsed(&format!("NDIME= 3\nNZONE= 2\n{}{}", zone(1), zone(2))).unwrap();
    assert_eq!(ahead.counts(), mesh.counts(), "the dimension may stand before the zones");
    assert!(one.contains("announces 2 zones, but has 1"), "{one}");
}

#[test]
fn elements_of_higher_order_have_their_nodes_row_by_row() {
    for p in 2..=4 {
        let order = Order::new(p).unwrap();
        let mut rows = lattice(Cell::Hex, order).to_vec();
        rows.sort_by_key(|&[i, j, k]| [k, j, i]);
        let all: Vec<String> = (0..rows.len()).map(|n| n.to_string()).collect();
        let points: String = rows.iter().map(|[i, j, k]| format!("{i} {j} {k}\n")).collect();
        let code = 100 * (p - 1) + 12;
        let head = format!("NDIME= 3\nNELEM= 1\n{code} {}\n", all.join(" "));
        let mesh = parsed(&format!("{head}NPOIN= {}\n{points}NMARK= 0\n", rows.len())).unwrap();
        assert_eq!(mesh.order(), order);
        let hex = mesh.cells().iter().next().unwrap();
        for (node, at) in hex.nodes.iter().zip(lattice(Cell::Hex, order)) {
            assert_eq!(mesh.points()[node.index()].to_array(), at.map(f64::from), "{order}");
        }
    }
}

#[test]
fn damage_is_told_with_its_line() {
    for (from, to, place, needle) in [
        ("NELEM= 1\n12 0 1 2 3 4 5 6 7 0", "NELEM= 2\n12 0 1 2 3 4 5 6 7 0\n10 0 1 2 4", "line 4", "0 numbers follow"),
        ("12 0 1 2 3 4 5 6 7 0", "9 0 1 2 3 0", "line 3", "a quad among the elements of NELEM"),
        ("12 0 1 2 3 4 5 6 7 0", "1 0 0", "line 3", "a point among the elements"),
        ("12 0 1 2 3 4 5 6 7 0", "12 0 1 2 3 4 5 6 9 0", "line 3", "refers to node 9"),
        ("12 0 1 2 3 4 5 6 7 0", "12 0 1 2 3 4 5 6.5 7 0", "line 3", "6.5"),
        ("9 0 1 2 3", "3 0 1", "line 16", "a line among the elements of MARKER_ELEMS"),
        ("9 0 1 5 4\n", "", "line 20", "ends inside"),
        ("1 1 0 2", "1 1 0.5 0 2 3", "line 7", "number too many"),
        ("1 1 0 2", "1 1 2", "line 7", "0 numbers follow"),
        ("NMARK= 2", "NMARK= 3", "line 21", "3 markers (NMARK), but has 2"),
        ("NMARK= 2", "NELEM= 0\nNMARK= 2", "line 13", "twice"),
        ("NDIME= 3\n", "", "line 1", "NELEM= must follow NDIME="),
    ] {
        let told = told(from, to);
        assert!(told.contains(place) && told.contains(needle), "{to:?}: {told}");
    }
    let fewer = CUBE.replacen("NMARK= 2", "NMARK= 1", 1);
    assert!(parsed(&fewer).unwrap().notes()[0].contains("announces 1 markers, and there are 2"));
}
