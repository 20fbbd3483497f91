//! Making packings: sizes from a gradation or a law, shapes from a library, places on a lattice, at random, or loosely
//! stacked for gravity deposition, in boxes, cones and closed surfaces; growth to a porosity.
//!
//! Everything random comes from a PCG stream that the scene's seed starts, so a scene has the same stones, bit for
//! bit, on every machine and for any number of threads.

pub mod closed;
pub mod container;
pub mod flow;
pub mod gradation;
pub mod grow;
pub mod lattice;
pub mod library;
pub mod place;
pub mod room;
pub mod scatter;
pub mod sizes;
