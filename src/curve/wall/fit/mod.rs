//! Lets nodes of wall edges slide along the CAD, so that the wall polynomial comes nearer to it.
//!
//! A polynomial through nodes on the CAD is off it between them. Where an edge spans a change of slope or curvature, it bulges: an
//! edge of P2 is off by about `h^3 k' / 125`, `h` its length and `k'` the change of curvature along it. Sliding the node by `b h`
//! bends the polynomial by `b h^2 k` times a cubic of the same shape, so that a small slide takes the cubic away wherever there is
//! curvature. Every edge on its own makes it worse (see [`crate::curve::wall`]): the faces between the edges bulge, and thin
//! faces fold. So all edges around the farthest faces are fitted together:
//!
//! 1. Measure the distance of every curved wall face from its surface, and of every edge on a curve from that. Each surface and curve
//!    has a *level*, the largest of its distances.
//! 2. Take the farthest faces. Their edges' nodes may slide: those on a curve along it, those on a surface in it. Inner nodes of
//!    faces follow, as after projection.
//! 3. Minimise, over all faces and edges that have one of these nodes, 8th powers of the distances over their levels, and the strain of
//!    the sliding itself. Distances are linear there; no CAD is asked.
//! 4. Cut slides that strain a face by more than 0.12, put the nodes on the CAD, and measure. Around a face or edge that is now farther
//!    than before and near its level, slides are halved, until there is none.
//! 5. Keep this if a level has fallen by a worthwhile fraction, and begin again; else undo it.
//!
//! So no level rises, of no surface and no curve. What is gained stands in [`crate::curve::wall`].
//!
//! In a plane mesh a line shares only its ends with others, and these stay: each is fitted alone, by Newton's method, its level its own
//! distance. On a circle the slides that bring a line of P4 nearer are those of two nodes at once; one node after the other gains nothing.
//! Its strain along the chord is limited, squeezed and stretched differently.

mod measure;
mod model;
mod table;

use cad::{Evaluation, Foot};
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::associate::{Classification, normal_at, normal_of};
use crate::curve::level::{Case, Level};
use crate::element::Cell;
use crate::mesh::NodeId;
use measure::{Fit, Part, Piece};
use model::{Model, Response, Slider, gradients, relax, solve};
use table::Table;

/// Rounds at most.
const ROUNDS: usize = 4;
/// Faces farther than this fraction of their level are fitted ...
const FAR: f64 = 0.5;
/// ... the farthest first, of all faces and edges one in so many ...
const FEW: usize = 10;
/// ... but as many as this where there are few, and no more than that where there are many.
const CHOSEN: [usize; 2] = [64, 4096];
/// Distances below this fraction of an edge are not worth a slide.
///
/// It must lie below what refinement reaches: with 1e-4 the fit ended between two levels, and with it the observed order.
const NEGLIGIBLE: f64 = 1e-8;
/// The same for the lines of a plane mesh, which cost nothing.
const NEGLIGIBLE_LINE: f64 = 1e-12;
/// Levels of curves that an edge on one is compared with.
///
/// Compared with one, edges slide for their own sake, and wing_sharp at scale 0.4 came out with `C_JAC` 0.76 in place of 0.80. Not
/// compared, they slide off their curves, and what is around them slides back: the weeble at 1.4e-3 in place of 1.1e-3.
const ON_CURVE: f64 = 3.0;
/// Sweeps of the model's solver; 200 gave the same distances to 1e-4 of them.
const SWEEPS: usize = 40;
/// Largest strain of a face by sliding. A strain takes as much off `C_JAC`: with 0.4 and little stiffness the nozzle at scale 0.4 fell
/// from 0.81 to 0.76, its wall from 1.2e-3 to 1.05e-3.
const STRAIN: f64 = 0.12;
/// The same for a line of a plane mesh: how much it may be squeezed by sliding, which takes as much off `C_JAC`, ...
const SQUEEZE: f64 = 0.1;
/// ... at P2, where it is so at an end, below the whole of a column, and where a slide gains less. Three elements in a row, P2: with
/// 0.12 C_JAC 0.772 and 0.66 times Gmsh's distance, with 0.06 0.806 and 0.84 times.
const SQUEEZE_P2: f64 = 0.06;
/// ... and stretched, which takes nothing off it. With the limit of the squeeze NACA 4412 of edges of 75 degrees stays at 0.76 times Gmsh's
/// distance at P3, three elements at 0.73, NLR 7301 at P4 at 0.75; with this at 0.46, 0.48 and 0.66.
const STRETCH: f64 = 0.25;
/// Parts in which a slide is cut down to the largest strain.
const CUTS: u32 = 16;
/// A face or edge may come out farther than it was, up to this fraction of the level of its surface or curve.
const ROOM: f64 = 0.95;
/// What a distance may exceed: less than this fraction of it is no change.
const SAME: f64 = 1e-3;
/// Times that slides are halved where faces come out too far.
const TRIES: usize = 16;
/// Fractions of a slide below this are not halved but set to nothing.
const LEAST: f64 = 0.2;
/// A round is kept if it takes a level to this fraction of it.
const GAIN: f64 = 0.98;
/// A slide below this fraction of the node's edge is not made: in a CAD file whose curves end off their faces (IGES) it can only end worse.
const UNMOVED: f64 = 1e-6;
/// The same in a plane mesh, whose lines have no faces to be off: what closest points are worth.
const UNMOVED_LINE: f64 = 1e-12;
/// Distances below this fraction of a face's edge have no direction.
const NO_DIRECTION: f64 = 1e-9;

