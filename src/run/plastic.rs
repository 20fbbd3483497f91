//! A plastic solid that runs alone: in quasi-static steps, or through time.

use super::system::{Applied, SolidView, System};
use crate::failure::Failure;
use crate::model::solid::{InitialStress, InitialStressKind, QuasiStaticPlan, SolidPart, TimeMethod};
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_fem as fem;
use trackbed_fem::State;
use trackbed_fem::nonlinear::{
    Dynamics, DynamicsMethod, Loading, QuasiStatic, Statistics, StepControl, initial_stress,
};
use trackbed_fem::nonlinear::energy;

/// Loads and supports of a solid in time.
struct Course<'a> {
    part: &'a SolidPart,
    gravity: &'a [f64],
    /// The share of dead weight, and of the loads and supports at time 0, while these are brought on; none afterwards.
    share: Option<f64>,
}

impl Loading for Course<'_> {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        let (share, time) = match self.share {
            Some(_) => (time, 0.0),
            None => (1.0, time),
        };
        self.part.add_loads(time, load);
        for (l, g) in load.iter_mut().zip(self.gravity) {
            *l = share * (*l + g);
        }
    }

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        match self.share {
            Some(_) => values.iter_mut().for_each(|v| *v *= time),
            None => self.part.prescribe(time, values),
        }
    }
}

/// A solid brought into equilibrium with its initial stress, its weight, and the loads and supports at time 0.
///
/// # Errors
/// It finds no equilibrium.
pub fn at_rest(part: &SolidPart, gravity: &[f64]) -> Result<State, Failure> {
    let model = &part.model;
    let mut state = State::new(model);
    if let Some(InitialStress { kind, .. }) = &part.initial_stress {
        match kind {
            InitialStressKind::Gravity => {}
            InitialStressKind::Uniform(stress) => initial_stress::uniform(model, &mut state, *stress),
            InitialStressKind::K0 { k0, surface } => initial_stress::k0(model, &mut state, k0, *surface),
        }
        .map_err(|e| part.failure(&e))?;
    }
    Ok(state)
}
