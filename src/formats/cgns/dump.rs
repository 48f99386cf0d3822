//! The tree of a CGNS file as plain bytes: the only place where the HDF5 library parses a file.

use std::io::{self, Write};
use std::path::Path;

use hdf5_metno as hdf5;
use hdf5_metno::LinkType;
use hdf5_metno::dataset::Layout;
use hdf5_metno::plist::file_access::FileCloseDegree;
use hdf5_metno::types::{FixedAscii, IntSize, TypeDescriptor, VarLenAscii};

use super::labels::{self, kind};

/// Levels of a tree that are followed; CGNS has seven down to the arrays that are read.
const DEEPEST: usize = 12;

/// Bytes that an answer may take, and how many more for each byte of the file: HDF5 compresses arrays, and one node may be in many
/// places of the tree.
const ROOM: u64 = 64 << 20;
const EXPANSION: u64 = 100;

/// What a node takes of the room beside its name and array, in bytes.
const NODE: u64 = 4096;

/// Bytes that the answer to a file of `length` bytes may take, where reading may take `memory`.
pub(super) fn room(length: u64, memory: u64) -> u64 {
    ROOM.saturating_add(length.saturating_mul(EXPANSION)).min(memory)
}

/// Characters in which texts of fixed length are handed on.
const NAME: usize = 255;

/// Opens a file for reading; without a lock, as nobody writes to it and some file systems have none.
pub(super) fn open(path: &Path) -> hdf5::Result<hdf5::File> {
    hdf5::FileBuilder::new().with_fapl(|access| access.file_locking(false)).open(path)
}

/// Creates a file, or empties the one that has the name. All of it is closed with it, and arrays are handed to the system when they are
/// written, not when a handle is dropped, where nobody would hear that it refused.
pub(in crate::formats) fn create(path: &Path) -> hdf5::Result<hdf5::File> {
    hdf5::FileBuilder::new()
        .with_fapl(|access| access.file_locking(false).fclose_degree(FileCloseDegree::Strong).sieve_buf_size(0))
        .create(path)
}

/// Writes the tree of a file, or why there is none; the answer takes `room` bytes at most, about.
///
/// `visit` hears the path of every node before the library looks at it.
///
/// # Errors
/// Those of the output.
pub(super) fn write(path: &Path, room: u64, out: &mut impl Write, visit: impl FnMut(&str)) -> io::Result<()> {
    let told = match open(path) {
        Ok(file) => {
            out.write_all(labels::TREE)?;
            let own = file.loc_info().map(|info| info.fileno).unwrap_or_default();
            let mut dump = Dump { out: &mut *out, room, path: String::new(), own, visit };
            match dump.children(&file, 0) {
                Ok(()) => None,
                Err(Stop::Output(error)) => return Err(error),
                Err(Stop::Input(cause)) if dump.path.is_empty() => Some(("/".to_owned(), cause)),
                Err(Stop::Input(cause)) => Some((dump.path, cause)),
            }
        }
        Err(error) => Some((String::new(), error.to_string())), // no node: the library refuses the file's head
    };
    match told {
        None => out.write_all(labels::TREE)?, // an answer without its end was cut off
        Some((node, cause)) => {
            let text = format!("{node}\0{cause}");
            out.write_all(text.as_bytes())?;
            out.write_all(&(text.len() as u64).to_le_bytes())?;
            out.write_all(labels::FAILURE)?;
        }
    }
    out.flush()
}

/// Why no tree can be written.
enum Stop {
    /// The file is at fault, in the node where the dump stands.
    Input(String),
    Output(io::Error),
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Stop {
        Stop::Output(error)
    }
}

impl From<hdf5::Error> for Stop {
    fn from(error: hdf5::Error) -> Stop {
        Stop::Input(format!("the HDF5 library cannot read it ({error}): the file is malformed"))
    }
}

/// A refusal of what leads out of the file.
fn elsewhere(what: &str) -> Stop {
    Stop::Input(format!("{what} of another file, which is not followed; write the mesh into one file"))
}

