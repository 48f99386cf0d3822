//! The run that a document is of: when, by which command and options, and how it ended.

use std::collections::BTreeMap;
use std::time::{SystemTime, UNIX_EPOCH};

use schemars::JsonSchema;
use serde::Serialize;

/// When a document was made, by which command, and how that ended.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Run {
    /// When it ended: year, month, day, hour, minute and second of UTC, as `2026-12-01T13:05:59Z`.
    pub date: String,
    /// The program and its arguments as they were given; empty where no program was run.
    pub command: Vec<String>,
    /// Every option and argument of the command by its name, with the values that it had, given or by default; those that had none are left
    /// out.
    pub options: BTreeMap<String, Vec<String>>,
    /// The exit code that the result is worth, which is that of the program unless something beside the result could not be written; nothing
    /// where no program was run.
    pub exit_code: Option<u8>,
    /// What that code means.
    pub reason: Option<String>,
}

impl Run {
    /// A run of no program that ends now.
    #[must_use]
    pub fn ending_now() -> Run {
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        Run { date: date(seconds), command: Vec::new(), options: BTreeMap::new(), exit_code: None, reason: None }
    }
}

/// A document with the run that it is of.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Told<T> {
    /// The document.
    #[serde(flatten)]
    pub document: T,
    /// When it was made, by which command, and how that ended.
    pub run: Run,
}

/// The units of the numbers of a document.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Units {
    /// Of lengths and coordinates, as the CAD file names it; nothing where that is not known.
    pub length: Option<String>,
    /// Of angles.
    pub angle: &'static str,
    /// Of times.
    pub time: &'static str,
    /// Of memory.
    pub memory: &'static str,
}

impl Units {
    /// With this unit of lengths.
    #[must_use]
    pub fn with_length(length: Option<String>) -> Units {
        Units { length, angle: "degree", time: "second", memory: "byte" }
    }
}

/// The date of a time in seconds since 1970: days by E. G. Richards' algorithm for the Gregorian calendar.
fn date(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let shifted = days + 719_468; // since the first of March of the year 0
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    let [hour, minute, second] = [rest / 3600, rest / 60 % 60, rest % 60];
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::date;

    /// By `date -u -d @SECONDS`.
    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(date(0), "1970-01-01T00:00:00Z");
        assert_eq!(date(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(date(1_796_130_359), "2026-12-01T13:05:59Z");
    }
}
