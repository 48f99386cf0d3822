//! The end of a search: the winner on OCCT's own geometry, polished, and how it ended.

use crate::boxes::Branch;
use crate::closest::foot::{End, Foot};
use crate::closest::group::Member;
use crate::closest::hint::{Hint, Leeways};
use crate::closest::search::{Best, Search};
use crate::geometry::chart::{Jet, Rect, surface_d2};
use crate::geometry::curve::curve_d2;
use crate::geometry::leaf::{EdgeGeometry, FaceGeometry, FaceLeaf, Side};
use crate::geometry::newton::{self, ROUNDING};
use crate::ids::{EdgeId, EntityId, FaceId, VertexId};
use crate::model::Geometry;
use crate::tolerance::{LEAF_MARGIN, ORTHOGONAL, POLISH_LIMIT, POLISHED, TIE};
use glam::{DVec3, Vec3};

/// Golden section, and sections enough for rounding to end the search.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const GOLDEN_STEPS: usize = 60;

/// Samples of a pcurve before that.
const SIDE_SAMPLES: usize = 128;

/// A foot and how the search came to it.
pub(crate) struct Landing {
    pub(crate) foot: Foot,
    /// The leaf it lies on.
    best: Best,
    /// It lies beside that leaf, within a tolerance of the file.
    beside: bool,
    response: [Vec3; 2],
}

