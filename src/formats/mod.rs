//! Mesh files: one format a file, both ways.
