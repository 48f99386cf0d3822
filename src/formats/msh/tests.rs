//! Content that is wrong, rare, or in the other byte order.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::io;

use super::sink::Sink;
use super::*;
use crate::formats::Place;
use crate::mesh::EntityKey;

const HEAD: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const NODES: &str = "$Nodes\n1 3 10 30\n2 7 0 3\n10\n30\n20\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";
const ELEMENTS: &str = "$Elements\n1 1 1 1\n2 7 2 1\n5 10 30 20\n$EndElements\n";

fn parse(content: &[u8]) -> Result<Mesh, Flaw> {
    read(content, content.len() as u64)
}

fn with(from: &str, to: &str) -> String {
    let whole = [HEAD, NODES, ELEMENTS].concat();
    assert!(whole.contains(from), "{from:?} stands in the sound file");
    whole.replacen(from, to, 1)
}

fn form(msh_version: Version, msh_encoding: Encoding) -> WriteOptions<'static> {
    WriteOptions { msh_version, msh_encoding, ..WriteOptions::default() }
}

#[test]
fn sparse_numbers_unknown_sections_and_odd_spacing_are_read() {
    let whole = [HEAD, NODES, ELEMENTS].concat();
    let mesh = parse(whole.as_bytes()).unwrap();
    assert_eq!(mesh.node_tags(), [10, 30, 20]);
    assert_eq!(mesh.node_entities(), [Some(EntityKey::new(2, 7)); 3]);
    assert_eq!(mesh.blocks()[0].tags, [5]);
    assert_eq!(mesh.blocks()[0].nodes.iter().map(|n| n.index()).collect::<Vec<_>>(), [0, 1, 2]);
    let odd =
        format!("$Comments\nby hand: $Nodes $En$EndComment\n$EndComments\n\n{whole}$NodeData\n1 2 3\n$EndNodeData");
    assert_eq!(parse(odd.replace('\n', "\r\n").as_bytes()).unwrap(), mesh);
    assert_eq!(parse(whole.trim_end().as_bytes()).unwrap(), mesh);
}