impl Search<'_> {
    /// The winner, evaluated by OCCT; `None` where there is none, or OCCT cannot.
    pub(crate) fn finish(&self) -> Option<Landing> {
        let best = self.best?;
        let landing = self.finish_at(best)?;
        let landing = self.within_tolerance(best, &landing.foot).unwrap_or(landing);
        landing.foot.distance.is_finite().then_some(landing)
    }

    /// A nearer minimum on the surface that is outside the trim by no more than the tolerance of the edge or vertex beside it is a point of
    /// the face: the trim is not known better than that.
    fn within_tolerance(&self, best: Best, foot: &Foot) -> Option<Landing> {
        let geometry = &self.group.geometry;
        let tolerance = match foot.end {
            End::OnTrim(edge) => geometry.edges[edge.index()].as_ref()?.tolerance,
            End::OnEnd(vertex) => geometry.vertices[vertex.index()].1,
            _ => return None,
        };
        let nearer = self.outside.iter().filter(|outside| outside.distance < best.distance - self.tie());
        let within = nearer.filter_map(|outside| {
            let Member::Face { face, .. } = self.group.members[outside.member] else { return None };
            let [u, v] = outside.parameters;
            let point = surface_d2(&geometry.faces[face as usize].handle, u, v)[0];
            (point.distance(foot.point) <= tolerance).then_some((outside, FaceId::new(face as usize), point))
        });
        let (outside, face, point) =
            within.min_by(|(a, ..), (b, ..)| a.distance.total_cmp(&b.distance).then(a.member.cmp(&b.member)))?;
        Some(self.land_beside(best, face.into(), Some(outside.parameters), point, foot.end))
    }

    fn finish_at(&self, best: Best) -> Option<Landing> {
        let geometry = &self.group.geometry;
        match self.group.members[best.member] {
            Member::Face { face, leaf } => {
                let geometry = &geometry.faces[face as usize];
                let leaf_geometry = &geometry.leaves[leaf as usize];
                let (parameters, jet) =
                    polish_surface(geometry, leaf_geometry, self.x, best.parameters, self.group.diagonal);
                let end = self.end_on_face(geometry, leaf_geometry, parameters, &jet);
                // where a surface ends at a knot or seam there is an edge as a rule, as near as the surface
                let rim = self.rim.filter(|rim| end != End::Interior && rim.distance <= best.distance + self.tie());
                if let Some(rim) = rim {
                    return self.finish_at(rim);
                }
                let at_trim = matches!(end, End::Stalled { .. }) && leaf_geometry.crossed;
                let slid = if at_trim { self.slide_to_trim(best, face as usize) } else { None };
                Some(slid.unwrap_or_else(|| {
                    let entity = FaceId::new(face as usize).into();
                    let mut landing = self.land(Best { parameters, ..best }, entity, Some(parameters), jet[0], end);
                    if end == End::Interior && self.floors.is_some() {
                        landing.response = newton::response(&jet, self.x).map(|gradient| gradient.as_vec3());
                    }
                    landing
                }))
            }
            Member::Edge { edge, owner, .. } => self.finish_edge(best, edge as usize, owner.map(|face| face as usize)),
            Member::Vertex { vertex, owner } => {
                let id = VertexId::new(vertex as usize);
                let (entity, parameters) = match owner {
                    Some(face) => (FaceId::new(face as usize).into(), geometry.corner_parameters(face as usize, id)),
                    None => (id.into(), Some([0.0; 2])),
                };
                Some(self.land(best, entity, parameters, geometry.vertices[vertex as usize].0, End::OnEnd(id)))
            }
        }
    }

    fn land(&self, best: Best, entity: EntityId, parameters: Option<[f64; 2]>, point: DVec3, end: End) -> Landing {
        let foot = Foot { point, entity, parameters, distance: point.distance(self.x), end, doubt: self.doubt };
        Landing { foot, best, beside: false, response: [Vec3::ZERO; 2] }
    }

    fn land_beside(
        &self,
        best: Best,
        entity: EntityId,
        parameters: Option<[f64; 2]>,
        point: DVec3,
        end: End,
    ) -> Landing {
        Landing { beside: true, ..self.land(best, entity, parameters, point, end) }
    }

    /// What the next query nearby should know.
    pub(crate) fn hint(&self, landing: &Landing) -> Hint {
        let Landing { best, response, .. } = landing;
        let leeways = self.leeways(landing);
        let leaf = best.member as u32;
        Hint { group: self.group.number, leaf, x: self.x, start: best.parameters, response: *response, leeways }
    }

    /// The leeways of all but the leaf of the foot.
    fn leeways(&self, landing: &Landing) -> Leeways {
        let Some(floors) = self.floors.as_ref().filter(|_| self.doubt.is_none() && !landing.beside) else {
            return Leeways::NONE;
        };
        let group = self.group;
        let bounds = |branch: Branch| match branch.split() {
            Ok(leaf) => group.geometry.bounds_of(group.members[leaf]),
            Err(node) => group.boxes.bounds_below(node),
        };
        let at = (landing.foot.point, landing.foot.distance);
        let mut leeways = floors.leeways(self.spared, landing.best.member, at, group.leaf_size, bounds);
        // an edge or vertex as near as the winner took the foot
        if let Some(winner) = self.best.filter(|winner| winner.member != landing.best.member) {
            leeways.push(Branch::leaf(winner.member), 0.0);
        }
        leeways
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
    /// surface at the trim can be nearer than the curve. Finds the nearest point of the surface along the pcurves of the face.
    fn slide_to_trim(&self, best: Best, index: usize) -> Option<Landing> {
        let face = &self.group.geometry.faces[index];
        let nearest = |side: &Side| {
            let [u, v] = side.nearest_on(face, self.x)?;
            let point = surface_d2(&face.handle, u, v)[0];
            Some((point.distance(self.x), [u, v], point, EdgeId::new(side.edge?)))
        };
        let sides = face.sides.iter().filter_map(nearest);
        let (distance, parameters, point, edge) = sides.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let end = End::OnTrim(edge);
        (distance <= best.distance + self.tie())
            .then(|| self.land_beside(best, FaceId::new(index).into(), Some(parameters), point, end))
    }

    fn finish_edge(&self, best: Best, index: usize, owner: Option<usize>) -> Option<Landing> {
        let geometry = &self.group.geometry;
        let id = EdgeId::new(index);
        let edge = geometry.edges[index].as_ref()?;
        let (t, jet) = polish_curve(edge, self.x, best.parameters[0]);
        if let Some(face) = owner {
            let parameters = geometry.faces[face].parameters_on(index, edge.range, t, jet[0]);
            let corner = geometry.ends[index][usize::from(t >= edge.range[1])];
            let at_end = t <= edge.range[0] || t >= edge.range[1];
            let end = corner.filter(|_| at_end).map_or(End::OnTrim(id), End::OnEnd);
            return Some(self.land(best, FaceId::new(face).into(), parameters, jet[0], end));
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
        Some(self.land(best, id.into(), Some([t, 0.0]), jet[0], end))
    }
}

/// Length of the part of `r` along `d`; 0 where `d` vanishes.
fn tangential(r: DVec3, d: DVec3) -> f64 {
    let length = d.length();
    if length > 0.0 { (r.dot(d) / length).abs() } else { 0.0 }
}

/// Newton's last steps on OCCT's own surface, taken while they make the residual smaller.
fn polish_surface(face: &FaceGeometry, leaf: &FaceLeaf, x: DVec3, mut p: [f64; 2], diagonal: f64) -> ([f64; 2], Jet) {
    let mut jet = surface_d2(&face.handle, p[0], p[1]);
    let window = around(face, leaf);
    for _ in 0..POLISH_LIMIT {
        let distance = jet[0].distance(x);
        if residual(&jet, x) <= POLISHED * (diagonal + distance) {
            break;
        }
        let next = window.clamp(newton::surface_target(&jet, x, p));
        if next.iter().any(|t| !t.is_finite()) || (leaf.crossed && !face.trim.contains(next)) {
            break;
        }
        let polished = surface_d2(&face.handle, next[0], next[1]);
        // coordinates are rounded relative to the model, not to the distance
        let farther = polished[0].distance(x) > distance + 0.1 * TIE * diagonal;
        if farther || residual(&polished, x) >= residual(&jet, x) {
            break;
        }
        (p, jet) = (next, polished);
    }
    (p, jet)
}

/// A leaf's range and a little of its neighbours: of two leaves that tie, the one without the foot may have won.
fn around(face: &FaceGeometry, leaf: &FaceLeaf) -> Rect {
    let [du, dv] = leaf.rect.size().map(|size| LEAF_MARGIN * size);
    let widen = |r: [f64; 2], d: f64, all: [f64; 2]| [(r[0] - d).max(all[0]), (r[1] + d).min(all[1])];
    Rect { u: widen(leaf.rect.u, du, face.rect.u), v: widen(leaf.rect.v, dv, face.rect.v) }
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

impl Geometry {
    /// Parameters on a face of one of its corners: the end of a pcurve there.
    fn corner_parameters(&self, face: usize, vertex: VertexId) -> Option<[f64; 2]> {
        let sides = self.faces[face].sides.iter().filter_map(|side| side.edge);
        let ends = sides.filter_map(|edge| {
            let end = self.ends[edge].iter().position(|&end| end == Some(vertex))?;
            Some((edge, self.edges[edge].as_ref()?.range, end))
        });
        let (point, _) = self.vertices[vertex.index()];
        let parameters = |(edge, range, end): (usize, [f64; 2], usize)| {
            self.faces[face].parameters_on(edge, range, range[end], point)
        };
        ends.filter_map(parameters).find(|p| p[0].is_finite())
    }
}

impl Side {
    /// Parameters of the point of the surface along the pcurve that is nearest to `x`: the best of some samples, then golden sections
    /// between its neighbours.
    fn nearest_on(&self, face: &FaceGeometry, x: DVec3) -> Option<[f64; 2]> {
        let at = |t: f64| {
            let mut jet = [0.0; 4];
            self.pcurve.d1(t, &mut jet).ok().map(|()| [jet[0], jet[1]])
        };
        let distance = |t: f64| at(t).map_or(f64::INFINITY, |[u, v]| face.chart.d2(u, v)[0].distance_squared(x));
        let [first, last] = self.range;
        let sample = |k: usize| first + (last - first) * (k as f64 / SIDE_SAMPLES as f64);
        let near = (0..=SIDE_SAMPLES).min_by(|&a, &b| distance(sample(a)).total_cmp(&distance(sample(b))))?;
        let (mut low, mut high) = (sample(near.saturating_sub(1)), sample((near + 1).min(SIDE_SAMPLES)));
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
    /// Parameters on the surface of the point of a boundary edge at `t`; of the two sides of a seam, the first. `None` where the face has
    /// no curve for that edge.
    fn parameters_on(&self, edge: usize, range: [f64; 2], t: f64, point: DVec3) -> Option<[f64; 2]> {
        let sides = self.sides.iter().filter(|side| side.edge == Some(edge));
        let mut best = (None, f64::INFINITY);
        for side in sides {
            let fraction = (t - range[0]) / (range[1] - range[0]);
            let along = side.range[0] + fraction * (side.range[1] - side.range[0]);
            let mut jet = [0.0; 4];
            if side.pcurve.d1(if side.range == range { t } else { along }, &mut jet).is_err() {
                continue;
            }
            let distance = self.chart.d2(jet[0], jet[1])[0].distance(point);
            if best.1.is_infinite() || distance < 0.5 * best.1 {
                best = (Some([jet[0], jet[1]]), distance);
            }
        }
        best.0
    }
}
