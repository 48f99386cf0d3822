//! Lists of points and their feet on the CAD, as comma-separated values.

use std::io::{self, BufRead, Write};

use cad::Foot;
use glam::DVec3;

use crate::report::end_of;

/// The columns that are read; others may stand beside them.
const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// The columns that are written.
const COLUMNS: &str = "foot_x,foot_y,foot_z,entity,u,v,distance,state";

/// What is wrong with a list of points.
#[derive(Debug, thiserror::Error)]
#[error("line {line}: {what}")]
pub(super) struct Flaw {
    line: usize,
    what: String,
}

/// The parts of a list, without spaces around them: commas between quotation marks separate nothing.
pub(super) fn split(list: &str) -> Vec<&str> {
    let mut quoted = false;
    let outside = |c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    list.split(outside).map(str::trim).collect()
}

/// Reads the columns `x`, `y`, `z`, found by their names in the first line.
///
/// # Errors
/// Columns that are missing or stand there twice, no points, what is no finite number.
pub(super) fn read(mut input: impl BufRead) -> Result<Vec<DVec3>, Flaw> {
    let (mut bytes, mut columns, mut points) = (Vec::new(), None, Vec::new());
    for line in 1.. {
        let flaw = |what: String| Flaw { line, what };
        bytes.clear();
        let length = input.read_until(b'\n', &mut bytes).map_err(|error| flaw(error.to_string()))?;
        let text = std::str::from_utf8(&bytes).map_err(|_| flaw("it is not text in UTF-8".into()))?;
        let text = text.trim_start_matches('\u{feff}').trim();
        match (&columns, length) {
            (None, 0) => return Err(flaw("it is empty; give columns named x, y, z and a point a line".into())),
            (Some(_), 0) if points.is_empty() => {
                return Err(flaw("no points stand below the names of the columns".into()));
            }
            (Some(_), 0) => break,
            _ if text.is_empty() => {}
            (None, _) => columns = Some(Columns::new(text).map_err(flaw)?),
            (Some(columns), _) => points.push(columns.point(text).map_err(flaw)?),
        }
    }
    Ok(points)
}

/// Where the coordinates stand.
struct Columns {
    count: usize,
    at: [usize; 3],
}

impl Columns {
    fn new(text: &str) -> Result<Columns, String> {
        let names = split(text);
        let mut at = [0; 3];
        for (column, wanted) in at.iter_mut().zip(COORDINATES) {
            let is = |i: &usize| names[*i].trim_matches('"').trim().eq_ignore_ascii_case(wanted);
            let mut found = (0..names.len()).filter(is);
            *column = match (found.next(), found.next()) {
                (Some(only), None) => only,
                (None, _) => {
                    return Err(format!("no column is named {wanted}: {:?} are not the names x,y,z", shown(text)));
                }
                _ => return Err(format!("two columns are named {wanted}")),
            };
        }
        Ok(Columns { count: names.len(), at })
    }

    fn point(&self, text: &str) -> Result<DVec3, String> {
        let values = split(text);
        if values.len() != self.count {
            return Err(format!("{} columns, but {} are named in the first line", values.len(), self.count));
        }
        let mut point = [0.0; 3];
        for i in 0..3 {
            let text = values[self.at[i]].trim_matches('"').trim();
            let value = text.parse().ok().filter(|value: &f64| value.is_finite());
            point[i] = value.ok_or_else(|| format!("{} is {:?}, not a finite number", COORDINATES[i], shown(text)))?;
        }
        Ok(DVec3::from_array(point))
    }
}

/// The beginning of a text, for messages.
fn shown(text: &str) -> String {
    text.chars().take(60).collect()
}

/// Writes a foot a line, numbers so that they read back unchanged.
///
/// # Errors
/// The system's.
pub(super) fn write(mut out: impl Write, feet: &[Foot]) -> io::Result<()> {
    writeln!(out, "{COLUMNS}")?;
    for foot in feet {
        let ([x, y, z], [u, v]) = (foot.point.to_array(), foot.parameters);
        writeln!(out, "{x:?},{y:?},{z:?},{},{u:?},{v:?},{:?},{}", foot.entity, foot.distance, state(foot))?;
    }
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
        let points = read(text.as_bytes()).unwrap();
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
        ] {
            let flaw = read(text.as_bytes()).unwrap_err();
            assert!(flaw.line == line && flaw.what.contains(words), "{text:?}: {flaw}");
        }
    }

    #[test]
    fn commas_in_names_separate_nothing() {
        assert_eq!(split("face:1, name:\"A, B\",step:#4"), ["face:1", "name:\"A, B\"", "step:#4"]);
    }
}
