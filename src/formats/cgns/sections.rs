//! Element sections of a zone.

use super::fault::CgnsFault;
use super::labels;
use super::tree::{Ints, Tree};
use super::type_code;
use crate::element::{Cell, Order};
use crate::formats::error::{Fault, Flaw};

/// Element types that are no elements of a cell and order.
const NODE: i64 = 2;
const MIXED: i64 = 20;
const NGON: i64 = 22;
const NFACE: i64 = 23;
/// The last type of CGNS 4: order 4 and 5.
const LAST: i64 = 56;

/// A run of elements with consecutive numbers.
pub(super) struct Section<'a> {
    pub(super) tree: &'a Tree<'a>,
    /// Number of its first element.
    pub(super) first: u64,
    /// How many there are.
    pub(super) count: usize,
    /// Elements of the zone's sections before it.
    pub(super) before: usize,
    /// Cell and order of all elements, or `None` where each says its own.
    kind: Option<(Cell, Order)>,
    connectivity: Ints<'a>,
}

/// An element: its cell and order, and its nodes as they stand in the file.
pub(super) struct Element<'a> {
    pub(super) cell: Cell,
    pub(super) order: Order,
    connectivity: Ints<'a>,
    nodes: std::ops::Range<usize>,
}

impl Element<'_> {
    /// The file's node numbers, in CGNS order.
    pub(super) fn nodes(&self) -> impl Iterator<Item = i64> {
        self.nodes.clone().filter_map(|n| self.connectivity.get(n))
    }
}

/// The sections of a zone, by rising element number.
pub(super) fn sections<'a>(zone: &'a Tree<'a>) -> Result<Vec<Section<'a>>, Flaw> {
    let mut sections = zone.all(labels::ELEMENTS).map(Section::new).collect::<Result<Vec<_>, _>>()?;
    sections.sort_by_key(|section| section.first);
    let (mut before, mut next) = (0, 1);
    for section in &mut sections {
        if section.first < next {
            return Err(section.tree.flaw(CgnsFault::Overlap(section.first)));
        }
        section.before = before;
        before += section.count;
        next = section.first + section.count as u64;
    }
    Ok(sections)
}

impl<'a> Section<'a> {
    fn new(tree: &'a Tree<'a>) -> Result<Section<'a>, Flaw> {
        let code = tree.ints()?.get(0).unwrap_or_default();
        let kind = if code == MIXED { None } else { Some(kind(code).map_err(|fault| tree.flaw(fault))?) };
        let range = tree.required(labels::RANGE, "ElementRange")?;
        let bounds = range.ints()?;
        let (first, last) = (bounds.get(0).unwrap_or(0), bounds.get(1).unwrap_or(0));
        let wrong = || range.flaw(CgnsFault::Range { first, last });
        let count = last.checked_sub(first).and_then(|n| n.checked_add(1)).filter(|&n| n >= 0 && first > 0);
        let count = count.and_then(|n| usize::try_from(n).ok()).ok_or_else(wrong)?;
        let array = tree.required(labels::ARRAY, "ElementConnectivity")?;
        let connectivity = array.ints()?;
        let least = kind.map_or(2, |(cell, order)| cell.node_count(order)) as u64;
        let needed = least.saturating_mul(count as u64);
        let found = connectivity.len();
        if (found as u64) < needed || (kind.is_some() && found as u64 != needed) {
            return Err(array.flaw(CgnsFault::Length { what: "the connectivity", found, needed }));
        }
        Ok(Section { tree, first: first.unsigned_abs(), count, before: 0, kind, connectivity })
    }

    /// Visits every element with its place in the section.
    pub(super) fn each(&self, mut visit: impl FnMut(usize, Element) -> Result<(), Flaw>) -> Result<(), Flaw> {
        let mut start = 0;
        for n in 0..self.count {
            // The offsets that newer files hold beside a mixed section say nothing that its types do not.
            let (cell, order) = match self.kind {
                Some(kind) => kind,
                None => {
                    let code = self.connectivity.get(start).ok_or_else(|| self.short(start))?;
                    start += 1;
                    kind(code).map_err(|fault| self.tree.flaw(fault))?
                }
            };
            let end = start + cell.node_count(order);
            if end > self.connectivity.len() {
                return Err(self.short(end));
            }
            visit(n, Element { cell, order, connectivity: self.connectivity, nodes: start..end })?;
            start = end;
        }
        let found = self.connectivity.len();
        if found > start {
            let fault = CgnsFault::Length { what: "the connectivity", found, needed: start as u64 };
            return Err(self.tree.flaw(fault));
        }
        Ok(())
    }

    fn short(&self, needed: usize) -> Flaw {
        let found = self.connectivity.len();
        self.tree.flaw(CgnsFault::Length { what: "the connectivity", found, needed: needed as u64 })
    }

    /// A fault of one of its elements.
    pub(super) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        self.tree.flaw(fault)
    }
}

/// What an element type number stands for.
fn kind(code: i64) -> Result<(Cell, Order), CgnsFault> {
    match code {
        NODE => Ok((Cell::Point, Order::LINEAR)),
        NGON | NFACE => Err(CgnsFault::Polyhedra),
        _ => i32::try_from(code).ok().and_then(type_code::meaning).ok_or(if (3..=LAST).contains(&code) {
            CgnsFault::Incomplete(code)
        } else {
            CgnsFault::UnknownType(code)
        }),
    }
}
