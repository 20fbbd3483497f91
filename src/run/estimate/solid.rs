//! What a step of the solid costs, of which a few are made, and what a static solve will, which is done in one go.

use super::clock::Clock;
use super::{Known, StageTime};
use crate::failure::Failure;
use crate::model::Job;
use crate::model::solid::{Analysis, SolidPart};
use crate::run::{Prediction, initial};
use nalgebra::DMatrix;
use std::time::{Duration, Instant};
use trackbed_fem::theta::{NonlinearTheta, ThetaMethod, ThetaSolver};
use trackbed_fem::{Method, Model, SolveError, State};

/// Time by the clock for steps.
const ENOUGH: Duration = Duration::from_millis(500);

/// Share of its weight by which the load of a solid changes from window to window, so that a plastic one takes an iteration in each.
const RESTLESS: f64 = 0.01;

/// Seconds of one step of `dt` [s] of a solid that moves under its weight, its factorization apart where one serves all
/// steps.
///
/// # Errors
/// A matrix cannot be factored; no equilibrium.
pub fn step(part: &SolidPart, theta: f64, dt: f64) -> Result<f64, Failure> {
    let (model, gravity) = (&part.model, part.model.gravity_load());
    let failure = |e: SolveError| part.failure(&e);
    let (mut state, mut solver): (State, Box<dyn ThetaMethod>) = if part.is_linear() {
        (State::new(model), Box::new(ThetaSolver::new(model, theta, dt).map_err(failure)?))
    } else {
        // Let go without stress, a soil would yield everywhere, and the more so the less it is confined.
        let state = initial::under_load(part, model, &gravity, &gravity)?;
        (state, Box::new(NonlinearTheta::new(model, theta, dt, part.newton).map_err(failure)?))
    };
    let (mut load, mut heavier) = (gravity.clone(), false);
    time(|| {
        heavier = !heavier;
        let factor = if heavier { 1.0 + RESTLESS } else { 1.0 };
        load.iter_mut().zip(&gravity).for_each(|(l, g)| *l = factor * g);
        solver.step(model, &mut state, &load).map(drop).map_err(failure)
    })
}

/// Static solves that are estimated to take longer are not rehearsed [s].
const LONG: f64 = 2.0;
/// Rate of the factorization over that of a product of dense matrices, on one thread.
const RATE: f64 = 0.75;
/// Order of these matrices.
const ORDER: usize = 512;

/// Products with the stiffness in a static solve by conjugate gradients: some 60 iterations of 12, most of them in single
/// precision, and the set-up.
const PRODUCTS: f64 = 560.0;

/// The static solve of a large solid, from the operations of its factorization or from a product; none where it is short, or not
/// what the scene has.
pub fn statics(job: &Job, threads: usize) -> Option<Vec<StageTime>> {
    let part = job.solid.as_ref().filter(|s| matches!(s.analysis, Analysis::Static))?;
    if job.grains.is_some() {
        return None;
    }
    let seconds = match part.equations.methods.statics {
        Method::Iterative { .. } => PRODUCTS * product(&part.model) / super::cores(threads),
        Method::Direct => Prediction::of(part).ok()?.flops / (rate() * super::cores(threads)),
        // A library, on one thread.
        _ => part.model.solver_demand(true).ok()?.flops / rate(),
    };
    let stage = StageTime { name: "static".into(), seconds, known: Known::Expected };
    (seconds > LONG).then(|| vec![stage])
}

/// Seconds of a product with the stiffness on one thread.
fn product(model: &Model) -> f64 {
    let (x, mut y) = (vec![1.0; model.dof_count()], vec![0.0; model.dof_count()]);
    // The first one touches what the second finds warm.
    model.stiffness_times(&x, &mut y);
    let clock = Clock::start(1);
    model.stiffness_times(&x, &mut y);
    clock.seconds()
}

/// Operations per second of a factorization on one thread.
fn rate() -> f64 {
    let matrix = DMatrix::from_fn(ORDER, ORDER, |i, j| 1.0 / (1.0 + i as f64 + j as f64));
    let mut product = matrix.clone();
    let clock = Clock::start(1);
    product.gemm(1.0, &matrix, &matrix, 1.0);
    let seconds = clock.seconds();
    if product[(0, 0)] > 0.0 { RATE * 2.0 * (ORDER as f64).powi(3) / seconds } else { 1e10 }
}

/// Seconds of a step.
fn time(mut step: impl FnMut() -> Result<(), Failure>) -> Result<f64, Failure> {
    // The first one touches what the others find warm.
    step()?;
    let (begun, clock, mut steps) = (Instant::now(), Clock::start(rayon::current_num_threads()), 0);
    while steps < 3 || begun.elapsed() < ENOUGH {
        step()?;
        steps += 1;
    }
    Ok(clock.seconds() / f64::from(steps))
}
