//! Explicit discrete elements for ballasted track: spheres, rigid clumps, blocks, walls.
//!
//! A [`Model`] is what a run never changes, a [`State`] all that it changes, a [`Work`] its scratch; [`step()`] advances
//! the state. SI units throughout.
//!
//! Folders are layers; each imports from those above it in this list only: `base` (vectors, errors, the ledger), `lanes`
//! (several numbers at a time), `shape`, `spatial` (trees, cells, surfaces, how two shapes touch), `law` (laws of
//! contact), `bodies` (arrays of motion), `pairs` (storage of contacts), `contact` (the loops over contacts),
//! `integrate`, `body_force`, `bond`, `wall`, `engine` (model, state, scratch, search, step), `measure`, `stability` (the step that contacts
//! allow), `insert`, `device` (steps computed elsewhere), `ranks` (steps computed by several processes).

mod base;
mod bodies;
pub mod body_force;
pub mod bond;
mod contact;
pub mod device;
mod engine;
pub mod insert;
pub mod integrate;
pub mod lanes;
pub mod law;
pub mod measure;
mod pairs;
pub mod ranks;
pub mod shape;
mod spatial;
pub mod stability;
#[cfg(test)]
mod testing;
pub mod wall;

pub use base::{Vec3, error, ledger, random};
pub use bodies::input::BodyInput;
pub use engine::back_end::BackEnd;
pub use engine::{input, model, state, step, timestep, work};
pub use insert::flow;
pub use law::{material, scarring};
pub use shape::plane::{Plane, PlaneMotion};
pub use spatial::{bvh, detect, distance, sheet, surface};

pub use body_force::{BodyForce, DragArea, Measured, Orbit, Water, Wave, WaveError, Wind};
pub use error::{ModelError, Partner, StepError};
pub use input::{AppliedForce, LocalDamping, ModelInput, SearchSkin, TimeStep};
pub use law::material::{Material, PairOverride};
pub use law::scarring::Scarring;
pub use model::Model;
pub use shape::Shape;
pub use state::State;
pub use step::{find_contacts, step};
pub use wall::{Motion, Mount, Oscillation, RigidBody, Servo, TriangleSurface, WallInput, WallShape};
pub use work::Work;
