//! The Python module `sagitta`: its native part, `sagitta._sagitta`.
//!
//! What a user sees is Python (`python/sagitta/`): classes with names, shapes and units in their documentation. This crate hands meshes
//! between numpy and the library, runs the work in a thread of its own while Python waits for it (`work.rs`), and turns errors into
//! exceptions by their cause (`failure.rs`). Nothing is decided here.
//!
//! CAD and CGNS files are read by the program `bin/sagitta` inside the package, in a process of its own which malformed files may crash.

mod cad_model;
mod check;
mod curve;
mod failure;
mod linkage;
mod mesh;
mod node_arrays;
mod patch;
mod reading;
mod settings;
mod work;

use pyo3::prelude::*;

#[pymodule]
mod _sagitta {
    #[pymodule_export]
    use crate::cad_model::{Cad, Feet};
    #[pymodule_export]
    use crate::check::check;
    #[pymodule_export]
    use crate::curve::curve;
    #[pymodule_export]
    use crate::linkage::{link, validate};
    #[pymodule_export]
    use crate::mesh::{Mesh, from_arrays, read};
    #[pymodule_export]
    use crate::node_arrays::{node_order, node_orders};
    #[pymodule_export]
    use crate::patch::Patch;
    #[pymodule_export]
    use crate::work::Progress;
}
