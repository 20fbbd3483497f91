//! Scene files: [`scene`] has the keys, [`model`] resolves them into models, [`plausible`] checks values against usual ranges.

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod model;
pub mod plausible;
pub mod scene;
