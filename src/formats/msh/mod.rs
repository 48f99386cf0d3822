//! Gmsh MSH, versions 4.1 and 2.2, as text and as bytes.
//!
//! A file is a row of sections `$Name` ... `$EndName`. Each section is read once, over a `Source` of
//! numbers that hides how they are encoded, and written once, over a `Sink`. Sections that say nothing of
//! the mesh itself (`$NodeData`, `$Comments`, ...) are passed over.

mod draft;
mod fault;
mod names;
pub(super) mod node_order;
mod node_tags;
mod outline;
mod read22;
mod read41;
mod sink;
mod source;
mod type_code;
mod views;
mod write22;
mod write41;

#[cfg(test)]
mod tests;

use std::io::{BufRead, Write};

use draft::Draft;
use fault::MshFault;
use sink::{ByteSink, Sink, TextSink};
use source::{Bytes, Text};

use super::detect::{Head, Verdict};
use super::error::{Fault, Flaw};
use super::format::{Format, Holds, Reader, Writer};
use super::loss::Loss;
use super::options::WriteOptions;
use super::part::Unwritten;
use super::scanner::Scanner;
use crate::element::{Cell, Order};
use crate::mesh::Mesh;

pub use super::options::{Encoding, Version};
pub use type_code::of as element_type;

