//! Steps of a stress point under mixed control.

use super::checks::{Checks, Increment};
use super::path::{Control, Sample};
use crate::material::{
    Material, Point, PointState, REGULARISATION, Response, ReturnError, UpdateContext, regularise,
};
use nalgebra::{Matrix6, Vector6};
use thiserror::Error;

/// Largest residual of the prescribed stress over the size of the stress.
pub const TOLERANCE: f64 = 1e-10;
/// Most parts of a step.
pub const MOST_PARTS: u32 = 1 << 10;
const ITERATIONS: usize = 40;

/// Step that did not converge.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "step {step} not converged: residual {residual:.1e} of the stress (limit {TOLERANCE:e}) with {MOST_PARTS} parts{}",
    reason(cause)
)]
pub struct StepFailure {
    /// Step, from 1.
    pub step: usize,
    /// Smallest residual of the last attempt over the size of the stress; infinite without a result.
    pub residual: f64,
    /// Failure of the law, if any.
    pub cause: Option<ReturnError>,
}

fn reason(cause: &Option<ReturnError>) -> String {
    cause.map_or(String::new(), |cause| format!(": {cause}"))
}

struct Attempt {
    residual: f64,
    cause: Option<ReturnError>,
}

/// State of the point.
pub(super) struct Driver<'a> {
    material: &'a Material,
    state: PointState,
    values: Vec<f64>,
    strain: [f64; 6],
    plastic_work: f64,
    /// A step lasts 1 s.
    context: UpdateContext,
}

impl<'a> Driver<'a> {
    pub(super) fn new(material: &'a Material, stress: &[f64; 6]) -> Driver<'a> {
        let state = PointState { stress: *stress, ..PointState::default() };
        let mut values = vec![0.0; material.law.state_values().len()];
        material.law.initial_values(&material.elastic, stress, &mut values);
        let context = UpdateContext { time: 0.0, time_step: 1.0, element: 1, point: 1 };
        Driver { material, state, values, strain: [0.0; 6], plastic_work: 0.0, context }
    }

    pub(super) fn point(&self) -> Point<'_> {
        Point { state: &self.state, values: &self.values, context: self.context }
    }

    pub(super) fn sample(&self) -> Sample {
        Sample {
            strain: self.strain,
            state: self.state,
            values: self.values.clone(),
            plastic_work: self.plastic_work,
        }
    }

    /// Current values of the controlled components.
    pub(super) fn values_of(&self, controls: &[Control; 6]) -> [f64; 6] {
        std::array::from_fn(|k| match controls[k] {
            Control::Strain => self.strain[k],
            Control::Stress => self.state.stress[k],
        })
    }

    /// Moves the controlled components to `aim`, in parts if necessary.
    pub(super) fn step(
        &mut self,
        step: usize,
        controls: &[Control; 6],
        aim: &[f64; 6],
        checks: &mut Checks,
    ) -> Result<(), StepFailure> {
        let start = self.values_of(controls);
        let (mut done, mut part) = (0, MOST_PARTS);
        while done < MOST_PARTS {
            let end = done + part;
            let share = f64::from(end) / f64::from(MOST_PARTS);
            let aim = std::array::from_fn(|k| match end {
                MOST_PARTS => aim[k],
                _ => start[k] + share * (aim[k] - start[k]),
            });
            self.context.time = (step - 1) as f64 + f64::from(done) / f64::from(MOST_PARTS);
            self.context.time_step = f64::from(part) / f64::from(MOST_PARTS);
            match self.solve(controls, &aim) {
                Ok((increment, response, values)) => {
                    self.commit(step, &increment, &response, values, checks);
                    done = end;
                }
                Err(Attempt { residual, cause }) if part == 1 => {
                    return Err(StepFailure { step, residual, cause });
                }
                Err(_) => part /= 2,
            }
        }
        Ok(())
    }

    fn solve(
        &self,
        controls: &[Control; 6],
        aim: &[f64; 6],
    ) -> Result<([f64; 6], Response, Vec<f64>), Attempt> {
        let free = |k: usize| controls[k] == Control::Stress;
        let mut increment: [f64; 6] =
            std::array::from_fn(|k| if free(k) { 0.0 } else { aim[k] - self.strain[k] });
        let mut values = vec![0.0; self.values.len()];
        let mut best = f64::INFINITY;
        let prescribed = (0..6).filter(|k| free(*k)).map(|k| aim[k]);
        let scale = largest(self.state.stress.into_iter().chain(prescribed));
        for _ in 0..ITERATIONS {
            let mut response = self
                .material
                .law
                .update(&self.material.elastic, self.point(), &increment, true, &mut values)
                .map_err(|cause| Attempt { residual: best, cause: Some(cause) })?;
            let stress = response.state.stress;
            let missing: [f64; 6] = std::array::from_fn(|k| if free(k) { aim[k] - stress[k] } else { 0.0 });
            let size = largest(missing.into_iter());
            let scale = scale.max(largest(stress.into_iter()));
            if size <= TOLERANCE * scale {
                return Ok((increment, response, values));
            }
            best = best.min(size / scale);
            // Singular on edges of Mohr-Coulomb.
            regularise(&mut response.tangent, &self.material.elastic, REGULARISATION);
            let row = |i: usize, j: usize| match free(i) {
                true => response.tangent[i][j],
                false => f64::from(u8::from(i == j)),
            };
            let change = Matrix6::from_fn(row).lu().solve(&Vector6::from(missing));
            let Some(change) = change.filter(|c| c.iter().all(|x| x.is_finite())) else { break };
            (0..6).filter(|k| free(*k)).for_each(|k| increment[k] += change[k]);
        }
        Err(Attempt { residual: best, cause: None })
    }

    fn commit(
        &mut self,
        step: usize,
        increment: &[f64; 6],
        response: &Response,
        values: Vec<f64>,
        checks: &mut Checks,
    ) {
        let old = self.point();
        self.plastic_work += checks.add(&Increment { step, old, increment, response });
        self.state = response.state;
        self.values = values;
        (0..6).for_each(|k| self.strain[k] += increment[k]);
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| most.max(value.abs()))
}
