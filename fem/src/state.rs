//! The state of the solid: what a checkpoint holds. No field may be left out of it, since binary formats go by position.

use crate::material::Points;
use crate::model::Model;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Motion of all nodes at one time, shapes `[3 * nodes]`, and history of the material.
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
    /// Stress and history of the Gauss points, element by element in the order of
    /// [`stiffness_points`](crate::element::stiffness_points), see [`Model::point_start`]. Empty for a linear model
    /// without initial stress. Shape `[points]`.
    #[serde(default)]
    pub points: Points,
}

impl State {
    /// The body at rest at time 0, undeformed but for the prescribed displacements, without stress at the Gauss points of
    /// a plastic model.
    pub fn new(model: &Model) -> State {
        let n = model.dof_count();
        let points = if model.is_linear() { Points::default() } else { model.new_points() };
        let mut state = State { time: 0.0, u: vec![0.0; n], v: vec![0.0; n], a: vec![0.0; n], points };
        for &(dof, value) in model.supports().fixed() {
            state.u[dof as usize] = value;
        }
        state
    }

    /// Becomes a copy of another state of the same model, without new memory but for the Gauss points.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.u.clone_from(&other.u);
        self.v.clone_from(&other.v);
        self.a.clone_from(&other.a);
        self.points.clone_from(&other.points);
    }
}

/// What entered and left the body in one step; for the ledger of energy.
///
/// `external_work + support_work = change of (kinetic + strain) + damping_dissipation + boundary_dissipation +
/// plastic_dissipation + numerical_dissipation`, to rounding. The strain energy includes that of the boundary springs.
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
    /// Energy taken by plastic flow [J].
    #[serde(default)]
    pub plastic_dissipation: f64,
    /// Energy taken by the time integration itself [J]; negative when it feeds energy in.
    pub numerical_dissipation: f64,
}

impl AddAssign for StepAudit {
    fn add_assign(&mut self, other: StepAudit) {
        self.external_work += other.external_work;
        self.support_work += other.support_work;
        self.damping_dissipation += other.damping_dissipation;
        self.boundary_dissipation += other.boundary_dissipation;
        self.plastic_dissipation += other.plastic_dissipation;
        self.numerical_dissipation += other.numerical_dissipation;
    }
}
