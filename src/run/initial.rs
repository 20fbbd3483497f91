//! Initial state of a plastic solid.

use trackbed_fem::nonlinear::initial_stress::{self, Overburden};
use trackbed_fem::nonlinear::{QuasiStatic, StepControl};
use trackbed_fem::{Model, State, TimeIntegrator};
use trackbed_input::model::solid::{InitialStressKind, InitialStressPlan, SolidPart};
use trackbed_io::failure::Failure;

/// Returns the initial stress state, and the fraction of weight that it balances.
///
/// # Errors
/// Equilibrium not converged.
pub fn state(part: &SolidPart, model: &Model, gravity: &[f64]) -> Result<(State, f64), Failure> {
    let mut state = undeformed(model);
    let Some(InitialStressPlan { kind, steps, loads }) = &part.initial_stress else {
        return Ok((state, 0.0));
    };
    let mut carried = gravity.to_vec();
    if *loads {
        part.add_loads(0.0, &mut carried);
    }
    match kind {
        InitialStressKind::Gravity => Ok(0),
        InitialStressKind::Uniform(stress) => initial_stress::set_uniform(model, &mut state, *stress),
        InitialStressKind::K0 { k0, overburden } => {
            let top = Overburden::Level(top(model));
            initial_stress::set_k0(model, &mut state, overburden.as_ref().unwrap_or(&top), k0)
        }
    }
    .and_then(|_| initial_stress::equilibrate(model, &mut state, &carried, part.newton, *steps))
    .map_err(|e| part.failure(&e).in_stage("initial stress"))?;
    let points = std::mem::take(&mut state.points);
    Ok((State { points, ..undeformed(model) }, 1.0))
}

/// Returns the initial state in equilibrium with `load` [N], shape `[3·nodes]`, applied in steps.
///
/// # Errors
/// Equilibrium not converged.
pub fn under_load(part: &SolidPart, model: &Model, gravity: &[f64], load: &[f64]) -> Result<State, Failure> {
    let (mut state, carried) = state(part, model, gravity)?;
    let control = StepControl { initial: 0.25, min: 1.0 / 1024.0, max: 1.0, target_iterations: 40 };
    let mut solver = QuasiStatic::new(model, part.newton, control).map_err(|e| part.failure(&e))?;
    let mut loading = |time: f64, f: &mut [f64]| {
        for d in 0..f.len() {
            f[d] = time * load[d] + (1.0 - time) * carried * gravity[d];
        }
    };
    solver
        .integrate(model, &mut state, 1.0, &mut loading, &mut |_, _, _| {})
        .map_err(|e| part.failure(&e).in_stage("before time 0, during application of weight and loads"))?;
    state.time = 0.0;
    Ok(state)
}

/// Moving supports move with the stress.
fn undeformed(model: &Model) -> State {
    let mut state = State::new(model);
    state.u.fill(0.0);
    state
}

/// Against gravity [m].
fn top(model: &Model) -> f64 {
    let g = model.gravity();
    let size = g.iter().map(|g| g * g).sum::<f64>().sqrt();
    let height = |x: &[f64; 3]| -> f64 { (0..3).map(|k| -g[k] / size * x[k]).sum() };
    model.mesh().coordinates.iter().map(height).fold(f64::NEG_INFINITY, f64::max)
}
