//! Versions and byte orders, node orders, and what is wrong or rare in files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;

use glam::DVec3;

use super::sink::Form;
use super::*;
use crate::element::lattice;
use crate::formats::error::Flaw;
use crate::mesh::{EntityKey, NodeId};

fn text(content: &str) -> Result<Mesh, Flaw> {
    Source::text(content.as_bytes(), content.len() as u64).and_then(read::mesh)
}

fn binary(content: &[u8]) -> Result<Mesh, Flaw> {
    Source::binary(content, content.len() as u64).and_then(read::mesh)
}

/// A binary file being put together, apart from the writer.
struct Bytes {
    version: u32,
    big: bool,
    content: Vec<u8>,
}

impl Bytes {
    fn new(version: u32, big: bool, dimension: u32) -> Bytes {
        let mut own = Bytes { version, big, content: Vec::new() };
        [1, version, 3].into_iter().for_each(|number| own.word(number));
        own.position(if version > 2 { 24 } else { 20 });
        own.word(dimension);
        own
    }

    fn put<const N: usize>(&mut self, mut little: [u8; N]) {
        if self.big {
            little.reverse();
        }
        self.content.extend(little);
    }

    fn word(&mut self, value: u32) {
        self.put(value.to_le_bytes());
    }

    fn position(&mut self, value: u64) {
        if self.version > 2 { self.put(value.to_le_bytes()) } else { self.word(value as u32) }
    }

    fn int(&mut self, value: i64) {
        if self.version > 3 { self.put(value.to_le_bytes()) } else { self.word(value as i32 as u32) }
    }

    fn real(&mut self, value: f64) {
        if self.version > 1 { self.put(value.to_le_bytes()) } else { self.put((value as f32).to_le_bytes()) }
    }

    /// A keyword with rows of reals and then whole numbers.
    fn section(mut self, code: u32, rows: &[(&[f64], &[i64])]) -> Bytes {
        let (int, real) = (if self.version > 3 { 8 } else { 4 }, if self.version > 1 { 8 } else { 4 });
        let content: usize = rows.iter().map(|(reals, ints)| reals.len() * real + ints.len() * int).sum();
        self.word(code);
        let head = if self.version > 2 { 8 } else { 4 } + int;
        self.position((self.content.len() + head + content) as u64);
        self.int(rows.len() as i64);
        for (reals, ints) in rows {
            reals.iter().for_each(|&x| self.real(x));
            ints.iter().for_each(|&n| self.int(n));
        }
        self
    }

    fn end(mut self) -> Vec<u8> {
        self.word(54);
        self.position(0);
        self.content
    }
}

/// A tet with a triangle on each of two entities, an edge, and keywords that nobody knows.
fn tet(version: u32, big: bool) -> Vec<u8> {
    let points: [(&[f64], &[i64]); 4] =
        [(&[0.0; 3], &[0]), (&[1.0, 0.0, 0.0], &[0]), (&[0.0, 1.0, 0.0], &[0]), (&[0.0, 0.0, 0.5], &[0])];
    Bytes::new(version, big, 3)
        .section(4, &points)
        .section(999, &[(&[1.0, 2.0], &[3])])
        .section(5, &[(&[], &[1, 2, 9])])
        .section(6, &[(&[], &[1, 3, 2, 7]), (&[], &[1, 2, 4, 8])])
        .section(14, &[(&[], &[1])])
        .section(8, &[(&[], &[1, 2, 3, 4, 0])])
        .end()
}

#[test]
fn all_versions_and_both_byte_orders_are_one_mesh() {
    let first = binary(&tet(1, false)).unwrap();
    let tags: Vec<(Cell, i32)> = first.blocks().iter().map(|block| (block.cell, block.entity.tag)).collect();
    assert_eq!(
        tags,
        [(Cell::Line, 9), (Cell::Triangle, 7), (Cell::Triangle, 8), (Cell::Tet, 1)],
        "reference 0 is none"
    );
    assert_eq!(first.points()[3], DVec3::new(0.0, 0.0, 0.5));
    assert_eq!(first.notes(), ["1 Ridges are not used", "the keyword 999, which is not known, is not used"]);
    for version in 1..=4 {
        for big in [false, true] {
            let content = tet(version, big);
            let head = |name| Head::new(Path::new(name), &content);
            assert_eq!((FORMAT.detect)(&head("tet.meshb")), Verdict::ByContent, "version {version}, big {big}");
            assert_eq!(binary(&content).unwrap(), first, "version {version}, big {big}");
        }
    }
}

