//! The search for the closest point of a group.
//!
//! 1. A first foot from the hint's leaf or, without one, the leaf of the nearest sample. With a hint the search may end here: its
//!    [leeways](crate::closest::hint) tell which few other leaves can matter.
//! 2. Every leaf whose hull box is nearer than the best foot so far is visited: closed form, or Newton where the leaf's
//!    [certificate](crate::geometry::certificate) says that one start is enough (given up as soon as convexity tells that the leaf is too
//!    far away), else the leaf is cut until it does.
//! 3. The winner is evaluated by OCCT on the original surface or curve, and its residual checked there.
//!
//! The foot on a trimmed face is a minimum inside the trim or a point of a boundary edge, and the edges are leaves of the same tree.

use crate::boxes::{Branch, Met};
use crate::closest::foot::{Doubt, Foot};
use crate::closest::group::{Group, Member};
use crate::closest::hint::{Floors, Hint, Leeways};
use crate::geometry::certificate::{Bowl, Certificate};
use crate::geometry::chart::{Jet, Rect};
use crate::geometry::closed_form;
use crate::geometry::curve::Hull;
use crate::geometry::leaf::{EdgeGeometry, EdgeLeaf, FaceGeometry, FaceLeaf};
use crate::geometry::newton::{self, Found, Local};
use crate::geometry::slab::Slab;
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
    /// The best foot on an edge or vertex.
    pub(crate) rim: Option<Best>,
    /// Minima on surfaces that are outside the trim, as long as they are nearer than the best foot.
    pub(crate) outside: Vec<Best>,
    budget: usize,
    pub(crate) doubt: Option<Doubt>,
    /// How far all is at least that was not visited, or was and did not win; for hints.
    pub(crate) floors: Option<&'a mut Floors>,
    /// Leeways of what a hint spared.
    pub(crate) spared: Leeways,
    /// Leaves of faces that must be cut, with their first local minimum: they wait until the bound is as small as the others make it.
    deferred: Vec<(usize, Local)>,
}

impl Group {
    /// The closest point of the group to `x`, trims respected. `None` where `x` is not finite, or so far away that its squared distance is
    /// not, and where OCCT cannot evaluate the point.
    ///
    /// Who asks again and again for a point that moves little passes the same `hint` each time: it makes queries faster, never wrong,
    /// and the first one a little slower.
    pub fn closest(&self, x: DVec3, hint: Option<&mut Hint>) -> Option<Foot> {
        if let Some(hint) = hint {
            return self.closest_from(x, hint);
        }
        let mut search = Search::new(self, x);
        search.visit_all(self.seed(x));
        search.finish().map(|landing| landing.foot)
    }

    /// Distance of `x` from its closest point; infinite where [`Group::closest`] gives none.
    pub fn distance(&self, x: DVec3) -> f64 {
        self.closest(x, None).map_or(f64::INFINITY, |foot| foot.distance)
    }

    fn closest_from(&self, x: DVec3, hint: &mut Hint) -> Option<Foot> {
        let mut floors = Floors::new();
        let mut search = Search { floors: Some(&mut floors), ..Search::new(self, x) };
        if hint.group == self.number {
            search.visit_from(hint);
        } else {
            search.visit_all(self.seed(x));
        }
        let landing = search.finish();
        *hint = landing.as_ref().map_or_else(Hint::default, |landing| search.hint(landing));
        landing.map(|landing| landing.foot)
    }

    /// The foot that Newton's method finds on the whole face or edge from the nearest sample: what a search without proof gives, for
    /// benchmarks. Where the group is trimmed, its answer may lie outside.
    #[doc(hidden)]
    pub fn closest_without_proof(&self, x: DVec3) -> Option<Foot> {
        let mut search = Search { doubt: Some(Doubt::NotSearched), ..Search::new(self, x) };
        let seed = self.seed(x);
        match self.members[seed] {
            Member::Face { face, leaf } => {
                let face = &self.geometry.faces[face as usize];
                let start = face.leaves[leaf as usize].rect.center();
                search.offer(seed, newton::on_surface(&face.chart, &face.rect, x, start));
            }
            _ => search.visit(seed, None),
        }
        search.finish().map(|landing| landing.foot)
    }
}

