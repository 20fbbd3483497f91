//! Exchange of force and motion between the grains and the solid: the only crate that sees both sides.

pub mod face;
pub mod inverse_map;
#[cfg(test)]
mod testing;
