//! The oracle: closest points against the best of OCCT's three searches and a dense grid with Newton, on every kind of face.
//!
//! `cargo test -p sagitta-cad --release --test suite oracle:: -- --ignored --nocapture`; `SAGITTA_CAD=FOLDER[:FOLDER]` adds all STEP, IGES, BREP and
//! EGADS files of folders and their sub-folders, `SAGITTA_ORACLE_QUERIES` sets the queries a face (default 300).

mod edges;

use crate::common::{Random, cad_files, foreign_folders, options};
use cad::{End, EntityId, Evaluation, FaceId, Foot, Group, Model, SourceFormat};
use glam::DVec3;
use opencascade_sys as sys;
use std::path::{Path, PathBuf};

/// Excess over the best that counts as wrong, fraction of the diagonal.
const WRONG: f64 = 1e-9;

/// Points a side of the dense grid.
const GRID: usize = 50;

/// Faces of a file that are asked, evenly chosen.
const FACES: usize = 20;

/// OCCT's searches on a trimmed face are slow: a face stops after this many seconds, a printed figure tells how far it came.
const SECONDS: f64 = 20.0;

#[derive(Default, Debug)]
struct Tally {
    queries: usize,
    ours: usize,
    unproven: usize,
    stalled: usize,
    /// GeomAPI_ProjectPointOnSurf, ShapeAnalysis_Surface, BRepExtrema_DistShapeShape, dense grid.
    others: [usize; 4],
}

struct Judge<'a> {
    model: &'a Model,
    face: FaceId,
    oracle: sys::UniquePtr<sys::Oracle>,
    grid: Vec<([f64; 2], DVec3)>,
}

impl<'a> Judge<'a> {
    fn new(model: &'a Model, import: &sys::Import, face: FaceId) -> Self {
        let oracle = sys::oracle(import.shape(), face.index()).unwrap();
        let [u, v] = model.face(face).unwrap().parameters;
        let at = |r: [f64; 2], k: usize| r[0] + (r[1] - r[0]) * k as f64 / (GRID - 1) as f64;
        let node = |k: usize| {
            let p = [at(u, k / GRID), at(v, k % GRID)];
            Some((p, model.evaluate(face.into(), p)?.point()))
        };
        Self { model, face, oracle, grid: (0..GRID * GRID).filter_map(node).collect() }
    }

    /// The nearest grid points, each led on by Newton's method.
    fn dense(&self, x: DVec3) -> Option<DVec3> {
        let mut near: Vec<_> = self.grid.iter().map(|(p, q)| (q.distance_squared(x), *p)).collect();
        let count = 4.min(near.len());
        near.select_nth_unstable_by(count.checked_sub(1)?, |a, b| a.0.total_cmp(&b.0));
        let points = near[..count].iter().filter_map(|&(_, p)| self.newton(x, p));
        points.min_by(|a, b| a.distance_squared(x).total_cmp(&b.distance_squared(x)))
    }

    fn newton(&self, x: DVec3, mut p: [f64; 2]) -> Option<DVec3> {
        let bounds = self.model.face(self.face)?.parameters;
        let mut point = DVec3::NAN;
        for _ in 0..30 {
            let Evaluation::Surface(s) = self.model.evaluate(self.face.into(), p)? else { return None };
            point = s.point;
            let by = s.parameters_of(x - s.point);
            if !by.is_finite() {
                break;
            }
            p = [0, 1].map(|i| (p[i] + by[i]).clamp(bounds[i][0], bounds[i][1]));
        }
        Some(point)
    }

    /// How far a point is off the trimmed face, `None` where by more than rounding. OCCT 7.6 answers wrongly for some faces of IGES files:
    /// what stands clearly out of the box of the face's edges and samples is none of its points, whatever it says.
    fn off(&self, p: DVec3) -> Option<f64> {
        let bounds = self.model.faces()[self.face.index()].bounds;
        let inside = bounds.grown(0.001 * bounds.diagonal()).distance_squared(p) == 0.0;
        let slack = WRONG * self.model.diagonal();
        let off = self.oracle.off(p.x, p.y, p.z, slack).ok()?;
        (inside && off <= slack).then_some(off)
    }

    /// Distances that the four methods find; `None` without an answer, or for one off the trimmed face that would be too near.
    fn candidates(&mut self, x: DVec3, ours: &Foot) -> [Option<f64>; 4] {
        let (mut at, mut nearest) = ([0.0; 3], [0.0; 3]);
        let id: EntityId = self.face.into();
        let point = |p: [f64; 3]| Some(self.model.evaluate(id, [p[0], p[1]])?.point());
        let project = self.oracle.pin_mut().project(x.x, x.y, x.z, &mut at).unwrap_or(false).then_some(at);
        let analyse = self.oracle.pin_mut().analyse(x.x, x.y, x.z, &mut at).is_ok().then_some(at);
        let extrema = self.oracle.extrema(x.x, x.y, x.z, &mut nearest).is_ok().then_some(DVec3::from_array(nearest));
        let points = [project.and_then(point), analyse.and_then(point), extrema, self.dense(x)];
        let limit = ours.distance - WRONG * self.model.diagonal();
        points.map(|p| {
            let p = p.filter(|p| p.is_finite())?;
            let distance = p.distance(x);
            if distance >= limit { Some(distance) } else { self.off(p).map(|off| distance + off) }
        })
    }
}

