//! The state of the solid: what a checkpoint holds.

use crate::model::Model;
use serde::{Deserialize, Serialize};

/// Motion of all nodes at one time. Shapes `[3 * nodes]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// Displacements [m].
    pub u: Vec<f64>,
    /// Velocities [m/s].
    pub v: Vec<f64>,
    /// Accelerations [m/s²].
    pub a: Vec<f64>,
}

impl State {
    /// The body at rest at time 0, undeformed but for the prescribed displacements.
    pub fn new(model: &Model) -> State {
        let n = model.dof_count();
        let mut state = State { time: 0.0, u: vec![0.0; n], v: vec![0.0; n], a: vec![0.0; n] };
        for &(dof, value) in model.supports().fixed() {
            state.u[dof as usize] = value;
        }
        state
    }
}

/// What entered and left the body in one step; for the ledger of energy.
///
/// `external_work + support_work = change of (kinetic + strain) + damping_dissipation + boundary_dissipation +
/// numerical_dissipation`, to rounding. The strain energy includes that of the boundary springs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepAudit {
    /// Work of the load on the displacement of the step [J].
    pub external_work: f64,
    /// Work of the supports on the prescribed displacements of the step [J].
    pub support_work: f64,
    /// Energy taken by Rayleigh damping [J].
    pub damping_dissipation: f64,
    /// Energy taken by boundary dashpots [J].
    pub boundary_dissipation: f64,
    /// Energy taken by the time integration itself [J]; negative when it feeds energy in.
    pub numerical_dissipation: f64,
}