#[test]
fn each_fault_is_told_with_its_place() {
    let table: &[(&str, String, Place, &str)] = &[
        ("not Gmsh's", "$NOD\n3\n".into(), Place::Line(1), "MSH version 1 is not read"),
        ("4.0", with("4.1 0 8", "4 0 8"), Place::Line(2), "MSH version 4 is not read; save as version 4.1 or 2.2"),
        ("3", with("4.1 0 8", "3.0 0 8"), Place::Line(2), "MSH version 3.0 is not read"),
        ("header cut", "$MeshFormat\n4.1 0".into(), Place::Line(2), "expected version, 0 or 1, and data size"),
        ("data size", with("4.1 0 8", "4.1 0 4"), Place::Line(2), "data size 4"),
        ("byte order", with("4.1 0 8\n", "4.1 1 8\nabcd\n"), Place::Line(3), "byte-order mark is 0x64636261"),
        ("no nodes", HEAD.into(), Place::Line(4), "section $Nodes is missing"),
        ("no elements", [HEAD, NODES].concat(), Place::Line(14), "section $Elements is missing"),
        ("elements first", [HEAD, ELEMENTS].concat(), Place::Line(4), "section $Elements must follow $Nodes"),
        ("nodes twice", [HEAD, NODES, NODES].concat(), Place::Line(14), "section $Nodes occurs twice"),
        (
            "no marker",
            with("$Elements", "Elements"),
            Place::Line(14),
            "expected a section's name, as $Nodes, found \"Elements\"",
        ),
        (
            "wrong end",
            with("$EndNodes", "$EndNode"),
            Place::Line(13),
            "section $Nodes should end here, found \"$EndNode\"",
        ),
        ("end missing", with("$EndElements\n", ""), Place::Line(18), "the file ends inside a section's end"),
        (
            "unknown unended",
            [HEAD, "$Whatever\n1 2 3\n"].concat(),
            Place::Line(4),
            "the file ends inside a section that is not read",
        ),
        ("cut in nodes", with("0 1 0\n$EndNodes\n", "")[..60].into(), Place::Line(5), "nodes do not fit into"),
        (
            "huge nodes",
            with("1 3 10 30", "1 1000000000000000 1 2"),
            Place::Line(5),
            "1000000000000000 nodes do not fit into the",
        ),
        ("huge block", with("2 7 0 3\n", "2 7 0 18446744073709551615\n"), Place::Line(6), "nodes do not fit into the"),
        ("huge blocks", with("1 3 10 30", "99999999999 3 1 2"), Place::Line(5), "99999999999 node blocks do not fit"),
        (
            "huge elements",
            with("2 7 2 1\n", "2 7 2 4000000000\n"),
            Place::Line(16),
            "4000000000 elements do not fit into the",
        ),
        (
            "negative count",
            with("2 7 0 3\n", "2 7 0 -3\n"),
            Place::Line(6),
            "reading nodes: \"-3\" is not a valid number here",
        ),
        (
            "not a number",
            with("1 0 0\n", "1 O 0\n"),
            Place::Line(11),
            "reading a node's coordinates: \"O\" is not a valid number",
        ),
        ("not text", with("1 0 0\n", "1 \u{e4} 0\n"), Place::Line(11), "reading a node's coordinates"),
        ("NaN", with("1 0 0\n", "1 nan 0\n"), Place::Line(11), "node 30: a coordinate or parameter is not a finite"),
        (
            "infinite",
            with("1 0 0\n", "1 1e999 0\n"),
            Place::Line(11),
            "node 30: a coordinate or parameter is not a finite",
        ),
        ("repeated node", with("10\n30\n20\n", "10\n30\n30\n"), Place::Line(12), "node 30 occurs twice; renumber"),
        ("node 0", with("10\n30\n20\n", "0\n30\n20\n"), Place::Line(10), "node number 0"),
        ("fewer nodes", with("1 3 10 30", "1 4 10 30"), Place::Line(12), "the file announces 4 nodes, but has 3"),
        (
            "unknown node",
            with("5 10 30 20", "5 10 30 21"),
            Place::Line(17),
            "element 5 refers to node 21, which the file does not have",
        ),
        ("unknown type", with("2 7 2 1\n", "2 7 34 1\n"), Place::Line(16), "element type 34 is unknown"),
        (
            "serendipity",
            with("2 7 2 1\n", "2 7 16 1\n"),
            Place::Line(16),
            "element type 16 leaves out interior nodes (serendipity); write complete",
        ),
        ("order 5", with("2 7 2 1\n", "2 7 25 1\n"), Place::Line(16), "element type 25 is of order 5 or more"),
        ("dimension 4", with("2 7 2 1\n", "4 7 2 1\n"), Place::Line(16), "entity dimension 4 is outside 0 to 3"),
        ("wrong dimension", with("2 7 2 1\n", "3 7 2 1\n"), Place::Line(16), "elements of dimension 2 on volume 7"),
        (
            "more elements",
            with("1 1 1 1\n2 7", "1 2 1 1\n2 7"),
            Place::Line(17),
            "the file announces 2 elements, but has 1",
        ),
        (
            "mixed orders",
            with("1 1 1 1\n2 7 2 1\n5 10 30 20\n", "2 2 1 2\n2 7 2 1\n5 10 30 20\n1 3 8 1\n6 10 30 20\n"),
            Place::Line(18),
            "elements of P2 in a mesh of P1",
        ),
        (
            "name",
            with("$Nodes", "$PhysicalNames\n1\n2 1 wall\n$EndPhysicalNames\n$Nodes"),
            Place::Line(6),
            "quoted name",
        ),
        (
            "periodic",
            [HEAD, NODES, ELEMENTS, "$Periodic\n1\n2 7 8\n0\n1\n10 11\n$EndPeriodic\n"].concat(),
            Place::Line(24),
            "periodic entity 7 refers to node 11",
        ),
        (
            "4.1 section in 2.2",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Entities\n".into(),
            Place::Line(4),
            "a section of MSH 2.2",
        ),
        (
            "2.2 negative node",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n-1 0 0 0\n".into(),
            Place::Line(6),
            "reading a node number: \"-1\"",
        ),
        (
            "2.2 tags",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 15 -2 1 1\n".into(),
            Place::Line(10),
            "element tags do not fit into",
        ),
    ];
    for (name, content, place, message) in table {
        let flaw = parse(content.as_bytes()).expect_err(name);
        let told = flaw.fault.to_string();
        assert!(told.contains(message), "{name}: {told:?} does not say {message:?}");
        assert_eq!(flaw.place, *place, "{name}: {told}");
    }
}

