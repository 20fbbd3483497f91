//! Walls: boundaries other than grains and the solid.
//!
//! Infinite planes of constant velocity ([`crate::Plane`]) have a separate kernel (`contact/planes.rs`). A
//! [`WallInput`] is a set of patches in a rigid frame, which follows a [`Motion`], a [`Servo`], or the forces
//! on a [`RigidBody`].

pub mod body;
pub(crate) mod check;
mod enclosed;
pub mod hull;
pub mod input;
mod mount;
pub mod servo;
pub(crate) mod set;
mod shape;
pub(crate) mod shells;
pub mod state;
pub(crate) mod triangulated;

pub use hull::WaterLoad;
pub use input::{
    BodyWater, Motion, Mount, Oscillation, Propulsion, RigidBody, Rudder, TriangleSurface, WallInput,
};
pub use servo::Servo;
pub use shape::{PlanCircle, WallShape, square};
