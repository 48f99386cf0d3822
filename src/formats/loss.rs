//! What files of a format do not hold of a mesh, told when there is something to lose.

use super::assembly::VOLUME_NAME;
use crate::element::Order;
use crate::mesh::{Mesh, Skin};

/// A kind of thing that a mesh may have and a file does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Loss {
    /// Elements below the sides of the cells: points, and in a volume mesh lines.
    Lower,
    /// Boundary elements that are no side of any cell.
    Strays,
    /// Numbers of nodes that are not their places.
    NodeNumbers,
    /// The order of the nodes of curved elements.
    NodeOrder,
    /// Nodes of no element.
    Isolated,
    /// Names of groups.
    Names,
    /// Names of groups of cells.
    CellGroups,
    /// Numbers of groups that are not those of their entities.
    GroupNumbers,
    /// Pairs of periodic entities.
    Periodic,
    /// Kinds of boundary conditions.
    Conditions,
    /// Parameters of nodes on their curves and surfaces.
    Parameters,
    /// Zones.
    Zones,
}

impl Loss {
    /// What is lost of a mesh, where there is something.
    pub(super) fn note(self, mesh: &Mesh) -> Option<String> {
        let count = match self {
            Loss::Lower => {
                let lower = mesh.blocks().iter().filter(|block| block.cell.dimension() + 2 <= mesh.dimension());
                lower.map(|block| block.tags.len()).sum()
            }
            Loss::Strays => Skin::of(mesh).strays.len(),
            Loss::NodeNumbers => mesh.node_tags().iter().zip(1..).filter(|&(&tag, place)| tag != place).count(),
            Loss::NodeOrder => usize::from(mesh.order() > Order::LINEAR),
            Loss::Isolated => Skin::isolated(mesh).len(),
            Loss::Names => mesh.physical_names().len(),
            Loss::CellGroups => {
                let own = mesh.physical_names().iter();
                own.filter(|own| usize::from(own.dimension) == mesh.dimension() && own.name != VOLUME_NAME).count()
            }
            Loss::GroupNumbers => {
                let other = |key| mesh.physical_tags_of(key).iter().any(|tag| *tag != key.tag);
                mesh.blocks().iter().filter(|block| other(block.entity)).count()
            }
            Loss::Periodic => mesh.periodic().len(),
            Loss::Conditions => mesh.conditions().len(),
            Loss::Parameters => mesh.node_parameters().len(),
            Loss::Zones => mesh.zones().len(),
        };
        (count > 0).then(|| self.told(count))
    }

    fn told(self, count: usize) -> String {
        match self {
            Loss::Lower => format!("{count} elements below the boundary (points, lines) have no place in the file"),
            Loss::Strays => format!("{count} boundary elements are no side of any cell and have no place in the file"),
            Loss::NodeNumbers => {
                format!("{count} nodes have other numbers in the file, which counts them in their order")
            }
            Loss::NodeOrder => "the nodes stand by vertex, edge, face and cell in the file".to_owned(),
            Loss::Isolated => format!("{count} nodes belong to no cell and have no place in the file"),
            Loss::Names => format!("the names of {count} groups have no place in the file"),
            Loss::CellGroups => format!("the names of {count} groups of cells have no place in the file"),
            Loss::GroupNumbers => "numbers of groups have no place in the file".to_owned(),
            Loss::Periodic => format!("{count} periodic pairs of entities have no place in the file"),
            Loss::Conditions => format!("the kinds of {count} boundary conditions have no place in the file"),
            Loss::Parameters => format!("the parameters of {count} nodes on the CAD have no place in the file"),
            Loss::Zones => format!("{count} zones become one"),
        }
    }
}
