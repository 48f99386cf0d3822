//! Lists of points and their feet on the CAD, as comma-separated values.

use std::io::{Chain, Read, Write};

use cad::Foot;
use csv::{ByteRecord, Reader, ReaderBuilder, StringRecord, Terminator};
use glam::DVec3;

use crate::report::end_of;

/// The columns that are read; others may stand beside them.
const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// The columns that are written.
const COLUMNS: [&str; 8] = ["foot_x", "foot_y", "foot_z", "entity", "u", "v", "distance", "state"];

/// What is wrong with a list of points.
#[derive(Debug, thiserror::Error)]
#[error("line {line}: {what}")]
pub(super) struct Flaw {
    line: u64,
    what: String,
}

/// Reads the columns `x`, `y`, `z`, found by their names in the first line; of a text of `most` bytes at most.
///
/// # Errors
/// A longer text, columns that are missing or stand there twice, no points, what is no finite number.
pub(super) fn read(input: impl Read, most: u64) -> Result<Vec<DVec3>, Flaw> {
    let mut lines = Lines::new(input, most);
    let empty = "it is empty; give columns named x, y, z and a point a line";
    let columns = lines.next()?.ok_or_else(|| lines.flaw(empty.into()))?;
    let columns = Columns::new(&columns).map_err(|what| lines.flaw(what))?;
    let mut points = Vec::new();
    while let Some(values) = lines.next()? {
        points.push(columns.point(&values).map_err(|what| lines.flaw(what))?);
    }
    if points.is_empty() {
        return Err(lines.flaw("no points stand below the names of the columns".into()));
    }
    Ok(points)
}

/// An input that ends with an error where it is too long.
struct Bounded<R> {
    input: R,
    /// Bytes that may still come.
    left: u64,
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        let count = self.input.read(into)?;
        let left = self.left.checked_sub(count as u64);
        let told = "it is too long for the memory that reading may take; raise it (--memory-limit), or is it no list of points?";
        self.left = left.ok_or_else(|| std::io::Error::other(told))?;
        Ok(count)
    }
}

/// Lines that are not empty, with their numbers.
struct Lines<R> {
    /// Behind the input stands a line's end, so that the last line has one in any case.
    reader: Reader<Chain<Bounded<R>, &'static [u8]>>,
    record: ByteRecord,
}

impl<R: Read> Lines<R> {
    fn new(input: R, most: u64) -> Lines<R> {
        let mut builder = ReaderBuilder::new();
        // '\r' is space at the end of a line, so that lines are counted by '\n' alone
        builder.has_headers(false).flexible(true).terminator(Terminator::Any(b'\n'));
        Lines {
            reader: builder.from_reader(Bounded { input, left: most }.chain(&b"\n"[..])),
            record: ByteRecord::new(),
        }
    }

    /// The values of the next line, without spaces around them.
    fn next(&mut self) -> Result<Option<StringRecord>, Flaw> {
        loop {
            match self.reader.read_byte_record(&mut self.record) {
                Err(error) => return Err(self.flaw(error.to_string())),
                Ok(false) => return Ok(None),
                Ok(true) => {}
            }
            let values = StringRecord::from_byte_record(self.record.clone());
            let mut values = values.map_err(|_| self.flaw("it is not text in UTF-8".into()))?;
            values.trim();
            if values.len() > 1 || values.get(0).is_some_and(|value| !value.is_empty()) {
                return Ok(Some(values));
            }
        }
    }

    /// What is wrong with the line that was read last, or at the end of the file.
    fn flaw(&self, what: String) -> Flaw {
        Flaw { line: self.reader.position().line() - 1, what }
    }
}

/// Where the coordinates stand.
struct Columns {
    count: usize,
    at: [usize; 3],
}

impl Columns {
    fn new(names: &StringRecord) -> Result<Columns, String> {
        let mut at = [0; 3];
        for (column, wanted) in at.iter_mut().zip(COORDINATES) {
            let is = |i: &usize| unquoted(&names[*i]).eq_ignore_ascii_case(wanted);
            let mut found = (0..names.len()).filter(is);
            *column = match (found.next(), found.next()) {
                (Some(only), None) => only,
                (None, _) => {
                    let names = names.iter().collect::<Vec<_>>().join(",");
                    return Err(format!("no column is named {wanted}: {:?} are not the names x,y,z", shown(&names)));
                }
                _ => return Err(format!("two columns are named {wanted}")),
            };
        }
        Ok(Columns { count: names.len(), at })
    }

