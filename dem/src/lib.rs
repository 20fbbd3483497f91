//! Explicit discrete elements for ballasted track: spheres, rigid clumps, blocks, walls.
//!
//! A [`model::Model`] is what a run never changes, a [`state::State`] all that it changes, a [`work::Work`] its
//! scratch; [`step::step`] advances the state. SI units throughout.

mod bodies;
pub mod bond;
mod check;
mod contact;
pub mod detect;
pub mod error;
pub mod flow;
pub mod input;
pub mod insert;
pub mod integrate;
pub mod lanes;
pub mod law;
pub mod ledger;
pub mod measure;
pub mod model;
mod order;
mod periodic;
pub mod search;
pub mod shape;
pub mod state;
pub mod step;
pub mod surface;
#[cfg(test)]
mod testing;
mod threads;
pub mod timestep;
pub mod wall;
pub mod work;

pub use error::{ModelError, Partner, StepError};
pub use input::{AppliedForce, BodyInput, LocalDamping, ModelInput, Plane, TimeStep, TriangleSurface};
pub use law::material;
pub use law::material::{Material, PairOverride};
pub use model::Model;
pub use shape::Shape;
pub use state::State;
pub use step::{find_contacts, step};
pub use wall::{Motion, Oscillation, RigidBody, Servo, WallInput, WallShape};
pub use work::Work;

/// A vector of three components.
pub type Vec3 = nalgebra::Vector3<f64>;
