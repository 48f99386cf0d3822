//! `.mapbc` files: boundary condition and name of each surface of a UGRID mesh.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::formats::error::{Error, Fault, Flaw, Place};
use crate::mesh::{Condition, Parts, PhysicalName};

/// A line: the surface's condition and name.
struct Surface {
    code: i32,
    name: Option<String>,
}

/// Largest `.mapbc` that is read, in bytes.
const LARGEST: u64 = 64 << 20;

/// Names the mesh's surfaces as the file beside it does; notes where there is none.
pub(super) fn apply(mesh: &mut Parts, path: &Path) -> Result<(), Error> {
    let Some(file) = beside(path) else {
        mesh.notes.push("no .mapbc file beside the mesh: its surfaces have numbers but no names".into());
        return Ok(());
    };
    let failed = |source| Error::Io { file: file.clone(), action: "read", source };
    let mut bytes = Vec::new();
    let content = cad::regular::open(&file).and_then(|input| input.take(LARGEST + 1).read_to_end(&mut bytes));
    content.map_err(failed)?;
    if bytes.len() as u64 > LARGEST {
        return Err(Error::Format { file, reason: "far too large for a list of surfaces".into() });
    }
    let text = crate::formats::names::text(&bytes);
    if text.split_whitespace().next().is_some_and(|word| word.parse::<u64>().is_err()) {
        let name = file.display();
        mesh.notes.push(format!(
            "{name}: not read, as it is not a list of surface number, condition and name (one of VGRID's?)"
        ));
        return Ok(());
    }
    let surfaces = parse(&text).map_err(|flaw| flaw.of(&file))?;
    name(mesh, &surfaces);
    Ok(())
}

/// `case.mapbc` or `case.lb8.mapbc` for `case.lb8.ugrid`.
pub(in crate::formats) fn beside(path: &Path) -> Option<PathBuf> {
    let first = path.with_extension("mapbc");
    let second = path.with_extension("").with_extension("mapbc");
    [second, first].into_iter().find(|file| file.is_file())
}

fn parse(text: &str) -> Result<BTreeMap<i32, Surface>, Flaw> {
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let flaw = |line, what, found: &str| {
        Flaw::new(Place::Line(line), Fault::Number { what, found: found.chars().take(40).collect() })
    };
    let Some((first, line)) = lines.next() else { return Ok(BTreeMap::new()) };
    let what = "the number of surfaces";
    let word = line.split_whitespace().next().unwrap_or_default();
    let announced: u64 = word.parse().map_err(|_| flaw(first, what, word))?;
    let mut surfaces = BTreeMap::new();
    for (number, line) in lines {
        let line = line.split(['!', '#']).next().unwrap_or_default();
        let mut words = line.split_whitespace();
        let Some(word) = words.next() else { continue };
        let surface = word.parse().map_err(|_| flaw(number, "a surface number", word))?;
        let word = words.next().unwrap_or_default();
        let code = word.parse().map_err(|_| flaw(number, "a boundary condition's number", word))?;
        surfaces.insert(surface, Surface { code, name: words.next().map(str::to_owned) });
    }
    if surfaces.len() as u64 != announced {
        let fault = Fault::Miscounted { what: "surfaces", announced, found: surfaces.len() as u64 };
        return Err(Flaw::new(Place::Line(first), fault));
    }
    Ok(surfaces)
}

/// Surfaces of one name become one group, with the number of the first of them.
fn name(mesh: &mut Parts, surfaces: &BTreeMap<i32, Surface>) {
    let mut groups: BTreeMap<&str, i32> = BTreeMap::new();
    let mut missing = Vec::new();
    for entity in mesh.entities.iter_mut().filter(|entity| entity.key.dimension == 2) {
        let key = entity.key;
        let Some(surface) = surfaces.get(&key.tag) else {
            missing.push(key.tag.to_string());
            continue;
        };
        let unnamed = format!("surface_{}", key.tag);
        let name = surface.name.clone().unwrap_or_else(|| unnamed.clone());
        mesh.conditions.push(Condition { entity: key, name, kind: kind(surface.code).into() });
        let Some(name) = &surface.name else { continue };
        let tag = *groups.entry(name).or_insert(key.tag);
        entity.physical_tags = vec![tag];
    }
    mesh.physical_names.extend(groups.into_iter().map(|(name, tag)| PhysicalName {
        dimension: 2,
        tag,
        name: name.to_owned(),
    }));
    mesh.physical_names.sort_by_key(|name| (name.dimension, name.tag));
    if !missing.is_empty() {
        mesh.notes.push(format!("the .mapbc file does not name surface {}", missing.join(", ")));
    }
}

/// The condition of a number of FUN3D's, in the words of CGNS.
fn kind(code: i32) -> &'static str {
    match code {
        4 | 4000..=4999 => "BCWallViscous",
        5 | 3000..=3999 => "BCWallInviscid",
        3 | 5000..=5050 => "BCFarfield",
        6021..=6023 | 6661..=6663 => "BCSymmetryPlane",
        5051..=5052 | 7012 | 7031 | 7032 => "BCOutflow",
        7011 | 7036 | 7100..=7105 => "BCInflow",
        _ => "UserDefined",
    }
}
