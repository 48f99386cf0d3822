//! The search for the closest point of a group.
//!
//! 1. A first foot from the hint's leaf or, without one, the leaf of the nearest sample.
//! 2. Every leaf whose hull box is nearer than the best foot so far is visited: closed form, or Newton where the leaf's
//!    [certificate](crate::certificate) says that one start is enough, else the leaf is cut until it does.
//! 3. The winner is evaluated by OCCT on the original surface or curve, and its residual checked there.
//!
//! The foot on a trimmed face is a minimum inside the trim or a point of a boundary edge, and the edges are leaves of the same tree.

use crate::certificate::Certificate;
use crate::chart::{Jet, Rect, surface_d2};
use crate::closed_form;
use crate::curve::curve_d2;
use crate::foot::{End, Foot};
use crate::group::{Group, Member};
use crate::ids::{EdgeId, EntityId, FaceId, VertexId};
use crate::leaf::{EdgeGeometry, EdgeLeaf, FaceGeometry, FaceLeaf, Side};
use crate::newton::{self, Local, ROUNDING};
use crate::tolerance::{CUT_BUDGET, ORTHOGONAL, POINT, POLISH_LIMIT, TIE};
use glam::DVec3;

/// Golden section, and sections enough for rounding to end the search.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const GOLDEN_STEPS: usize = 60;

#[derive(Clone, Copy)]
struct Best {
    member: usize,
    parameters: [f64; 2],
    distance: f64,
}

struct Search<'a> {
    group: &'a Group,
    x: DVec3,
    best: Option<Best>,
    budget: usize,
    proven: bool,
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
            search.visit(seed, hint.filter(|_| hinted.is_some()).map(|foot| foot.parameters));
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
    fn tie(&self) -> f64 {
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
            Member::Vertex { vertex } => {
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

    /// The winner, evaluated by OCCT.
    fn finish(self) -> Foot {
        let Some(best) = self.best else { return self.nowhere() };
        let geometry = &self.group.geometry;
        match self.group.members[best.member] {
            Member::Face { face, leaf } => {
                let geometry = &geometry.faces[face as usize];
                let (parameters, jet) =
                    polish_surface(geometry, &geometry.leaves[leaf as usize], self.x, best.parameters);
                let end = self.end_on_face(geometry, &geometry.leaves[leaf as usize], parameters, &jet);
                let at_trim = matches!(end, End::Stalled { .. }) && geometry.leaves[leaf as usize].crossed;
                let slid = if at_trim { self.slide_to_trim(best, face as usize, jet[0]) } else { None };
                if let Some(foot) = slid {
                    return foot;
                }
                self.foot(best, FaceId::new(face as usize).into(), parameters, jet[0], end)
            }
            Member::Edge { edge, owner, .. } => self.finish_edge(best, edge as usize, owner.map(|face| face as usize)),
            Member::Vertex { vertex } => {
                let id = VertexId::new(vertex as usize);
                self.foot(best, id.into(), [0.0; 2], geometry.vertices[vertex as usize], End::OnEnd(id))
            }
        }
    }

    fn foot(&self, best: Best, entity: EntityId, parameters: [f64; 2], point: DVec3, end: End) -> Foot {
        let distance = point.distance(self.x);
        Foot { point, entity, parameters, distance, end, proven: self.proven, leaf: best.member as u32 }
    }

    fn nowhere(&self) -> Foot {
        let entity = self.group.entities()[0];
        let end = End::Stalled { residual: f64::INFINITY };
        Foot {
            point: DVec3::NAN,
            entity,
            parameters: [f64::NAN; 2],
            distance: f64::INFINITY,
            end,
            proven: false,
            leaf: 0,
        }
    }

    fn residual_limit(&self, distance: f64) -> f64 {
        ORTHOGONAL * (self.group.diagonal + distance)
    }

    fn end_on_face(&self, face: &FaceGeometry, leaf: &FaceLeaf, [u, v]: [f64; 2], jet: &Jet) -> End {
        let r = jet[0] - self.x;
        let residual = residual(jet, self.x);
        let at = |range: [f64; 2], t: f64| t <= range[0] || t >= range[1];
        if residual <= self.residual_limit(r.length()) {
            End::Interior
        } else if at(leaf.rect.u, u) || at(leaf.rect.v, v) || at(face.rect.u, u) || at(face.rect.v, v) {
            End::OnCrease
        } else {
            End::Stalled { residual }
        }
    }

    /// Where the curve of a boundary edge lies beside its pcurve on the surface (within the edge's tolerance), a point of the
    /// surface at the trim can be nearer than the curve. Finds the nearest point of the surface along the pcurve of the edge that is nearest to `near`.
    fn slide_to_trim(&self, best: Best, index: usize, near: DVec3) -> Option<Foot> {
        let geometry = &self.group.geometry;
        let face = &geometry.faces[index];
        let nearest = |side: &Side| {
            let edge = geometry.edges[side.edge?].as_ref()?;
            let on_leaf = |leaf: &EdgeLeaf| {
                newton::on_curve(&edge.curve, leaf.range, near, 0.5 * (leaf.range[0] + leaf.range[1]))
            };
            let local =
                edge.leaves.iter().map(on_leaf).min_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared))?;
            let fraction = (local.parameters[0] - edge.range[0]) / (edge.range[1] - edge.range[0]);
            Some((local.distance_squared, side.range[0] + fraction * (side.range[1] - side.range[0])))
        };
        let sides = face.sides.iter().filter_map(|side| Some((nearest(side)?, side)));
        let ((_, t), side) = sides.min_by(|a, b| a.0.0.total_cmp(&b.0.0))?;
        let parameters = side.nearest_on(face, self.x, t)?;
        let point = surface_d2(&face.handle, parameters[0], parameters[1])[0];
        let end = End::OnTrim(EdgeId::new(side.edge?));
        (point.distance(self.x) <= best.distance + self.tie())
            .then(|| self.foot(best, FaceId::new(index).into(), parameters, point, end))
    }

    fn finish_edge(&self, best: Best, index: usize, owner: Option<usize>) -> Foot {
        let geometry = &self.group.geometry;
        let id = EdgeId::new(index);
        let Some(edge) = &geometry.edges[index] else { return self.nowhere() };
        let (t, jet) = polish_curve(edge, self.x, best.parameters[0]);
        if let Some(face) = owner {
            let parameters = geometry.faces[face].parameters_on(index, edge.range, t, jet[0]);
            return self.foot(best, FaceId::new(face).into(), parameters, jet[0], End::OnTrim(id));
        }
        let r = jet[0] - self.x;
        let residual = tangential(r, jet[1]);
        let ends = geometry.ends[index];
        let end = if residual <= self.residual_limit(r.length()) {
            End::Interior
        } else if let (true, Some(start)) = (t <= edge.range[0], ends[0]) {
            End::OnEnd(start)
        } else if let (true, Some(end)) = (t >= edge.range[1], ends[1]) {
            End::OnEnd(end)
        } else {
            let at_knot = edge.leaves.iter().any(|leaf| leaf.range.contains(&t));
            if at_knot { End::OnCrease } else { End::Stalled { residual } }
        };
        self.foot(best, id.into(), [t, 0.0], jet[0], end)
    }
}

