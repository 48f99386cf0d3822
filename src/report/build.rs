//! The report of a curved mesh, filled in.

use std::collections::BTreeSet;

use glam::DVec3;
use rayon::prelude::*;

use super::certificate::CertificateReport;
use super::curve::{
    Angles, CellReport, Costs, GridLinesReport, Input, LowerOrderReport, Nodes, OffCadReport, OpenFaceReport,
    PatchReport, PlaneReport, Projections, Report, SCHEMA, SmoothingReport, StepReport, SweepReport, WallFailure,
    WallReport, WallVerdict,
};
use super::distance::{Distance, distance, node_distance};
use super::finite;
use super::measures::{lowest, spread};
use super::run::{Run, Units};
use crate::associate::{Classification, OpenFace};
use crate::certify::{self, FaceFinding, Measured, Verdict};
use crate::curve::layers::straight_elements;
use crate::curve::recover::{Departure, OffCadFace};
use crate::curve::{Curved, Job, LowerOrder, Sweep};
use crate::element::{Cell, Order};
use crate::mesh::EntityKey;
use crate::quality::{GridLineAngles, GridLines};
use crate::scene::Measures;
use crate::smooth::Summary;

/// The measures of the elements of a curved mesh, against the linear one.
#[must_use]
pub fn measures(curved: &Curved) -> Measures {
    let (mesh, settings) = (&curved.mesh, certify::Settings::default());
    let proven = certify::measured(mesh, mesh.points(), Some(&curved.straight), &settings);
    // The certificate has sharpened the smallest.
    let proven = Measured { relative: curved.certificate.minima.clone(), ..proven };
    Measures::new(proven, &curved.smoothed.costs)
}

/// The report of a curved mesh, with the measures of its elements where they are taken.
#[must_use]
pub fn report(job: &Job, curved: &Curved, measures: &Measures, run: Run) -> Report {
    let mesh = &curved.mesh;
    let has_cad = |classification: &Classification| matches!(classification, Classification::Surface(_));
    let (grid_line_angles, (cells, patches)) =
        rayon::join(|| grid_line_angles(curved), || rayon::join(|| cells(curved), || patches(curved)));
    Report {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        run,
        units: Units::with_length((curved.cad_scale == 1.0).then(|| curved.cad_unit.clone())),
        input: Input {
            mesh: job.mesh.display().to_string(),
            cad: job.cad.display().to_string(),
            linkage: job.linkage.as_ref().map(|path| path.display().to_string()),
            cad_unit: curved.cad_unit.clone(),
            cad_scale: curved.cad_scale,
        },
        order: mesh.order().into(),
        plane: plane(curved),
        certified: curved.certificate.holds(),
        nodes: Nodes { linear: curved.linear_nodes, curved: mesh.points().len() },
        cells,
        patches,
        faces_without_cad: curved.association.faces.iter().filter(|own| !has_cad(own)).count(),
        off_cad: curved.off_cad.par_iter().map(|face| off_cad(curved, face)).collect(),
        open_faces: curved.open_faces.iter().map(|own| open_face(curved, own)).collect(),
        walls: walls(curved),
        grid_line_angles,
        certificate: CertificateReport::new(mesh, &curved.certificate),
        measures: spread(mesh, measures),
        lowest: lowest(mesh, measures),
        smoothing: SmoothingReport {
            lower_orders: curved.lower_orders.iter().map(LowerOrderReport::from).collect(),
            sweeps: curved.smoothed.sweeps,
            stopped: curved.smoothed.stopped,
            start: curved.smoothed.start.into(),
            end: curved.smoothed.end.into(),
        },
        sweeps: Vec::new(),
        projections: Projections { count: curved.wall.queries, unproven: curved.wall.unproven },
        notes: curved.mesh.notes().iter().chain(&curved.association.notes).cloned().collect(),
        seconds: curved.seconds.iter().map(|&(step, seconds)| StepReport { step: step.name(), seconds }).collect(),
        peak_memory: peak_memory(),
        threads: rayon::current_num_threads(),
    }
}

