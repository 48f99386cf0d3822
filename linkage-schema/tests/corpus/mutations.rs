//! One document, changed in every place.

use super::FULL;

/// The full document with one thing changed: a line left out or doubled, an attribute left out or given another value, an
/// element renamed. For comparing verdicts of two schemas.
pub(crate) fn mutations() -> Vec<(String, String)> {
    let lines: Vec<&str> = FULL.lines().collect();
    let mut all = Vec::new();
    let mut with = |kind: &str, number: usize, replacement: &str| {
        let text: Vec<&str> =
            lines.iter().enumerate().map(|(i, line)| if i == number { replacement } else { line }).collect();
        all.push((format!("{kind}-line-{}", number + 1), text.join("\n")));
    };
    for (number, line) in lines.iter().enumerate().skip(2) {
        with("without", number, "");
        with("twice", number, &format!("{line}\n{line}"));
        with("moved-in", number, &format!("<Attribute attid='99'/>{line}"));
        with("text-before", number, &format!("word {line}"));
        with("renamed", number, &line.replace("<Mesh", "<mesh").replace("<Geometry", "<geometry"));
        with("emptied", number, &line.replace(|c: char| c.is_ascii_digit(), ""));
        for (place, (at, _)) in line.match_indices("=\"").enumerate() {
            let name_at = line[..at].rfind(' ').map_or(0, |blank| blank + 1);
            let end = line[at + 2..].find('"').map_or(line.len(), |length| at + 2 + length);
            let (head, name, tail) = (&line[..name_at], &line[name_at..at], &line[end + 1..]);
            with(&format!("no-attribute-{place}"), number, &format!("{head}{tail}"));
            with(&format!("other-attribute-{place}"), number, &format!("{head}x{name}=\"1\"{tail}"));
            for (kind, value) in
                [("zero", "0"), ("word", "x"), ("sign", " +3 "), ("negative", "-1"), ("dangling", "77"), ("empty", "")]
            {
                with(&format!("{kind}-{place}"), number, &format!("{head}{name}=\"{value}\"{tail}"));
            }
        }
    }
    all
}
