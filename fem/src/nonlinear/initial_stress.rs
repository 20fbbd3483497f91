//! The stress that the ground has before anything is built on it.
//!
//! Three ways: a given constant stress; the K0 state, vertical stress from the weight above and horizontal stress K0 times that; or
//! gravity turned on in steps. The last two are brought to equilibrium by Newton's iteration, and the displacements are
//! set to zero afterwards (on boundary springs they stay), so that what follows starts from undeformed ground under stress.
//!
//! Source: Potts and Zdravković, Finite Element Analysis in Geotechnical Engineering: Theory (1999), section 10.3. Limits: K0 is
//! exact for level ground alone; under a slope the equilibrium changes it.
//!
//! Theory manual: equation (4.15) of `docs/theory/solid.md`.

use super::conditions::ensure_points;
use super::options::NewtonOptions;
use super::quasi_static::QuasiStatic;
use crate::element::stiffness_points;
use crate::error::SolveError;
use crate::integrator::{Driven, Statistics, StepControl, TimeIntegrator};
use crate::material::{Point, PointState, Region};
use crate::model::Model;
use crate::state::State;
use std::collections::BTreeMap;

/// What lies above a point.
#[derive(Clone, Debug, PartialEq)]
pub enum Overburden {
    /// Level ground at this height [m] against the direction of gravity, of one density: that of the element of the point.
    Level(f64),
    /// Level layers, from the top down: height of the top [m] and density [kg/m³]. The last goes down without end.
    Layers(Vec<(f64, f64)>),
}

impl Overburden {
    /// Mass above a square metre at the height `z` [kg/m²]; `density` is that of the place itself.
    fn mass(&self, z: f64, density: f64) -> f64 {
        match self {
            Overburden::Level(top) => density * (top - z).max(0.0),
            Overburden::Layers(layers) => {
                let bottom = |i: usize| layers.get(i + 1).map_or(f64::NEG_INFINITY, |l| l.0);
                layers.iter().enumerate().map(|(i, (top, rho))| rho * (top - bottom(i).max(z)).max(0.0)).sum()
            }
        }
    }
}

/// How an initial state came about.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InitialReport {
    /// Points whose stress lay outside the yield surface and was returned to it.
    pub returned: usize,
    /// Largest displacement [m] on the way to equilibrium, set to zero afterwards.
    pub largest_displacement: f64,
    /// Counts and times.
    pub statistics: Statistics,
}

/// Gives every point the stress `stress` [Pa] (xx yy zz xy yz zx, tension positive), returned to the yield surface where it lies outside.
/// Equilibrium is not sought. Returns the number of points returned.
///
/// # Errors
/// A stress that is not finite.
pub fn set_uniform(model: &Model, state: &mut State, stress: [f64; 6]) -> Result<usize, SolveError> {
    set(model, state, |_, _| stress)
}

/// Gives every point the K0 state: vertical stress from what lies above, horizontal stress `k0` (by material number; 1 - sin phi or
/// what was measured) times that, along and across the direction of gravity. Returns the number of points returned to the yield
/// surface.
///
/// # Errors
/// A K0 that is missing or out of [0, 10], no gravity, layers that do not descend.
pub fn set_k0(
    model: &Model,
    state: &mut State,
    overburden: &Overburden,
    k0: &BTreeMap<u32, f64>,
) -> Result<usize, SolveError> {
    let g = model.gravity();
    let size = (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]).sqrt();
    if size == 0.0 {
        return Err(SolveError::Option {
            what: "gravity",
            value: 0.0,
            expected: "a value above 0 for a K0 state",
        });
    }
    if let Overburden::Layers(layers) = overburden {
        let sorted = layers.windows(2).all(|pair| pair[0].0 > pair[1].0);
        if layers.is_empty() || !sorted || layers.iter().any(|l| !(l.0 + l.1).is_finite() || l.1 < 0.0) {
            let (what, value) = ("the number of layers", layers.len() as f64);
            let expected = "1 or more, from the top down, with densities of 0 or above";
            return Err(SolveError::Option { what, value, expected });
        }
    }
    for number in &model.mesh().materials {
        let value = k0.get(number).copied().unwrap_or(f64::NAN);
        if !(0.0..=10.0).contains(&value) {
            return Err(SolveError::Option {
                what: "K0",
                value,
                expected: "0 to 10 for every material in use",
            });
        }
    }
    let up = g.map(|g| -g / size);
    set(model, state, |e, x| {
        let z = (0..3).map(|k| up[k] * x[k]).sum();
        let vertical = -size * overburden.mass(z, model.elastic(e).density);
        let horizontal = k0[&model.mesh().materials[e]] * vertical;
        let pair = |i: usize, j: usize| (vertical - horizontal) * up[i] * up[j];
        [
            horizontal + pair(0, 0),
            horizontal + pair(1, 1),
            horizontal + pair(2, 2),
            pair(0, 1),
            pair(1, 2),
            pair(2, 0),
        ]
    })
}

