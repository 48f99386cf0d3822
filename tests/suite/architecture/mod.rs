//! No circle of imports: between the modules of a crate, between the files of a folder, between a module and its parts.
//!
//! `use` lines and paths of the sources are followed to the file that defines the item. Comments, documentation and tests do not count, nor
//! does a module that only hands on what its parts define (`pub use`). A module and a part of it are a circle where the part takes
//! something that the module's own file defines, and that file uses the part.

mod graph;
mod imports;
mod source;
mod tokens;

use std::collections::BTreeSet;
use std::path::Path;

use graph::{Graph, circles, ranks};
use imports::{Import, imports};
use source::{Modules, Name};

/// Circles of files that are known, by folder and members: none is left.
const KNOWN: &[(&str, &[&str])] = &[];

/// Folders whose own file defines what its parts take, and uses these parts.
const OWN_FILES: &[&str] = &[
    "src/associate/document",
    "src/associate/infer", // tolerances and candidates, and the order in which the parts find them
    "src/validate",        // how things are called in findings
];

/// The name of a folder's own file in its graph.
const OWN: &str = ".";

fn read(folder: &str) -> (Modules, BTreeSet<Import>) {
    let modules = source::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let imports = imports(&modules);
    (modules, imports)
}

/// Who imports whom among the parts of one module and its own file.
fn inside(modules: &Modules, imports: &BTreeSet<Import>, of: &Name) -> Graph {
    let part = |name: &Name| {
        let rest = name.strip_prefix(of.as_slice())?;
        Some(rest.first().map_or(OWN, String::as_str).to_owned())
    };
    let mut graph: Graph = modules.keys().filter_map(part).map(|name| (name, BTreeSet::new())).collect();
    for (from, to) in imports {
        if let (Some(from), Some(to)) = (part(from), part(to))
            && from != to
        {
            graph.entry(from).or_default().insert(to);
        }
    }
    graph
}

/// Imports that make a circle, for the message.
fn evidence(imports: &BTreeSet<Import>, of: &Name, circle: &[String]) -> String {
    let part =
        |name: &Name| name.strip_prefix(of.as_slice()).map(|rest| rest.first().map_or(OWN, String::as_str).to_owned());
    let within = |name: &Name| part(name).filter(|part| circle.contains(part));
    let between = imports.iter().filter(|(from, to)| within(from).zip(within(to)).is_some_and(|(a, b)| a != b));
    between.map(|(from, to)| format!("\n    {} imports {}", from.join("::"), to.join("::"))).collect()
}

/// The graph without one name.
fn without(mut graph: Graph, name: &str) -> Graph {
    graph.remove(name);
    for imports in graph.values_mut() {
        imports.remove(name);
    }
    graph
}

/// Circles of a folder that no list knows, and how it is called.
fn unknown(folder: &str, of: &Name, graph: Graph) -> (String, Vec<Vec<String>>) {
    let place = [&[folder.to_owned()], of.as_slice()].concat().join("/");
    let known = |circle: &Vec<String>| KNOWN.iter().any(|(at, members)| *at == place && circle == members);
    let own = circles(&graph).into_iter().filter(|circle| circle.iter().any(|name| name == OWN));
    let own = own.filter(|_| !of.is_empty() && !OWN_FILES.contains(&place.as_str()));
    let parts = circles(&without(graph.clone(), OWN)).into_iter().filter(|circle| of.is_empty() || !known(circle));
    (place.clone(), parts.chain(own).collect())
}

fn check(folder: &str) {
    let (modules, imports) = read(folder);
    let mut found = Vec::new();
    for of in modules.keys() {
        let (place, circles) = unknown(folder, of, inside(&modules, &imports, of));
        let told = |circle: &Vec<String>| format!("  {place}: {}{}", circle.join(", "), evidence(&imports, of, circle));
        found.extend(circles.iter().map(told));
    }
    let top = without(inside(&modules, &imports, &Name::new()), OWN);
    println!("{folder}: rank, module, what it imports");
    let ranks = ranks(&top);
    let mut table: Vec<_> = top.iter().map(|(name, imports)| (ranks[name], name, imports)).collect();
    table.sort();
    for (rank, name, imports) in table {
        let imports: Vec<&str> = imports.iter().map(String::as_str).collect();
        println!("  {rank} {name:<12} {}", imports.join(" "));
    }
    assert!(found.is_empty(), "circles of imports:\n{}", found.join("\n"));
}

#[test]
fn the_program_has_no_circle_of_imports() {
    check("src");
}

#[test]
fn the_cad_crate_has_no_circle_of_imports() {
    check("cad/src");
}

#[test]
fn the_linkage_crate_has_no_circle_of_imports() {
    check("linkage-schema/src");
}

/// Lists of exceptions must not outlive them.
#[test]
fn known_circles_are_still_there() {
    let graph = |place: &str| {
        let folder =
            ["src", "cad/src", "linkage-schema/src"].into_iter().find(|folder| place.starts_with(folder)).unwrap();
        let of: Name = place[folder.len()..].split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect();
        let (modules, imports) = read(folder);
        inside(&modules, &imports, &of)
    };
    for (place, members) in KNOWN {
        assert!(circles(&without(graph(place), OWN)).iter().any(|circle| circle == members), "{place}: {members:?}");
    }
    for place in OWN_FILES {
        let own = |circle: &Vec<String>| circle.iter().any(|name| name == OWN);
        assert!(circles(&graph(place)).iter().any(own), "{place}");
    }
}
