//! A mesh from the files of a case.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::fault::FoamFault;
use super::tokens::Tokens;
use crate::element::Cell;
use crate::formats::assembly::{Assembly, node_of};
use crate::formats::error::{Error, Flaw, Place};
use crate::formats::from_faces::{self, Faces};
use crate::mesh::{Condition, EntityKey, Mesh, NodeId};

/// Bytes of memory that a mesh takes for each byte of its files, at least.
const MEMORY_OF_FILE: u64 = 2;

/// A patch: its faces, counted from 0.
struct Patch {
    name: String,
    kind: String,
    neighbour: Option<String>,
    first: usize,
    end: usize,
}

/// Reads the mesh whose file of faces is given; it may take `memory` bytes.
///
/// # Errors
/// [`Error`], with the file at fault.
pub(super) fn read(faces_file: &Path, memory: u64) -> Result<Mesh, Error> {
    let file = |name: &str| faces_file.with_file_name(name);
    let mut left = memory / MEMORY_OF_FILE;
    let mut content = |path: &PathBuf| {
        let failed = |source| Error::Io { file: path.clone(), action: "read", source };
        let mut file = cad::regular::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        left = left.checked_sub(length).ok_or_else(|| Error::Format {
            file: path.clone(),
            reason: format!(
                "reading the case takes more than the limit of {} MB; raise it (--memory-limit)",
                memory >> 20
            ),
        })?;
        let mut bytes = Vec::new();
        file.by_ref().take(length).read_to_end(&mut bytes).map_err(failed)?;
        Ok(bytes)
    };
    let path = file("points");
    let points = Tokens::new(&content(&path)?, &["vectorField", "pointField"]).and_then(|mut own| own.points());
    let points = points.map_err(|flaw| flaw.of(&path))?;
    let mut assembly = Assembly::new(points).map_err(|fault| Flaw::new(Place::Line(1), fault).of(&path))?;
    let bytes = content(&faces_file.to_path_buf())?;
    let classes = ["faceList", "faceCompactList"];
    let faces = Tokens::new(&bytes, &classes).and_then(|mut own| nodes(&mut own, assembly.parts.points.len()));
    let faces = faces.map_err(|flaw| flaw.of(faces_file))?;
    let list = |bytes: &[u8], path: &Path, what| {
        Tokens::new(bytes, &["labelList"]).and_then(|mut own| own.whole(what)).map_err(|flaw| flaw.of(path))
    };
    let [owner, neighbour] = [file("owner"), file("neighbour")];
    let owners = list(&content(&owner)?, &owner, "owners")?;
    let neighbours = list(&content(&neighbour)?, &neighbour, "neighbours")?;
    let path = file("boundary");
    let patches = patches(&content(&path)?, faces.len()).map_err(|flaw| flaw.of(&path))?;
    let told = |fault: FoamFault| Flaw::new(Place::Line(1), fault).of(&owner);
    let cells = enclosed(&faces, &owners, &neighbours).map_err(told)?;
    put_together(&mut assembly, &cells, &faces, &patches).map_err(told)?;
    assembly.finish().map_err(|fault| Flaw::new(Place::Line(1), fault).of(faces_file))
}

/// The corners of the faces.
fn nodes(tokens: &mut Tokens, points: usize) -> Result<Faces, Flaw> {
    let faces = tokens.faces()?;
    let mut all = Vec::with_capacity(faces.len());
    for (n, face) in faces.iter().enumerate() {
        let node = |&number: &i64| node_of(points, number, 0, n as u64).map_err(|fault| tokens.flaw(fault));
        all.push(face.iter().map(node).collect::<Result<Vec<NodeId>, Flaw>>()?);
    }
    Ok(all)
}

