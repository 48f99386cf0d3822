//! A state of the smoothing between two rounds, as bytes.
//!
//! Costs are not kept: they follow from the positions of the nodes.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Read, Write};

use glam::DVec3;

use super::Summary;
use super::pace::{Pace, Stage};

/// All that smoothing needs to go on as if it had not been interrupted.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint<'a> {
    pub(super) pace: Pace,
    /// Smallest costs before the first sweep.
    pub(super) start: Summary,
    pub(super) sweeps: usize,
    /// Each cell's survey.
    pub(super) density: Cow<'a, [u8]>,
    /// Positions of all nodes.
    pub(super) x: Cow<'a, [DVec3]>,
    /// Places in the best state so far, of the nodes that are elsewhere in it.
    pub(super) best: BTreeMap<u32, DVec3>,
}

impl Checkpoint<'_> {
    /// Sweeps so far.
    #[must_use]
    pub fn sweeps(&self) -> usize {
        self.sweeps
    }

    /// Writes the state: numbers in little-endian order, places as the bits of their doubles.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let Pace { stage, idle, low_rings, gained, focused, round, spent } = self.pace;
        out.write_all(&[u8::from(stage == Stage::Full), u8::from(focused), u8::from(gained)])?;
        let Summary { c_wcn, c_jac, inverted } = self.start;
        for cost in [c_wcn, c_jac] {
            out.write_all(&cost.to_le_bytes())?;
        }
        for number in [inverted, idle, low_rings, round, spent, self.sweeps] {
            out.write_all(&(number as u64).to_le_bytes())?;
        }
        out.write_all(&self.density)?;
        for x in self.x.iter() {
            write_place(out, *x)?;
        }
        out.write_all(&(self.best.len() as u64).to_le_bytes())?;
        for (node, x) in &self.best {
            out.write_all(&node.to_le_bytes())?;
            write_place(out, *x)?;
        }
        Ok(())
    }

    /// Reads a state of a mesh with so many cells and nodes.
    ///
    /// # Errors
    /// Those of `input`, also where it ends early; [`io::ErrorKind::InvalidData`] for a node that there is not.
    pub fn read(input: &mut impl Read, elements: usize, nodes: usize) -> io::Result<Checkpoint<'static>> {
        let [full, focused, gained] = array(input)?;
        let stage = if full == 1 { Stage::Full } else { Stage::Shape };
        let [c_wcn, c_jac] = [f64::from_le_bytes(array(input)?), f64::from_le_bytes(array(input)?)];
        let mut number = || array(input).map(|bytes| u64::from_le_bytes(bytes) as usize);
        let start = Summary { c_wcn, c_jac, inverted: number()? };
        let (idle, low_rings, round, spent) = (number()?, number()?, number()?, number()?);
        let pace = Pace { stage, idle, low_rings, gained: gained == 1, focused: focused == 1, round, spent };
        let sweeps = number()?;
        let mut density = vec![0; elements];
        input.read_exact(&mut density)?;
        let x = (0..nodes).map(|_| read_place(input)).collect::<io::Result<Vec<DVec3>>>()?;
        let mut best = BTreeMap::new();
        for _ in 0..u64::from_le_bytes(array(input)?) {
            let node = u32::from_le_bytes(array(input)?);
            if node as usize >= nodes {
                return Err(io::ErrorKind::InvalidData.into());
            }
            best.insert(node, read_place(input)?);
        }
        Ok(Checkpoint { pace, start, sweeps, density: density.into(), x: x.into(), best })
    }
}

fn write_place(out: &mut impl Write, x: DVec3) -> io::Result<()> {
    x.to_array().into_iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))
}

fn read_place(input: &mut impl Read) -> io::Result<DVec3> {
    let mut coordinate = || array(input).map(f64::from_le_bytes);
    Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
}

fn array<const N: usize>(input: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}
