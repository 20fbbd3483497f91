//! Browser viewer of results and scenes, served locally or exported as one HTML file.

mod chunk;
mod connections;
pub mod export;
mod grains;
mod lines;
mod names;
mod page;
mod preview;
mod results;
pub mod server;
mod solid;
mod tables;

pub use chunk::{Blocks, Coding};
pub use preview::{Live, Still};
pub use results::Results;
