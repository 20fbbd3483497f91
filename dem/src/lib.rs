//! Explicit discrete element method for ballasted track: spheres, rigid clumps, blocks, walls.
//!
//! A [`Model`] is constant in a run, a [`State`] evolves, a [`Work`] is scratch; [`step()`] advances the
//! state. SI units.
//!
//! Modules are layers, which import only from earlier ones: `wall`, `engine`, `measure`, `stability`, `insert`,
//! `device` (GPU), `ranks` (several processes); below them the crates `trackbed-kernels` (laws, loops) and
//! `trackbed-geometry` (shapes, search).

pub mod device;
mod engine;
pub mod insert;
pub mod measure;
pub mod ranks;
pub mod stability;
#[cfg(test)]
mod testing;
pub mod wall;

use trackbed_geometry::{base, spatial};
use trackbed_kernels::{bodies, contact, pairs};

pub use trackbed_geometry::{lanes, shape};
pub use trackbed_kernels::{body_force, bond, integrate, law};

pub use base::{Vec3, balance_terms, error, force_tracking, names, random};
pub use bodies::input::BodyInput;
pub use engine::back_end::BackEnd;
pub use engine::{input, model, state, step, timestep, work};
pub use insert::flow;
pub use law::{material, scarring};
pub use shape::plane::{Plane, PlaneMotion};
pub use spatial::{bvh, detect, distance, sheet, surface};

pub use body_force::{BodyForce, DragArea, Measured, Orbit, Water, Wave, WaveError, Wind};
pub use error::{ModelError, Partner, StepError};
pub use force_tracking::{AppliedLoad, ForceTracking, LoadRange};
pub use input::{AppliedForce, LocalDamping, ModelInput, SearchSkin, TimeStep};
pub use law::material::{Material, PairOverride};
pub use law::scarring::Scarring;
pub use model::Model;
pub use names::Names;
pub use shape::Shape;
pub use state::State;
pub use step::{find_contacts, find_deep_contacts, step};
pub use wall::{
    BodyWater, Motion, Mount, Oscillation, Propulsion, RigidBody, Rudder, Servo, TriangleSurface, WallInput,
    WallShape, WaterLoad,
};
pub use work::Work;
