//! The constraint that keeps boundary nodes on their CAD groups while the mesh is smoothed.

use std::mem::discriminant;

use cad::{EntityId, Evaluation, Foot};
use glam::DVec3;
use rustc_hash::FxHashSet;

use super::tight::tight_nodes;
use crate::associate::Classification;
use crate::curve::level::Case;
use crate::curve::periodic::PeriodicConstraint;
use crate::curve::wall_state::Wall;
use crate::mesh::NodeId;
use crate::mesh::elevate::Elevated;
use crate::smooth::{Anchor, Constraint, Freedom, Image};

/// How far a wall node may slide before it costs as much as a badly shaped element; fraction of the edge or face that it lies in.
///
/// On the weeble free sliding gained 0.004 in min C_JAC and took the P3 wall 2.2 times as far from the CAD.
const SLIDE: f64 = 1e-3;
/// The same for a linear node; fraction of its shortest edge. All edges and faces around it follow, and with the fraction of the others the
/// weeble at P3 ended with C_JAC 0.73 in place of 0.80.
const SLIDE_LINEAR: f64 = 1e-4;
/// How far a released node may be from its place on the CAD before it costs as much; fraction of its displacement.
const LEAVE: f64 = 0.1;
/// How much farther than others the nodes at tight corners may slide.
const AT_TIGHT_CORNERS: f64 = 30.0;

/// Keeps boundary nodes on what they are classified on.
pub struct CadConstraint<'a> {
    case: Case<'a>,
    straight: &'a [DVec3],
    linear_nodes: usize,
    wall: &'a Wall,
    periodic: &'a PeriodicConstraint,
    held: FxHashSet<NodeId>,
    /// Nodes at tight corners.
    tight: FxHashSet<NodeId>,
}

impl<'a> CadConstraint<'a> {
    /// The constraint of a level.
    ///
    /// Nodes off the CAD are held. With [`Settings::freeze_linear`](crate::curve::Settings::freeze_linear) all linear nodes are held, with
    /// [`Settings::freeze_walls`](crate::curve::Settings::freeze_walls) nodes on curves and curved surfaces; nodes in planes move all the
    /// same. Nodes of periodic patches move as images of one another, and are held where their classifications are not of one kind.
    #[must_use]
    pub fn new(
        case: Case<'a>,
        elevated: &'a Elevated,
        wall: &'a Wall,
        periodic: &'a PeriodicConstraint,
    ) -> CadConstraint<'a> {
        let kind = |node: NodeId| {
            let classification = wall.classification(node.index());
            (discriminant(&classification), case.association.plane_of(classification).is_some())
        };
        let unlike = periodic.images().iter().filter(|image| kind(image.node) != kind(image.of));
        let held = unlike.flat_map(|image| [image.node, image.of]).collect();
        let (straight, linear_nodes) = (elevated.mesh.points(), elevated.linear_nodes);
        let tight = tight_nodes(case, elevated, wall);
        CadConstraint { case, straight, linear_nodes, wall, periodic, held, tight }
    }

    fn foot(&self, classification: Classification, x: DVec3) -> Option<Foot> {
        self.case.association.group_of(classification).and_then(|group| group.closest(x, None))
    }
}

impl CadConstraint<'_> {
    /// The freedom that what holds the node leaves it.
    fn held_by_cad(&self, node: NodeId, at: DVec3) -> Freedom {
        let (n, Case { settings, association, .. }) = (node.index(), self.case);
        let classification = self.wall.classification(n);
        let frozen = settings.freeze_linear && n < self.linear_nodes;
        if frozen || self.wall.fraction(n) < 1.0 || self.wall.is_held(n) || self.held.contains(&node) {
            return Freedom::Fixed;
        }
        if classification == Classification::Free || self.wall.is_released(n) {
            return Freedom::Space;
        }
        if let Some(plane) = association.plane_of(classification) {
            return Freedom::Plane(plane.normal);
        }
        if settings.freeze_walls {
            return Freedom::Fixed;
        }
        let (Some(foot), Some(group)) = (self.foot(classification, at), self.case.association.group_of(classification))
        else {
            return Freedom::Fixed;
        };
        // A foot on a rim has the parameters of the rim's own curve on its face, so that it has a normal as well.
        match group.evaluate_at(&foot) {
            Some(Evaluation::Surface(point)) if matches!(foot.entity, EntityId::Face(_)) => {
                point.normal.map_or(Freedom::Fixed, Freedom::Plane)
            }
            Some(Evaluation::Curve(point)) => point.tangent.map_or(Freedom::Fixed, Freedom::Line),
            _ => Freedom::Fixed,
        }
    }

    fn place_on_cad(&self, node: NodeId, from: DVec3, wish: DVec3) -> DVec3 {
        let classification = self.wall.classification(node.index());
        if self.wall.is_released(node.index()) {
            return wish;
        }
        if let Some(plane) = self.case.association.plane_of(classification) {
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
}

impl Constraint for CadConstraint<'_> {
    fn freedom(&self, node: NodeId, at: DVec3) -> Freedom {
        let own = self.held_by_cad(node, at);
        self.case.boundary.plane.map_or(own, |plane| own.within(plane.normal))
    }

    fn restrict(&self, node: NodeId, from: DVec3, wish: DVec3) -> DVec3 {
        let place = self.place_on_cad(node, from, wish);
        self.case.boundary.plane.map_or(place, |plane| plane.closest(place))
    }

    fn images(&self) -> &[Image] {
        self.periodic.images()
    }

    fn anchor(&self, node: NodeId) -> Option<Anchor> {
        let n = node.index();
        if self.wall.fraction(n) < 1.0 {
            return None;
        }
        let classification = self.wall.classification(n);
        self.case
            .association
            .group_of(classification)
            .filter(|_| self.case.association.plane_of(classification).is_none())?;
        let size = self.wall.size(n)?;
        let fraction = if n < self.linear_nodes { SLIDE_LINEAR } else { SLIDE };
        let mut slack = fraction * size;
        if self.tight.contains(&node) {
            slack *= AT_TIGHT_CORNERS;
        }
        let released = self.wall.is_released(n);
        if released {
            slack = slack.max(LEAVE * self.wall.displacement(n).length());
        }
        Some(Anchor { place: self.straight[n] + self.wall.displacement(n), slack, loosens: !released })
    }
}