/// Gmsh's own format.
pub(super) static FORMAT: Format = Format {
    name: "Gmsh MSH",
    endings: &["msh"],
    detect,
    reader: Some(Reader {
        holds: Holds { notes: "4.1 and 2.2, text and binary", ..HOLDS },
        read: |input, _| read(input.content, input.length).map_err(|flaw| flaw.of(input.path)),
    }),
    writer: Some(Writer {
        holds: Holds { notes: "4.1, `--msh-version 2.2`, `--ascii`; fields as views by `curve --msh-views`", ..HOLDS },
        loses: &[Loss::Conditions, Loss::Zones],
        held: None,
        write: |part, mesh, options| part.stream(|out| write(out, mesh, options)),
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: true, fields: false, notes: "" };

/// Whether a file begins with a section; Nastran's comments begin with a dollar too.
fn detect(head: &Head) -> Verdict {
    const FIRST: [&str; 3] = ["MeshFormat", "Comments", "NOD"];
    let lines = head.lines();
    let name = lines.first().and_then(|line| line.strip_prefix('$')).unwrap_or_default();
    let begins = FIRST.contains(&name) || SECTIONS.contains(&name);
    let holds = !name.is_empty() && lines.iter().any(|line| line == "$MeshFormat");
    if begins || holds { Verdict::ByContent } else { Verdict::No }
}

/// Reads a mesh from an MSH file's content of `length` bytes.
///
/// # Errors
/// The first [`Fault`] and its place. Memory stays within a small multiple of `length`, whatever the file says.
pub fn read(input: impl BufRead, length: u64) -> Result<Mesh, Flaw> {
    let mut scanner = Scanner::new(input, length);
    let header = Header::read(&mut scanner)?;
    scanner.binary = header.binary;
    let mut draft = Draft::default();
    let mut seen: Vec<&'static str> = Vec::new();
    while let Some(line) = scanner.line("a section's name")? {
        let Some(name) = line.strip_prefix('$') else {
            let found = line.chars().take(40).collect();
            return Err(scanner.flaw(Fault::Unexpected { what: "a section's name, as $Nodes", found }));
        };
        let Some(&section) = SECTIONS.iter().find(|&&section| section == name) else {
            draft.pass_over(name);
            scanner.skip_section(name)?;
            continue;
        };
        if seen.contains(&section) {
            return Err(scanner.flaw(MshFault::RepeatedSection(section)));
        }
        seen.push(section);
        if matches!(section, "Elements" | "Periodic") && !draft.has_nodes() {
            return Err(scanner.flaw(MshFault::SectionOrder { earlier: "Nodes", later: section }));
        }
        read_section(&mut scanner, header, section, &mut draft)?;
        end_section(&mut scanner, section)?;
    }
    if !draft.has_nodes() {
        return Err(scanner.flaw(MshFault::MissingSection("Nodes")));
    }
    if !seen.contains(&"Elements") {
        return Err(scanner.flaw(MshFault::MissingSection("Elements")));
    }
    draft.finish().map_err(|cause| scanner.flaw(cause))
}

/// Sections that say something of the mesh.
const SECTIONS: [&str; 7] =
    ["PhysicalNames", "Entities", "PartitionedEntities", "Nodes", "ParametricNodes", "Elements", "Periodic"];

/// What `$MeshFormat` says.
#[derive(Clone, Copy)]
struct Header {
    version: Version,
    binary: bool,
    swap: bool,
}

impl Header {
    fn read(scanner: &mut Scanner<impl BufRead>) -> Result<Header, Flaw> {
        let mut line = scanner.full_line("the header")?;
        while line != "$MeshFormat" {
            let Some(other) = line.strip_prefix('$').filter(|&name| name != "NOD") else {
                let what = "$MeshFormat (MSH version 1 is not read; save as 4.1)";
                return Err(scanner.flaw(Fault::Unexpected { what, found: line.chars().take(40).collect() }));
            };
            scanner.skip_section(other)?;
            line = scanner.full_line("the header")?;
        }
        let line = scanner.full_line("the header")?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let words = if words.len() == 3 { words } else { Vec::new() };
        let (Some(&version), Some(binary), Some(Ok(size))) =
            (words.first(), words.get(1).filter(|w| matches!(**w, "0" | "1")), words.get(2).map(|w| w.parse()))
        else {
            let found = line.chars().take(40).collect();
            return Err(scanner.flaw(Fault::Unexpected { what: "version, 0 or 1, and data size", found }));
        };
        let version = match version {
            "4.1" => Version::V4_1,
            "2" | "2.0" | "2.1" | "2.2" => Version::V2_2,
            other => return Err(scanner.flaw(MshFault::Version(other.chars().take(40).collect()))),
        };
        if size != 8 {
            return Err(scanner.flaw(MshFault::DataSize(size)));
        }
        let mut header = Header { version, binary: *binary == "1", swap: false };
        if header.binary {
            scanner.end_line("the byte-order mark")?;
            header.swap = match u32::from_le_bytes(scanner.bytes("the byte-order mark")?) {
                1 => false,
                0x0100_0000 => true,
                other => return Err(scanner.flaw(MshFault::ByteOrder(other))),
            };
        }
        end_section(scanner, "MeshFormat")?;
        Ok(header)
    }
}

/// Reads one section's content.
fn read_section(
    scanner: &mut Scanner<impl BufRead>,
    header: Header,
    section: &'static str,
    draft: &mut Draft,
) -> Result<(), Flaw> {
    match (header.version, section) {
        (_, "PhysicalNames") => {
            draft.parts.physical_names = names::read(scanner)?;
            Ok(())
        }
        (Version::V4_1, _) if header.binary => {
            scanner.end_line("a section")?;
            read_section41(&mut Bytes { scanner, swap: header.swap }, section, draft)
        }
        (Version::V4_1, _) => read_section41(&mut Text(scanner), section, draft),
        (Version::V2_2, "Periodic") => read22::periodic(scanner, draft),
        (Version::V2_2, "Nodes" | "ParametricNodes") => {
            let count = read22::count(scanner, "the number of nodes", header.binary)?;
            let parametric = section == "ParametricNodes";
            if header.binary {
                read22::nodes(&mut Bytes { scanner, swap: header.swap }, draft, count, parametric)
            } else {
                read22::nodes(&mut Text(scanner), draft, count, parametric)
            }
        }
        (Version::V2_2, "Elements") => {
            let count = read22::count(scanner, "the number of elements", header.binary)?;
            if header.binary {
                read22::elements_binary(&mut Bytes { scanner, swap: header.swap }, draft, count)
            } else {
                read22::elements_text(&mut Text(scanner), draft, count)
            }
        }
        (Version::V2_2, other) => {
            Err(scanner.flaw(Fault::Unexpected { what: "a section of MSH 2.2", found: other.into() }))
        }
    }
}

fn read_section41(source: &mut impl source::Source, section: &'static str, draft: &mut Draft) -> Result<(), Flaw> {
    match section {
        "Entities" => read41::entities(source, draft),
        "PartitionedEntities" => read41::partitioned_entities(source, draft),
        "Nodes" => read41::nodes(source, draft),
        "Elements" => read41::elements(source, draft),
        "Periodic" => read41::periodic(source, draft),
        other => Err(source.flaw(Fault::Unexpected { what: "a section of MSH 4.1", found: other.into() })),
    }
}

fn end_section(scanner: &mut Scanner<impl BufRead>, section: &'static str) -> Result<(), Flaw> {
    let line = scanner.full_line("a section's end")?;
    if line.strip_prefix("$End") == Some(section) {
        return Ok(());
    }
    let found = line.chars().take(40).collect();
    Err(scanner.flaw(MshFault::SectionEnd { section: section.into(), found }))
}

/// Writes a mesh, and fields as views. Equal meshes make equal bytes.
fn write(out: &mut (impl Write + Send), mesh: &Mesh, options: &WriteOptions<'_>) -> Result<(), Unwritten> {
    let binary = options.msh_encoding == Encoding::Binary;
    write!(out, "$MeshFormat\n{} {} 8\n", options.msh_version.name(), u8::from(binary))?;
    if binary {
        out.write_all(&1_i32.to_le_bytes())?;
        out.write_all(b"\n")?;
    }
    out.write_all(b"$EndMeshFormat\n")?;
    names::write(out, mesh.physical_names())?;
    if binary {
        write_sections(&mut ByteSink(out), mesh, options)
    } else {
        write_sections(&mut TextSink::new(out), mesh, options)
    }
}

fn write_sections(sink: &mut impl Sink, mesh: &Mesh, options: &WriteOptions<'_>) -> Result<(), Unwritten> {
    match options.msh_version {
        Version::V4_1 => write41::write(sink, mesh),
        Version::V2_2 => write22::write(sink, mesh),
    }?;
    views::write(sink, mesh, options.fields)
}