/// Sweeps that a report lists at most.
const SWEEPS: usize = 1000;

/// Sweeps as reports have them: all, or one of every so many, and the last.
#[must_use]
pub fn sweeps(all: &[Sweep]) -> Vec<SweepReport> {
    let step = all.len().div_ceil(SWEEPS).max(1);
    let row = |own: &Sweep| SweepReport {
        order: own.order,
        sweep: own.sweep,
        active_nodes: own.active_nodes,
        c_wcn: finite(own.costs[0]),
        c_jac: finite(own.costs[1]),
        inverted: own.inverted,
    };
    let last = all.last().filter(|_| !(all.len() - 1).is_multiple_of(step));
    all.iter().step_by(step).chain(last).map(row).collect()
}

fn plane(curved: &Curved) -> Option<PlaneReport> {
    let plane = curved.boundary.plane?;
    let on = |classification: &Classification| match classification {
        Classification::Surface(surface) => Some(*surface),
        _ => None,
    };
    let lying = curved.boundary.faces.iter().zip(&curved.association.faces).filter(|(_, on_cad)| on(on_cad).is_some());
    let walls: BTreeSet<EntityKey> = lying.map(|(face, _)| face.entity).collect();
    let surfaces: BTreeSet<usize> = curved.association.faces.iter().filter_map(on).collect();
    let edges = surfaces.iter().flat_map(|&surface| curved.association.surfaces[surface].group.entities());
    let curves = edges.collect::<BTreeSet<_>>().len();
    Some(PlaneReport { point: plane.point.to_array(), normal: plane.normal.to_array(), walls: walls.len(), curves })
}

fn walls(curved: &Curved) -> WallReport {
    let walls = &curved.walls;
    let failure = |finding: &FaceFinding| {
        let face = &curved.boundary.faces[finding.face];
        WallFailure {
            element: curved.boundary.tag(finding.face, &curved.mesh),
            entity: face.entity.to_string(),
            verdict: match finding.verdict {
                Verdict::Undecided => WallVerdict::Undecided,
                _ => WallVerdict::Folded,
            },
            position: finding.place.to_array(),
        }
    };
    let (faces, folded, failed) = (walls.faces, walls.folded(), walls.failures.len());
    let failures = walls.failures.iter().map(failure).collect();
    WallReport { faces, valid: faces - failed, folded, undecided: failed - folded, failures }
}

fn grid_line_angles(curved: &Curved) -> GridLinesReport {
    let lines = GridLines::new(&curved.mesh, &curved.straight);
    GridLinesReport { curved: lines.curved(curved.mesh.points()).into(), linear: lines.linear(&curved.straight).into() }
}

fn cells(curved: &Curved) -> Vec<CellReport> {
    let kinds: Vec<Cell> = curved.mesh.cells().iter().map(|own| own.cell).collect();
    let straight = straight_elements(&curved.mesh, &curved.straight);
    let tallies = curved.certificate.tallies();
    tallies
        .map(|(cell, tally)| {
            let own = || (0..kinds.len()).filter(|&e| kinds[e] == cell);
            let costs = || own().map(|e| &curved.smoothed.costs[e]);
            CellReport {
                cell: cell.name(),
                count: tally.elements,
                straight: own().filter(|&e| straight[e]).count(),
                c_wcn_min: costs().map(|c| c.c_wcn).fold(1.0, f64::min),
                c_wcn_mean: costs().map(|c| c.mean_c_wcn).sum::<f64>() / tally.elements as f64,
                c_jac_min: costs().map(|c| c.c_jac).fold(1.0, f64::min),
                j_over_jc_min: own().map(|e| curved.certificate.minima[e]).reduce(f64::min).and_then(finite),
                valid: tally.valid,
                invalid: tally.invalid,
                undecided: tally.undecided,
            }
        })
        .collect()
}

