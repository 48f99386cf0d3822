//! CAD of others.
#![allow(dead_code, unreachable_pub)] // each program includes it as a module of its own

use std::path::PathBuf;

/// The folders that `SAGITTA_CAD` names, separated as in `PATH`.
pub fn foreign_folders() -> Vec<PathBuf> {
    std::env::var_os("SAGITTA_CAD").map(|folders| std::env::split_paths(&folders).collect()).unwrap_or_default()
}
