//! A body as given by its user.

use crate::base::Vec3;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// One body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyInput {
    /// Shape (index).
    pub shape: usize,
    /// Factor on all lengths of the shape [-].
    pub scale: f64,
    /// Material (index).
    pub material: usize,
    /// Group number, carried to the output.
    pub part: u32,
    /// Centre of mass at the start [m].
    pub position: Vec3,
    /// Turns the shape's frame into the world's.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity at the start [m/s].
    pub velocity: Vec3,
    /// Angular velocity at the start, in world axes [rad/s].
    pub spin: Vec3,
    /// Motions that keep their starting velocity whatever the forces: x, y, z, and turning about x, y, z (world axes).
    pub fixed: [bool; 6],
    /// Mass instead of density × volume [kg]; the inertia scales along.
    pub mass: Option<f64>,
    /// Whether the body is not there at the start: it waits until [`crate::engine::flow::exchange`] puts it in.
    #[serde(default)]
    pub absent: bool,
}

impl Default for BodyInput {
    /// Shape 0 of material 0, unscaled, at rest at the origin, free.
    fn default() -> BodyInput {
        BodyInput {
            shape: 0,
            scale: 1.0,
            material: 0,
            part: 0,
            position: Vec3::zeros(),
            orientation: UnitQuaternion::identity(),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            fixed: [false; 6],
            mass: None,
            absent: false,
        }
    }
}
