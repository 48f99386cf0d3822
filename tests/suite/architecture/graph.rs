//! Circles and ranks in a graph of names.

use std::collections::{BTreeMap, BTreeSet};

/// Who imports whom.
pub type Graph = BTreeMap<String, BTreeSet<String>>;

/// All names that can be reached from `start`.
fn reached<'a>(graph: &'a Graph, start: &str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut left: Vec<&str> = graph.get(start).into_iter().flatten().map(String::as_str).collect();
    while let Some(name) = left.pop() {
        if found.insert(name) {
            left.extend(graph.get(name).into_iter().flatten().map(String::as_str));
        }
    }
    found
}

/// Sets of names that import each other, each ascending.
pub fn circles(graph: &Graph) -> BTreeSet<Vec<String>> {
    let names = || graph.keys().map(String::as_str);
    let reach: BTreeMap<&str, BTreeSet<&str>> = names().map(|name| (name, reached(graph, name))).collect();
    let together = |a: &str, b: &str| reach[a].contains(b) && reach.get(b).is_some_and(|of_b| of_b.contains(a));
    let on_circle = names().filter(|name| reach[name].contains(name));
    on_circle.map(|a| names().filter(|b| together(a, b)).map(str::to_owned).collect()).collect()
}

/// Length of the longest chain of imports below each name; the graph has no circle.
pub fn ranks(graph: &Graph) -> BTreeMap<String, usize> {
    let mut ranks: BTreeMap<String, usize> = graph.keys().map(|name| (name.clone(), 0)).collect();
    for _ in graph {
        for (name, imports) in graph {
            let rank = imports.iter().map(|import| ranks[import] + 1).max().unwrap_or(0);
            ranks.insert(name.clone(), rank);
        }
    }
    ranks
}
