//! Geometry of the discrete element method: vectors, SIMD lanes, body shapes, spatial search. Knows no force.
//!
//! `trackbed-dem` re-exports what users need. Modules are layers, which import only from earlier ones: `base`,
//! `lanes`, `shape`, `spatial`.

#[doc(hidden)]
pub mod base;
pub mod lanes;
pub mod shape;
#[doc(hidden)]
pub mod spatial;