/// Lets nodes of wall edges slide where that takes the wall nearer to the CAD; nodes of periodic pairs stay. In a plane mesh those that lead
/// slide, and those that follow are to be carried along.
pub fn fit(level: &mut Level) {
    let tables =
        [Cell::Line, Cell::Triangle, Cell::Quad].map(|cell| (cell, Table::new(cell, level.elevated.mesh.order())));
    let start = level.wall.displacements();
    let leads = level.plane().is_some();
    let paired = level
        .periodic
        .images()
        .iter()
        .flat_map(|image| [image.node, if leads { image.node } else { image.of }])
        .collect();
    let mut fit = Fit { level, paired, start, tables: tables.into_iter().collect() };
    let mut pieces = fit.pieces();
    for _ in 0..ROUNDS {
        if !fit.round(&mut pieces) {
            break;
        }
    }
    // Faces that stay off the CAD share edges with those on it.
    let Case { boundary, association, .. } = fit.level.case;
    let straight = |&face: &usize| association.faces[face] == Classification::Straight;
    fit.lead(&(0..boundary.faces.len()).filter(straight).map(Part::Face).collect::<Vec<_>>());
}

impl Fit<'_, '_> {
    /// One fit of the farthest faces; false where it was not worth it.
    fn round(&mut self, pieces: &mut [Piece]) -> bool {
        let sliding = self.sliding(pieces);
        let number: FxHashMap<NodeId, usize> = sliding.iter().enumerate().map(|(s, &n)| (n, s)).collect();
        let mut sliders: Vec<Slider> = sliding.par_iter().map(|&n| self.slider(n)).collect();
        let near = |&p: &usize| self.rim(pieces[p].part).iter().any(|n| number.contains_key(n));
        let near: Vec<usize> = (0..pieces.len()).into_par_iter().filter(near).collect();
        let model = |&p: &usize| self.model(p, pieces[p].part, &sliders, &number);
        let mut models: Vec<Model> = near.par_iter().map(model).collect();
        for own in &models {
            pieces[own.piece].far = own.distances.iter().copied().fold(0.0, f64::max);
        }
        let (levels, alone) = (self.levels(pieces), self.level.plane().is_some());
        for (m, own) in models.iter_mut().enumerate() {
            let part = pieces[own.piece].part;
            let least = self.negligible(part);
            let level = levels[&self.key(part)].max(least).max(f64::MIN_POSITIVE);
            own.level = if matches!(part, Part::Face(_)) { level } else { ON_CURVE * level };
            own.room = pieces[own.piece].far.max(ROOM * level);
            if alone {
                own.level = pieces[own.piece].far.max(least).max(f64::MIN_POSITIVE);
                own.room = pieces[own.piece].far;
            }
            own.sliders.iter().enumerate().for_each(|(r, response)| sliders[response.slider].at.push((m, r)));
        }
        if alone {
            models.iter_mut().for_each(|own| solve(&mut sliders, own, SWEEPS));
        } else {
            relax(&mut sliders, &mut models, SWEEPS);
        }
        let allowed: Vec<f64> = models.par_iter().map(|own| self.allowed(own, pieces[own.piece].part)).collect();
        let size = |slider: &Slider| self.level.wall.size(slider.node.index()).unwrap_or(0.0);
        let unmoved = if alone { UNMOVED_LINE } else { UNMOVED };
        let share = |slider: &Slider| {
            let moves = slider.step.length() > unmoved * size(slider);
            if moves { slider.at.iter().map(|&(m, _)| allowed[m]).fold(1.0, f64::min) } else { 0.0 }
        };
        let shares = sliders.iter().map(share).collect();
        let kept = self.level.wall.displacements();
        let Some(far) = self.attempt(pieces, &sliders, &models, shares) else {
            self.level.wall.displace_all(&kept);
            return false;
        };
        let mut after = pieces.to_vec();
        models.iter().zip(far).for_each(|(own, far)| after[own.piece].far = far);
        let fallen = self.levels(&after);
        let nearer = |own: &Model| after[own.piece].far < GAIN * pieces[own.piece].far;
        let worth =
            levels.iter().any(|(key, level)| fallen[key] < GAIN * level) || (alone && models.iter().any(nearer));
        if worth {
            pieces.copy_from_slice(&after);
        } else {
            self.level.wall.displace_all(&kept);
        }
        worth
    }