/// Sets the stresses given by element and position; history starts at zero.
fn set(
    model: &Model,
    state: &mut State,
    stress: impl Fn(usize, [f64; 3]) -> [f64; 6],
) -> Result<usize, SolveError> {
    let mesh = model.mesh();
    let mut points = model.new_points();
    let (states, values) = points.split_mut();
    let mut returned = 0;
    for e in 0..mesh.element_count() {
        let (x, kind) = (mesh.element_coordinates(e), mesh.connectivity.kind(e));
        for (i, point) in stiffness_points(kind, model.quadrature()).iter().enumerate() {
            let at = std::array::from_fn(|k| point.shape.iter().zip(&x).map(|(n, x)| n * x[k]).sum());
            let (material, own) = (model.material(e), model.values(e, i));
            let mut new = PointState { stress: stress(e, at), ..Default::default() };
            let mut start = vec![0.0; own.len()];
            material.law.initial_values(&new.stress, &mut start);
            let values = &mut values[own];
            values.copy_from_slice(&start);
            let old = Point { state: &new, values: &start };
            if material.law.yield_function(old) > 0.0 || new.stress.iter().any(|s| !s.is_finite()) {
                let response = material.law.update(&material.elastic, old, &[0.0; 6], false, values);
                let response = response.map_err(|_| {
                    let (element, region) = (mesh.element_ids[e], Region::Elastic);
                    let (time, residual) = (state.time, f64::NAN);
                    let (point, xi) = (i as u32 + 1, point.xi);
                    SolveError::Diverged { time, iterations: 0, residual, element, point, xi, region }
                })?;
                returned += usize::from(response.region != Region::Elastic);
                // What returned it is no history of the ground.
                new.stress = response.state.stress;
            }
            states[model.point_start(e) + i] = new;
        }
    }
    state.points = points;
    Ok(returned)
}

/// Brings a state to equilibrium with `load` [N] (shape `[3 * nodes]`; gravity goes in here), from whatever stresses it has. The
/// part of the load that the stresses do not carry is applied in steps. Displacements, velocities and accelerations are
/// then set to zero but for the prescribed displacements, time to what it was. On boundary springs the displacements stay,
/// because it is by them that the springs carry the body.
///
/// # Errors
/// As [`QuasiStatic::advance`]; the state is that of before then.
pub fn equilibrate(
    model: &Model,
    state: &mut State,
    load: &[f64],
    options: NewtonOptions,
    steps: u32,
) -> Result<InitialReport, SolveError> {
    let mut next = state.clone();
    next.time = 0.0;
    ensure_points(model, &mut next);
    let mut solver = QuasiStatic::new(model, options, StepControl::fixed(1.0 / f64::from(steps.max(1))))?;
    // What the stresses carry already stays on from the start.
    let carried = solver.carried(model, &next);
    let fixed: Vec<f64> = model.supports().fixed().iter().map(|(dof, _)| next.u[*dof as usize]).collect();
    let mut loading = Driven {
        load: |time: f64, f: &mut [f64]| {
            for d in 0..f.len() {
                f[d] = time * load[d] + (1.0 - time) * carried[d];
            }
        },
        prescribed: |_: f64, values: &mut [f64]| values.copy_from_slice(&fixed),
    };
    let start = next.u.clone();
    solver.integrate(model, &mut next, 1.0, &mut loading, &mut |_, _, _| ())?;
    let largest_displacement = next.u.iter().zip(&start).fold(0.0, |m: f64, (u, s)| m.max((u - s).abs()));
    let mut rest = State::new(model);
    if !model.matrices().springs().is_empty() {
        rest.u = next.u;
    }
    *state = State { time: state.time, points: next.points, ..rest };
    Ok(InitialReport { returned: 0, largest_displacement, statistics: solver.statistics() })
}

/// Turns gravity on in `steps` steps from the state as it is, and sets the displacements to zero.
///
/// # Errors
/// As [`equilibrate`].
pub fn turn_on_gravity(
    model: &Model,
    state: &mut State,
    options: NewtonOptions,
    steps: u32,
) -> Result<InitialReport, SolveError> {
    equilibrate(model, state, &model.gravity_load(), options, steps)
}

/// The K0 state, brought to equilibrium under gravity.
///
/// # Errors
/// As [`set_k0`] and [`equilibrate`].
pub fn k0(
    model: &Model,
    state: &mut State,
    overburden: &Overburden,
    k0: &BTreeMap<u32, f64>,
    options: NewtonOptions,
    steps: u32,
) -> Result<InitialReport, SolveError> {
    let mut next = state.clone();
    let returned = set_k0(model, &mut next, overburden, k0)?;
    let report = equilibrate(model, &mut next, &model.gravity_load(), options, steps)?;
    *state = next;
    Ok(InitialReport { returned, ..report })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_add_up() {
        let layers = Overburden::Layers(vec![(10.0, 1500.0), (8.0, 2000.0), (5.0, 1000.0)]);
        assert_eq!(layers.mass(11.0, 9.0), 0.0);
        assert_eq!(layers.mass(9.0, 9.0), 1500.0);
        assert_eq!(layers.mass(8.0, 9.0), 3000.0);
        assert_eq!(layers.mass(4.0, 9.0), 3000.0 + 6000.0 + 1000.0);
        assert_eq!(Overburden::Level(2.0).mass(-1.0, 1000.0), 3000.0);
    }
}
