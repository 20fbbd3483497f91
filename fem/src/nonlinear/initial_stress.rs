//! Initial ground stress: uniform, K0, or gravity in steps.
//!
//! Source: Potts and Zdravković (1999), section 10.3. Limits: K0 is exact for level ground only.
//!
//! Theory manual: equation (4.15) of `docs/theory/solid.md`.

use super::conditions::ensure_points;
use super::options::NewtonOptions;
use super::quasi_static::QuasiStatic;
use crate::element::stiffness_points;
use crate::error::SolveError;
use crate::integrator::{LoadFunctions, Statistics, StepControl, TimeIntegrator};
use crate::material::{Point, PointState, ReturnRegion};
use crate::model::Model;
use crate::state::State;
use std::collections::BTreeMap;

/// Overburden of a point.
#[derive(Clone, Debug, PartialEq)]
pub enum Overburden {
    /// Ground level [m] against gravity; density of the point's element.
    Level(f64),
    /// Layers from the top: height of the top [m], density [kg/m³]; the last is unbounded.
    Layers(Vec<(f64, f64)>),
}

impl Overburden {
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

/// Report of an initial state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InitialReport {
    /// Points returned to the yield surface.
    pub returned: usize,
    /// Largest displacement [m] before zeroing.
    pub largest_displacement: f64,
    /// Counts and times.
    pub statistics: Statistics,
}

/// Sets a uniform stress [Pa] (xx yy zz xy yz zx, tension positive) without equilibrium; returns the number
/// of points returned to the yield surface.
///
/// # Errors
/// Stress not finite.
pub fn set_uniform(model: &Model, state: &mut State, stress: [f64; 6]) -> Result<usize, SolveError> {
    set(model, state, |_, _| stress)
}

/// Sets the K0 state with horizontal stress `k0` (by material number) times vertical; returns the number of
/// points returned to yield.
///
/// # Errors
/// K0 missing or out of [0, 10], no gravity, or layers not descending.
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
            material.law.initial_values(&material.elastic, &new.stress, &mut start);
            let values = &mut values[own];
            values.copy_from_slice(&start);
            let old = Point::new(&new, &start);
            if material.law.yield_function(old) > 0.0 || new.stress.iter().any(|s| !s.is_finite()) {
                let response = material.law.update(&material.elastic, old, &[0.0; 6], false, values);
                let response = response.map_err(|_| {
                    let (element, region) = (mesh.element_ids[e], ReturnRegion::Elastic);
                    let (time, residual) = (state.time, f64::NAN);
                    let (point, xi) = (i as u32 + 1, point.xi);
                    SolveError::Diverged { time, iterations: 0, residual, element, point, xi, region }
                })?;
                returned += usize::from(response.region != ReturnRegion::Elastic);
                // This return is not part of the ground's history.
                new.stress = response.state.stress;
            }
            states[model.point_start(e) + i] = new;
        }
    }
    state.points = points;
    Ok(returned)
}

/// Equilibrates a state with `load` [N] (shape `[3 * nodes]`, including gravity), then resets displacements
/// (except prescribed ones or on boundary springs), velocities, accelerations and time.
///
/// # Errors
/// As [`QuasiStatic::advance`], with unchanged state.
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
    // The part already in equilibrium acts from the start.
    let carried = solver.internal_force(model, &next);
    let fixed: Vec<f64> = model.supports().fixed().iter().map(|(dof, _)| next.u[*dof as usize]).collect();
    let mut loading = LoadFunctions {
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

/// Applies gravity in `steps` steps and zeroes displacements.
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

/// K0 state, equilibrated under gravity.
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