    /// The nodes of the farthest pieces that may slide.
    fn sliding(&self, pieces: &[Piece]) -> Vec<NodeId> {
        let levels = self.levels(pieces);
        let alone = self.level.plane().is_some();
        let ratio = |piece: &Piece| piece.far / levels[&self.key(piece.part)];
        let far = |piece: &&Piece| {
            matches!(piece.part, Part::Face(_))
                && (alone || ratio(piece) > FAR)
                && piece.far > self.negligible(piece.part)
        };
        let mut chosen: Vec<&Piece> = pieces.iter().filter(far).collect();
        chosen.sort_by(|a, b| ratio(b).total_cmp(&ratio(a))); // stable: in file order where they are equal
        let [least, most] = CHOSEN;
        if !alone {
            chosen.truncate((pieces.len() / FEW).clamp(least, most));
        }
        let rims = chosen.iter().flat_map(|piece| self.rim(piece.part));
        let mut sliding: Vec<NodeId> = rims.filter(|&n| self.slides(n)).collect();
        sliding.sort_unstable();
        sliding.dedup();
        sliding
    }

    /// Distances of a part that are not worth a slide.
    fn negligible(&self, part: Part) -> f64 {
        self.size(part) * if self.level.plane().is_some() { NEGLIGIBLE_LINE } else { NEGLIGIBLE }
    }

    fn slider(&self, node: NodeId) -> Slider {
        let classification = self.level.wall.classification(node.index());
        let evaluation = self.group(classification).and_then(|group| {
            let foot = group.closest(self.position(node), None)?;
            group.evaluate_at(&foot)
        });
        let along = match (classification, evaluation) {
            (Classification::Surface(_), Some(Evaluation::Surface(point))) => {
                point.normal.map_or(Vec::new(), |normal| {
                    let first = normal.any_orthonormal_vector();
                    vec![first, normal.cross(first)]
                })
            }
            (_, Some(Evaluation::Curve(point))) => point.tangent.into_iter().collect(),
            _ => Vec::new(),
        };
        Slider { node, along, step: DVec3::ZERO, at: Vec::new() }
    }