/// Length of the part of `r` along `d`; 0 where `d` vanishes.
fn tangential(r: DVec3, d: DVec3) -> f64 {
    let length = d.length();
    if length > 0.0 { (r.dot(d) / length).abs() } else { 0.0 }
}

/// Newton's last steps on OCCT's own surface, taken while they make the residual smaller.
fn polish_surface(face: &FaceGeometry, leaf: &FaceLeaf, x: DVec3, mut p: [f64; 2]) -> ([f64; 2], Jet) {
    let mut jet = surface_d2(&face.handle, p[0], p[1]);
    let inside = |t: f64, range: [f64; 2]| t > range[0] && t < range[1];
    for _ in 0..POLISH_LIMIT {
        if !(inside(p[0], leaf.rect.u) && inside(p[1], leaf.rect.v)) {
            break;
        }
        let next = leaf.rect.clamp(newton::surface_target(&jet, x, p));
        if next.iter().any(|t| !t.is_finite()) || (leaf.crossed && !face.trim.contains(next)) {
            break;
        }
        let polished = surface_d2(&face.handle, next[0], next[1]);
        let farther = polished[0].distance_squared(x) > jet[0].distance_squared(x) * ROUNDING;
        if farther || residual(&polished, x) >= residual(&jet, x) {
            break;
        }
        (p, jet) = (next, polished);
    }
    (p, jet)
}

/// Length of the larger tangential part of the line from `x`.
fn residual(jet: &Jet, x: DVec3) -> f64 {
    let r = jet[0] - x;
    tangential(r, jet[1]).max(tangential(r, jet[2]))
}

fn polish_curve(edge: &EdgeGeometry, x: DVec3, t: f64) -> (f64, [DVec3; 3]) {
    let jet = curve_d2(&edge.handle, t);
    let r = jet[0] - x;
    let next = (t - r.dot(jet[1]) / (jet[1].length_squared() + r.dot(jet[2]))).clamp(edge.range[0], edge.range[1]);
    let polished = curve_d2(&edge.handle, next);
    let s = polished[0] - x;
    let better = tangential(s, polished[1]) < tangential(r, jet[1]);
    if better && s.length_squared() <= r.length_squared() * ROUNDING { (next, polished) } else { (t, jet) }
}

impl Side {
    /// Parameters of the point of the surface along the pcurve that is nearest to `x`, by golden sections around `t`.
    fn nearest_on(&self, face: &FaceGeometry, x: DVec3, t: f64) -> Option<[f64; 2]> {
        let at = |t: f64| {
            let mut jet = [0.0; 4];
            self.pcurve.d1(t, &mut jet).ok().map(|()| [jet[0], jet[1]])
        };
        let distance = |t: f64| at(t).map_or(f64::INFINITY, |[u, v]| face.chart.d2(u, v)[0].distance_squared(x));
        let reach = 0.02 * (self.range[1] - self.range[0]);
        let (mut low, mut high) = ((t - reach).max(self.range[0]), (t + reach).min(self.range[1]));
        for _ in 0..GOLDEN_STEPS {
            let (a, b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
            if distance(a) <= distance(b) {
                high = b;
            } else {
                low = a;
            }
        }
        at(0.5 * (low + high))
    }
}

impl FaceGeometry {
    /// Parameters on the surface of the point of a boundary edge at `t`; of the two sides of a seam, the first.
    pub(crate) fn parameters_on(&self, edge: usize, range: [f64; 2], t: f64, point: DVec3) -> [f64; 2] {
        let sides = self.sides.iter().filter(|side| side.edge == Some(edge));
        let mut best = ([f64::NAN; 2], f64::INFINITY);
        for side in sides {
            let fraction = (t - range[0]) / (range[1] - range[0]);
            let along = side.range[0] + fraction * (side.range[1] - side.range[0]);
            let mut jet = [0.0; 4];
            if side.pcurve.d1(if side.range == range { t } else { along }, &mut jet).is_err() {
                continue;
            }
            let distance = self.chart.d2(jet[0], jet[1])[0].distance(point);
            if best.1.is_infinite() || distance < 0.5 * best.1 {
                best = ([jet[0], jet[1]], distance);
            }
        }
        best.0
    }
}
