//! What a step of the solid costs, of which a few are made, and what a static solve will, which is done in one go.

use super::{Known, StageTime};
use crate::failure::Failure;
use crate::model::Job;
use crate::model::solid::{Analysis, SolidPart, TimeMethod};
use crate::run::Prediction;
use crate::run::plastic::PlasticDynamics;
use crate::run::system::{SolidSystem, System};
use nalgebra::DMatrix;
use std::time::{Duration, Instant};
use trackbed_fem::newmark::Newmark;

/// Time by the clock for steps.
const ENOUGH: Duration = Duration::from_millis(500);

/// Share of its weight with which a plastic solid is in equilibrium; the rest sets it in motion.
const AT_REST: f64 = 0.99;

/// Seconds by the clock of one step of `dt` [s] of a solid that moves under its weight, its factorization apart where it is elastic.
///
/// # Errors
/// A matrix cannot be factored; no equilibrium.
pub fn step(part: &SolidPart, dt: f64) -> Result<f64, Failure> {
    let method = TimeMethod::Newmark(Newmark { alpha: 0.25, delta: 0.5 });
    if part.is_linear() {
        time(&mut SolidSystem::new(part, method, dt).map_err(|e| part.failure(&e))?)
    } else {
        // Let go without stress, a soil would yield everywhere, and the more so the less it is confined.
        time(&mut PlasticDynamics::nearly_at_rest(part, method, dt, AT_REST)?)
    }
}

/// Static solves that are estimated to take longer are not rehearsed [s].
const LONG: f64 = 2.0;
/// Rate of the factorization over that of a product of dense matrices, on one thread.
const RATE: f64 = 0.75;
/// Order of these matrices.
const ORDER: usize = 512;

/// The static solve of a large solid, from the operations of its factorization; none where it is short, or not what the scene has.
pub fn statics(job: &Job, threads: usize) -> Option<Vec<StageTime>> {
    let part = job.solid.as_ref().filter(|s| matches!(s.analysis, Analysis::Static))?;
    if job.grains.is_some() {
        return None;
    }
    let flops = Prediction::of(part).ok()?.flops;
    let matrix = DMatrix::from_fn(ORDER, ORDER, |i, j| 1.0 / (1.0 + i as f64 + j as f64));
    let mut product = matrix.clone();
    let begun = Instant::now();
    product.gemm(1.0, &matrix, &matrix, 1.0);
    let seconds = begun.elapsed().as_secs_f64();
    let rate = if product[(0, 0)] > 0.0 { RATE * 2.0 * (ORDER as f64).powi(3) / seconds } else { 1e10 };
    let seconds = flops / (rate * super::cores(threads));
    let stage = StageTime { name: "static".into(), seconds, known: Known::Expected };
    (seconds > LONG).then(|| vec![stage])
}

fn time<S: System>(system: &mut S) -> Result<f64, Failure> {
    // The first one touches what the others find warm.
    system.advance(&mut |_, _, _, _| ())?;
    let (begun, mut steps) = (Instant::now(), 0);
    while steps < 3 || begun.elapsed() < ENOUGH {
        system.advance(&mut |_, _, _, _| ())?;
        steps += 1;
    }
    Ok(begun.elapsed().as_secs_f64() / f64::from(steps))
}
