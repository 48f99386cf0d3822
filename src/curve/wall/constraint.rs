//! The constraint that keeps boundary nodes on their CAD groups while the mesh is smoothed.

use std::mem::discriminant;

use cad::{EntityId, Evaluation, Foot};
use glam::DVec3;
use rustc_hash::FxHashSet;

use super::state::{Projected, group_of};
use crate::associate::{Association, Classification};
use crate::curve::periodic::PeriodicConstraint;
use crate::mesh::NodeId;
use crate::smooth::{Anchor, Constraint, Freedom, Image};

/// How far a wall node may slide before it costs as much as a badly shaped element: share of the edge or face that it lies in.
///
/// On the weeble free sliding gained 0.004 in min C_JAC and took the P3 wall 2.2 times as far from the CAD.
const SLIDE: f64 = 1e-3;
/// The same for a linear node: share of its shortest edge. All edges and faces around it follow, and with the share of the others the
/// weeble at P3 ended with C_JAC 0.73 in place of 0.80.
const SLIDE_LINEAR: f64 = 1e-4;

/// Keeps boundary nodes on their classifications.
pub struct CadConstraint<'a> {
    association: &'a Association,
    straight: &'a [DVec3],
    projected: &'a Projected,
    periodic: &'a PeriodicConstraint,
    held: FxHashSet<NodeId>,
    linear_nodes: usize,
    freeze_walls: bool,
    freeze_linear: bool,
}

impl<'a> CadConstraint<'a> {
    /// The constraint of the given classifications.
    ///
    /// With `freeze_linear` all linear nodes are held. With `freeze_walls` nodes on curves and curved surfaces are held; nodes
    /// in planes move all the same. Nodes of periodic patches move as images of one another, and are held where their classifications are not
    /// of one kind.
    #[must_use]
    pub fn new(
        association: &'a Association,
        straight: &'a [DVec3],
        projected: &'a Projected,
        periodic: &'a PeriodicConstraint,
        linear_nodes: usize,
        freeze_walls: bool,
        freeze_linear: bool,
    ) -> CadConstraint<'a> {
        let kind = |node: NodeId| {
            let classification = projected.classification(node.index());
            (discriminant(&classification), association.plane_of(classification).is_some())
        };
        let unlike = periodic.images().iter().filter(|image| kind(image.node) != kind(image.of));
        let held = unlike.flat_map(|image| [image.node, image.of]).collect();
        CadConstraint { association, straight, projected, periodic, held, linear_nodes, freeze_walls, freeze_linear }
    }

    fn foot(&self, classification: Classification, x: DVec3) -> Option<Foot> {
        group_of(self.association, classification).map(|group| group.closest(x, None))
    }
}

impl Constraint for CadConstraint<'_> {
    fn freedom(&self, node: NodeId, at: DVec3) -> Freedom {
        let classification = self.projected.classification(node.index());
        if self.freeze_linear && node.index() < self.linear_nodes {
            return Freedom::Fixed;
        }
        if self.held.contains(&node) {
            return Freedom::Fixed;
        }
        if classification == Classification::Free {
            return Freedom::Space;
        }
        if let Some(plane) = self.association.plane_of(classification) {
            return Freedom::Plane(plane.normal);
        }
        if self.freeze_walls {
            return Freedom::Fixed;
        }
        let (Some(foot), Some(group)) = (self.foot(classification, at), group_of(self.association, classification))
        else {
            return Freedom::Fixed;
        };
        // A foot on a rim has the parameters of the rim's own curve on its face, so that it has a normal as well.
        match group.evaluate(foot.entity, foot.parameters) {
            Some(Evaluation::Surface(point)) if matches!(foot.entity, EntityId::Face(_)) => {
                point.normal.map_or(Freedom::Fixed, Freedom::Plane)
            }
            Some(Evaluation::Curve(point)) => point.tangent.map_or(Freedom::Fixed, Freedom::Line),
            _ => Freedom::Fixed,
        }
    }

    fn restrict(&self, node: NodeId, from: DVec3, wish: DVec3) -> DVec3 {
        let classification = self.projected.classification(node.index());
        if let Some(plane) = self.association.plane_of(classification) {
            return plane.closest(wish);
        }
        match classification {
            Classification::Surface(_) | Classification::Curve(_) => {
                self.foot(classification, wish).map_or(from, |foot| foot.point)
            }
            Classification::Free => wish,
            Classification::Plane(_) | Classification::Vertex(_) | Classification::Straight => from,
        }
    }

    fn images(&self) -> &[Image] {
        self.periodic.images()
    }

    fn anchor(&self, node: NodeId) -> Option<Anchor> {
        let n = node.index();
        let classification = self.projected.classification(n);
        group_of(self.association, classification).filter(|_| self.association.plane_of(classification).is_none())?;
        let size = self.projected.sizes.get(&n)?;
        let share = if n < self.linear_nodes { SLIDE_LINEAR } else { SLIDE };
        Some(Anchor { place: self.straight[n] + self.projected.displacement[n], slack: share * size })
    }
}
