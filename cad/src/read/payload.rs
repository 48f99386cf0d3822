//! What the reading child sends to its parent: a magic word, a description in JSON, the shape in OCCT's binary format.

use crate::model::{SourceFormat, Unit};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

const MAGIC: &[u8; 8] = b"sagitta1";

/// Name and reference of an entity, or of a group that it is a member of.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct RawLabel {
    pub(crate) kind: u8,
    pub(crate) index: u32,
    pub(crate) reference: String,
    pub(crate) name: String,
}

/// Kinds of labels, as the shim numbers them.
impl RawLabel {
    pub(crate) const FACE: u8 = 0;
    pub(crate) const EDGE: u8 = 1;
    pub(crate) const VERTEX: u8 = 2;
    pub(crate) const FACE_OF_GROUP: u8 = 3;
}

/// What the file says beside the shape.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Description {
    pub(crate) format: SourceFormat,
    pub(crate) unit_name: String,
    pub(crate) millimetres: f64,
    pub(crate) labels: Vec<RawLabel>,
    pub(crate) dropped: Vec<String>,
    pub(crate) warnings: Vec<String>,
}

impl Description {
    pub(crate) fn unit(&self) -> Unit {
        let known = self.format != SourceFormat::Brep;
        // 1e-3 * 25.4 is not 0.0254 in binary; rounding to 15 digits is
        let metres = format!("{:.14e}", self.millimetres / 1000.0).parse().unwrap_or(self.millimetres / 1000.0);
        Unit { name: self.unit_name.clone(), metres: known.then_some(metres) }
    }
}

/// The child's answer: a model, or why there is none.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Answer {
    Model(Description),
    Failure(String),
}

/// Writes an answer; `shape` is empty with a failure.
pub(crate) fn write(mut out: impl Write, answer: &Answer, shape: &[u8]) -> io::Result<()> {
    let text = serde_json::to_vec(answer)?;
    out.write_all(MAGIC)?;
    for part in [text.as_slice(), shape] {
        out.write_all(&(part.len() as u64).to_le_bytes())?;
        out.write_all(part)?;
    }
    out.flush()
}

fn take<'a>(bytes: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    let (head, rest) = bytes.split_at_checked(count)?;
    *bytes = rest;
    Some(head)
}

fn part<'a>(bytes: &mut &'a [u8]) -> Option<&'a [u8]> {
    let length = u64::from_le_bytes(take(bytes, 8)?.try_into().ok()?);
    take(bytes, usize::try_from(length).ok()?)
}

/// Reads an answer back; `None` where the bytes are cut short or not an answer.
pub(crate) fn read(mut bytes: &[u8]) -> Option<(Answer, &[u8])> {
    let magic = take(&mut bytes, MAGIC.len())?;
    let answer = serde_json::from_slice(part(&mut bytes)?).ok()?;
    let shape = part(&mut bytes)?;
    (magic == MAGIC && bytes.is_empty()).then_some((answer, shape))
}
