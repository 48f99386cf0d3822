//! The search for the closest point of a group.
//!
//! 1. A first foot from the hint's leaf or, without one, the leaf of the nearest sample.
//! 2. Every leaf whose hull box is nearer than the best foot so far is visited: closed form, or Newton where the leaf's
//!    [certificate](crate::certificate) says that one start is enough, else the leaf is cut until it does.
//! 3. The winner is evaluated by OCCT on the original surface or curve, and its residual checked there.
//!
//! The foot on a trimmed face is a minimum inside the trim or a point of a boundary edge, and the edges are leaves of the same tree.

use crate::certificate::Certificate;
use crate::chart::Rect;
use crate::closed_form;
use crate::foot::Foot;
use crate::group::{Group, Member};
use crate::leaf::{EdgeGeometry, EdgeLeaf, FaceGeometry, FaceLeaf};
use crate::newton::{self, Local};
use crate::tolerance::{CUT_BUDGET, POINT, TIE};
use glam::DVec3;

/// The best foot so far.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    pub(crate) member: usize,
    pub(crate) parameters: [f64; 2],
    pub(crate) distance: f64,
}

/// One query under way.
pub(crate) struct Search<'a> {
    pub(crate) group: &'a Group,
    pub(crate) x: DVec3,
    pub(crate) best: Option<Best>,
    budget: usize,
    pub(crate) proven: bool,
    /// Leaves of faces that must be cut, with their first local minimum: they wait until the bound is as small as the others make it.
    deferred: Vec<(usize, Local)>,
}

impl Group {
    /// The closest point of the group to `x`, trims respected. `hint` is the foot of an earlier query to this group nearby: it
    /// makes the query faster, never wrong. A query point that is not finite gives a foot at infinite distance.
    pub fn closest(&self, x: DVec3, hint: Option<&Foot>) -> Foot {
        let mut search = Search { group: self, x, best: None, budget: CUT_BUDGET, proven: true, deferred: Vec::new() };
        let hinted = hint.map(|foot| foot.leaf as usize).filter(|&leaf| leaf < self.members.len());
        if x.is_finite() {
            let seed = hinted.unwrap_or_else(|| self.seed(x));
            let start = hint.filter(|_| hinted.is_some()).map(|foot| foot.parameters);
            search.visit(seed, start.filter(|p| p[0].is_finite() && p[1].is_finite()));
            self.boxes.visit(x, search.bound(), |leaf, bound| {
                if leaf != seed {
                    search.visit(leaf, None);
                    search.bound()
                } else {
                    bound
                }
            });
            search.cut_deferred();
        }
        search.finish()
    }
}

