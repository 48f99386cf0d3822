//! JSON Schemas (draft 2020-12) of the documents, made from their structs.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

#[cfg(feature = "cad")]
use super::Told;
use super::{CheckReport, check};
#[cfg(feature = "cad")]
use super::{FeetReport, Groups, Report, curve, feet, groups};
#[cfg(feature = "cad")]
use crate::{associate, validate};

/// The schemas of all documents that this build writes, each with the document's name and version.
#[must_use]
pub fn schemas() -> Vec<(&'static str, Schema)> {
    vec![
        of::<CheckReport>(check::SCHEMA),
        #[cfg(feature = "cad")]
        of::<Report>(curve::SCHEMA),
        #[cfg(feature = "cad")]
        of::<Told<FeetReport>>(feet::SCHEMA),
        #[cfg(feature = "cad")]
        of::<Groups>(groups::SCHEMA),
        #[cfg(feature = "cad")]
        of::<Told<associate::Summary>>(associate::SUMMARY_SCHEMA),
        #[cfg(feature = "cad")]
        of::<Told<validate::Validation>>(validate::SCHEMA),
    ]
}

fn of<T: JsonSchema>(name: &'static str) -> (&'static str, Schema) {
    let mut schema = SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>();
    schema.insert("title".to_owned(), name.into());
    (name, schema)
}
