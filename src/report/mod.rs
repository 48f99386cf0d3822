//! Results as documents: JSON for programs, text for people.
//!
//! | document | of | data | text |
//! |---|---|---|---|
//! | [`Report`] | `sagitta curve` | [`curve`], filled by [`report()`] | `text/curve.rs` |
//! | [`CheckReport`] | `sagitta check` | [`check`] | `text/check.rs` |
//! | [`FeetReport`] | `sagitta project` | [`feet`] | `text/feet.rs` |
//! | [`Groups`] | `sagitta groups` | [`groups`] | `text/groups.rs` |
//! | [`associate::Summary`] | `sagitta link`, `curve --dry-run` | there | `text/association.rs` |
//! | [`validate::Validation`] | `sagitta validate` | there | there |
//!
//! A JSON document is its struct, field by field. Its `schema` names what it is and the version, which changes when a field
//! changes its meaning or goes away. Lengths are in the mesh's unit, times in seconds, memory in bytes, angles in degrees.
//! Numbers are finite: what is not known is `null`. [`schemas()`] are the JSON Schemas of all, published in `docs/schema`.
//!
//! [`associate::Summary`]: crate::associate::Summary
//! [`validate::Validation`]: crate::validate::Validation

#[cfg(feature = "cad")]
mod build;
pub mod certificate;
pub mod check;
#[cfg(feature = "cad")]
pub mod curve;
#[cfg(feature = "cad")]
mod curved_fields;
#[cfg(feature = "cad")]
mod distance;
#[cfg(feature = "cad")]
pub mod feet;
mod fields;
#[cfg(feature = "cad")]
pub mod groups;
#[cfg(feature = "cad")]
mod left_open;
mod measures;
mod run;
mod schema;
mod text;

use schemars::JsonSchema;
use serde::Serialize;

pub use check::CheckReport;
pub use fields::measure_fields;
pub use measures::{Histogram, LowElement, MeasureReport, Percentile};
pub use run::{Run, Told, Units};
pub use schema::schemas;
#[cfg(feature = "cad")]
pub use {
    build::{measures, report, sweeps},
    curve::Report,
    curved_fields::fields,
    distance::{Distance, distance, face_distances},
    feet::{CadReport, FeetReport, end_of},
    groups::Groups,
    left_open::{left_open, undecided},
};

/// Proven bounds of a minimum: it is not smaller than `lower`, and a value of at most `upper` is attained.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Bounds {
    /// No value is smaller; nothing where there is no such bound.
    pub lower: Option<f64>,
    /// Some value is at most this; nothing where none is known.
    pub upper: Option<f64>,
}

impl From<crate::certify::Bounds> for Bounds {
    fn from(bounds: crate::certify::Bounds) -> Bounds {
        Bounds { lower: finite(bounds.lower), upper: finite(bounds.upper) }
    }
}

/// A number as JSON can hold it.
fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}
