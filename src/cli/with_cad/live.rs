//! What is going on, on stderr: lines that are redrawn in place on a terminal, plain lines elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::row::Row;
use crate::cli::output::{message, write_messages};

/// Shows what is going on.
pub(super) struct Live {
    bar: Option<ProgressBar>,
    quiet: bool,
    start: Instant,
    /// Whether the columns of the table have been named.
    named: bool,
}

impl Live {
    /// Begins to count the time.
    pub(super) fn new(quiet: bool) -> Live {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new_spinner();
            bar.enable_steady_tick(Duration::from_millis(200));
            let own = bar.clone();
            write_messages(Some(Box::new(move |write| own.suspend(write))));
            bar
        });
        Live { bar, quiet, start: Instant::now(), named: false }
    }

    /// Whether what is shown is redrawn, so that it may be shown as often as it changes.
    pub(super) fn is_redrawn(&self) -> bool {
        self.bar.is_some()
    }

    /// Shows a sentence.
    pub(super) fn text(&self, text: String) {
        match &self.bar {
            Some(bar) => {
                set_style(bar, "{spinner} [{elapsed}] {wide_msg}");
                bar.set_message(text);
            }
            None if self.quiet => {}
            None => message(format_args!("[{:7.1} s] {text}", self.start.elapsed().as_secs_f64())),
        }
    }

    /// Shows a row of the table.
    pub(super) fn row(&mut self, row: &Row) {
        let named = std::mem::replace(&mut self.named, true);
        match &self.bar {
            Some(bar) => {
                if !named {
                    let template =
                        format!("  {}\n{{spinner}} {{msg}}{{elapsed_precise:>10}}{{prefix:>9}}", Row::heads());
                    set_style(bar, &template);
                }
                bar.set_prefix(row.estimate());
                bar.set_message(row.to_string());
            }
            None if self.quiet => {}
            None => {
                if !named {
                    message(Row::heads());
                }
                let elapsed = format!("{:.1} s", self.start.elapsed().as_secs_f64());
                message(format!("{row}{elapsed:>10}{:>9}", row.estimate()).trim_end());
            }
        }
    }

    /// Takes the lines on the terminal away.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            write_messages(None);
            bar.finish_and_clear();
        }
    }
}

fn set_style(bar: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
}
