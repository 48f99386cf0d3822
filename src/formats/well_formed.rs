//! What is no XML, and what the parser of XML lets pass.

use quick_xml::events::{BytesDecl, BytesStart};

use super::error::{Fault, Flaw, Place};

/// Refuses characters that XML has none for: control characters, and bytes that are not of its encoding.
///
/// # Errors
/// [`Fault::Xml`] at the first of them.
pub(super) fn characters(xml: &[u8]) -> Result<(), Flaw> {
    let control = xml.iter().position(|byte| *byte < b' ' && !matches!(byte, b'\t' | b'\n' | b'\r'));
    let declaration = xml.split(|&byte| byte == b'>').next().unwrap_or_default();
    let declaration = String::from_utf8_lossy(declaration).to_ascii_lowercase();
    // Only words that are ASCII are of use, which most encodings have in common.
    let other = declaration.starts_with("<?xml") && declaration.contains("encoding") && !declaration.contains("utf-8");
    let wrong = std::str::from_utf8(xml).err().filter(|_| !other).map(|error| error.valid_up_to());
    match control.into_iter().chain(wrong).min() {
        Some(at) => Err(Flaw::new(Place::Byte(at as u64), Fault::Xml("a character that no XML has".into()))),
        None => Ok(()),
    }
}

/// Refuses a declaration of another version than those that there are.
///
/// # Errors
/// [`Fault::Xml`].
pub(super) fn declaration(found: &BytesDecl) -> Result<(), Fault> {
    match found.version() {
        Ok(version) if matches!(&*version, "1.0" | "1.1") => Ok(()),
        Ok(version) => Err(Fault::Xml(format!("version {version:?}"))),
        Err(error) => Err(Fault::Xml(error.to_string())),
    }
}

/// Refuses a tag whose attributes cannot be told apart: one that is not found would be taken as not given.
///
/// # Errors
/// [`Fault::Xml`].
pub(super) fn tag(found: &BytesStart) -> Result<(), Fault> {
    for attribute in found.attributes() {
        let attribute = attribute.map_err(|error| Fault::Xml(error.to_string()))?;
        let (name, value) = (attribute.key.as_ref(), attribute.value.as_ref());
        if !is_name(name) || value.contains('<') {
            return Err(Fault::Xml(format!("{:?} is no attribute", name.chars().take(40).collect::<String>())));
        }
    }
    if is_name(found.name().as_ref()) && stand_apart(found) {
        Ok(())
    } else {
        Err(Fault::Xml("a tag whose name or attributes cannot be told apart".into()))
    }
}

/// Whether a word can name an element or an attribute; letters beyond ASCII are taken as such.
fn is_name(word: &str) -> bool {
    let begins = |c: char| c.is_ascii_alphabetic() || matches!(c, '_' | ':') || !c.is_ascii();
    word.starts_with(begins) && word.chars().all(|c| begins(c) || c.is_ascii_digit() || matches!(c, '-' | '.'))
}

/// Whether white space, or the tag's end, follows every quoted value.
fn stand_apart(content: &str) -> bool {
    let mut quote = None;
    let mut closed = false;
    for c in content.chars() {
        if closed && !c.is_ascii_whitespace() {
            return false;
        }
        closed = quote == Some(c);
        quote = match quote {
            Some(open) if open != c => Some(open),
            Some(_) => None,
            None => Some(c).filter(|c| matches!(c, '"' | '\'')),
        };
    }
    true
}