impl<'a> Search<'a> {
    fn new(group: &'a Group, x: DVec3) -> Self {
        Self {
            group,
            x,
            best: None,
            rim: None,
            outside: Vec::new(),
            budget: CUT_BUDGET,
            doubt: None,
            floors: None,
            spared: Leeways::FREE,
            deferred: Vec::new(),
        }
    }

    pub(crate) fn tie(&self) -> f64 {
        TIE * self.group.diagonal
    }

    /// Squared distance beyond which a leaf cannot matter.
    fn bound(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |best| (best.distance + self.tie()).powi(2))
    }

    /// Visits the leaf whose sample is nearest, then all others that may be nearer.
    fn visit_all(&mut self, seed: usize) {
        if self.x.is_finite() {
            self.visit(seed, None);
            self.visit_below(0, seed);
            self.cut_deferred();
        }
    }

    /// Visits the leaf of an earlier foot, and what may be nearer.
    fn visit_from(&mut self, hint: &Hint) {
        if !self.x.is_finite() {
            return;
        }
        let leaf = hint.leaf as usize;
        self.visit(leaf, Some(hint.follow(self.x)));
        if hint.moved(self.x) < hint.leeways.rest {
            self.visit_rivals(hint);
        } else {
            self.visit_below(0, leaf);
        }
        self.cut_deferred();
        if self.has_lost(leaf) {
            self.spared = Leeways::FREE;
            self.visit_below(0, leaf);
            self.cut_deferred();
        }
    }

    /// Whether a leaf that held a foot has a nearer minimum outside the trim than the best foot: then the old foot may be the nearer one, and what is
    /// farther than that still matter.
    fn has_lost(&self, leaf: usize) -> bool {
        let lost =
            |best: Best| self.outside.iter().any(|o| o.member == leaf && o.distance < best.distance - self.tie());
        self.best.is_none_or(lost)
    }

    fn visit_rivals(&mut self, hint: &Hint) {
        let moved = hint.moved(self.x);
        self.spared.rest = self.spared.rest.min(hint.leeways.rest - moved);
        for rival in hint.leeways.rivals() {
            let left = f64::from(rival.leeway) - moved;
            match rival.branch.split() {
                _ if left > 0.0 => self.spared.push(rival.branch, left),
                Ok(leaf) => self.visit(leaf, None),
                Err(node) => self.visit_below(node, hint.leaf as usize),
            }
        }
    }

    /// Visits all leaves below a node of the tree that may be near enough, but the one that has been visited.
    fn visit_below(&mut self, node: usize, seed: usize) {
        let group = self.group;
        group.boxes.walk(node, self.x, self.bound(), |met| {
            match met {
                Met::Leaf(leaf) if leaf != seed => self.visit(leaf, None),
                Met::Leaf(_) => {}
                Met::Skipped(branch, distance_squared) => self.keeps_off(branch, distance_squared),
            }
            self.bound()
        });
    }

    /// No point of a part is nearer than this squared distance.
    #[inline]
    fn keeps_off(&mut self, branch: Branch, distance_squared: f64) {
        if let Some(floors) = &mut self.floors {
            floors.push(branch, distance_squared);
        }
    }

    fn stays_off(&mut self, member: usize, distance_squared: f64) {
        self.keeps_off(Branch::leaf(member), distance_squared);
    }

    /// A local minimum at which the foot may lie.
    fn offer(&mut self, member: usize, local: Local) {
        let distance = local.distance_squared.sqrt();
        let tie = self.tie();
        let better =
            |best: Best| distance < best.distance - tie || (distance <= best.distance + tie && member < best.member);
        let found = Best { member, parameters: local.parameters, distance };
        if !matches!(self.group.members[member], Member::Face { .. }) && self.rim.is_none_or(better) {
            self.rim = Some(found);
        }
        if !distance.is_finite() {
            self.spared = Leeways::NONE;
        } else if self.best.is_none_or(better) {
            if let Some(beaten) = self.best {
                self.stays_off(beaten.member, beaten.distance * beaten.distance);
            }
            self.best = Some(found);
            if let Some(floors) = &mut self.floors {
                floors.closest_within(distance, self.group.leaf_size);
            }
        } else {
            self.stays_off(member, local.distance_squared);
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
                    self.visit_edge(index, edge, &edge.leaves[leaf as usize], start.map(|p| p[0]));
                }
            }
            Member::Vertex { vertex, .. } => {
                let distance_squared = geometry.vertices[vertex as usize].0.distance_squared(self.x);
                self.offer(index, Local { parameters: [0.0; 2], distance_squared });
            }
        }
    }

    fn offer_on_face(&mut self, index: usize, face: &FaceGeometry, leaf: &FaceLeaf, local: Local) {
        let near = local.distance_squared <= self.bound();
        if near && (!leaf.crossed || face.trim.contains(local.parameters)) {
            return self.offer(index, local);
        }
        self.stays_off(index, local.distance_squared);
        if near {
            let distance = local.distance_squared.sqrt();
            self.outside.push(Best { member: index, parameters: local.parameters, distance });
        }
    }

    /// Whether an oriented box is too far away to matter.
    fn is_far(&mut self, index: usize, slab: &Slab) -> bool {
        let distance_squared = slab.distance_squared(self.x);
        let far = distance_squared > self.bound();
        if far {
            self.stays_off(index, distance_squared);
        }
        far
    }

    fn visit_face(&mut self, index: usize, face: &FaceGeometry, leaf: &FaceLeaf, start: Option<[f64; 2]>) {
        if self.is_far(index, &leaf.slab) {
            return;
        }
        if let Some(local) = closed_form::nearest(&face.chart, &leaf.rect, self.x) {
            return self.offer_on_face(index, face, leaf, local);
        }
        self.doubt = self.doubt.max((!leaf.sound).then_some(Doubt::SampledHull));
        let start = start.filter(|p| p[0].is_finite() && p[1].is_finite()).map(|p| leaf.rect.clamp(p));
        if let Some(certificate) = &leaf.certificate {
            let modulus = certificate.modulus(self.x);
            if modulus > 0.0 || certificate.radius() < POINT * self.group.diagonal {
                let from = match start {
                    Some(p) => (p, face.chart.d2_within(&leaf.rect, p)),
                    None => (leaf.rect.center(), *certificate.jet()),
                };
                let bowl = (modulus > 0.0).then(|| certificate.bowl(modulus));
                return self.descend(index, face, leaf, &leaf.rect, from, bowl);
            }
        }
        let local = newton::on_surface(&face.chart, &leaf.rect, self.x, start.unwrap_or(leaf.rect.center()));
        self.offer_on_face(index, face, leaf, local);
        self.deferred.push((index, local));
    }

    /// Newton over a part with one minimum, as long as that may be nearer than the best foot.
    fn descend(
        &mut self,
        index: usize,
        face: &FaceGeometry,
        leaf: &FaceLeaf,
        rect: &Rect,
        (p, jet): ([f64; 2], Jet),
        bowl: Option<Bowl>,
    ) {
        let x = self.x;
        let floor = |p: [f64; 2], jet: &Jet| bowl.map_or(0.0, |bowl| bowl.floor(rect, p, jet, x));
        match newton::from_jet(&face.chart, rect, x, p, jet, self.bound(), floor) {
            Found::Minimum(local) => self.offer_on_face(index, face, leaf, local),
            Found::TooFar(floor) => self.stays_off(index, floor),
        }
    }

    fn cut_deferred(&mut self) {
        let group = self.group;
        for (index, local) in std::mem::take(&mut self.deferred) {
            let Member::Face { face, leaf } = group.members[index] else { continue };
            let face = &group.geometry.faces[face as usize];
            let leaf = &face.leaves[leaf as usize];
            if self.is_far(index, &leaf.slab) {
                continue;
            }
            let center = leaf.certificate.as_ref().map(|certificate| *certificate.jet());
            if center.is_some_and(|center| Bowl::over(&face.chart, &leaf.rect, self.x, &center).is_some()) {
                continue;
            }
            let p = face.chart.d2(local.parameters[0], local.parameters[1])[0];
            if !self.is_beyond(index, &face.chart.hull(leaf.rect), p, local) {
                self.cut_face(index, face, leaf, local);
            }
        }
    }

    /// Whether no point of a hull is nearer than the foot so far, or than its own `local` minimum at `p`: it is beyond a plane there.
    fn is_beyond(&mut self, index: usize, hull: &Hull, p: DVec3, local: Local) -> bool {
        let Some(best) = self.best else { return false };
        let floor = hull.distance_towards(self.x, p);
        let beyond = floor >= best.distance.min(local.distance_squared.sqrt()) - self.tie();
        if beyond {
            self.stays_off(index, floor.max(0.0).powi(2));
        }
        beyond
    }

    /// Cuts a leaf until each part is too far away, or has one minimum only, or is a point.
    fn cut_face(&mut self, index: usize, face: &FaceGeometry, leaf: &FaceLeaf, local: Local) {
        let mut parts = Vec::new();
        self.cut_part(face, &leaf.rect, local, &mut parts);
        while let Some(rect) = parts.pop() {
            let hull = face.chart.hull(rect);
            let bounds = hull.bounds();
            let distance_squared = bounds.distance_squared(self.x);
            if distance_squared > self.bound() {
                self.stays_off(index, distance_squared);
                continue;
            }
            let center = face.chart.d2_within(&rect, rect.center());
            if self.is_far(index, &Slab::new(&hull, center[1], center[2])) {
                continue;
            }
            if let Some(bowl) = Bowl::over(&face.chart, &rect, self.x, &center) {
                self.descend(index, face, leaf, &rect, (rect.center(), center), Some(bowl));
                continue;
            }
            let local = newton::on_surface(&face.chart, &rect, self.x, rect.center());
            self.offer_on_face(index, face, leaf, local);
            let p = face.chart.d2_within(&rect, local.parameters)[0];
            if self.is_beyond(index, &hull, p, local) {
                continue;
            }
            if bounds.diagonal() < POINT * self.group.diagonal {
                self.stays_off(index, distance_squared);
                continue;
            }
            if self.budget == 0 {
                self.doubt = self.doubt.max(Some(Doubt::Budget));
                return;
            }
            self.budget -= 1;
            self.cut_part(face, &rect, local, &mut parts);
        }
    }

    /// Pushes the parts of a leaf, nearest last: four around a foot inside, else two halves.
    fn cut_part(&self, face: &FaceGeometry, part: &Rect, local: Local, parts: &mut Vec<Rect>) {
        let ([u, v], [du, dv]) = (local.parameters, part.size());
        let inside = |t: f64, range: [f64; 2], size: f64| t > range[0] + 0.01 * size && t < range[1] - 0.01 * size;
        if inside(u, part.u, du) && inside(v, part.v, dv) {
            parts.extend(part.quarters([u, v]));
            return;
        }
        let distance = |rect: Rect| face.chart.hull(rect).bounds().distance_squared(self.x);
        let mut halves = part.halves(face.chart.direction(part)).map(|half| (distance(half), half));
        halves.sort_by(|a, b| b.0.total_cmp(&a.0));
        parts.extend(halves.map(|(_, half)| half));
    }

    fn is_decided(&self, certificate: Option<&Certificate>) -> bool {
        certificate.is_some_and(|c| c.modulus(self.x) > 0.0 || c.radius() < POINT * self.group.diagonal)
    }

    fn visit_edge(&mut self, index: usize, edge: &EdgeGeometry, leaf: &EdgeLeaf, start: Option<f64>) {
        if self.is_far(index, &leaf.slab) {
            return;
        }
        if let Some(local) = closed_form::nearest_on_curve(&edge.curve, leaf.range, self.x) {
            return self.offer(index, local);
        }
        self.doubt = self.doubt.max((!leaf.sound).then_some(Doubt::SampledHull));
        if self.is_decided(leaf.certificate.as_ref()) {
            let start = start.filter(|t| t.is_finite()).unwrap_or(0.5 * (leaf.range[0] + leaf.range[1]));
            return self.offer(index, newton::on_curve(&edge.curve, leaf.range, self.x, start));
        }
        let mut parts: Vec<EdgeLeaf> = vec![leaf.clone()];
        while let Some(part) = parts.pop() {
            if self.is_far(index, &part.slab) {
                continue;
            }
            let [a, b] = part.range;
            self.offer(index, newton::on_curve(&edge.curve, part.range, self.x, 0.5 * (a + b)));
            if self.is_decided(part.certificate.as_ref()) || part.bounds.diagonal() < POINT * self.group.diagonal {
                continue;
            }
            if self.budget == 0 {
                self.doubt = self.doubt.max(Some(Doubt::Budget));
                return;
            }
            self.budget -= 1;
            parts.extend(part.halves(&edge.curve));
        }
    }
}