#[test]
fn names_that_are_no_utf8_are_latin1() {
    let mut content = HEAD.as_bytes().to_vec();
    content.extend(b"$PhysicalNames\n1\n2 1 \"fl\xfcgel\"\n$EndPhysicalNames\n");
    content.extend([NODES, ELEMENTS].concat().as_bytes());
    assert_eq!(parse(&content).unwrap().physical_names()[0].name, "flügel");
}

#[test]
fn binary_that_was_cut_off_is_told_at_every_length() {
    let mesh = parse([HEAD, NODES, ELEMENTS].concat().as_bytes()).unwrap();
    let mut whole = Vec::new();
    write(&mut whole, &mesh, &form(Version::V4_1, Encoding::Binary)).unwrap();
    assert_eq!(parse(&whole).unwrap().points(), mesh.points());
    for length in 0..whole.len() - 1 {
        assert!(parse(&whole[..length]).is_err(), "cut to {length} of {}", whole.len());
    }
}

/// Numbers as bytes in the order that [`ByteSink`] does not write.
struct BigEndian<'a>(&'a mut Vec<u8>);

impl Sink for BigEndian<'_> {
    const BINARY: bool = true;
    type Memory<'b> = BigEndian<'b>;
    fn memory(bytes: &mut Vec<u8>) -> BigEndian<'_> {
        BigEndian(bytes)
    }
    fn encoded(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.extend(bytes);
        Ok(())
    }
    fn int(&mut self, value: i32) -> io::Result<()> {
        self.0.extend(value.to_be_bytes());
        Ok(())
    }
    fn size(&mut self, value: u64) -> io::Result<()> {
        self.0.extend(value.to_be_bytes());
        Ok(())
    }
    fn real(&mut self, value: f64) -> io::Result<()> {
        self.0.extend(value.to_be_bytes());
        Ok(())
    }
    fn end_line(&mut self) -> io::Result<()> {
        Ok(())
    }
    fn text(&mut self, text: &str) -> io::Result<()> {
        self.0.extend(text.as_bytes());
        Ok(())
    }
}

#[test]
fn both_byte_orders_are_read() {
    let mesh = parse([HEAD, NODES, ELEMENTS].concat().as_bytes()).unwrap();
    for (version, number) in [(Version::V4_1, "4.1"), (Version::V2_2, "2.2")] {
        let mut bytes = format!("$MeshFormat\n{number} 1 8\n\0\0\0\x01\n$EndMeshFormat\n").into_bytes();
        write_sections(&mut BigEndian(&mut bytes), &mesh, &form(version, Encoding::Binary)).unwrap();
        let again = parse(&bytes).unwrap();
        assert_eq!((again.points(), again.node_tags()), (mesh.points(), mesh.node_tags()), "{number}");
        assert_eq!(
            (&again.blocks()[0].nodes, &again.blocks()[0].tags),
            (&mesh.blocks()[0].nodes, &mesh.blocks()[0].tags)
        );
    }
}

const OLD: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n$EndNodes\n";