    fn model(&self, piece: usize, part: Part, sliders: &[Slider], number: &FxHashMap<NodeId, usize>) -> Model {
        let table = &self.tables[&self.cell(part)];
        let (nodes, rim, off) = (self.nodes(part), self.rim(part), NO_DIRECTION * self.size(part));
        let group = self.group(self.classification(part));
        let plane = self.level.plane();
        let normal = |x: DVec3| match plane {
            None => group.and_then(|group| normal_at(group, x)),
            Some(_) => group.and_then(|group| normal_of(group, &group.closest(x, None)?, plane)),
        };
        let feet = self.feet(part, &table.fine);
        // A foot may be off along the curve by more than the point is off the curve: its normal is the better direction.
        let of_line = |x: DVec3, foot: &Foot| {
            let own = normal_of(group?, foot, Some(plane?))?;
            Some(if own.dot(x - foot.point) < 0.0 { -own } else { own })
        };
        let away = |(x, foot): &(DVec3, Option<Foot>)| match foot {
            Some(foot) if plane.is_some() => of_line(*x, foot).unwrap_or(DVec3::ZERO),
            Some(foot) if foot.distance > off => (*x - foot.point) / foot.distance,
            _ => normal(*x).unwrap_or(DVec3::ZERO),
        };
        let normals: Vec<DVec3> = feet.iter().map(away).collect();
        let inner: Vec<DVec3> =
            nodes[rim.len()..].iter().map(|&n| normal(self.position(n)).unwrap_or(DVec3::ZERO)).collect();
        let slopes = |r: usize, along: DVec3| -> Vec<f64> {
            let moved = |values: &Vec<f64>| -> DVec3 {
                let led = inner.iter().enumerate().map(|(i, normal)| {
                    let slid = along - *normal * normal.dot(along);
                    slid * (values[rim.len() + i] * table.extension[i * rim.len() + r])
                });
                along * values[r] + led.sum::<DVec3>()
            };
            normals.iter().zip(&table.fine).map(|(n, values)| n.dot(moved(values))).collect()
        };
        let responses = rim.iter().enumerate().filter_map(|(r, node)| {
            let &slider = number.get(node)?;
            let slopes = sliders[slider].along.iter().map(|&t| slopes(r, t)).collect();
            Some(Response { slider, rim: r, slopes })
        });
        let sliders = responses.collect();
        let corners: Vec<DVec3> = nodes[..table.straight[0].len()].iter().map(|&n| self.straight(n)).collect();
        let slopes = table.slopes.iter().zip(&table.straight);
        let slopes: Vec<Vec<DVec3>> =
            slopes.map(|(slopes, straight)| gradients(slopes, straight, &corners, plane.is_some())).collect();
        let mean = |r: usize, q: usize| slopes.iter().map(|s| s[r].dot(s[q])).sum::<f64>() / slopes.len() as f64;
        let products = (0..rim.len()).map(|r| (0..rim.len()).map(|q| mean(r, q)).collect()).collect();
        let gap = |(x, foot): &(DVec3, Option<Foot>)| foot.map_or(f64::INFINITY, |foot| self.gap(part, *x, &foot));
        let (distances, shifts) = (feet.iter().map(gap).collect(), self.shifts(part));
        let quadratic = self.level.mesh().order().get() == 2;
        let limits = plane.map(|_| [if quadratic { SQUEEZE_P2 } else { SQUEEZE }, STRETCH]);
        Model { piece, level: 0.0, room: 0.0, distances, sliders, slopes, products, shifts, limits }
    }

    /// Share of the last steps up to which the strain stays within its limit.
    fn allowed(&self, own: &Model, part: Part) -> f64 {
        let before = self.shifts(part);
        let mut shares = (0..=CUTS).rev().map(|k| f64::from(k) / f64::from(CUTS));
        let allows = |share: f64| match own.limits {
            None => own.strain(&before, share) <= STRAIN,
            Some(_) => own.pulls(&own.shifts_at(&before, share)).all(|pull| pull.abs() <= 1.0),
        };
        shares.find(|&share| allows(share)).unwrap_or(0.0)
    }

