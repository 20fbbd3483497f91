//! Verification of the finite elements against exact answers and against tables of other programs.
//!
//! The tables are in `tests/data/fem` of the workspace; each folder's `case.json` tells how they were made.

mod absorbing;
mod common;
mod convergence;
mod determinism;
mod dynamics;
mod element;
mod hht;
mod modal;
mod patch;
mod prescribed;
mod static_cases;
mod support;
mod window;
