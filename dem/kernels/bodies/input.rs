//! Body input.

use crate::base::Vec3;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyInput {
    /// Shape (index).
    pub shape: usize,
    /// Scale factor on lengths [-].
    pub scale: f64,
    /// Material (index).
    pub material: usize,
    /// Group number, for output.
    pub part: u32,
    /// Initial centre of mass [m].
    pub position: Vec3,
    /// Shape frame to world.
    pub orientation: UnitQuaternion<f64>,
    /// Initial velocity [m/s].
    pub velocity: Vec3,
    /// Initial angular velocity, world axes [rad/s].
    pub spin: Vec3,
    /// Motions at constant starting velocity: translation, rotation, world axes.
    pub fixed: [bool; 6],
    /// Mass instead of density × volume [kg]; scales the inertia.
    pub mass: Option<f64>,
    /// Whether the body is absent until `flow::exchange` inserts it.
    #[serde(default)]
    pub absent: bool,
}

impl Default for BodyInput {
    /// Free unscaled shape 0 of material 0, at rest at the origin.
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