    /// Slides, with less and less around the pieces that come out too far; their distances in the end, `None` where some still do.
    fn attempt(
        &mut self,
        pieces: &[Piece],
        sliders: &[Slider],
        models: &[Model],
        mut shares: Vec<f64>,
    ) -> Option<Vec<f64>> {
        let before: Vec<DVec3> = sliders.iter().map(|slider| self.position(slider.node)).collect();
        let mut far: Vec<f64> = vec![0.0; models.len()];
        let mut moved = vec![true; sliders.len()];
        for _ in 0..TRIES {
            let stale = |own: &Model| own.sliders.iter().any(|response| moved[response.slider]);
            let stale: Vec<usize> = (0..models.len()).filter(|&m| stale(&models[m])).collect();
            self.slide(sliders, &before, &shares, &moved);
            self.lead(&stale.iter().map(|&m| pieces[models[m].piece].part).collect::<Vec<_>>());
            let measured = |&m: &usize| {
                let part = pieces[models[m].piece].part;
                self.far(part, &self.tables[&self.cell(part)].fine)
            };
            let measured: Vec<f64> = stale.par_iter().map(measured).collect();
            stale.iter().zip(measured).for_each(|(&m, own)| far[m] = own);
            moved.fill(false);
            let mut fits = true;
            for (own, &far) in models.iter().zip(&far) {
                if far > (1.0 + SAME) * own.room {
                    fits = false;
                    own.sliders.iter().for_each(|response| moved[response.slider] = true);
                }
            }
            if fits {
                return Some(far);
            }
            for (share, _) in shares.iter_mut().zip(&moved).filter(|(_, moved)| **moved) {
                *share = if *share < LEAST { 0.0 } else { 0.5 * *share };
            }
        }
        None
    }

    /// Puts nodes that move at a fraction of their steps from `before`, on the CAD.
    fn slide(&mut self, sliders: &[Slider], before: &[DVec3], shares: &[f64], moved: &[bool]) {
        let foot = |s: usize| {
            let group = self.group(self.level.wall.classification(sliders[s].node.index())).filter(|_| shares[s] > 0.0);
            group.and_then(|group| group.closest(before[s] + sliders[s].step * shares[s], None))
        };
        let moved: Vec<usize> = (0..sliders.len()).filter(|&s| moved[s]).collect();
        let feet: Vec<Option<Foot>> = moved.par_iter().map(|&s| foot(s)).collect();
        for (s, foot) in moved.into_iter().zip(feet) {
            self.put(sliders[s].node, foot.as_ref(), before[s]);
        }
    }

    /// Puts the nodes inside faces where their rims take them, on the CAD where the faces are.
    fn lead(&mut self, parts: &[Part]) {
        let inner = |&part: &Part| -> Vec<(NodeId, DVec3, Option<Foot>)> {
            let (nodes, rim, table) = (self.nodes(part), self.rim(part), &self.tables[&self.cell(part)]);
            let group = self.group(self.classification(part));
            let inner = nodes[rim.len()..].iter().zip(table.extension.chunks_exact(rim.len()));
            let foot = |(&node, weights): (&NodeId, &[f64])| {
                let moved = |(n, &w): (&NodeId, &f64)| self.level.wall.displacement(n.index()) * w;
                let wish = self.straight(node) + rim.iter().zip(weights).map(moved).sum::<DVec3>();
                (node, wish, group.and_then(|group| group.closest(wish, None)))
            };
            inner.map(foot).collect()
        };
        let feet: Vec<Vec<(NodeId, DVec3, Option<Foot>)>> = parts.par_iter().map(inner).collect();
        for (node, wish, foot) in feet.into_iter().flatten() {
            self.put(node, foot.as_ref(), wish);
        }
    }

    /// Puts a node at its foot, or else at `otherwise`.
    fn put(&mut self, node: NodeId, foot: Option<&Foot>, otherwise: DVec3) {
        let unproven = foot.iter().filter(|foot| !foot.is_proven()).count();
        let position = foot.map_or(otherwise, |foot| foot.point);
        let displacement = position - self.straight(node);
        self.level.wall.count_queries(foot.iter().len(), unproven);
        self.level.wall.displace(node.index(), displacement);
    }
}
