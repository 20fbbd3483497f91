//! Readers and writers of meshes, tables, frames and results; messages and errors; what differs between operating systems.

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod columns;
pub mod extremes;
pub mod failure;
pub mod guard;
pub mod ice_loads;
pub mod mesh_tools;
pub mod message;
pub mod plot;
pub mod progress;
pub mod read;
pub mod replaced;
pub mod results;
#[doc(hidden)]
pub mod scratch;
pub mod stone_tools;
pub mod system;
pub mod write;