#[test]
fn a_file_without_an_end_is_read_to_its_end() {
    for version in [2, 4] {
        let whole = tet(version, false);
        let end = whole.len() - if version > 2 { 12 } else { 8 };
        let (cut, whole) = (binary(&whole[..end]).unwrap(), binary(&whole).unwrap());
        assert_eq!((cut.points(), cut.blocks()), (whole.points(), whole.blocks()));
        assert!(cut.notes().iter().any(|note| note.contains("no keyword End")), "{:?}", cut.notes());
    }
}

#[test]
fn every_written_version_reads_back_bit_for_bit() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/samples/hexpyrtet_p2_msh41b_param.msh");
    let mesh = crate::formats::read(path.as_ref()).unwrap();
    let sections = write::sections(&mesh);
    let write = |mesh: &Mesh, version: u32| {
        let mut bytes = Vec::new();
        write::write_as(&mut bytes, mesh, &write::sections(mesh), Form::Bytes { version }).unwrap();
        bytes
    };
    assert!(sections.len() > 10);
    for version in 2..=4 {
        let bytes = write(&mesh, version);
        let again = binary(&bytes).unwrap();
        assert!(
            again
                .points()
                .iter()
                .zip(mesh.points())
                .all(|(a, b)| a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits))
        );
        assert_eq!(again.node_parameters(), mesh.node_parameters());
        assert_eq!(write(&again, version), bytes, "version {version}");
    }
}

/// The order of a single element's nodes is what its keyword says; without one, that of the internal lattice. Coordinates tell.
#[test]
fn nodes_lie_where_the_ordering_says() {
    for cell in keyword::cells() {
        for order in Order::all() {
            let nodes = lattice(cell, order);
            let p = order.get() as f64;
            // Lexicographic: corners do not come first.
            let mut sorted: Vec<[u8; 3]> = nodes.to_vec();
            sorted.sort_unstable();
            for (own, stated) in [(&sorted[..], true), (nodes, false)] {
                let mut file = format!("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", own.len());
                own.iter().for_each(|at| {
                    file += &format!("{} {} {} 0\n", f64::from(at[0]) / p, f64::from(at[1]) / p, f64::from(at[2]) / p)
                });
                let numbers: Vec<String> = (1..=own.len()).map(|n| n.to_string()).collect();
                let word = |keyword: keyword::Keyword| keyword.names().1;
                file += &format!("{}\n1\n{} 5\n", word(keyword::Keyword::Elements(cell, order)), numbers.join(" "));
                if stated {
                    file += &format!("{}\n{}\n", word(keyword::Keyword::Ordering(cell, order)), own.len());
                    for &at in own {
                        let row = node_order::row(cell, order, at);
                        file += &format!("{}\n", row.iter().map(u8::to_string).collect::<Vec<_>>().join(" "));
                    }
                }
                file += "End\n";
                let mesh = text(&file).unwrap_or_else(|flaw| panic!("{cell} {order}: {}", flaw.fault));
                let element = mesh.blocks()[0].elements(order).next().unwrap();
                for (node, at) in element.iter().zip(nodes) {
                    let expected = DVec3::from(at.map(f64::from)) / p;
                    assert_eq!(mesh.points()[node.index()], expected, "{cell} {order} {stated}");
                }
                assert_eq!(mesh.notes().len(), usize::from(!stated && order.get() > 2), "{:?}", mesh.notes());
            }
        }
    }
}

