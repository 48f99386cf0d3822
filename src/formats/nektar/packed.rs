//! Packed sections: rows of 8-byte numbers, compressed with zlib, in base64.

use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;

use super::fault::NektarFault;
use super::tables::Points;
use crate::formats::error::Fault;

/// How many times as long as its text a packed section may be; what is longer is no mesh.
const EXPANSION: u64 = 200;
const ROOM: u64 = 1 << 20;

/// Names of the kinds of points by their numbers (`LibUtilities/Foundations/PointsType.h`), as far as curves have them.
const KINDS: [(i64, &str); 6] = [
    (4, "GaussLobattoLegendre"),
    (17, "PolyEvenlySpaced"),
    (22, "NodalTriElec"),
    (23, "NodalTriFekete"),
    (24, "NodalTriEvenlySpaced"),
    (32, "NodalQuadElec"),
];

/// The 8-byte numbers of a packed section.
pub(super) struct Unpacked {
    bytes: Vec<u8>,
    is_big_endian: bool,
}

impl Unpacked {
    /// The content of a section with the word that says how it is packed, in rows of `width` numbers.
    pub(super) fn new(section: &'static str, packing: &str, text: &str, width: usize) -> Result<Unpacked, Fault> {
        let is_big_endian = match packing.to_ascii_lowercase().as_str() {
            "b64z-littleendian" => false,
            "b64z-bigendian" => true,
            _ => {
                let found = packing.chars().take(40).collect();
                return Err(NektarFault::Packing { section, found }.into());
            }
        };
        let damaged = |cause: String| NektarFault::Packed { section, cause };
        let plain: Vec<u8> = text.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
        let compressed = STANDARD.decode(&plain).map_err(|error| damaged(error.to_string()))?;
        let most = ROOM + EXPANSION * plain.len() as u64;
        let mut bytes = Vec::new();
        let decoder = flate2::read::ZlibDecoder::new(&compressed[..]);
        decoder.take(most + 1).read_to_end(&mut bytes).map_err(|error| damaged(error.to_string()))?;
        if bytes.len() as u64 > most {
            return Err(damaged(format!("it expands to more than {EXPANSION} times its length")).into());
        }
        if !bytes.len().is_multiple_of(8 * width) {
            return Err(damaged(format!("{} bytes are no rows of {width} numbers", bytes.len())).into());
        }
        Ok(Unpacked { bytes, is_big_endian })
    }

    fn words(&self) -> impl Iterator<Item = [u8; 8]> + '_ {
        let (words, _) = self.bytes.as_chunks::<8>();
        words.iter().copied()
    }

    /// The numbers as whole ones.
    pub(super) fn whole(&self) -> Vec<i64> {
        let number = |word| if self.is_big_endian { i64::from_be_bytes(word) } else { i64::from_le_bytes(word) };
        self.words().map(number).collect()
    }

    /// Rows of a whole number and three coordinates.
    pub(super) fn points(&self) -> Vec<(i64, DVec3)> {
        let real = |word: [u8; 8]| if self.is_big_endian { f64::from_be_bytes(word) } else { f64::from_le_bytes(word) };
        let coordinates: Vec<f64> = self.words().map(real).collect();
        let ids = self.whole();
        let rows = ids.chunks_exact(4).zip(coordinates.chunks_exact(4));
        rows.map(|(ids, x)| (ids[0], DVec3::new(x[1], x[2], x[3]))).collect()
    }
}

/// The packed curves: what they are of, and their points in one list.
#[derive(Default)]
pub(super) struct Curves {
    /// Number, edge or face, number of points, list, first place in the index, kind of points.
    pub(super) edges: Vec<i64>,
    pub(super) faces: Vec<i64>,
    /// Places among the points.
    pub(super) index: Vec<i64>,
    pub(super) points: Vec<(i64, DVec3)>,
}

impl Curves {
    /// Numbers that tell of one curve.
    pub(super) const WIDTH: usize = 6;

    /// The curves of edges, or of faces.
    pub(super) fn unpacked(&self, of_edges: bool) -> Result<Vec<Points>, NektarFault> {
        let what = if of_edges { "edge" } else { "face" };
        let rows = if of_edges { &self.edges } else { &self.faces };
        let place = |row: &[i64]| {
            let first = usize::try_from(row[4]).ok()?;
            let count = usize::try_from(row[2]).ok()?;
            self.index.get(first..first.checked_add(count)?)
        };
        let curve = |row: &[i64]| {
            let id = row[1];
            let unknown = |wrong| NektarFault::Unknown { section: "the curve of", id, what: "point", wrong };
            let index = place(row).ok_or_else(|| unknown(row[4]))?;
            let at = |&n: &i64| {
                let point = usize::try_from(n).ok().and_then(|n| self.points.get(n));
                point.map(|&(_, x)| x).ok_or_else(|| unknown(n))
            };
            let kind = KINDS.iter().find(|(number, _)| *number == row[5]).map(|(_, name)| (*name).to_owned());
            let kind = kind.ok_or_else(|| NektarFault::Kind { what, id, kind: row[5].to_string() })?;
            Ok(Points { id, kind, points: index.iter().map(at).collect::<Result<_, _>>()? })
        };
        rows.chunks_exact(Curves::WIDTH).map(curve).collect()
    }
}
