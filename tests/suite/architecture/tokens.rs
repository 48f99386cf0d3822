//! Rust source as words and signs: without comments, without what literals hold, without test code.

/// One token: an identifier, `::`, or a single sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Token {
    Word(String),
    Path,
    Sign(char),
}

impl Token {
    pub fn word(&self) -> Option<&str> {
        if let Token::Word(word) = self { Some(word) } else { None }
    }

    pub fn is(&self, sign: char) -> bool {
        *self == Token::Sign(sign)
    }
}

/// The tokens of a file but those of items under `#[cfg(test)]`.
pub fn tokens(source: &str) -> Vec<Token> {
    without_tests(&split(source))
}

fn split(source: &str) -> Vec<Token> {
    let text: Vec<char> = source.chars().collect();
    let mut found = Vec::new();
    let mut i = 0;
    while i < text.len() {
        let at = |k: usize| text.get(i + k).copied().unwrap_or(' ');
        match text[i] {
            '/' if at(1) == '/' => i = line_end(&text, i),
            '/' if at(1) == '*' => i = comment_end(&text, i),
            '"' => i = string_end(&text, i + 1),
            'r' if at(1) == '"' || (at(1) == '#' && matches!(at(2), '"' | '#')) => i = raw_end(&text, i + 1),
            'b' if at(1) == 'r' && matches!(at(2), '"' | '#') => i = raw_end(&text, i + 2),
            'b' | 'c' if at(1) == '"' => i = string_end(&text, i + 2),
            '\'' => i = quote_end(&text, i),
            ':' if at(1) == ':' => {
                found.push(Token::Path);
                i += 2;
            }
            c if c.is_alphanumeric() || c == '_' => {
                let end = (i..text.len()).find(|&k| !(text[k].is_alphanumeric() || text[k] == '_'));
                let end = end.unwrap_or(text.len());
                found.push(Token::Word(text[i..end].iter().collect()));
                i = end;
            }
            c => {
                if !c.is_whitespace() {
                    found.push(Token::Sign(c));
                }
                i += 1;
            }
        }
    }
    found
}

fn line_end(text: &[char], from: usize) -> usize {
    (from..text.len()).find(|&k| text[k] == '\n').unwrap_or(text.len())
}

fn comment_end(text: &[char], from: usize) -> usize {
    let (mut depth, mut i) = (0, from);
    while i + 1 < text.len() {
        match (text[i], text[i + 1]) {
            ('/', '*') => (depth, i) = (depth + 1, i + 2),
            ('*', '/') => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            return i;
        }
    }
    text.len()
}

/// Behind the closing quotation mark of a string whose inside begins at `i`.
fn string_end(text: &[char], mut i: usize) -> usize {
    while i < text.len() {
        match text[i] {
            '\\' => i += 2,
            '"' => return i + 1,
            _ => i += 1,
        }
    }
    text.len()
}

/// Behind a raw string whose signs `#` begin at `from`.
fn raw_end(text: &[char], from: usize) -> usize {
    let marks = text[from..].iter().take_while(|&&c| c == '#').count();
    let closes = |k: usize| text[k] == '"' && text[k + 1..].iter().take(marks).filter(|&&c| c == '#').count() == marks;
    (from + marks + 1..text.len()).find(|&k| closes(k)).map_or(text.len(), |k| k + 1 + marks)
}

/// Behind a character, or behind the mark of a lifetime.
fn quote_end(text: &[char], i: usize) -> usize {
    match (text.get(i + 1), text.get(i + 2)) {
        (Some('\\'), _) => (i + 3..text.len()).find(|&k| text[k] == '\'').map_or(text.len(), |k| k + 1),
        (Some(_), Some('\'')) => i + 3,
        _ => i + 1,
    }
}

fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let test: Vec<Token> = split("#[cfg(test)]");
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if tokens[i..].starts_with(&test) {
            i = item_end(tokens, i + test.len());
        } else {
            kept.push(tokens[i].clone());
            i += 1;
        }
    }
    kept
}

/// Behind the item that begins at `i`: its semicolon, or its braces.
fn item_end(tokens: &[Token], mut i: usize) -> usize {
    let mut depth = 0;
    while i < tokens.len() {
        match tokens[i] {
            Token::Sign('(' | '[' | '{') => depth += 1,
            Token::Sign(')' | ']') => depth -= 1,
            Token::Sign('}') => {
                depth -= 1;
                if depth == 0 {
                    return i + 1;
                }
            }
            Token::Sign(';') if depth == 0 => return i + 1,
            _ => {}
        }
        i += 1;
    }
    i
}