const TRIANGLES: &str = "MeshVersionFormatted 2 # made by hand\nDimension\n2\n# comment\nVertices 4\n0 0 0\n1 0 0\n1D0 1 0\n0 1 0\n\
     Identifier\n\"none\"\nTriangles\n2\n1 2 3 -1\n1 3 4 4\nEnd\nnothing behind it";

#[test]
fn a_plane_mesh_is_read_and_written_in_the_plane() {
    let mesh = text(TRIANGLES).unwrap();
    assert_eq!((mesh.dimension(), mesh.points()[2]), (2, DVec3::new(1.0, 1.0, 0.0)));
    let tags: Vec<i32> = mesh.blocks().iter().map(|block| block.entity.tag).collect();
    assert_eq!(tags, [5, 4], "a negative reference is the next free one");
    for version in 2..=4 {
        let mut bytes = Vec::new();
        write::write_as(&mut bytes, &mesh, &write::sections(&mesh), Form::Bytes { version }).unwrap();
        assert_eq!(u32::from(bytes[if version > 2 { 20 } else { 16 }]), 2, "its dimension");
        assert_eq!(binary(&bytes).unwrap().points(), mesh.points());
    }
}

#[test]
fn vertices_are_on_the_lowest_entity_that_the_elements_know() {
    let faces = "Edges\n1\n1 2 6\nTriangles\n2\n1 2 3 7\n1 2 4 8\nTetrahedra\n1\n1 2 3 4 0\n";
    let head = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
    let on = |edge: i32| {
        format!(
            "{head}{faces}VerticesOnGeometricVertices\n1\n1 3\nVerticesOnGeometricEdges\n2\n1 6 0.25 0\n2 {edge} 0.5 0\n\
             VerticesOnGeometricTriangles\n3\n2 7 1 2 0\n2 8 3 4 0\n3 7 5 6 0.1\nCorners\n2\n1\n2\nEnd\n"
        )
    };
    let mesh = text(&on(6)).unwrap();
    let key = |dimension, tag| Some(EntityKey::new(dimension, tag));
    assert_eq!(mesh.node_entities(), [key(0, 3), key(1, 6), key(2, 7), None]);
    let node = |n| NodeId::new(n).unwrap();
    assert_eq!(mesh.node_parameters(), [(node(1), [0.5, 0.0]), (node(2), [5.0, 6.0])]);
    let corners: Vec<_> = mesh.blocks().iter().filter(|block| block.cell == Cell::Point).collect();
    assert_eq!((corners.len(), corners[0].entity, &corners[0].nodes[..]), (1, EntityKey::new(0, 3), &[node(0)][..]));
    assert_eq!(mesh.notes(), ["1 Corners are not used, as no VerticesOnGeometricVertices numbers them"]);

    let foreign = text(&on(60)).unwrap();
    assert!(foreign.node_entities().iter().all(Option::is_none) && foreign.node_parameters().is_empty());
    let told = "6 VerticesOnGeometric* are not used: vertex 2 is on curve 60, which none of its elements refers to";
    assert_eq!(foreign.notes()[0], told);
}

