//! Scene files: keys, models, and plausibility of values.

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod model;
pub mod plausible;
pub use trackbed_scene as scene;
