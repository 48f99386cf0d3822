//! CGNS nodes as HDF5 groups, written.

use hdf5_metno as hdf5;
use hdf5_metno::H5Type;
use hdf5_metno::types::FixedAscii;

use crate::formats::part::Unwritten;

/// Longest name of a node, by the standard.
pub(super) const LONGEST_NAME: usize = 32;

impl From<hdf5::Error> for Unwritten {
    fn from(error: hdf5::Error) -> Unwritten {
        let text = error.to_string();
        // The library tells of the system's number among many others, over several lines.
        let number = text.split("errno = ").nth(1).and_then(|rest| rest.split(',').next()?.parse().ok());
        Unwritten::Io(match number {
            Some(number) => std::io::Error::from_raw_os_error(number),
            None => std::io::Error::other(text.lines().map(str::trim).collect::<Vec<_>>().join(" ")),
        })
    }
}

/// A node that has its name and label.
pub(super) struct Node(hdf5::Group);

/// Kinds of data of a node, by CGNS' letters.
pub(super) trait Data: H5Type {
    /// `I4`, `R8`, ...
    const LETTERS: &'static str;
}

impl Data for i32 {
    const LETTERS: &'static str = "I4";
}
impl Data for i64 {
    const LETTERS: &'static str = "I8";
}
impl Data for f32 {
    const LETTERS: &'static str = "R4";
}
impl Data for f64 {
    const LETTERS: &'static str = "R8";
}
impl Data for i8 {
    const LETTERS: &'static str = "C1";
}

impl Node {
    /// The file's root.
    pub(super) fn root(file: &hdf5::File) -> Result<Node, Unwritten> {
        let root = file.group("/")?;
        attribute::<33>(&root, "name", "HDF5 MotherNode")?;
        attribute::<33>(&root, "label", "Root Node of HDF5 File")?;
        attribute::<3>(&root, "type", "MT")?;
        raw(&root, " format", &[15], &padded("IEEE_LITTLE_32", 15))?;
        let [major, minor, release] = hdf5::library_version().into();
        raw(&root, " hdf5version", &[33], &padded(&format!("HDF5 Version {major}.{minor}.{release}"), 33))?;
        Ok(Node(root))
    }

    /// A child without data.
    pub(super) fn child(&self, name: &str, label: &str) -> Result<Node, Unwritten> {
        self.typed(name, label, "MT")
    }

    fn typed(&self, name: &str, label: &str, letters: &str) -> Result<Node, Unwritten> {
        let group = self.0.create_group(name)?;
        attribute::<33>(&group, "name", name)?;
        attribute::<33>(&group, "label", label)?;
        attribute::<3>(&group, "type", letters)?;
        group.new_attr::<i32>().shape([1]).create("flags")?.write_raw(&[1])?;
        Ok(Node(group))
    }

    /// A child with an array whose shape, in HDF5's order, is given.
    pub(super) fn array<T: Data>(
        &self,
        name: &str,
        label: &str,
        shape: &[usize],
        values: &[T],
    ) -> Result<Node, Unwritten> {
        let node = self.typed(name, label, T::LETTERS)?;
        raw(&node.0, " data", shape, values)?;
        Ok(node)
    }

    /// A child with a text.
    pub(super) fn text(&self, name: &str, label: &str, text: &str) -> Result<Node, Unwritten> {
        self.array(name, label, &[text.len()], &padded(text, text.len()))
    }

    /// A child with a list that is made piece by piece: `fill` gives the values of a range of places.
    pub(super) fn list<T: Data>(
        &self,
        name: &str,
        label: &str,
        count: usize,
        mut fill: impl FnMut(std::ops::Range<usize>) -> Vec<T>,
    ) -> Result<Node, Unwritten> {
        const PIECE: usize = 1 << 21;
        let node = self.typed(name, label, T::LETTERS)?;
        let set = node.0.new_dataset::<T>().obj_track_times(false).shape([count]).create(" data")?;
        for start in (0..count).step_by(PIECE) {
            let places = start..count.min(start + PIECE);
            set.write_slice(&fill(places.clone()), places)?;
        }
        Ok(node)
    }
}

/// Writes an array whole; without the time of writing, so that equal meshes make equal bytes.
fn raw<T: H5Type>(group: &hdf5::Group, name: &str, shape: &[usize], values: &[T]) -> Result<(), Unwritten> {
    let set = group.new_dataset::<T>().obj_track_times(false).shape(shape).create(name)?;
    Ok(set.write_raw(values)?)
}

fn attribute<const N: usize>(group: &hdf5::Group, name: &str, text: &str) -> Result<(), Unwritten> {
    let text = FixedAscii::<N>::from_ascii(text)
        .map_err(|_| Unwritten::Inexpressible(format!("the name {text:?} is not ASCII, which CGNS needs")))?;
    Ok(group.new_attr::<FixedAscii<N>>().create(name)?.write_scalar(&text)?)
}

fn padded(text: &str, length: usize) -> Vec<i8> {
    let mut bytes: Vec<i8> = text.bytes().map(u8::cast_signed).collect();
    bytes.resize(length, 0);
    bytes
}