fn patches(curved: &Curved) -> Vec<PatchReport> {
    let mut entities: Vec<EntityKey> = curved.boundary.faces.iter().map(|f| f.entity).collect();
    entities.sort_unstable();
    entities.dedup();
    entities.into_iter().map(|entity| patch(curved, entity)).collect()
}

fn patch(curved: &Curved, entity: EntityKey) -> PatchReport {
    let faces: Vec<usize> =
        (0..curved.boundary.faces.len()).filter(|&f| curved.boundary.faces[f].entity == entity).collect();
    let classification = |&f: &usize| curved.association.faces[f];
    let on: BTreeSet<usize> = faces
        .iter()
        .filter_map(|f| if let Classification::Surface(s) = classification(f) { Some(s) } else { None })
        .collect();
    let distances: Vec<Distance> = faces.par_iter().filter_map(|&f| distance(curved, f)).collect();
    let distance = distances.into_iter().reduce(Distance::and);
    let corners = faces.iter().flat_map(|&f| &curved.boundary.corners[f]);
    PatchReport {
        entity: entity.to_string(),
        names: curved.mesh.names_of(entity),
        cad_groups: on.iter().map(|&s| curved.association.surfaces[s].label.clone()).collect(),
        faces: faces.len(),
        cad_distance_max: distance.map(|own| own.max),
        cad_distance_at: distance.map(|own| own.at.to_array()),
        cad_distance_rms: distance.map(|own| own.rms()),
        node_move_max: corners.map(|n| curved.wall.displacement(n.index()).length()).fold(0.0, f64::max),
    }
}

fn off_cad(curved: &Curved, off: &OffCadFace) -> OffCadReport {
    let face = &curved.boundary.faces[off.face];
    OffCadReport {
        element: curved.boundary.tag(off.face, &curved.mesh),
        entity: face.entity.to_string(),
        released: off.departure == Departure::Released,
        order: off.order().map(Order::get),
        fraction: off.fraction(),
        cad_distance: distance(curved, off.face).map(|own| own.max),
        node_distance: node_distance(curved, off.face),
        position: middle(curved, off.face),
    }
}

fn open_face(curved: &Curved, open: &OpenFace) -> OpenFaceReport {
    let (entity, tags) = (curved.boundary.faces[open.face].entity, curved.mesh.node_tags());
    OpenFaceReport {
        element: (!entity.is_unmarked()).then(|| curved.boundary.tag(open.face, &curved.mesh)),
        entity: entity.to_string(),
        nodes: curved.boundary.corners[open.face].iter().map(|n| tags[n.index()]).collect(),
        position: middle(curved, open.face),
        cause: open.doubt.to_string(),
        cad_distance: open.doubt.distance(),
        remedy: open.doubt.remedy(),
    }
}

/// The mean of a boundary face's corners.
fn middle(curved: &Curved, face: usize) -> [f64; 3] {
    let corners = &curved.boundary.corners[face];
    (curved.mesh.points_of(corners).sum::<DVec3>() / corners.len() as f64).to_array()
}

impl From<&LowerOrder> for LowerOrderReport {
    fn from(lower: &LowerOrder) -> LowerOrderReport {
        let &LowerOrder { order, sweeps, stopped, start, end } = lower;
        LowerOrderReport { order: order.into(), sweeps, stopped, start: start.into(), end: end.into() }
    }
}

impl From<Summary> for Costs {
    fn from(Summary { c_wcn, c_jac, inverted }: Summary) -> Costs {
        Costs { c_wcn, c_jac, inverted }
    }
}

impl From<GridLineAngles> for Angles {
    fn from(GridLineAngles { lines, angles, p99, max }: GridLineAngles) -> Angles {
        Angles { lines, angles, p99, max }
    }
}

/// `VmHWM` of `/proc/self/status`, in bytes.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().trim_end_matches(" kB").parse().ok()?;
    Some(kilobytes * 1024)
}
