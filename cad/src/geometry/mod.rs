//! Surfaces and curves as the search needs them: copied out of OCCT into plain arrays, cut into leaves, with bounds that hold.

mod bezier;
pub(crate) mod certificate;
pub(crate) mod chart;
pub(crate) mod closed_form;
pub(crate) mod curve;
pub(crate) mod evaluation;
pub(crate) mod leaf;
pub(crate) mod newton;
pub(crate) mod slab;
pub(crate) mod trim;
