//! Cost of solid steps and static solves.

use super::clock::Clock;
use super::{Known, StageTime};
use crate::initial;
use crate::stages::reduction;
use nalgebra::DMatrix;
use std::time::{Duration, Instant};
use trackbed_coupling::surface::SolidSurface;
use trackbed_fem::mesh::Face;
use trackbed_fem::theta::{NonlinearTheta, ThetaMethod, ThetaSolver};
use trackbed_fem::{Model, SolveError, State};
use trackbed_input::model::Job;
use trackbed_input::model::grains::GrainsPart;
use trackbed_input::model::solid::{Analysis, SolidPart};
use trackbed_io::failure::Failure;

const ENOUGH: Duration = Duration::from_millis(500);

/// Load change per window over weight, so that plastic solids iterate.
const RESTLESS: f64 = 0.01;

/// Returns seconds per step of `dt` [s] under gravity, without a shared factorization.
///
/// # Errors
/// Failed factorization; equilibrium not converged.
pub fn step(part: &SolidPart, theta: f64, dt: f64) -> Result<f64, Failure> {
    let (model, gravity) = (&part.model, part.model.gravity_load());
    let failure = |e: SolveError| part.failure(&e);
    let (mut state, mut solver): (State, Box<dyn ThetaMethod>) = if part.is_linear() {
        (State::new(model), Box::new(ThetaSolver::new(model, theta, dt).map_err(failure)?))
    } else {
        // An unstressed soil would yield everywhere.
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

/// Steps of the full solid in the time of as many `windows`, less if a reduced basis is used; grains load the faces below and
/// between their first places.
pub fn steps(part: &SolidPart, ground: &SolidSurface, grains: &GrainsPart, windows: f64) -> f64 {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for body in &grains.groups.bodies {
        for d in 0..2 {
            ends[d] = [ends[d][0].min(body.position[d]), ends[d][1].max(body.position[d])];
        }
    }
    let below = |face: &&Face| {
        let centre = face.centre(part.model.mesh());
        (0..2).all(|d| (ends[d][0]..=ends[d][1]).contains(&centre[d]))
    };
    let loaded: Vec<Face> = ground.faces().iter().filter(below).copied().collect();
    reduction::full_steps(part, ground.faces(), &loaded, windows)
}

/// Longer static solves are not run [s].
const LONG: f64 = 2.0;
/// Speed relative to dense matrix products, on one thread.
const RATE: f64 = 0.75;
const ORDER: usize = 512;

/// Estimates the static solve of a large solid; none if short or absent.
pub fn statics(job: &Job, threads: usize) -> Option<Vec<StageTime>> {
    let part = job.solid.as_ref().filter(|s| matches!(s.analysis, Analysis::Static))?;
    if job.grains.is_some() {
        return None;
    }
    let method = part.equations.methods.statics;
    let cores = if method.is_serial() { 1.0 } else { super::cores(threads) };
    let seconds = match method.statics_products() {
        Some(products) => products * product(&part.model) / cores,
        None => part.model.solver_demand(true).ok()?.flops / (rate() * cores),
    };
    let stage = StageTime { name: "static".into(), seconds, known: Known::Expected };
    (seconds > LONG).then(|| vec![stage])
}

fn product(model: &Model) -> f64 {
    let (x, mut y) = (vec![1.0; model.dof_count()], vec![0.0; model.dof_count()]);
    // The first call warms the cache.
    model.stiffness_times(&x, &mut y);
    let clock = Clock::start(1);
    model.stiffness_times(&x, &mut y);
    clock.seconds()
}

fn rate() -> f64 {
    let matrix = DMatrix::from_fn(ORDER, ORDER, |i, j| 1.0 / (1.0 + i as f64 + j as f64));
    let mut product = matrix.clone();
    let clock = Clock::start(1);
    product.gemm(1.0, &matrix, &matrix, 1.0);
    let seconds = clock.seconds();
    if product[(0, 0)] > 0.0 { RATE * 2.0 * (ORDER as f64).powi(3) / seconds } else { 1e10 }
}

fn time(mut step: impl FnMut() -> Result<(), Failure>) -> Result<f64, Failure> {
    // The first call warms the cache.
    step()?;
    let (begun, clock, mut steps) = (Instant::now(), Clock::start(rayon::current_num_threads()), 0);
    while steps < 3 || begun.elapsed() < ENOUGH {
        step()?;
        steps += 1;
    }
    Ok(clock.seconds() / f64::from(steps))
}
