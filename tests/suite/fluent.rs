//! Fluent's meshes as text: cells made from faces.

use std::fmt::Write as _;

use sagitta::element::Cell;
use sagitta::formats;
use sagitta::mesh::Mesh;

use crate::common::measure::measure;
use crate::common::sample::sample;
use crate::openfoam::{Case, content};

/// A case as a Fluent mesh: all numbers hexadecimal, from 1; the faces mixed or of one kind.
fn text(case: &Case, mixed: bool) -> String {
    let mut text = "(0 \"written by a test (with brackets\")\n(2 3)\n".to_owned();
    let cells = 1 + case.owner.iter().chain(&case.neighbour).max().unwrap();
    writeln!(text, "(10 (0 1 {0:x} 0 3))\n(10 (1 1 {0:x} 1 3)\n(", case.points.len()).unwrap();
    case.points.iter().for_each(|[x, y, z]| writeln!(text, "{x:?} {y:?} {z:?}").unwrap());
    writeln!(text, "))\n(12 (0 1 {cells:x} 0))\n(12 (2 1 {cells:x} 1 0)(").unwrap();
    (0..cells).for_each(|_| text += "2 ");
    text += "))\n";
    writeln!(text, "(13 (0 1 {:x} 0))", case.faces.len()).unwrap();
    let mut zones = vec![("interior".to_owned(), 0, case.neighbour.len())];
    zones.extend(case.patches.iter().cloned());
    for (zone, (_, first, count)) in zones.iter().enumerate() {
        let own = || *first..first + count;
        let same = own().all(|f| case.faces[f].len() == case.faces[*first].len());
        let kind = if mixed || !same { 0 } else { case.faces[*first].len() };
        let bc = if zone == 0 { 2 } else { 3 };
        writeln!(text, "(13 ({:x} {:x} {:x} {bc} {kind})(", zone + 10, first + 1, first + count).unwrap();
        for face in own() {
            if kind == 0 {
                write!(text, "{:x} ", case.faces[face].len()).unwrap();
            }
            // The normal points to the first cell.
            case.faces[face].iter().rev().for_each(|node| write!(text, "{:x} ", node + 1).unwrap());
            let other = case.neighbour.get(face).map_or(0, |own| own + 1);
            writeln!(text, "{:x} {other:x}", case.owner[face] + 1).unwrap();
        }
        text += "))\n";
    }
    text += "(45 (2 fluid air)())\n(39 (10 interior default-interior 1)())\n";
    for (zone, (name, ..)) in zones.iter().enumerate().skip(1) {
        writeln!(text, "(45 ({} wall {name})(\n(option . \"a ) in quotes\")))", zone + 10).unwrap();
    }
    text + "(37 (\n(case-config (rp-3d? . #t))))\n"
}

fn read(text: &str) -> Result<Mesh, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.msh");
    std::fs::write(&path, text).unwrap();
    formats::read(&path).map_err(|error| error.to_string())
}

#[test]
fn cells_are_made_from_faces() {
    for name in ["hexpyrtet_p1_msh41b.msh", "cylprism_p1_msh41b.msh"] {
        let mesh = sample(name);
        for mixed in [false, true] {
            let again = read(&text(&Case::of(&mesh), mixed)).unwrap();
            assert_eq!(content(&again), content(&mesh), "{name}");
            assert!((measure(&again).0 - measure(&mesh).0).abs() < 1e-13);
            assert!(again.notes().is_empty(), "{:?}", again.notes());
            let cell = again.cells().iter().next().unwrap().entity;
            assert_eq!(again.label(cell), "air");
            assert!(again.conditions().iter().all(|own| own.kind == "wall"));
        }
    }
}

/// A square of a quadrilateral and two triangles, its edges the faces.
#[test]
fn plane_meshes_are_read() {
    let text = "(2 2)\n(10 (1 1 6 1 2)(\n0 0\n1 0\n2 0\n2 1\n1 1\n0 1\n))\n(12 (2 1 3 1 0)(3 1 1))\n\
                (13 (3 1 2 2 2)(\n2 5 1 2\n2 4 2 3\n))\n\
                (13 (4 3 8 3 2)(\n1 2 1 0\n5 6 1 0\n6 1 1 0\n2 3 3 0\n3 4 3 0\n4 5 2 0\n))\n(45 (4 wall rim)())\n";
    let mesh = read(text).unwrap();
    let counts: Vec<(Cell, usize)> = mesh.counts().into_iter().collect();
    assert_eq!(counts, [(Cell::Line, 6), (Cell::Triangle, 2), (Cell::Quad, 1)]);
    let area: f64 = measure(&mesh).1.values().sum();
    assert!((area - 2.0).abs() < 1e-14);
    assert!(mesh.sides().iter().all(|side| mesh.label(side.entity) == "rim"));
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let whole = text(&Case::of(&sample("cylprism_p1_msh41b.msh")), false);
    let refused = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        let told = read(&whole.replacen(from, to, 1)).unwrap_err();
        assert!(told.contains("mesh.msh, line "), "{told}");
        told
    };
    assert!(refused("(2 3)", "(2 5)").contains("dimension 5"));
    assert!(refused("(10 (1 1 111", "(10 (1 1 112").contains("expected a coordinate, found \")\""));
    assert!(refused("(10 (1 1 111", "(10 (1 2 112").contains("node 1 is told of twice, or not at all"));
    assert!(refused("(10 (1 1 111", "(10 (1 1 ffffffff").contains("do not fit into the"));
    assert!(refused("(10 (1 1 111", "(10 (1 7fffffff 7fffffff").contains("do not fit into the"));
    assert!(refused("(10 (1 1 111 1 3)", "(2010 (1 1 111 1 3)").contains("section 2010 is binary"));
    assert!(refused("(12 (2 1 126", "(12 (2 1 7fffffff").contains("cells do not fit"));
    assert!(refused("(12 (2 1 126", "(12 (2 1 125").contains("names cell 294, and there are 293"));
    assert!(refused("(37 (", "(59 (").contains("hanging nodes"));
    assert!(refused("(45 (2 fluid", "(45 (x fluid").contains("the number of a zone"));
    assert!(read(&whole[..whole.len() / 2]).unwrap_err().contains("mesh.msh, line "));
    let mut case = Case::of(&sample("cylprism_p1_msh41b.msh"));
    case.faces.last_mut().unwrap().extend([7, 8]);
    assert!(read(&text(&case, true)).unwrap_err().contains("corners; a cell of such faces is a polyhedron"));
    // Two prisms as one.
    let mut case = Case::of(&sample("cylprism_p1_msh41b.msh"));
    let (kept, gone) = (case.owner.remove(0), case.neighbour.remove(0));
    case.faces.remove(0);
    case.owner.iter_mut().chain(&mut case.neighbour).filter(|own| **own == gone).for_each(|own| *own = kept);
    case.patches.iter_mut().for_each(|patch| patch.1 -= 1);
    let told = read(&text(&case, true)).unwrap_err();
    assert!(told.contains("none of the standard cells") && told.contains("near ("), "{told}");
}
