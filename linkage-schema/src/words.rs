//! The places of single indices in contents: looked up when something is to be reported of them, as keeping them would double the memory.

use std::io::{self, BufRead};

use crate::{Findings, Position};

impl Findings {
    /// Moves findings about one word of a content from their element to that word; `stream` is the file once more.
    ///
    /// # Errors
    /// What reading the stream says; findings that were not reached by then stay at their elements.
    pub fn place_words(&mut self, stream: impl BufRead) -> io::Result<()> {
        let mut wanted: Vec<(Position, usize, usize)> = Vec::new();
        for (place, finding) in self.list.iter().enumerate() {
            if let (Some(position), Some(word)) = (finding.position(), finding.word) {
                wanted.push((position, word, place));
            }
        }
        wanted.sort_unstable();
        let mut scanner = Scanner { stream, here: Here::default() };
        for element in wanted.chunk_by(|a, b| a.0 == b.0) {
            let Some(&(position, ..)) = element.first() else { continue };
            if !scanner.enter(position)? {
                break;
            }
            let mut next = scanner.word()?;
            let mut number = 0;
            for &(_, word, place) in element {
                while number < word && next.is_some() {
                    next = scanner.word()?;
                    number += 1;
                }
                if let (Some(at), Some(finding)) = (next, self.list.get_mut(place)) {
                    finding.origin = at.into();
                    finding.word = None;
                }
            }
        }
        Ok(())
    }
}

/// The place of the next byte, and what came last.
#[derive(Clone, Copy)]
struct Here {
    line: u64,
    column: u64,
    in_word: bool,
}

impl Default for Here {
    fn default() -> Self {
        Self { line: 1, column: 1, in_word: false }
    }
}

struct Scanner<R> {
    stream: R,
    here: Here,
}

impl<R: BufRead> Scanner<R> {
    fn byte(&mut self) -> io::Result<Option<u8>> {
        let Some(&byte) = self.stream.fill_buf()?.first() else { return Ok(None) };
        self.stream.consume(1);
        match byte {
            b'\n' => (self.here.line, self.here.column) = (self.here.line + 1, 1),
            _ => self.here.column += 1,
        }
        Ok(Some(byte))
    }

    fn position(&self) -> Position {
        Position::new(self.here.line, self.here.column)
    }

    /// Goes behind the start tag at this place; whether there is one.
    fn enter(&mut self, at: Position) -> io::Result<bool> {
        while self.position() < at {
            if self.byte()?.is_none() {
                return Ok(false);
            }
        }
        let mut quote = None;
        while let Some(byte) = self.byte()? {
            match (byte, quote) {
                (b'>', None) => {
                    self.here.in_word = false;
                    return Ok(true);
                }
                (b'"' | b'\'', None) => quote = Some(byte),
                (byte, Some(open)) if byte == open => quote = None,
                _ => {}
            }
        }
        Ok(false)
    }

    /// The place of the next word of the content; comments and the marks of CDATA are blanks.
    fn word(&mut self) -> io::Result<Option<Position>> {
        loop {
            let at = self.position();
            let was_in_word = self.here.in_word;
            let Some(byte) = self.byte()? else { return Ok(None) };
            self.here.in_word = false;
            match byte {
                b'<' if !self.markup()? => return Ok(None),
                b'<' | b']' | b'>' => {}
                byte if byte.is_ascii_whitespace() => {}
                _ => {
                    self.here.in_word = true;
                    if !was_in_word {
                        return Ok(Some(at));
                    }
                }
            }
        }
    }

    /// Passes what follows a `<`; whether the content goes on behind it.
    fn markup(&mut self) -> io::Result<bool> {
        if self.byte()? != Some(b'!') {
            return Ok(false);
        }
        let mut tail = [0_u8; 2];
        match self.byte()? {
            Some(b'[') => while !matches!(self.byte()?, Some(b'[') | None) {},
            _ => {
                while let Some(byte) = self.byte()? {
                    if byte == b'>' && tail == *b"--" {
                        break;
                    }
                    tail = [tail[1], byte];
                }
            }
        }
        Ok(true)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::{Code, Findings};

    #[test]
    fn words_behind_comments_cdata_and_line_ends() {
        let text = "<a x='>'>\n 1 2 <!-- 9 9 -->\n3<![CDATA[ 4 ]]>\r\n  55 </a><a>6\n7</a>";
        let mut findings = Findings::default();
        let [first, second] = [(1, 1), (4, 10)].map(|(line, column)| crate::Position::new(line, column));
        let words = [(first, 4), (first, 0), (first, 2), (first, 3), (second, 1), (second, 9)];
        for (element, word) in words {
            findings.push_word(Code::BadIndex, element.into(), Some(word), String::new);
        }
        findings.place_words(text.as_bytes()).unwrap();
        let places: Vec<String> = findings.iter().map(|f| f.position().unwrap().to_string()).collect();
        assert_eq!(places, ["4:3", "2:2", "3:1", "3:12", "5:1", "4:10"], "the last content has no tenth word");
    }
}
