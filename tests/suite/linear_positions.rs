//! The linear mesh that a curved one was made from is found whatever numbers its nodes have.

use crate::common::{fixture, sagitta};
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{Mesh, NodeId};

/// A curved mesh whose nodes were given other numbers, and one whose nodes stand in another order too, are judged against the linear mesh as
/// the one with its numbers is; another mesh of as many cells is refused.
#[test]
fn a_renumbered_mesh_is_held_against_its_linear_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let [curved, other] = ["curved.msh", "other.msh"].map(|name| folder.path().join(name));
    let [linear, cad] = ["msh", "step"].map(|extension| fixture("sphere_shell", extension));
    sagitta(args!["curve", linear, "--cad", cad, "--order", "2", "-q", "-o", curved]).expect(0);
    let judged = |mesh: &std::path::Path, code| sagitta(args!["check", mesh, "--linear", linear]).expect(code);
    let last = |text: &str| text.lines().last().unwrap().to_owned();
    let expected = last(&judged(&curved, 0).stdout);
    let write = |change: &dyn Fn(&mut sagitta::mesh::Parts)| {
        let mut parts = formats::read(&curved).unwrap().into_parts();
        change(&mut parts);
        formats::write(&other, &Mesh::new(parts).unwrap(), &WriteOptions::default()).unwrap();
    };
    write(&|parts| parts.node_tags.reverse());
    assert_eq!(last(&judged(&other, 0).stdout), expected);
    write(&|parts| {
        let count = parts.points.len();
        parts.points.reverse();
        parts.node_entities.reverse();
        parts.node_parameters.clear();
        let turned = |node: &mut NodeId| *node = NodeId::new(count - 1 - node.index()).unwrap();
        parts.blocks.iter_mut().flat_map(|block| &mut block.nodes).for_each(turned);
        parts.periodic.clear();
    });
    assert_eq!(last(&judged(&other, 0).stdout), expected);
    write(&|parts| {
        parts.node_tags.reverse();
        let cells = parts.blocks.iter_mut().find(|block| block.cell.dimension() == 3).unwrap();
        let stride = cells.cell.node_count(parts.order);
        cells.nodes.rotate_left(stride);
    });
    assert!(judged(&other, 2).stderr.contains("other corners"));
}
