//! `$PhysicalNames`, which is text in all versions and encodings.

use std::io::{BufRead, Write};

use crate::formats::error::{Fault, Flaw};
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
    (numbers.next().is_none() && close > open).then(|| PhysicalName {
        dimension,
        tag,
        name: line[open + 1..close].into(),
    })
}

/// Writes the section, where there are names.
pub(super) fn write(out: &mut impl Write, names: &[PhysicalName]) -> std::io::Result<()> {
    if names.is_empty() {
        return Ok(());
    }
    writeln!(out, "$PhysicalNames\n{}", names.len())?;
    for PhysicalName { dimension, tag, name } in names {
        writeln!(out, "{dimension} {tag} \"{name}\"")?;
    }
    writeln!(out, "$EndPhysicalNames")
}
