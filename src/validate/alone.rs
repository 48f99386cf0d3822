//! What needs neither mesh nor CAD beyond the document's own consistency: faces given twice, strings that are no path.

use std::collections::hash_map::Entry;

use linkage_schema::{Code, Findings, ModelLinks, Origin};
use rustc_hash::FxHashMap;

use super::called;
use crate::associate::paths;

pub(super) fn check(models: &[&ModelLinks<'_>], findings: &mut Findings) {
    for links in models {
        repeated_faces(links, findings);
        broken_strings(links, findings);
    }
}

fn repeated_faces(links: &ModelLinks<'_>, findings: &mut Findings) {
    let mut seen: FxHashMap<[u32; 4], Origin> = FxHashMap::default();
    for sheet in &links.sheets {
        for link in &sheet.faces {
            let mut again = Vec::new();
            for (number, face) in link.run.faces().enumerate() {
                match seen.entry(key(face)) {
                    Entry::Occupied(first) => again.push((number, face, *first.get())),
                    Entry::Vacant(vacant) => {
                        vacant.insert(link.run.origin);
                    }
                }
            }
            let Some(&(number, face, first)) = again.first() else { continue };
            findings.push_word(
                Code::RepeatedFace,
                link.run.origin,
                link.run.encoding.word(number * face.len()),
                || {
                    let place = first.position().map_or_else(String::new, |at| format!(", at {at}"));
                    let who = called("MeshSheet", sheet.name());
                    format!("{} faces of {who} are linked before{place}; the first is {face:?}", again.len())
                },
            );
        }
    }
}

/// Indices in rising order, filled up with zeros, which no face has.
fn key(face: &[u32]) -> [u32; 4] {
    let mut key = [0; 4];
    key.iter_mut().zip(face).for_each(|(slot, &index)| *slot = index);
    key.sort_unstable();
    key
}

fn broken_strings(links: &ModelLinks<'_>, findings: &mut Findings) {
    for string in &links.strings {
        let edges: Vec<[u32; 2]> = string.edges.iter().flat_map(|link| link.run.edges()).collect();
        let parts = paths(&edges);
        if let [first, second, ..] = &parts[..] {
            let [from, to] = [first[0][0], first[first.len() - 1][1]];
            findings.push(Code::BrokenString, string.string.origin, || {
                format!(
                    "{} is {} paths rather than one: the first leads from point {from} to point {to}, the next begins at {}",
                    called("MeshString", string.name()),
                    parts.len(),
                    second[0][0]
                )
            });
        }
    }
}