/// Points near the face, farther away, and anywhere about the model.
fn query(model: &Model, face: FaceId, k: usize, random: &mut Random) -> DVec3 {
    let [u, v] = model.face(face).unwrap().parameters;
    let mut between = |[a, b]: [f64; 2]| a + (b - a) * random.unit();
    let on = model.evaluate(face.into(), [between(u), between(v)]).map_or(DVec3::ZERO, |e| e.point());
    let way = DVec3::new(between([-1.0, 1.0]), between([-1.0, 1.0]), between([-1.0, 1.0]));
    let reach = [1e-6, 0.005, 0.1, 1.0][k % 4];
    on + way * reach * model.diagonal()
}

fn ask(model: &Model, group: &Group, judges: &mut [Judge], count: usize, tally: &mut Tally) {
    let mut random = Random(97);
    let start = std::time::Instant::now();
    for k in 0..count {
        if start.elapsed().as_secs_f64() > SECONDS {
            break;
        }
        let x = query(model, judges[k % judges.len()].face, k, &mut random);
        let ours = group.closest(x, None).unwrap();
        let mut best = [None::<f64>; 4];
        for judge in judges.iter_mut() {
            for (best, candidate) in best.iter_mut().zip(judge.candidates(x, &ours)) {
                *best = [*best, candidate].into_iter().flatten().reduce(f64::min);
            }
        }
        let least = best.into_iter().flatten().fold(ours.distance, f64::min);
        // a foot on a boundary edge lies on its curve, which may leave the surface by its tolerance
        let slack = match ours.end {
            End::OnTrim(edge) => model.edge(edge).unwrap().tolerance,
            End::OnEnd(vertex) => model.vertex(vertex).unwrap().tolerance,
            _ => 0.0,
        };
        let excess = |d: f64| d > least + WRONG * model.diagonal();
        tally.queries += 1;
        tally.unproven += usize::from(!ours.is_proven());
        if matches!(ours.end, End::Stalled { .. }) {
            tally.stalled += 1;
            println!("    STALLED at {x}: {ours:?}, others {best:?}");
        }
        if excess(ours.distance - slack) {
            tally.ours += 1;
            println!("    WORSE at {x}: {ours:?}, others {best:?}");
        }
        for (count, distance) in tally.others.iter_mut().zip(best) {
            *count += usize::from(distance.is_none_or(excess));
        }
    }
}

/// All judges of one file; the number of faces and groups that were asked.
fn file(path: &Path, count: usize, total: &mut Tally) -> usize {
    let model = Model::read(path, &options()).unwrap();
    let format = match model.format() {
        SourceFormat::Step => sys::Format::Step,
        SourceFormat::Iges => sys::Format::Iges,
        SourceFormat::Brep => sys::Format::Brep,
    };
    let import = sys::read_file(path.to_str().unwrap(), format, 1.0, false).unwrap();
    let faces: Vec<FaceId> = model.faces().iter().map(|face| face.id).collect();
    let stride = faces.len().div_ceil(FACES).max(1);
    // OCCT sees no hole that is written a period away
    let blind = |id: &FaceId| path.ends_with("shapes/kinds.brep") && id.index() == 12;
    let chosen: Vec<FaceId> = faces.iter().copied().step_by(stride).filter(|id| !blind(id)).collect();
    let mut tally = Tally::default();
    for &id in &chosen {
        let group = Group::of_faces(&model, &[id]).unwrap();
        ask(&model, &group, &mut [Judge::new(&model, &import, id)], count, &mut tally);
    }
    let mut asked = chosen.len();
    if chosen.len() > 1 {
        let some = &chosen[..chosen.len().min(6)];
        let group = Group::of_faces(&model, some).unwrap();
        let mut judges: Vec<Judge> = some.iter().map(|&id| Judge::new(&model, &import, id)).collect();
        ask(&model, &group, &mut judges, count, &mut tally);
        asked += 1;
    }
    println!(
        "{}: {asked} faces and groups, {} queries, ours worse {}, not proven {}, stalled {}; OCCT's worse or without answer: project {}, analysis {}, extrema {}; grid {}",
        path.display(),
        tally.queries,
        tally.ours,
        tally.unproven,
        tally.stalled,
        tally.others[0],
        tally.others[1],
        tally.others[2],
        tally.others[3]
    );
    total.queries += tally.queries;
    total.ours += tally.ours;
    total.unproven += tally.unproven;
    total.stalled += tally.stalled;
    total.others = [0, 1, 2, 3].map(|i| total.others[i] + tally.others[i]);
    asked
}

#[test]
#[ignore = "minutes: make oracle"]
fn never_farther_than_the_best_of_all() {
    let mut paths: Vec<PathBuf> = ["kinds.brep", "plate.brep", "rims.brep"].map(crate::common::shape_path).to_vec();
    cad_files(&crate::common::path(""), &mut paths);
    for folder in foreign_folders() {
        cad_files(&folder, &mut paths);
    }
    let count = std::env::var("SAGITTA_ORACLE_QUERIES").ok().and_then(|t| t.parse().ok()).unwrap_or(300);
    let mut total = Tally::default();
    let asked: usize = paths.iter().map(|path| file(path, count, &mut total)).sum();
    println!("all: {asked} faces and groups, {total:?}");
    assert!(asked >= 15 && total.ours == 0, "{total:?}");
}
