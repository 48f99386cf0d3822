//! Names of groups, patches and conditions: how bytes become text, and what no format could hold.

use crate::mesh::Mesh;

/// The text that bytes stand for: UTF-8, or Latin-1 where they are none, as older programs write.
pub(super) fn text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}

/// Whether a character can stand in a name in every format: line breaks and quotation marks end names.
pub(super) fn is_plain(character: char) -> bool {
    !character.is_control() && character != '"'
}

/// Puts `_` in place of the characters that names cannot have, and notes what was changed.
pub(super) fn clean(mesh: &mut Mesh) {
    let mut notes: Vec<String> = Vec::new();
    for name in mesh.names_mut() {
        if !name.chars().all(is_plain) {
            let plain = name.chars().map(|character| if is_plain(character) { character } else { '_' }).collect();
            notes.push(format!("the name {name:?} has characters that no name can have; it is {plain:?} from here on"));
            *name = plain;
        }
    }
    notes.dedup();
    notes.into_iter().for_each(|note| mesh.note(note));
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::mesh::{Parts, PhysicalName};

    #[test]
    fn bytes_that_are_no_utf8_are_latin1() {
        assert_eq!(text("café".as_bytes()), "café");
        assert_eq!(text(b"caf\xe9 \xdcbergang"), "café Übergang");
    }

    #[test]
    fn line_breaks_and_quotation_marks_leave_names() {
        let name = |name: &str| PhysicalName { dimension: 2, tag: 1, name: name.into() };
        let physical_names = vec![name("a\n2 3 \"b"), name("Flügel 1/2")];
        let mut mesh = Mesh::new(Parts { physical_names, ..Parts::default() }).unwrap();
        clean(&mut mesh);
        assert_eq!(mesh.physical_names(), [name("a_2 3 _b"), name("Flügel 1/2")]);
        assert_eq!(mesh.notes().len(), 1);
    }
}
