//! PLOT3D grids, read: structured blocks, whose cells become hexes and whose six sides become patches.
//!
//! Neither the file nor its name says how the numbers are written; the sizes that each way would need tell. Points of block
//! sides that coincide exactly become one node, so that blocks join and O-grids close; a side's face that two cells share is
//! no boundary.

mod blocks;

use std::io::BufRead;

use super::detect::Verdict;
use super::error::{Error, Fault, Flaw};
use super::format::{Format, Holds, Input, Reader};
use super::grid_layout::GridLayout;
use super::numbers::{Encoding, Numbers};
use super::options::ReadOptions;
use crate::element::{Cell, Order};
use crate::mesh::Mesh;
use blocks::Block;

/// Structured grids of many codes.
pub(super) static FORMAT: Format = Format {
    name: "PLOT3D",
    endings: &["x", "xyz", "p3d", "p3dfmt", "p3dbin", "plot3d", "g", "grd", "gin"],
    detect: |head| if FORMAT.is_name(head.path) { Verdict::ByName } else { Verdict::No },
    reader: Some(Reader {
        holds: Holds {
            highest: Order::LINEAR,
            cells: &[Cell::Quad, Cell::Hex],
            dimensions: &[3],
            names: false,
            fields: false,
            notes: "blocks as hexes; text, C and Fortran binary of either byte order and precision, one or several blocks, iblank",
        },
        read,
    }),
    writer: None,
};

/// A text may hold this many numbers for each of its bytes, where repeated ones are written once (`100*0.0`).
const REPEATED: usize = 16;

/// Reads a mesh.
///
/// # Errors
/// [`Error::Format`] where no way to write the numbers fits the length; [`Error::Content`].
fn read(input: Input, options: &ReadOptions) -> Result<Mesh, Error> {
    let Input { path, length, head, content } = input;
    let flaw = |flaw: Flaw| flaw.of(path);
    if head.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace()) {
        return text(&mut Numbers::new(content, length, Encoding::Text), &head).map_err(flaw);
    }
    let refused = |reason| Error::Format { file: path.to_path_buf(), reason };
    let kind = kind(&GridLayout::fitting(&head, length), options.grid_layout).map_err(refused)?;
    binary(&mut Numbers::new(content, length, Encoding::Bytes(kind.layout)), kind).map_err(flaw)
}

/// The way of writing that was asked for, or the only one that fits.
///
/// # Errors
/// What to tell the user.
fn kind(fitting: &[GridLayout], asked: Option<GridLayout>) -> Result<GridLayout, String> {
    match (fitting, asked) {
        ([], _) => {
            Err("its length fits no PLOT3D grid of three dimensions, single or double precision, with or without \
                        iblank, in C's or Fortran's records of either byte order: it is cut off, or not a grid file"
                .into())
        }
        (all, Some(asked)) if all.contains(&asked) => Ok(asked),
        (&[only], None) => Ok(only),
        (all, asked) => {
            let names: Vec<String> = all.iter().map(GridLayout::to_string).collect();
            let asked = asked.map_or_else(String::new, |asked| format!(", not {asked}"));
            Err(format!(
                "its length fits a PLOT3D grid that is written as {}{asked}; say which (--plot3d-layout)",
                names.join(" or as ")
            ))
        }
    }
}

fn binary(numbers: &mut Numbers<impl BufRead>, kind: GridLayout) -> Result<Mesh, Flaw> {
    let mut count = 1;
    if kind.several {
        numbers.begin_record("the number of blocks")?;
        count = numbers.int("the number of blocks")?;
        numbers.end_record("the number of blocks", true)?;
    }
    let count = numbers.checked(count, "blocks", 3, 0)?;
    numbers.begin_record("the blocks' sizes")?;
    let mut blocks = Vec::with_capacity(count);
    for _ in 0..count {
        blocks.push(size(numbers)?);
    }
    numbers.end_record("the blocks' sizes", true)?;
    for block in &mut blocks {
        numbers.begin_record("a block")?;
        block.allocate(numbers.checked(block.count() as i64, "points", 0, 3)?);
        for axis in 0..3 {
            for n in 0..block.points.len() {
                block.points[n][axis] = numbers.real("a coordinate")?;
            }
        }
        if kind.blanks {
            for _ in 0..block.points.len() {
                block.blanked += usize::from(numbers.int("iblank")? == 0);
            }
        }
        numbers.end_record("a block", true)?;
    }
    blocks::mesh(blocks).map_err(|fault| numbers.flaw(fault))
}

fn size(numbers: &mut Numbers<impl BufRead>) -> Result<Block, Flaw> {
    let mut size = [0; 3];
    for n in &mut size {
        let value = numbers.int("a block's size")?;
        *n = usize::try_from(value).ok().filter(|n| (2..=1 << 31).contains(n)).ok_or_else(|| {
            let what = "a block's size (grids of one plane are not read)";
            numbers.flaw(Fault::Number { what, found: value.to_string() })
        })?;
    }
    Ok(Block::new(size))
}

/// A grid as text: whether it has a number of blocks before the sizes shows in its first line, and whether it has iblank in
/// how many numbers it holds.
fn text(numbers: &mut Numbers<impl BufRead>, head: &[u8]) -> Result<Mesh, Flaw> {
    let first = head.trim_ascii_start().split(|&byte| byte == b'\n').next().unwrap_or_default();
    let several = String::from_utf8_lossy(first).split_whitespace().count() == 1;
    let count = if several { numbers.int("the number of blocks")? } else { 1 };
    let count = numbers.checked(count, "blocks", 3, 0)?;
    let mut blocks = Vec::with_capacity(count);
    for _ in 0..count {
        blocks.push(size(numbers)?);
    }
    let most = usize::try_from(numbers.rest()).unwrap_or(usize::MAX).saturating_mul(REPEATED);
    let mut values = Vec::new();
    while numbers.more()? {
        if values.len() >= most {
            let fault = Fault::Count { what: "repeated numbers", count: values.len() as u64, rest: numbers.rest() };
            return Err(numbers.flaw(fault));
        }
        values.push(numbers.real("a coordinate")?);
    }
    let points: usize = blocks.iter().fold(0, |sum, block| sum.saturating_add(block.count()));
    let blanks = values.len() == points.saturating_mul(4);
    if values.len() != points.saturating_mul(3) && !blanks {
        let (announced, found) = (points.saturating_mul(3) as u64, values.len() as u64);
        return Err(numbers.flaw(Fault::Miscounted { what: "coordinates", announced, found }));
    }
    let mut rest = &values[..];
    for block in &mut blocks {
        let count = block.count();
        block.allocate(count);
        for axis in 0..3 {
            let (own, others) = rest.split_at(count);
            block.points.iter_mut().zip(own).for_each(|(point, &x)| point[axis] = x);
            rest = others;
        }
        if blanks {
            let (own, others) = rest.split_at(count);
            block.blanked = own.iter().filter(|&&blank| blank == 0.0).count();
            rest = others;
        }
    }
    blocks::mesh(blocks).map_err(|fault| numbers.flaw(fault))
}
