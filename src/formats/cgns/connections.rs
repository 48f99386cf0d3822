//! Zones that touch: their points become one.

use rustc_hash::FxHashMap;

use super::fault::CgnsFault;
use super::labels;
use super::tree::Tree;
use super::zone::Zone;
use crate::formats::error::Flaw;

/// How far apart, as a part of a zone's size, points that are joined may be: what single precision leaves.
const SAME: f64 = 1e-5;

/// For each point of all zones, one after the other, the first point that it is one with.
pub(super) struct Joined {
    parents: Vec<usize>,
    /// What a user should know.
    pub(super) notes: Vec<String>,
}

impl Joined {
    /// The first of the points that this one is one with.
    pub(super) fn root(&mut self, mut point: usize) -> usize {
        while self.parents[point] != point {
            self.parents[point] = self.parents[self.parents[point]];
            point = self.parents[point];
        }
        point
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = a.min(b);
    }
}

/// Joins the points that zones list as common; where no zone lists any, those that coincide exactly.
pub(super) fn join(zones: &[Zone]) -> Result<Joined, Flaw> {
    let count = zones.last().map_or(0, |zone| zone.start + zone.points.len());
    let mut joined = Joined { parents: (0..count).collect(), notes: Vec::new() };
    let mut listed = false;
    for zone in zones {
        for parent in zone.tree.all(labels::CONNECTIVITY) {
            for node in parent.all(labels::GENERAL_CONNECTION).chain(parent.all(labels::DIRECT_CONNECTION)) {
                listed |= connection(zones, zone, node, &mut joined)?;
            }
        }
    }
    if !listed && zones.len() > 1 {
        coincident(zones, &mut joined);
    }
    Ok(joined)
}

/// Joins the points of one connection; false where it is of a kind that joins none.
fn connection(zones: &[Zone], zone: &Zone, node: &Tree, joined: &mut Joined) -> Result<bool, Flaw> {
    let location = node.child(labels::LOCATION).map_or_else(|| "Vertex".to_owned(), Tree::text);
    let lists = (node.named(labels::LIST, "PointList"), node.named(labels::LIST, "PointListDonor"));
    let periodic = node.child(labels::CONNECTION_PROPERTY).and_then(|property| property.child(labels::PERIODIC));
    if let Some(periodic) = periodic {
        joined.notes.push(format!(
            "{}: a periodic connection to {}{}; not taken over",
            node.path,
            node.text(),
            motion(periodic)
        ));
        return Ok(false);
    }
    let name = node.text();
    // The other zone is named alone or with its base.
    let short = name.rsplit('/').next().unwrap_or_default();
    let Some(donor) = zones.iter().find(|zone| zone.tree.name == short) else {
        return Err(node.flaw(CgnsFault::UnknownZone(name)));
    };
    if let (Some(grid), Some(other), labels::DIRECT_CONNECTION) = (&zone.grid, &donor.grid, node.label) {
        let pairs = grid.pairs(other, node)?;
        let apart = pairs.iter().map(|&(a, b)| zone.points[a].distance(donor.points[b])).fold(0.0, f64::max);
        let size = zone.points.iter().map(|x| x.distance(zone.points[0])).fold(0.0, f64::max);
        if apart > SAME * size {
            return Err(node.flaw(CgnsFault::Apart(apart)));
        }
        pairs.into_iter().for_each(|(a, b)| joined.join(zone.start + a, donor.start + b));
        return Ok(true);
    }
    let is_listed = zone.grid.is_none() && donor.grid.is_none() && location == "Vertex";
    let (Some(own), Some(donors), true) = (lists.0, lists.1, is_listed) else {
        joined.notes.push(format!("{}: a connection that is not node to node; ignored", node.path));
        return Ok(false);
    };
    let (points, others) = (own.ints()?, donors.ints()?);
    if points.len() != others.len() {
        return Err(node.flaw(CgnsFault::Unpaired { found: points.len(), donors: others.len() }));
    }
    for (a, b) in points.iter().zip(others.iter()) {
        let a = zone.point(a).map_err(|fault| own.flaw(fault))?;
        let b = donor.point(b).map_err(|fault| donors.flaw(fault))?;
        joined.join(a, b);
    }
    Ok(true)
}

/// How the other side of a periodic connection is moved, in words.
fn motion(periodic: &Tree) -> String {
    let told = |(name, what): (&str, &str)| {
        let values = periodic.named(labels::ARRAY, name)?.reals().ok()?.into_owned();
        let words: Vec<String> = values.iter().map(f64::to_string).collect();
        values.iter().any(|&x| x != 0.0).then(|| format!("{what} ({})", words.join(", ")))
    };
    let moves: Vec<String> =
        [("Translation", "moved by"), ("RotationAngle", "turned by")].into_iter().filter_map(told).collect();
    if moves.is_empty() { String::new() } else { format!(", {}", moves.join(", ")) }
}

fn coincident(zones: &[Zone], joined: &mut Joined) {
    let mut first: FxHashMap<[u64; 3], (usize, usize)> = FxHashMap::default();
    let mut common = 0;
    for (z, zone) in zones.iter().enumerate() {
        for (n, point) in zone.points.iter().enumerate() {
            let bits = point.to_array().map(|x| (x + 0.0).to_bits()); // -0 and 0 are one place
            let (other, known) = *first.entry(bits).or_insert((z, zone.start + n));
            // Points of one zone at one place are two on purpose.
            if other != z {
                joined.join(known, zone.start + n);
                common += 1;
            }
        }
    }
    joined.notes.push(format!("the zones list no common points; {common} points that coincide exactly were merged"));
}
