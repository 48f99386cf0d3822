//! What needs neither mesh nor CAD beyond the document's own consistency: faces given twice, strings that are no path.

use linkage_schema::{Code, Document, Findings, ModelLinks, Origin};

use super::called;
use crate::associate::paths;

pub(super) fn check(document: &Document, models: &[&ModelLinks<'_>], findings: &mut Findings) {
    if models.is_empty() {
        findings
            .push(Code::EmptyElement, document.origin, || "MeshLink links nothing: it has no mesh model".to_owned());
    }
    for links in models {
        repeated_faces(links, findings);
        broken_strings(links, findings);
    }
}

fn repeated_faces(links: &ModelLinks<'_>, findings: &mut Findings) {
    let again = again(links);
    let mut number = 0;
    for sheet in &links.sheets {
        for link in &sheet.faces {
            let numbers = number..number + link.run.faces().len();
            number = numbers.end;
            let own =
                again.partition_point(|(n, _)| *n < numbers.start)..again.partition_point(|(n, _)| *n < numbers.end);
            let Some(&(first, before)) = again[own.clone()].first() else { continue };
            let place = first - numbers.start;
            let Some(face) = link.run.faces().nth(place) else { continue };
            findings.push_word(Code::RepeatedFace, link.run.origin, link.run.encoding.word(place * face.len()), || {
                let place = run_of(links, before).position().map_or_else(String::new, |at| format!(", at {at}"));
                let who = called("MeshSheet", sheet.name());
                format!("{} faces of {who} are already linked{place}; the first is {face:?}", own.len())
            });
        }
    }
}

/// The faces that were there before, each with the first of them; faces are counted through the model.
fn again(links: &ModelLinks<'_>) -> Vec<(usize, usize)> {
    let runs = links.sheets.iter().flat_map(|sheet| &sheet.faces);
    // Sorted rather than hashed: a third of the memory where there are millions.
    let mut faces: Vec<([u32; 4], u32)> = runs.flat_map(|link| link.run.faces()).map(key).zip(0..).collect();
    faces.sort_unstable();
    let alike = faces.chunk_by(|a, b| a.0 == b.0).filter(|alike| alike.len() > 1);
    let mut again: Vec<(usize, usize)> =
        alike.flat_map(|alike| alike[1..].iter().map(|(_, n)| (*n as usize, alike[0].1 as usize))).collect();
    again.sort_unstable();
    again
}

/// The place of the run that has a face.
fn run_of(links: &ModelLinks<'_>, number: usize) -> Origin {
    let mut end = 0;
    let mut runs = links.sheets.iter().flat_map(|sheet| &sheet.faces);
    let run = runs.find(|link| {
        end += link.run.faces().len();
        number < end
    });
    run.map_or(Origin::MADE, |link| link.run.origin)
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
                    "{} forms {} paths rather than one: the first leads from point {from} to point {to}, the next begins at {}",
                    called("MeshString", string.name()),
                    parts.len(),
                    second[0][0]
                )
            });
        }
    }
}