    fn point(&self, values: &StringRecord) -> Result<DVec3, String> {
        if values.len() != self.count {
            return Err(format!("{} columns, but {} are named in the first line", values.len(), self.count));
        }
        let mut point = [0.0; 3];
        for i in 0..3 {
            let text = unquoted(&values[self.at[i]]);
            let value = text.parse().ok().filter(|value: &f64| value.is_finite());
            point[i] = value.ok_or_else(|| format!("{} is {:?}, not a finite number", COORDINATES[i], shown(text)))?;
        }
        Ok(DVec3::from_array(point))
    }
}

/// A value without the quotation marks that stand behind a space: to `csv` they are part of it.
fn unquoted(value: &str) -> &str {
    value.trim_matches('"').trim()
}

/// The beginning of a text, for messages.
fn shown(text: &str) -> String {
    text.chars().take(60).collect()
}

/// Writes a foot a line, numbers so that they read back unchanged; `NaN` where there is none.
///
/// # Errors
/// The system's.
pub(super) fn write(out: impl Write, feet: &[Option<Foot>]) -> csv::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    out.write_record(COLUMNS)?;
    for foot in feet {
        let [x, y, z] = foot.map_or([f64::NAN; 3], |foot| foot.point.to_array());
        let [u, v] = foot.and_then(|foot| foot.parameters).unwrap_or([f64::NAN; 2]);
        let distance = foot.map_or(f64::INFINITY, |foot| foot.distance);
        let [x, y, z, u, v, distance] = [x, y, z, u, v, distance].map(|number| format!("{number:?}"));
        let (entity, state) = foot.map_or_else(
            || ("none".to_owned(), "no foot: the point is too far away".to_owned()),
            |foot| (foot.entity.to_string(), state(&foot)),
        );
        out.write_record([x, y, z, entity, u, v, distance, state])?;
    }
    out.flush()?;
    Ok(())
}

/// How the search ended and, where the foot is not proven to be the closest point, why.
fn state(foot: &Foot) -> String {
    match foot.doubt {
        None => end_of(foot).to_owned(),
        Some(doubt) => format!("{} not proven: {doubt}", end_of(foot)),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name() {
        let text = "\u{feff}\"a, id\", Z ,\"y\",X\r\n\"1,2\", 3,2e0 ,\"1\"\r\n\r\n2,-3,-2,-1";
        let points = read(text.as_bytes(), u64::MAX).unwrap();
        assert_eq!(points, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, -2.0, -3.0)]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, line, words) in [
            ("", 1, "empty"),
            ("\n\n", 3, "empty"),
            ("x,y,z\n", 2, "no points"),
            ("x,y\n1,2\n", 1, "no column is named z"),
            ("1,2,3\n4,5,6\n", 1, "no column is named x"),
            ("x,y,z,x\n1,2,3,4\n", 1, "two columns are named x"),
            ("x,y,z\n1,2,3\n4,nan,6\n", 3, "y is \"nan\""),
            ("x,y,z\n1,2,inf\n", 2, "z is \"inf\""),
            ("x,y,z\n1,2,1e999\n", 2, "z is \"1e999\""),
            ("x,y,z\r\n1,2,3\r\n\r\n4,nan,6\r\n", 4, "y is \"nan\""),
            ("x,y,z\n\n\n,2,3\n", 4, "x is \"\""),
            ("x,y,z\n1,2,3\n1,2\n", 3, "2 columns"),
            ("x,y,z\n1,2,3\n1,2", 3, "2 columns"),
            ("x,y,z\n1,2,\"3\"\r\n  \r\n1,2,nought", 4, "z is \"nought\""),
        ] {
            let flaw = read(text.as_bytes(), u64::MAX).unwrap_err();
            assert!(flaw.line == line && flaw.what.contains(words), "{text:?}: {flaw}");
        }
    }
}
