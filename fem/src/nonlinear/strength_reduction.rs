//! Factor of safety by strength reduction.
//!
//! Trials with cohesion and tan(phi) divided by F apply the whole load from one state. F is bracketed by
//! factors of 1.5, then bisected. Source: Griffiths and Lane (1999); Zienkiewicz, Humpheson and Lewis
//! (1975). Limits: the bracket depends on the iteration limit by some per cent; displacements rise steeply
//! near failure.

use super::options::NewtonOptions;
use super::quasi_static::QuasiStatic;
use crate::error::SolveError;
use crate::integrator::{Statistics, StepControl, TimeIntegrator};
use crate::model::Model;
use crate::state::State;
use serde::{Deserialize, Serialize};

/// Options of a strength reduction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReductionOptions {
    /// First trial factor.
    pub start: f64,
    /// Final width of the bracket.
    pub tolerance: f64,
    /// Largest trial factor; its reciprocal is the smallest.
    pub largest: f64,
    /// Newton options: many iterations and a loose tolerance, as slow convergence is not failure.
    pub newton: NewtonOptions,
    /// Load steps, from 0 to 1.
    pub control: StepControl,
}

impl Default for ReductionOptions {
    fn default() -> Self {
        ReductionOptions {
            start: 1.0,
            tolerance: 0.02,
            largest: 16.0,
            newton: NewtonOptions { max_iterations: 100, force_tolerance: 1e-3, ..NewtonOptions::default() },
            control: StepControl { initial: 1.0, min: 1.0 / 32.0, max: 1.0, target_iterations: 100 },
        }
    }
}

/// Trial.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Factor.
    pub factor: f64,
    /// Whether the whole load was applied.
    pub converged: bool,
    /// Fraction of the load applied.
    pub share: f64,
    /// Iterations, including rejected steps.
    pub iterations: u64,
    /// Largest displacement [m] at the last converged load.
    pub largest_displacement: f64,
}

/// Bracket of the factor of safety.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FactorOfSafety {
    /// Largest stable factor.
    pub converged: f64,
    /// Smallest unstable factor.
    pub failed: f64,
    /// Trials by factor.
    pub trials: Vec<Trial>,
}

/// Brackets the factor of safety under `load` [N] (shape `[3 * nodes]`, including gravity), from `state`.
///
/// # Errors
/// Options out of range; no plasticity; no failure at the largest factor, or not converged at the smallest.
pub fn factor_of_safety(
    model: &Model,
    state: &State,
    load: &[f64],
    options: &ReductionOptions,
) -> Result<FactorOfSafety, SolveError> {
    let ReductionOptions { start, tolerance, largest, .. } = *options;
    for (what, value, fine) in [
        ("the first factor", start, start > 0.0 && start.is_finite()),
        ("the width of the bracket", tolerance, tolerance > 0.0 && tolerance.is_finite()),
        ("the largest factor", largest, largest > start && largest.recip() < start && largest.is_finite()),
    ] {
        if !fine {
            return Err(SolveError::Option {
                what,
                value,
                expected: "above 0, the first within the largest",
            });
        }
    }
    if model.is_linear() {
        let what = "the number of plastic materials";
        return Err(SolveError::Option {
            what,
            value: 0.0,
            expected: "1 or more: an elastic body does not fail",
        });
    }
    let mut trials = Vec::new();
    let mut attempt = |factor: f64| -> Result<bool, SolveError> {
        let trial = attempt(model, state, load, options, factor)?;
        trials.push(trial);
        Ok(trial.converged)
    };
    let (mut converged, mut failed) = (None, None);
    let mut factor = start;
    let (converged, failed) = loop {
        if attempt(factor)? {
            converged = Some(factor);
            factor *= 1.5;
        } else {
            failed = Some(factor);
            factor /= 1.5;
        }
        if let (Some(converged), Some(failed)) = (converged, failed) {
            break (converged, failed);
        }
        if !(largest.recip()..=largest).contains(&factor) {
            let what = "the factor of safety";
            return Err(SolveError::Option { what, value: factor, expected: "within the largest factor" });
        }
    };
    let (mut low, mut high) = (converged, failed);
    while high - low > tolerance {
        let middle = 0.5 * (low + high);
        if attempt(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    trials.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    Ok(FactorOfSafety { converged: low, failed: high, trials })
}

/// Model with strength divided by `factor`, and its state under the whole load.
///
/// # Errors
/// As [`QuasiStatic::advance`]; none at stable factors.
pub fn at_factor(
    model: &Model,
    state: &State,
    load: &[f64],
    options: &ReductionOptions,
    factor: f64,
) -> Result<(Model, State), SolveError> {
    let reduced = reduced(model, factor)?;
    let (next, _, outcome) = solve_at_reduced_strength(&reduced, state, load, options)?;
    outcome.map(|()| (reduced, next))
}

fn reduced(model: &Model, factor: f64) -> Result<Model, SolveError> {
    let materials =
        model.materials().iter().map(|(&number, m)| (number, m.with_strength_divided_by(factor))).collect();
    model.with_laws(materials).map_err(|_| SolveError::Option {
        what: "the factor of reduction",
        value: factor,
        expected: "one that leaves usable constants",
    })
}

/// Returns the last converged state, its trial, and whether the load is complete.
fn solve_at_reduced_strength(
    reduced: &Model,
    state: &State,
    load: &[f64],
    options: &ReductionOptions,
) -> Result<(State, Statistics, Result<(), SolveError>), SolveError> {
    let mut trial = state.clone();
    trial.time = 0.0;
    let mut solver = QuasiStatic::new(reduced, options.newton, options.control)?;
    let mut loading = |time: f64, f: &mut [f64]| f.iter_mut().zip(load).for_each(|(f, l)| *f = time * l);
    let outcome = solver.integrate(reduced, &mut trial, 1.0, &mut loading, &mut |_, _, _| ());
    Ok((trial, solver.statistics(), outcome))
}

fn attempt(
    model: &Model,
    state: &State,
    load: &[f64],
    options: &ReductionOptions,
    factor: f64,
) -> Result<Trial, SolveError> {
    let (trial, statistics, outcome) =
        solve_at_reduced_strength(&reduced(model, factor)?, state, load, options)?;
    match outcome {
        Ok(()) | Err(SolveError::Diverged { .. }) => Ok(Trial {
            factor,
            converged: outcome.is_ok(),
            share: trial.time,
            iterations: statistics.iterations,
            largest_displacement: trial
                .u
                .iter()
                .zip(&state.u)
                .fold(0.0, |m: f64, (u, s)| m.max((u - s).abs())),
        }),
        Err(error) => Err(error),
    }
}
