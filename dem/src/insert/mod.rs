//! Making stones: sizes from a gradation, shapes from a library, first positions for gravity deposition.
//!
//! Everything random comes from a PCG stream that the scene's seed starts, so a scene has the same stones, bit for
//! bit, on every machine and for any number of threads.

pub mod gradation;
pub mod library;
pub mod place;
pub(crate) mod random;
