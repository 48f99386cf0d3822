//! The tests of the whole program: what it reads, writes, refuses and promises, one file a subject. They are one executable, as each of
//! them would link everything anew.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, unreachable_pub)] // a program of its own

#[macro_use]
mod common;

mod architecture;
mod association;
mod backtrack;
mod bad_input;
mod cgns;
mod cli;
mod coarse;
mod curve;
mod curve_layers;
mod damaged;
mod determinism;
mod engines;
mod environment;
mod fallback;
mod fields;
mod fit;
mod foreign_linkage;
mod formats;
mod fuzz_formats;
mod gap;
mod gmf;
mod hopr;
mod hostile;
mod linear_positions;
mod link;
mod nektar;
mod openfoam;
mod outputs;
mod pages;
mod partial;
mod periodic;
mod pictures;
mod plane;
mod plane_curve;
mod plane_gauntlet;
mod project;
mod real_linkage;
mod registry;
mod release;
mod resume;
mod rims;
mod samples;
mod schema;
mod skin;
mod sliding;
mod solvers;
mod sphere_order;
mod stop;
mod surface;
mod terminal;
mod thin_edges;
mod unit_and_place;
mod validate;
mod viscous_patches;
mod without_libraries;
mod zones;
