//! OpenFOAM's meshes, read: the folder `constant/polyMesh` with points, faces, their owners and neighbours, and patches.
//!
//! Cells are what faces enclose; those that are tets, pyramids, prisms and hexes are read. After the user guide, section "Mesh
//! description".

mod fault;
mod read;
mod tokens;

use std::path::{Path, PathBuf};

use super::detect::{Head, Refusal, Verdict};
use super::format::{Format, Holds, Reader};
use crate::element::{Cell, Order};

/// The format of OpenFOAM.
pub(super) static FORMAT: Format = Format {
    name: "OpenFOAM",
    endings: &["foam"],
    detect,
    reader: Some(Reader {
        holds: Holds {
            highest: Order::LINEAR,
            cells: &[Cell::Triangle, Cell::Quad, Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex],
            dimensions: &[3],
            names: true,
            fields: false,
            notes: "the case's folder, `constant/polyMesh`, its file `faces`, or an empty file `NAME.foam` in the case; text and binary; \
                    no general polyhedra",
        },
        read: |input, options| read::read(input.path, options.memory()),
    }),
    writer: None,
};

/// The file of faces that a folder or file stands for, where it is a case.
pub(super) fn faces(path: &Path) -> Option<PathBuf> {
    let own = |folder: &Path| Some(folder.join("faces")).filter(|faces| faces.is_file());
    if path.is_dir() {
        return own(&path.join("constant/polyMesh")).or_else(|| own(path).filter(|_| path.ends_with("polyMesh")));
    }
    let is_mark = path.extension().is_some_and(|own| own.eq_ignore_ascii_case("foam"));
    if is_mark { own(&path.parent()?.join("constant/polyMesh")) } else { None }
}

/// The files of a mesh.
const FILES: [&str; 5] = ["points", "faces", "owner", "neighbour", "boundary"];

/// The files that are read with one that a case stands for, or that is its file of faces.
pub(super) fn files(path: &Path) -> Vec<PathBuf> {
    let own = faces(path).or_else(|| path.ends_with("faces").then(|| path.to_path_buf()));
    let Some(folder) = own.as_deref().and_then(Path::parent) else { return Vec::new() };
    FILES.iter().map(|name| folder.join(name)).filter(|file| file != path && file.is_file()).collect()
}

fn detect(head: &Head) -> Verdict {
    let lines = head.lines();
    if !lines.iter().any(|line| line == "FoamFile") {
        return Verdict::No;
    }
    let class = lines.iter().find_map(|line| line.strip_prefix("class")).map(|rest| rest.trim().trim_end_matches(';'));
    match class {
        Some("faceList" | "faceCompactList") => Verdict::ByContent,
        _ => Verdict::Refused(Refusal::unread(
            "a file of an OpenFOAM case, but not its mesh; give the case's folder, or the file constant/polyMesh/faces",
        )),
    }
}
