//! What sagitta makes of each file named on stdin, a line each: `ok` with figures and notes, or `no` with the refusal. For `agree.py`,
//! whose own parsers count the same; a process for all files, as starting one takes longer than reading a small mesh.

use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};

use glam::DVec3;
use sagitta::formats;
use sagitta::mesh::Mesh;

fn main() -> io::Result<()> {
    let mut out = io::stdout().lock();
    for path in io::stdin().lock().lines() {
        match formats::read(path?.as_ref()) {
            Ok(mesh) => writeln!(out, "ok {}\t{}", figures(&mesh), mesh.notes().join("; ").replace('\n', " "))?,
            Err(error) => writeln!(out, "no {}", error.to_string().replace('\n', " "))?,
        }
        out.flush()?;
    }
    Ok(())
}

/// Sums that neither the order of elements nor that of an element's nodes changes: the points, their coordinates; of each kind of
/// element the number, the coordinates of all nodes, and the squares of each element's; the sizes of the entities.
fn figures(mesh: &Mesh) -> String {
    let sum: DVec3 = mesh.points().iter().copied().sum();
    let mut text =
        format!("order {} points {} {:?} {:?} {:?}", mesh.order().get(), mesh.points().len(), sum.x, sum.y, sum.z);
    let mut kinds: BTreeMap<&str, (usize, f64, f64)> = BTreeMap::new();
    let mut entities: BTreeMap<(usize, i32), usize> = BTreeMap::new();
    for block in mesh.blocks().iter().filter(|block| block.cell.dimension() > 0) {
        *entities.entry((block.cell.dimension(), block.entity.tag)).or_default() += block.tags.len();
        for nodes in block.elements(mesh.order()) {
            let own: DVec3 = mesh.points_of(nodes).sum();
            let kind = kinds.entry(block.cell.name()).or_default();
            *kind = (kind.0 + 1, kind.1 + own.x + 2.0 * own.y + 3.0 * own.z, kind.2 + own.length_squared());
        }
    }
    for (kind, (count, sum, squares)) in kinds {
        text += &format!(" {kind} {count} {sum:?} {squares:?}");
    }
    let mut sizes: Vec<String> =
        entities.iter().filter(|own| *own.1 > 0).map(|((dimension, _), size)| format!("{dimension}:{size}")).collect();
    sizes.sort();
    text + " entities " + &sizes.join(",")
}
