//! trackbed: coupled DEM–FEM solver for ballasted railway track.
//!
//! Data flows one way: a scene file ([`scene`]) is resolved into models ([`model`]), the run loop ([`mod@run`]) steps
//! them, and writers ([`mod@write`]) put the results on disk.

// A closed or full output must not end a run: see `message`.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod allocator;
pub mod cli;
pub mod columns;
pub mod commands;
pub mod convert;
pub mod failure;
pub mod guard;
mod machine;
pub mod mesh_tools;
pub mod message;
pub mod model;
pub mod plausible;
pub mod program;
mod progress;
pub mod read;
pub mod render;
pub mod report;
pub mod results;
pub mod run;
pub mod scene;
pub mod start;
pub mod stone_tools;
pub mod study;
pub mod view;
pub mod write;
