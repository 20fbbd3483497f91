//! Energies, momenta and support reactions of a state.
//!
//! Kinetic energy `v·M v/2`, strain energy `u·K u/2`. Linear momentum is the sum of `M v`; angular momentum is
//! `sum x_a × (M v)_a`, exact for the isoparametric element. It is taken with the undeformed positions: the linear
//! theory conserves that one, because its stiffness resists no infinitesimal rotation of the undeformed body.

use crate::model::Model;
use crate::state::State;
use crate::supports::CONSTRAINED;

/// Kinetic energy [J].
pub fn kinetic(model: &Model, state: &State) -> f64 {
    0.5 * model.matrices().mass_form(&state.v)
}

/// Strain energy [J].
pub fn strain(model: &Model, state: &State) -> f64 {
    0.5 * model.matrices().stiffness_form(&state.u)
}

/// Linear momentum [N s] and angular momentum about the origin [N m s].
pub fn momentum(model: &Model, state: &State) -> ([f64; 3], [f64; 3]) {
    let mut product = vec![0.0; state.v.len()];
    model.mass_times(&state.v, &mut product);
    let (mut linear, mut angular) = ([0.0; 3], [0.0; 3]);
    for (x, p) in model.mesh().coordinates.iter().zip(product.chunks_exact(3)) {
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            linear[k] += p[k];
            angular[k] += x[i] * p[j] - x[j] * p[i];
        }
    }
    (linear, angular)
}

/// Forces of the supports on the moving body [N], `M a + C v + K u - F` at constrained dofs, 0 elsewhere. Shape
/// `[3 * nodes]`.
pub fn reactions(model: &Model, state: &State, load: &[f64]) -> Vec<f64> {
    let c = model.rayleigh();
    let n = model.dof_count();
    let (mut elastic, mut inertia) = (vec![0.0; n], vec![0.0; n]);
    let strained: Vec<f64> = state.u.iter().zip(&state.v).map(|(u, v)| u + c.beta_k * v).collect();
    let moved: Vec<f64> = state.a.iter().zip(&state.v).map(|(a, v)| a + c.alpha_m * v).collect();
    model.stiffness_times(&strained, &mut elastic);
    model.mass_times(&moved, &mut inertia);
    let index = model.supports().free_index();
    (0..n).map(|d| if index[d] == CONSTRAINED { elastic[d] + inertia[d] - load[d] } else { 0.0 }).collect()
}
