//! The tests of the library of CAD, one file a subject, in one executable.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

mod common;

mod closest;
mod foreign;
mod fuzz;
mod health;
mod kinds;
mod oracle;
mod reading;
mod threads;
