//! Linkage files, changed as text.

/// Every index of the faces, edges and points moved, parameter vertices too.
pub fn renumbered(text: &str, by: i64) -> String {
    let moved = |word: &str| word.parse::<i64>().map_or(word.to_owned(), |n| (n + by).to_string());
    let line = |line: &str| -> String {
        let Some(open) = line.find('>').filter(|_| line.contains("<MeshEdge") || line.contains("<MeshPointRef")) else {
            let indices = !line.trim().is_empty() && line.chars().all(|c| c.is_ascii_digit() || c == ' ');
            let vertex = line.split_once("vref=\"").and_then(|(head, rest)| {
                let (index, tail) = rest.split_once('"')?;
                Some(format!("{head}vref=\"{}\"{tail}", moved(index)))
            });
            let all = || line.split(' ').map(moved).collect::<Vec<_>>().join(" ");
            return vertex.unwrap_or_else(|| if indices { all() } else { line.to_owned() });
        };
        let (head, rest) = line.split_at(open + 1);
        let (inside, tail) = rest.split_once('<').unwrap();
        format!("{head}{}<{tail}", inside.split(' ').map(moved).collect::<Vec<_>>().join(" "))
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}
