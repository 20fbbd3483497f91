//! Finished results as pictures, pages of the viewer, and other formats; [`preview`] shows a scene before it runs.

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod convert;
pub mod preview;
pub mod render;
pub mod view;
mod water;