#[test]
fn each_fault_is_told_with_its_place() {
    let with = |from: &str, to: &str| {
        assert!(TRIANGLES.contains(from), "{from:?} stands in the sound file");
        TRIANGLES.replacen(from, to, 1)
    };
    for (content, place, told) in [
        (with("Formatted 2", "Formatted 5"), "line 1", "GMF version 5 is not read"),
        (with("Dimension\n2", "Dimension\n4"), "line 3", "dimension 4 is not read"),
        (with("Dimension\n2\n", ""), "line 3", "Vertices come before Dimension"),
        (with("Vertices 4", "Vertices 400"), "line 5", "400 Vertices do not fit into"),
        (with("Vertices 4", "Vertices -4"), "line 5", "reading Vertices: \"-4\""),
        (with("Vertices 4", "Vertices 99999999999999999999"), "line 5", "reading Vertices"),
        (with("1D0 1 0\n", "1D0 nan 0\n"), "line", "node 3: a coordinate or parameter is not a finite number"),
        (with("1 2 3 -1", "1 2 3 X"), "line 14", "reading an element's reference: \"X\""),
        (with("1 2 3 -1", "1 2 5 0"), "line 14", "element 1 refers to node 5, but the nodes are numbered 1 to 4"),
        (with("1 2 3 -1", "1 2 0 0"), "line 14", "element 1 refers to node 0"),
        (with("1 2 3 -1", "1 2 3 4294967296"), "line 14", "reference 4294967296 is larger than 2147483647"),
        (with("1 3 4 4", "1 3 4 4 9"), "line 15", "expected a keyword (more numbers than announced"),
        (
            with("1 3 4 4\nEnd\nnothing behind it", "1 3                    "),
            "line 15",
            "the file ends inside a vertex' number",
        ),
        (
            with("End", "Triangles\n0\nTrianglesP2Ordering\n1\n1 1 1"),
            "line",
            "TrianglesP2Ordering is not an order of the element's 6 nodes",
        ),
        (with("End", "Polyhedra\n1\n1"), "line 16", "Polyhedra cannot be curved and are not read"),
        (with("End", "Vertices\n1\n0 0 0"), "line 16", "the keyword Vertices occurs twice"),
        ("MeshVersionFormatted 2\nDimension 3\nEnd\n".into(), "line", "the keyword Vertices is missing"),
        (
            "MeshVersionFormatted 2\nDimension 3\nTriangles\n1\n1 2 3 0\n".into(),
            "line 3",
            "Triangles come before Vertices",
        ),
    ] {
        let flaw = text(&content).map(|_| ()).unwrap_err();
        assert!(flaw.place.to_string().starts_with(place), "{content}: {}, {}", flaw.place, flaw.fault);
        assert!(flaw.fault.to_string().contains(told), "{content}: {}", flaw.fault);
    }
}

#[test]
fn binary_files_that_are_cut_off_or_run_backwards_are_refused() {
    for version in 1..=4 {
        let whole = tet(version, false);
        let end = if version > 2 { 12 } else { 8 };
        for length in (9..whole.len() - end).filter(|length| binary(&whole[..*length]).is_ok()) {
            // A cut between two keywords leaves a sound file, with fewer of them.
            let cut = Bytes { version, big: false, content: whole[..length].to_vec() }.end();
            assert!(binary(&cut).is_ok(), "version {version}, cut to {length} of {} bytes", whole.len());
        }
        let mut looped = whole.clone();
        let position = if version > 2 { 28 } else { 24 };
        looped[position..position + 4].copy_from_slice(&8_u32.to_le_bytes());
        let told = binary(&looped).map(|_| ()).unwrap_err().fault.to_string();
        assert!(told.contains("is at byte 8, which lies before it or beyond the file"), "{told}");
    }
}

#[test]
fn control_points_are_refused_where_elements_are_curved() {
    let head = "MeshVersionFormatted 2\nDimension 3\nBezierBasis\n1\nVertices\n3\n0 0 0 0\n1 0 0 0\n.5 .5 0 0\n";
    assert!(text(&format!("{head}Edges\n1\n1 2 1\n")).is_ok());
    let told = text(&format!("{head}EdgesP2\n1\n1 2 3 1\n")).map(|_| ()).unwrap_err().fault.to_string();
    assert!(told.contains("the vertices are control points"), "{told}");
}

#[test]
fn what_is_alike_but_no_gmf_is_told_apart() {
    let verdict = |content: &[u8]| (FORMAT.detect)(&Head::new(Path::new("grid.mesh"), content));
    assert_eq!(verdict(b"# by hand\n MeshVersionFormatted 1"), Verdict::ByContent);
    assert_eq!(verdict(b"MFEM mesh v1.0\n\ndimension\n3\n"), Verdict::No, "MFEM's is of another format");
    // A PLOT3D grid of one block of 2 x 3 x 20 points begins alike.
    let grid: Vec<u8> = [1_i32, 2, 3, 20].iter().flat_map(|n| n.to_le_bytes()).chain(0.5_f64.to_le_bytes()).collect();
    assert_eq!(verdict(&grid), Verdict::No);
    assert_eq!(verdict(b""), Verdict::No);
}
