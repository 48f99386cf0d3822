//! `$PhysicalNames`, which is text in all versions and encodings.

use std::io::{BufRead, Write};

use crate::formats::error::{Fault, Flaw};
use crate::formats::names::is_plain;
use crate::formats::part::Unwritten;
use crate::formats::scanner::Scanner;
use crate::mesh::PhysicalName;

/// Reads a count and as many lines `dimension tag "name"`.
pub(super) fn read<R: BufRead>(scanner: &mut Scanner<R>) -> Result<Vec<PhysicalName>, Flaw> {
    let count: u64 = scanner.number("the number of physical names")?;
    let mut names = Vec::new();
    for _ in 0..count {
        let line = scanner.full_line("a physical name")?;
        match parse(&line) {
            Some(name) => names.push(name),
            None => {
                let found = line.chars().take(40).collect();
                let what = "a line of dimension, tag and quoted name (fewer names than announced?)";
                return Err(scanner.flaw(Fault::Unexpected { what, found }));
            }
        }
    }
    Ok(names)
}

fn parse(line: &str) -> Option<PhysicalName> {
    let (open, close) = (line.find('"')?, line.rfind('"')?);
    let mut numbers = line[..open].split_ascii_whitespace();
    let dimension = numbers.next()?.parse().ok().filter(|&d| d <= 3)?;
    let tag = numbers.next()?.parse().ok()?;
    let whole = numbers.next().is_none() && close > open && line[close + 1..].trim().is_empty();
    whole.then(|| PhysicalName { dimension, tag, name: line[open + 1..close].into() })
}

/// Writes the section, where there are names.
///
/// # Errors
/// [`Unwritten::Inexpressible`] for a name with a line break or a quotation mark, for which the format has no other form.
pub(super) fn write(out: &mut impl Write, names: &[PhysicalName]) -> Result<(), Unwritten> {
    if names.is_empty() {
        return Ok(());
    }
    if let Some(PhysicalName { name, .. }) = names.iter().find(|own| !own.name.chars().all(is_plain)) {
        let reason = format!("the name {name:?} of a group has a line break or a quotation mark; rename the group");
        return Err(Unwritten::Inexpressible(reason));
    }
    writeln!(out, "$PhysicalNames\n{}", names.len())?;
    for PhysicalName { dimension, tag, name } in names {
        writeln!(out, "{dimension} {tag} \"{name}\"")?;
    }
    Ok(writeln!(out, "$EndPhysicalNames")?)
}
