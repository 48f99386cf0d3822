//! Files that are not read: what they are, and what to do.

use super::detect::{Head, Refusal};
use super::registry::readable;

/// A format that is not read.
struct Foreign {
    /// What it is called, with its article.
    name: &'static str,
    /// What brings its meshes into a format that is read.
    remedy: &'static str,
    is: fn(&Head) -> bool,
}

const MESHIO: &str = "convert it: meshio convert IN OUT.vtu";

/// Meshes, the most telling marks first.
const MESHES: &[Foreign] = &[
    #[cfg(not(feature = "cgns"))]
    Foreign {
        name: "a CGNS file (HDF5)",
        remedy: "build this program with the Cargo feature cgns",
        is: |head| head.bytes.starts_with(b"\x89HDF\r\n\x1a\n"),
    },
    Foreign {
        name: "an I-deas universal file (UNV)",
        remedy: "convert it: gmsh IN.unv -save -format msh41 -o OUT.msh",
        is: |head| {
            let lines = head.lines();
            lines.len() > 1 && lines[0] == "-1" && lines[1].parse::<u32>().is_ok()
        },
    },
    Foreign {
        name: "a netCDF file, as Exodus meshes are",
        remedy: MESHIO,
        is: |head| matches!(head.bytes, [b'C', b'D', b'F', 1 | 2 | 5, ..]),
    },
    Foreign {
        name: "a Fluent mesh",
        remedy: "export the mesh as CGNS",
        is: |head| matches!(head.text, [b'(', b'0'..=b'9', b' ' | b'0'..=b'9', ..]),
    },
    Foreign {
        name: "a Gambit neutral file",
        remedy: "export the mesh as CGNS",
        is: |head| first(head, "CONTROL INFO"),
    },
    Foreign { name: "a Netgen mesh", remedy: MESHIO, is: |head| first(head, "mesh3d") },
    Foreign {
        name: "a Nastran bulk data file",
        remedy: "convert it: gmsh IN.bdf -save -format msh41 -o OUT.msh",
        is: is_nastran,
    },
    Foreign {
        name: "an STL file, which holds triangles of a surface without its CAD",
        remedy: "give a volume mesh, and the CAD as STEP or IGES",
        is: |head| (head.text.starts_with(b"solid") && holds(head, b"facet")) || ends(head, "stl"),
    },
    Foreign {
        name: "a compressed file",
        remedy: "unpack it first",
        is: |head| matches!(head.bytes, [0x1f, 0x8b, ..] | [b'P', b'K', 3, 4, ..] | [0xfd, b'7', b'z', b'X', b'Z', ..]),
    },
    Foreign {
        name: "an Abaqus input file",
        remedy: MESHIO,
        is: |head| {
            let lines = head.lines();
            let first = lines.iter().find(|line| !line.is_empty() && !line.starts_with("**"));
            first.is_some_and(|line| matches!(line.as_bytes(), [b'*', b'A'..=b'Z' | b'a'..=b'z', ..]))
        },
    },
    Foreign {
        name: "a Tecplot file",
        remedy: "export the mesh as CGNS",
        is: |head| head.bytes.starts_with(b"#!TD") || first(head, "TITLE") || first(head, "VARIABLES"),
    },
    Foreign { name: "an XDMF file", remedy: MESHIO, is: |head| head.text.starts_with(b"<") && holds(head, b"<Xdmf") },
];

/// Lines of numbers in fields of 8 columns, or with commas; comments begin with a dollar.
fn is_nastran(head: &Head) -> bool {
    const CARDS: [&str; 9] = ["GRID", "CTETRA", "CHEXA", "CPENTA", "CPYRAM", "CTRIA3", "CQUAD4", "PSOLID", "PSHELL"];
    let lines = head.lines();
    let card = |line: &String| {
        let word = line.split([' ', ',', '*', '\t']).next().unwrap_or_default();
        word.len() < line.len() && CARDS.iter().any(|card| word.eq_ignore_ascii_case(card))
    };
    let control = |line: &String| ["BEGIN BULK", "CEND"].iter().any(|word| line.eq_ignore_ascii_case(word));
    let comment = lines.first().is_some_and(|line| line.starts_with('$'));
    lines.iter().any(|line| card(line) || control(line))
        || (comment && ["bdf", "nas", "fem"].iter().any(|name| ends(head, name)))
}

/// Whether the file's name has an ending.
fn ends(head: &Head, ending: &str) -> bool {
    head.path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// Whether the first line begins with a word.
fn first(head: &Head, word: &str) -> bool {
    head.lines().first().is_some_and(|line| line.starts_with(word))
}

fn holds(head: &Head, word: &[u8]) -> bool {
    head.bytes.windows(word.len()).any(|window| window == word)
}

/// What a file of none of the known formats is, where that can be said.
pub(super) fn refusal(head: &Head) -> Option<Refusal> {
    if let Some(Foreign { name, remedy, .. }) = MESHES.iter().find(|format| (format.is)(head)) {
        return Some(Refusal::unread(format!("{name}, which is not read; {remedy}")));
    }
    if head.text.starts_with(b"ISO-10303-21") {
        return Some(Refusal::other("a STEP file, which is CAD, not a mesh"));
    }
    let xml = head.text.starts_with(b"<");
    xml.then(|| Refusal::other(format!("an XML file, but not a VTU or Nektar++ mesh; {} are read", readable("and"))))
}