/// A tree being written.
struct Dump<'a, W, V> {
    out: &'a mut W,
    /// Bytes that the answer may still take.
    room: u64,
    /// The node where the dump stands.
    path: String,
    /// The library's number of the file.
    own: u64,
    visit: V,
}

impl<W: Write, V: FnMut(&str)> Dump<'_, W, V> {
    /// Writes the children of a group that are of use, their number before them; in the order of their names, as HDF5 keeps none
    /// that all writers agree on.
    fn children(&mut self, group: &hdf5::Group, depth: usize) -> Result<(), Stop> {
        let mut names = Vec::new();
        group.iter_visit_default(|name, link| {
            names.push((name.to_owned(), link.link_type));
            Ok(())
        })?;
        names.retain(|(name, _)| !name.starts_with(' ') && !labels::PASSED_OVER.contains(&name.as_str()));
        names.sort_unstable_by(|(a, _), (b, _)| a.cmp(b));
        let mut useful = Vec::new();
        for (name, link) in names.into_iter().filter(|_| depth < DEEPEST) {
            let parent = self.enter(&name);
            if let Some(child) = self.group(group, &name, link)?
                && let Some(label) = text(&child, "label").filter(|label| labels::READ.contains(&label.as_str()))
            {
                self.take(NODE + 2 * (self.path.len() + label.len()) as u64)?;
                useful.push((name, label, child));
            }
            self.path.truncate(parent);
        }
        let arrays = if depth == 0 { self.hopr(group)? } else { Vec::new() };
        self.out.write_all(&((useful.len() + arrays.len()) as u64).to_le_bytes())?;
        for (name, array) in arrays {
            let parent = self.enter(name);
            self.bytes(name.as_bytes())?;
            self.bytes(labels::HOPR.as_bytes())?;
            match array {
                Some(set) => self.values(&set)?,
                None => self.array(kind::INT, bytemuck::cast_slice(&group.attr(name)?.read_raw::<i32>()?))?,
            }
            self.out.write_all(&0_u64.to_le_bytes())?;
            self.path.truncate(parent);
        }
        for (name, label, child) in useful {
            let parent = self.enter(&name);
            let child = self.target(child)?;
            self.bytes(name.as_bytes())?;
            self.bytes(label.as_bytes())?;
            self.data(&child)?;
            self.children(&child, depth + 1)?;
            self.path.truncate(parent);
        }
        Ok(())
    }

    /// The arrays of a HOPR file, where it is one; the order of its elements is an attribute.
    fn hopr(&mut self, root: &hdf5::Group) -> Result<Vec<(&'static str, Option<hdf5::Dataset>)>, Stop> {
        let mut arrays = Vec::new();
        for name in labels::HOPR_ARRAYS {
            if link_of(root, name)? == Some(LinkType::Hard)
                && let Ok(set) = root.dataset(name)
            {
                arrays.push((name, Some(set)));
            }
        }
        if !arrays.is_empty() && root.attr("Ngeo").is_ok() {
            arrays.push(("Ngeo", None));
        }
        Ok(arrays)
    }

    /// Goes to a child; the length of the path of its parent.
    fn enter(&mut self, name: &str) -> usize {
        let parent = self.path.len();
        self.path.push('/');
        self.path.push_str(name);
        (self.visit)(&self.path);
        parent
    }

    /// A child that is a group of this file, where it is a group.
    fn group(&self, parent: &hdf5::Group, name: &str, link: LinkType) -> Result<Option<hdf5::Group>, Stop> {
        if link == LinkType::External {
            return Err(elsewhere("a link to a node"));
        }
        let Ok(child) = parent.group(name) else { return Ok(None) };
        // The path of a soft link may lead through another file.
        if child.loc_info()?.fileno != self.own {
            return Err(elsewhere("a link to a node"));
        }
        Ok(Some(child))
    }

    /// The node itself, or what it is a link to: a link's content is that of the node it leads to, which HDF5 finds.
    fn target(&self, node: hdf5::Group) -> Result<hdf5::Group, Stop> {
        if text(&node, "type").as_deref() != Some("LK") {
            return Ok(node);
        }
        let link = link_of(&node, " link")?.ok_or_else(|| Stop::Input("a link without a target".into()))?;
        let target = self.group(&node, " link", link)?;
        target.ok_or_else(|| Stop::Input("a link to a node that there is not".into()))
    }

    /// Takes bytes of the room.
    fn take(&mut self, bytes: u64) -> Result<(), Stop> {
        let left = self.room.checked_sub(bytes);
        self.room = left.ok_or_else(|| {
            Stop::Input("its tree and arrays are far larger than the file: it is damaged or hostile".into())
        })?;
        Ok(())
    }

    fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(&(bytes.len() as u64).to_le_bytes())?;
        self.out.write_all(bytes)
    }

    /// Writes the node's array: kind, length in bytes, values. The shape is not needed: all that is read is a list.
    fn data(&mut self, group: &hdf5::Group) -> Result<(), Stop> {
        match link_of(group, " data")? {
            None => return Ok(self.array(kind::NONE, &[])?),
            Some(LinkType::Hard) => {}
            Some(_) => return Err(elsewhere("an array")),
        }
        let Ok(set) = group.dataset(" data") else { return Ok(self.array(kind::NONE, &[])?) };
        self.values(&set)
    }

    /// Writes an array.
    fn values(&mut self, set: &hdf5::Dataset) -> Result<(), Stop> {
        let storage = set.dcpl()?;
        if !storage.get_external()?.is_empty() || storage.get_layout()? == Layout::Virtual {
            return Err(elsewhere("an array with bytes"));
        }
        let descriptor = set.dtype()?.to_descriptor()?;
        // Numbers are handed on in 8 bytes at most.
        self.take((set.size() as u64).saturating_mul(8))?;
        match descriptor {
            // Read as the other kind, bytes above 127 would be cut to what it holds.
            TypeDescriptor::Integer(IntSize::U1) => self.array(kind::TEXT, &unsigned(set.read_raw::<i8>()?))?,
            TypeDescriptor::Unsigned(IntSize::U1) => self.array(kind::TEXT, &set.read_raw::<u8>()?)?,
            TypeDescriptor::Integer(IntSize::U4) => {
                self.array(kind::INT, bytemuck::cast_slice(&set.read_raw::<i32>()?))?;
            }
            TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
                self.array(kind::LONG, bytemuck::cast_slice(&set.read_raw::<i64>()?))?;
            }
            TypeDescriptor::Float(_) => {
                self.array(kind::REAL, bytemuck::cast_slice(&set.read_raw::<f64>()?))?;
            }
            TypeDescriptor::FixedAscii(_) => {
                let texts = set.read_raw::<FixedAscii<NAME>>()?;
                let padded = |text: &FixedAscii<NAME>| {
                    let mut bytes = text.as_bytes().to_vec();
                    bytes.resize(NAME, b' ');
                    bytes
                };
                self.array(kind::TEXT, &texts.iter().flat_map(padded).collect::<Vec<u8>>())?;
            }
            _ => self.array(kind::NONE, &[])?,
        }
        Ok(())
    }

    fn array(&mut self, kind: u8, values: &[u8]) -> io::Result<()> {
        self.out.write_all(&[kind])?;
        self.bytes(values)
    }
}

/// The kind of link by which a group has a child; `None` where it has none of the name.
fn link_of(group: &hdf5::Group, child: &str) -> hdf5::Result<Option<LinkType>> {
    let mut found = None;
    group.iter_visit_default(|name, link| {
        if name == child {
            found = Some(link.link_type);
        }
        Ok(())
    })?;
    Ok(found)
}

/// A text attribute: of 33 bytes as the standard has it, or as others write it.
fn text(group: &hdf5::Group, name: &str) -> Option<String> {
    let attribute = group.attr(name).ok()?;
    let fixed = || Some(attribute.read_scalar::<FixedAscii<64>>().ok()?.as_str().to_owned());
    let variable = || Some(attribute.read_scalar::<VarLenAscii>().ok()?.as_str().to_owned());
    let text = fixed().or_else(variable)?;
    Some(text.trim_end_matches(['\0', ' ']).to_owned())
}

fn unsigned(text: Vec<i8>) -> Vec<u8> {
    text.into_iter().map(i8::cast_unsigned).collect()
}
