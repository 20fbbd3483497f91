//! trackbed: coupled DEM–FEM solver for ballasted railway track.
//!
//! A scene file ([`scene`]) is resolved into models ([`model`]), advanced by [`mod@run`] and written by
//! [`mod@write`].

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod allocator;
pub mod cli;
pub mod commands;
pub mod element;
pub mod life;
pub mod program;
pub mod start;
pub mod study;
pub mod verify;

pub use trackbed_input::{model, plausible, scene};
pub use trackbed_io::{columns, failure, guard, mesh_tools, message, read, results, stone_tools, write};
pub use trackbed_post::{convert, preview, render, view};
pub use trackbed_report as report;
pub use trackbed_run as run;
