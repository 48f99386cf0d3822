//! The tree of a CGNS file, as the reading child hands it on.

use std::borrow::Cow;

use super::fault::CgnsFault;
use super::labels::{self, kind};
use crate::formats::error::{Fault, Flaw, Place};
use crate::formats::names;

/// Levels that are followed; the child goes less deep.
const DEEPEST: usize = 64;

/// A node: its name, label, array and children.
#[derive(Debug)]
pub(in crate::formats) struct Tree<'a> {
    pub(super) path: String,
    pub(super) name: &'a str,
    pub(super) label: &'a str,
    kind: u8,
    data: &'a [u8],
    pub(super) children: Vec<Tree<'a>>,
}

/// Why an answer holds no tree.
#[derive(Debug)]
pub(super) enum Failure {
    /// The library said why, in a node; of a file that it does not open there is none.
    Told { node: String, cause: String },
    /// The answer ends too early.
    Cut,
}

impl<'a> Tree<'a> {
    /// The tree in an answer; the file itself is its root.
    pub(super) fn parse(answer: &'a [u8]) -> Result<Tree<'a>, Failure> {
        if let Some(answer) = answer.strip_suffix(labels::FAILURE) {
            return Err(told(answer).unwrap_or(Failure::Cut));
        }
        let mut bytes = answer.strip_prefix(labels::TREE).ok_or(Failure::Cut)?;
        let children = children(&mut bytes, "", 0).ok_or(Failure::Cut)?;
        if bytes != labels::TREE {
            return Err(Failure::Cut);
        }
        Ok(Tree { path: "/".into(), name: "", label: "", kind: kind::NONE, data: &[], children })
    }

    /// A fault in this node.
    pub(in crate::formats) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        Flaw::new(Place::Node(self.path.clone()), fault)
    }

    /// Children with a label.
    pub(super) fn all<'b>(&'b self, label: &'static str) -> impl DoubleEndedIterator<Item = &'b Tree<'a>> {
        self.children.iter().filter(move |child| child.label == label)
    }

    /// The first child with a label.
    pub(super) fn child(&self, label: &'static str) -> Option<&Tree<'a>> {
        self.children.iter().find(|child| child.label == label)
    }

    /// The child with a label and a name.
    pub(super) fn named(&self, label: &'static str, name: &str) -> Option<&Tree<'a>> {
        self.all(label).find(|child| child.name == name)
    }

    /// The child with a label and a name, which must be there.
    pub(in crate::formats) fn required(&self, label: &'static str, name: &'static str) -> Result<&Tree<'a>, Flaw> {
        self.named(label, name).ok_or_else(|| self.flaw(CgnsFault::Missing { label, name }))
    }

    /// The array as text, without what pads it.
    pub(super) fn text(&self) -> String {
        let text = if self.kind == kind::TEXT { self.data } else { &[] };
        let end = text.iter().position(|&byte| byte == 0).unwrap_or(text.len()); // what C's programs take for its end
        names::text(&text[..end]).trim_end().to_owned()
    }

    /// The array as characters.
    pub(in crate::formats) fn bytes(&self) -> &'a [u8] {
        if self.kind == kind::TEXT { self.data } else { &[] }
    }

    /// The array as whole numbers.
    pub(in crate::formats) fn ints(&self) -> Result<Ints<'a>, Flaw> {
        match self.kind {
            kind::INT | kind::LONG => Ok(Ints { data: self.data, long: self.kind == kind::LONG }),
            _ => Err(self.flaw(CgnsFault::NotNumbers("whole numbers"))),
        }
    }

    /// The array as real numbers; whole numbers are taken too.
    pub(in crate::formats) fn reals(&self) -> Result<Cow<'_, [f64]>, Flaw> {
        match self.kind {
            kind::REAL => Ok(self.data.chunks_exact(8).map(|x| f64::from_le_bytes(eight(x))).collect()),
            kind::INT | kind::LONG => Ok(self.ints()?.iter().map(|x| x as f64).collect()),
            _ => Err(self.flaw(CgnsFault::NotNumbers("real numbers"))),
        }
    }
}

/// Whole numbers of 4 or 8 bytes.
#[derive(Clone, Copy)]
pub(in crate::formats) struct Ints<'a> {
    data: &'a [u8],
    long: bool,
}

impl<'a> Ints<'a> {
    /// How many.
    pub(in crate::formats) fn len(self) -> usize {
        self.data.len() / if self.long { 8 } else { 4 }
    }

    /// The number at a place.
    pub(in crate::formats) fn get(self, n: usize) -> Option<i64> {
        if self.long {
            self.data.get(8 * n..8 * n + 8).map(|x| i64::from_le_bytes(eight(x)))
        } else {
            let x = self.data.get(4 * n..4 * n + 4)?;
            Some(i32::from_le_bytes([x[0], x[1], x[2], x[3]]).into())
        }
    }

    /// All of them.
    pub(in crate::formats) fn iter(self) -> impl Iterator<Item = i64> + 'a {
        (0..self.len()).filter_map(move |n| self.get(n))
    }
}

fn eight(x: &[u8]) -> [u8; 8] {
    let mut bytes = [0; 8];
    bytes.copy_from_slice(x);
    bytes
}

fn children<'a>(bytes: &mut &'a [u8], path: &str, depth: usize) -> Option<Vec<Tree<'a>>> {
    let count = number(bytes)?;
    if depth > DEEPEST {
        return None;
    }
    let mut nodes = Vec::new();
    for _ in 0..count {
        let name = std::str::from_utf8(string(bytes)?).ok()?;
        let label = std::str::from_utf8(string(bytes)?).ok()?;
        let kind = *bytes.split_off_first()?;
        let data = string(bytes)?;
        let path = format!("{path}/{name}");
        let children = children(bytes, &path, depth + 1)?;
        nodes.push(Tree { path, name, label, kind, data, children });
    }
    Some(nodes)
}

/// The cause at the end of an answer, behind it its length.
fn told(answer: &[u8]) -> Option<Failure> {
    let (rest, length) = answer.split_last_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let text = String::from_utf8_lossy(&rest[rest.len().checked_sub(length)?..]).into_owned();
    let (node, cause) = text.split_once('\0')?;
    Some(Failure::Told { node: node.to_owned(), cause: cause.to_owned() })
}

fn number(bytes: &mut &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(eight(bytes.split_off(..8)?)))
}

fn string<'a>(bytes: &mut &'a [u8]) -> Option<&'a [u8]> {
    let length = usize::try_from(number(bytes)?).ok()?;
    bytes.split_off(..length)
}
