//! MeshLink documents.
