//! trackbed: coupled DEM–FEM solver for ballasted railway track.
//!
//! A scene file ([`scene`]) is resolved into models ([`model`]), advanced by [`mod@run`] and written by
//! [`mod@write`].

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod allocator;
pub mod cli;
pub mod columns;
pub mod commands;
pub mod convert;
pub mod failure;
pub mod guard;
pub mod mesh_tools;
pub mod message;
pub mod model;
pub mod plausible;
pub mod preview;
pub mod program;
mod progress;
pub mod read;
pub mod render;
mod replaced;
pub mod report;
pub mod results;
pub mod run;
pub mod scene;
pub mod start;
pub mod stone_tools;
pub mod study;
mod system;
pub mod view;
pub mod write;