#[test]
fn an_element_in_several_groups_is_one_element() {
    // Element by element, as Gmsh writes; group by group, as others do.
    let by_element = "$Elements\n4\n1 2 2 8 5 1 2 3\n2 2 2 9 5 1 2 3\n3 2 2 8 5 2 4 3\n4 2 2 9 5 2 4 3\n$EndElements\n";
    let by_group = "$Elements\n4\n1 2 2 8 5 1 2 3\n3 2 2 8 5 2 4 3\n2 2 2 9 5 1 2 3\n4 2 2 9 5 2 4 3\n$EndElements\n";
    for elements in [by_element, by_group] {
        let mesh = parse([OLD, elements].concat().as_bytes()).unwrap();
        assert_eq!(mesh.blocks().len(), 1, "{elements}");
        assert_eq!((&mesh.blocks()[0].physical_tags[..], &mesh.blocks()[0].tags[..]), (&[8, 9][..], &[1, 3][..]));
        for version in [Version::V4_1, Version::V2_2] {
            let mut out = Vec::new();
            write(&mut out, &mesh, &form(version, Encoding::Ascii)).unwrap();
            let again = parse(&out).unwrap();
            assert_eq!(
                (&again.blocks()[0].nodes, &again.blocks()[0].tags),
                (&mesh.blocks()[0].nodes, &mesh.blocks()[0].tags)
            );
            let groups = match version {
                Version::V4_1 => &again.entities()[0].physical_tags,
                Version::V2_2 => &again.blocks()[0].physical_tags,
            };
            assert_eq!(groups, &[8, 9]);
        }
    }
}

#[test]
fn elements_of_one_entity_in_different_groups_get_entities_of_their_own() {
    let elements = "$Elements\n3\n1 2 2 8 5 1 2 3\n2 2 2 9 5 2 4 3\n3 1 2 0 0 1 2\n$EndElements\n";
    let mesh = parse([OLD, elements].concat().as_bytes()).unwrap();
    let mut out = Vec::new();
    write(&mut out, &mesh, &form(Version::V4_1, Encoding::Ascii)).unwrap();
    let again = parse(&out).unwrap();
    let entities: Vec<_> = again.entities().iter().map(|e| (e.key, &e.physical_tags[..])).collect();
    let key = EntityKey::new;
    assert_eq!(entities, [(key(1, 1), &[][..]), (key(2, 5), &[8]), (key(2, 6), &[9])]);
    assert_eq!(again.blocks().iter().map(|b| b.entity).collect::<Vec<_>>(), [key(2, 5), key(2, 6), key(1, 1)]);
    let nodes = [Some(key(1, 1)), Some(key(1, 1)), Some(key(2, 6)), Some(key(2, 6))];
    assert_eq!(again.node_entities(), nodes, "each node on the entity of lowest dimension");
}

#[test]
fn high_order_nodes_in_any_order_make_one_block_an_entity() {
    let mesh = parse([OLD, "$Elements\n1\n1 2 2 8 5 1 2 3\n$EndElements\n"].concat().as_bytes()).unwrap();
    let mut parts = mesh.into_parts();
    let (curve, surface) = (EntityKey::new(1, 1), EntityKey::new(2, 5));
    parts.points.truncate(3);
    parts.node_tags.truncate(3);
    parts.order = crate::element::Order::new(2).unwrap();
    parts.node_entities = vec![Some(curve), Some(curve), Some(surface), Some(surface), Some(curve), Some(surface)];
    for n in 3..6 {
        parts.points.push(parts.points[n - 3] + 0.5);
        parts.node_tags.push(n as u64 + 1);
        parts.blocks[0].nodes.push(crate::mesh::NodeId::new(n).unwrap());
    }
    let mesh = Mesh::new(parts).unwrap();
    let mut out = Vec::new();
    write(&mut out, &mesh, &form(Version::V4_1, Encoding::Ascii)).unwrap();
    let again = parse(&out).unwrap();
    assert_eq!(again.node_tags(), [1, 2, 3, 5, 4, 6]);
    assert!(String::from_utf8(out).unwrap().contains("\n$Nodes\n4 6 1 6\n"));
}

#[test]
fn version_2_2_refuses_numbers_beyond_its_own() {
    let mut parts = parse([HEAD, NODES, ELEMENTS].concat().as_bytes()).unwrap().into_parts();
    parts.node_tags[0] = 1 << 31;
    let mesh = Mesh::new(parts).unwrap();
    let refused = write(&mut Vec::new(), &mesh, &form(Version::V2_2, Encoding::Binary));
    assert!(matches!(refused, Err(Unwritten::Inexpressible(reason)) if reason.contains("write version 4.1")));
}
