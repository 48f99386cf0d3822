//! What is said of formats is what the registry holds.

use std::process::Command;

use sagitta::formats::{self, REGISTRY};

/// `SAGITTA_BLESS=1` writes the table into the document.
#[test]
fn the_documented_table_is_the_registrys() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/formats.md");
    let text = std::fs::read_to_string(path).unwrap();
    let (head, rest) = text.split_once("<!-- formats -->\n").unwrap();
    let (table, tail) = rest.split_once("<!-- /formats -->").unwrap();
    if std::env::var_os("SAGITTA_BLESS").is_some() {
        let table = formats::table();
        std::fs::write(path, format!("{head}<!-- formats -->\n{table}<!-- /formats -->{tail}")).unwrap();
        return;
    }
    assert_eq!(table, formats::table(), "SAGITTA_BLESS=1 cargo test --test registry writes it into docs/formats.md");
}

#[test]
fn help_names_every_format_and_every_ending_that_is_written() {
    let help = |command: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_sagitta")).args([command, "--help"]).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let convert = help("convert");
    for format in REGISTRY {
        let read = format.reader.is_some();
        assert!(
            !read || convert.contains(format.name) && help("check").contains(format.name),
            "{}: {convert}",
            format.name
        );
        for ending in format.endings.iter().filter(|_| format.writer.is_some()) {
            assert!(convert.contains(&format!(".{ending}")), "{ending}: {convert}");
        }
    }
}

/// No two formats take the same name.
#[test]
fn endings_are_unambiguous() {
    let mut endings: Vec<&str> = REGISTRY.iter().flat_map(|format| format.endings).copied().collect();
    let count = endings.len();
    endings.sort_unstable();
    endings.dedup();
    assert_eq!(endings.len(), count);
}