/// The faces round each cell, their normals outward.
fn enclosed(faces: &Faces, owners: &[i64], neighbours: &[i64]) -> Result<Vec<Faces>, FoamFault> {
    if owners.len() != faces.len() {
        return Err(FoamFault::Owners { owners: owners.len(), faces: faces.len() });
    }
    if neighbours.len() > faces.len() {
        return Err(FoamFault::Neighbours { neighbours: neighbours.len(), faces: faces.len() });
    }
    // Every cell has four faces or more, and is the owner of one at least where all are numbered.
    let count = owners.iter().chain(neighbours).copied().max().unwrap_or(-1) + 1;
    let count = usize::try_from(count).ok().filter(|&count| count <= faces.len()).unwrap_or(faces.len());
    let mut cells: Vec<Faces> = vec![Vec::new(); count];
    for (n, face) in faces.iter().enumerate() {
        let unknown = |what, wrong| FoamFault::Unknown { face: n, what, wrong, count };
        let place =
            |what, number: i64| usize::try_from(number).ok().filter(|&own| own < count).ok_or(unknown(what, number));
        cells[place("owner", owners[n])?].push(face.clone());
        if let Some(&own) = neighbours.get(n).filter(|&&own| own >= 0) {
            cells[place("neighbour", own)?].push(face.iter().rev().copied().collect());
        }
    }
    Ok(cells)
}

/// Cells and patches as elements.
fn put_together(assembly: &mut Assembly, cells: &[Faces], faces: &Faces, patches: &[Patch]) -> Result<(), FoamFault> {
    let found: Vec<Option<(Cell, Vec<NodeId>)>> = cells.iter().map(from_faces::cell).collect();
    if let Some(cell) = found.iter().position(Option::is_none) {
        let others = found.iter().filter(|own| own.is_none()).count() - 1;
        let nodes: Vec<NodeId> = cells[cell].iter().flatten().copied().collect();
        let at = from_faces::place(&assembly.parts.points, &nodes);
        return Err(FoamFault::Polyhedron { cell, at, faces: from_faces::told(&cells[cell]), others });
    }
    for (cell, corners) in found.iter().flatten() {
        assembly.push(*cell, EntityKey::new(3, 1), corners);
    }
    for (patch, tag) in patches.iter().zip(1..) {
        let key = EntityKey::new(2, tag);
        let group = assembly.group(2, &patch.name, Some(tag));
        assembly.entity(key, vec![group]);
        let condition = Condition { entity: key, name: patch.name.clone(), kind: patch.kind.clone() };
        assembly.parts.conditions.push(condition);
        for face in &faces[patch.first..patch.end] {
            let side = if face.len() == 3 { Cell::Triangle } else { Cell::Quad };
            assembly.push(side, key, face);
        }
        if let Some(neighbour) = &patch.neighbour {
            let note = format!(
                "the patch {} is periodic with {neighbour}; which nodes correspond is not taken over",
                patch.name
            );
            assembly.parts.notes.push(note);
        }
    }
    Ok(())
}

/// The patches of a mesh of so many faces.
fn patches(bytes: &[u8], faces: usize) -> Result<Vec<Patch>, Flaw> {
    let mut tokens = Tokens::new(bytes, &["polyBoundaryMesh"])?;
    let count = tokens.begin("patches", 4)?;
    let mut patches = Vec::new();
    while let Some(name) = tokens.name()? {
        tokens.expect("{")?;
        let entries = tokens.entries()?;
        let entry = |key: &str| entries.iter().find(|(own, _)| own == key).map(|(_, value)| value.clone());
        let number = |entry_name: &'static str| {
            let value = entry(entry_name).and_then(|value| value.parse::<i64>().ok());
            value.ok_or_else(|| tokens.flaw(FoamFault::Entry { name: name.clone(), entry: entry_name }))
        };
        let (first, own) = (number("startFace")?, number("nFaces")?);
        let last = first.saturating_add(own);
        let range = usize::try_from(first).ok().zip(usize::try_from(last).ok()).filter(|&(a, b)| a <= b && b <= faces);
        let Some((first, end)) = range else {
            return Err(tokens.flaw(FoamFault::Patch { name, first, last: last.saturating_sub(1), count: faces }));
        };
        let kind = entry("type").unwrap_or_default();
        patches.push(Patch { name, kind, neighbour: entry("neighbourPatch"), first, end });
    }
    if patches.len() != count {
        let (announced, found) = (count as u64, patches.len() as u64);
        return Err(tokens.flaw(crate::formats::error::Fault::Miscounted { what: "patches", announced, found }));
    }
    Ok(patches)
}
