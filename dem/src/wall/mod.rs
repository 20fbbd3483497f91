//! Walls: everything that is not a grain and not the solid.
//!
//! * Infinite planes of constant velocity ([`crate::Plane`]) are so common that they have a kernel of their own
//!   (`contact/planes.rs`).
//! * All else ([`WallInput`]) is a set of patches in a frame that moves as a rigid whole: triangles, frusta of cones
//!   with cylinders and rings among them, discs, spheres, and planes that turn, swing or are driven by a force. One
//!   mechanism ([`crate::spatial::surface::Surface`], `contact/patches.rs`) finds their contacts. The frame follows a prescribed
//!   [`Motion`], a [`Servo`], or, for a [`RigidBody`], the forces.

pub mod body;
pub(crate) mod check;
mod enclosed;
pub mod input;
mod mount;
pub mod servo;
pub(crate) mod set;
pub(crate) mod shells;
pub mod state;
pub(crate) mod triangulated;

pub use input::{Motion, Mount, Oscillation, RigidBody, TriangleSurface, WallInput, WallShape};
pub use servo::Servo;
