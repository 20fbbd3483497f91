//! A viewer of results in a browser: served on this machine, or as one HTML file that holds everything.
//!
//! The program reads the files of a run and hands the page (`page`) blocks of numbers (`chunk`), frame by frame, as the page
//! asks for them ([`server`]) or all at once ([`mod@export`]). What is drawn, and how, is up to the page: `web/`.

mod chunk;
mod connections;
pub mod export;
mod grains;
mod lines;
mod page;
mod results;
pub mod server;
mod solid;
mod tables;

pub use chunk::Coding;
pub use results::Results;
