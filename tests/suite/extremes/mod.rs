//! Extremes of scene values: correct results or a clear error. Each row is a test and a row of
//! `docs/extremes.md`.

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

/// Table sections and rows.
const PARTS: [(&str, &[&[Entry]]); 3] = [
    ("Grains", &[grains::ROWS, motion::ROWS, laws::ROWS, shapes::ROWS]),
    ("Solid", &[solid::ROWS, elements::ROWS, plastic::ROWS]),
    ("Coupling", &[exchange::ROWS]),
];
