//! Packing generation from a PCG stream of the scene's seed: bitwise reproducible on all machines.

pub mod closed;
pub mod container;
pub mod flow;
pub mod free_space;
pub mod gradation;
pub mod lattice;
pub mod library;
pub mod place;
pub mod radius_expansion;
pub mod random_placement;
pub mod sizes;
