//! Stability at the extremes: at, near and beyond each edge of what a scene can hold the program gives the right result, or
//! says what is wrong. Each row is a test that runs small scenes, and a row of the table in `docs/extremes.md`.

mod case;
mod elements;
mod exchange;
mod grains;
mod laws;
mod motion;
mod plastic;
mod scenes;
mod shapes;
mod solid;
mod table;

use table::Entry;

/// Titles of the table's parts with their rows.
const PARTS: [(&str, &[&[Entry]]); 3] = [
    ("Grains", &[grains::ROWS, motion::ROWS, laws::ROWS, shapes::ROWS]),
    ("Solid", &[solid::ROWS, elements::ROWS, plastic::ROWS]),
    ("Exchange", &[exchange::ROWS]),
];