impl Search<'_> {
    pub(crate) fn tie(&self) -> f64 {
        TIE * self.group.diagonal
    }

    /// Squared distance beyond which a leaf cannot matter.
    fn bound(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |best| (best.distance + self.tie()).powi(2))
    }

    fn offer(&mut self, member: usize, local: Local) {
        let distance = local.distance_squared.sqrt();
        let better = |best: Best| {
            distance < best.distance - self.tie() || (distance <= best.distance + self.tie() && member < best.member)
        };
        if distance.is_finite() && self.best.is_none_or(better) {
            self.best = Some(Best { member, parameters: local.parameters, distance });
        }
    }

    fn visit(&mut self, index: usize, start: Option<[f64; 2]>) {
        let geometry = &self.group.geometry;
        match self.group.members[index] {
            Member::Face { face, leaf } => {
                let face = &geometry.faces[face as usize];
                self.visit_face(index, face, &face.leaves[leaf as usize], start);
            }
            Member::Edge { edge, leaf, .. } => {
                if let Some(edge) = &geometry.edges[edge as usize] {
                    self.visit_edge(index, edge, &edge.leaves[leaf as usize]);
                }
            }
            Member::Vertex { vertex, .. } => {
                let distance_squared = geometry.vertices[vertex as usize].distance_squared(self.x);
                self.offer(index, Local { parameters: [0.0; 2], distance_squared });
            }
        }
    }

    fn is_decided(&self, certificate: Option<&Certificate>) -> bool {
        certificate.is_some_and(|c| c.is_convex(self.x) || c.radius() < POINT * self.group.diagonal)
    }

    fn offer_on_face(&mut self, index: usize, face: &FaceGeometry, leaf: &FaceLeaf, local: Local) {
        if local.distance_squared <= self.bound() && (!leaf.crossed || face.trim.contains(local.parameters)) {
            self.offer(index, local);
        }
    }

    fn visit_face(&mut self, index: usize, face: &FaceGeometry, leaf: &FaceLeaf, start: Option<[f64; 2]>) {
        if leaf.slab.distance_squared(self.x) > self.bound() {
            return;
        }
        if let Some(local) = closed_form::nearest(&face.chart, &leaf.rect, self.x) {
            return self.offer_on_face(index, face, leaf, local);
        }
        self.proven &= leaf.sound;
        let local = newton::on_surface(&face.chart, &leaf.rect, self.x, start.unwrap_or(leaf.rect.center()));
        self.offer_on_face(index, face, leaf, local);
        if !self.is_decided(leaf.certificate.as_ref()) {
            self.deferred.push((index, local));
        }
    }

    fn cut_deferred(&mut self) {
        let group = self.group;
        for (index, local) in std::mem::take(&mut self.deferred) {
            let Member::Face { face, leaf } = group.members[index] else { continue };
            let face = &group.geometry.faces[face as usize];
            let leaf = &face.leaves[leaf as usize];
            if leaf.slab.distance_squared(self.x) <= self.bound() && !self.is_beyond(face, leaf.rect, local) {
                self.cut_face(index, face, leaf, local);
            }
        }
    }

    /// Whether no point of `rect` is nearer than the foot so far, or than its own `local` minimum: its hull is beyond a plane there.
    fn is_beyond(&self, face: &FaceGeometry, rect: Rect, local: Local) -> bool {
        let Some(best) = self.best else { return false };
        let p = face.chart.d2(local.parameters[0], local.parameters[1])[0];
        let gain = local.distance_squared.sqrt() - best.distance;
        face.chart.hull(rect).is_beyond(self.x, p, gain.max(0.0) + self.tie())
    }

    /// Cuts a leaf until each part is too far away, or has one minimum only, or is a point.
    fn cut_face(&mut self, index: usize, face: &FaceGeometry, leaf: &FaceLeaf, local: Local) {
        let mut parts = Vec::new();
        self.cut_part(face, leaf, local, &mut parts);
        while let Some(rect) = parts.pop() {
            let hull = face.chart.hull(rect);
            if hull.bounds().distance_squared(self.x) > self.bound() {
                continue;
            }
            let local = newton::on_surface(&face.chart, &rect, self.x, rect.center());
            self.offer_on_face(index, face, leaf, local);
            if self.is_beyond(face, rect, local) {
                continue;
            }
            let part = FaceLeaf::new(&face.chart, rect, leaf.crossed);
            let far = part.slab.distance_squared(self.x) > self.bound();
            if far || self.is_decided(part.certificate.as_ref()) || part.bounds.diagonal() < POINT * self.group.diagonal
            {
                continue;
            }
            if self.budget == 0 {
                self.proven = false;
                return;
            }
            self.budget -= 1;
            self.cut_part(face, &part, local, &mut parts);
        }
    }

    /// Pushes the parts of a leaf, nearest last: four around a foot inside, else two halves.
    fn cut_part(&self, face: &FaceGeometry, part: &FaceLeaf, local: Local, parts: &mut Vec<Rect>) {
        let ([u, v], [du, dv]) = (local.parameters, part.rect.size());
        let inside = |t: f64, range: [f64; 2], size: f64| t > range[0] + 0.01 * size && t < range[1] - 0.01 * size;
        if inside(u, part.rect.u, du) && inside(v, part.rect.v, dv) {
            parts.extend(part.rect.quarters([u, v]));
            return;
        }
        let distance = |rect: Rect| face.chart.hull(rect).bounds().distance_squared(self.x);
        let mut halves = part.rect.halves(part.direction(&face.chart)).map(|half| (distance(half), half));
        halves.sort_by(|a, b| b.0.total_cmp(&a.0));
        parts.extend(halves.map(|(_, half)| half));
    }

    fn visit_edge(&mut self, index: usize, edge: &EdgeGeometry, leaf: &EdgeLeaf) {
        if leaf.slab.distance_squared(self.x) > self.bound() {
            return;
        }
        self.proven &= leaf.sound;
        let mut parts: Vec<EdgeLeaf> = Vec::new();
        let mut next = Some(leaf.clone());
        while let Some(part) = next.take().or_else(|| parts.pop()) {
            if part.slab.distance_squared(self.x) > self.bound() {
                continue;
            }
            let [a, b] = part.range;
            self.offer(index, newton::on_curve(&edge.curve, part.range, self.x, 0.5 * (a + b)));
            if self.is_decided(part.certificate.as_ref()) || part.bounds.diagonal() < POINT * self.group.diagonal {
                continue;
            }
            if self.budget == 0 {
                self.proven = false;
                return;
            }
            self.budget -= 1;
            parts.extend(part.halves(&edge.curve));
        }
    }
}
