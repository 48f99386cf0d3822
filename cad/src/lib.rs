//! CAD models, groups, closest points.
