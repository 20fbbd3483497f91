//! State of the solid in checkpoints; positional formats require every field.

use crate::material::Points;
use crate::model::Model;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Nodal motion, shapes `[3 * nodes]`, and material history.
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
    /// Gauss point states, see [`Model::point_start`]; may be empty for linear models. Shape `[points]`.
    #[serde(default)]
    pub points: Points,
    /// Motion of a reduced solid; `u`, `v`, `a` then follow by
    /// [`ThetaMethod::recover`](crate::theta::ThetaMethod::recover).
    #[serde(default)]
    pub reduced: Coordinates,
}

impl State {
    /// Rest state at time 0, undeformed except prescribed displacements.
    pub fn new(model: &Model) -> State {
        let n = model.dof_count();
        let points = if model.is_linear() { Points::default() } else { model.new_points() };
        let mut state = State {
            time: 0.0,
            u: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            points,
            reduced: Coordinates::default(),
        };
        for &(dof, value) in model.supports().fixed() {
            state.u[dof as usize] = value;
        }
        state
    }

    /// Copies a state of the same model; only Gauss points may allocate.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.u.clone_from(&other.u);
        self.v.clone_from(&other.v);
        self.a.clone_from(&other.a);
        self.points.clone_from(&other.points);
        self.reduced.clone_from(&other.reduced);
    }
}

/// Motion in the basis of a reduced solid: `u = rest + V q`, `v = V q'`, `a = V q''`; empty without a reduction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coordinates {
    /// Displacement when the motion began [m]. Shape `[3 * nodes]`.
    pub rest: Vec<f64>,
    /// q [kg^½ m]. Shape `[shapes]`.
    pub position: Vec<f64>,
    /// q' [kg^½ m/s]. Shape `[shapes]`.
    pub velocity: Vec<f64>,
    /// q'' [kg^½ m/s²]. Shape `[shapes]`.
    pub acceleration: Vec<f64>,
}

impl Coordinates {
    /// No motion of `shapes` from displacements `rest` [m].
    pub fn at_rest(rest: Vec<f64>, shapes: usize) -> Coordinates {
        let zero = vec![0.0; shapes];
        Coordinates { rest, position: zero.clone(), velocity: zero.clone(), acceleration: zero }
    }

    /// Exchanges the motion of the same solid.
    pub fn swap_motion(&mut self, other: &mut Coordinates) {
        std::mem::swap(&mut self.position, &mut other.position);
        std::mem::swap(&mut self.velocity, &mut other.velocity);
        std::mem::swap(&mut self.acceleration, &mut other.acceleration);
    }

    /// Writes −q, −q', −q'' of each shape, as the products with V take them.
    pub(crate) fn negate_into(&self, negative: &mut [f64]) {
        let motion = self.position.iter().zip(&self.velocity).zip(&self.acceleration);
        for (to, ((q, v), a)) in negative.as_chunks_mut::<3>().0.iter_mut().zip(motion) {
            *to = [-q, -v, -a];
        }
    }

    /// Copies the motion of the same solid; `rest` only if it is missing.
    pub fn copy_motion(&mut self, from: &Coordinates) {
        if self.rest.len() != from.rest.len() {
            self.rest.clone_from(&from.rest);
        }
        self.position.clone_from(&from.position);
        self.velocity.clone_from(&from.velocity);
        self.acceleration.clone_from(&from.acceleration);
    }
}

/// Energy terms of one step, to rounding:
///
/// ```text
/// external_work + support_work = change of (kinetic + strain) + damping_dissipation
///     + boundary_dissipation + plastic_dissipation + numerical_dissipation
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepAudit {
    /// Work of the load [J].
    pub external_work: f64,
    /// Work of the supports [J].
    pub support_work: f64,
    /// Rayleigh damping [J].
    pub damping_dissipation: f64,
    /// Boundary dashpots [J].
    pub boundary_dissipation: f64,
    /// Plastic dissipation [J].
    #[serde(default)]
    pub plastic_dissipation: f64,
    /// Numerical dissipation [J]; negative if spurious energy is added.
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
