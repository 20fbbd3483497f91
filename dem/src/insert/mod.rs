//! Packing generation. Random numbers come from a PCG stream of the scene's seed: bitwise reproducible on all
//! machines and thread counts.

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
