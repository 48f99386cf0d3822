//! The bridge to OpenCASCADE.
