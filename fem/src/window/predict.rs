//! The window that comes, with contacts linearized: what the stiffened scheme of the coupling goes on with.

use super::WindowSolver;
use crate::equations::system::Equations;
use crate::error::SolveError;
use crate::model::Model;
use crate::solver::LinearSolver;
use crate::state::State;
use crate::statics::{check_finite, check_load};
use crate::supports::Supports;

/// Residual at which a prediction is good enough [-].
const TOLERANCE: f64 = 1e-8;
/// Iterations on a factor at most; what is left then is good enough too.
const ITERATIONS: u32 = 100;

impl WindowSolver {
    /// The mean velocity vt [m/s] that a step would have if the load fell by `contacts(w)` as the velocity vt exceeds the
    /// present one by w: a linearized contact on the body. `contacts` adds a symmetric, not negative product to its second
    /// argument, shapes `[3 * nodes]`. The state stays as it is. Returns the iterations.
    ///
    /// Conjugate gradients. With the factor of the window as preconditioner they need no product with the matrix, since
    /// A z = r where z is the preconditioned residual r, and as many iterations as contacts are stiff against it.
    ///
    /// # Errors
    /// A load or a result that is not finite; an iteration without the factor that does not converge.
    pub fn predict(
        &mut self,
        model: &Model,
        state: &State,
        mean_load: &[f64],
        contacts: impl FnMut(&[f64], &mut [f64]),
        rate: &mut [f64],
    ) -> Result<u32, SolveError> {
        check_load(model, mean_load, state.time + self.dt)?;
        let (theta, dt, c) = (self.theta, self.dt, model.rayleigh());
        let (n, supports) = (state.u.len(), model.supports());
        for d in 0..n {
            self.work[d] = state.u[d] + (theta * dt + c.beta_k) * state.v[d];
        }
        model.stiffness_times(&self.work, &mut self.product);
        let mut force: Vec<f64> = (0..n).map(|d| mean_load[d] - self.product[d]).collect();
        if c.alpha_m > 0.0 {
            model.mass_times(&state.v, &mut self.product);
            (0..n).for_each(|d| force[d] -= c.alpha_m * self.product[d]);
        }
        if !model.matrices().dashpots().is_empty() {
            self.product.fill(0.0);
            model.dashpot_times(&state.v, &mut self.product);
            (0..n).for_each(|d| force[d] -= self.product[d]);
        }
        for (slot, &d) in self.equations.iter_mut().zip(supports.free()) {
            *slot = theta * dt * force[d as usize];
        }
        let (x, scale) = (&mut self.equations[..], theta * dt);
        let scratch = [&mut self.work[..], &mut self.product];
        let iterations = match &mut self.system {
            Equations::BlockJacobi(system) => system.solve_with(supports, x, scale, contacts, TOLERANCE)?,
            Equations::Aggregation(system) => system.solve_with(supports, x, scale, contacts, TOLERANCE)?,
            Equations::Direct(factor) => {
                let contacts = Contacts { supports, factor: scale, add: contacts };
                let solve = |x: &mut [f64]| {
                    factor.solve_in_place(x);
                    Ok(())
                };
                on_factor(solve, x, contacts, scratch)?
            }
            #[cfg(feature = "mumps")]
            Equations::Mumps(factor) => {
                let contacts = Contacts { supports, factor: scale, add: contacts };
                on_factor(|x| Ok(factor.solve_in_place(x)?), x, contacts, scratch)?
            }
        };
        rate.copy_from_slice(&state.v);
        for (x, &d) in self.equations.iter().zip(supports.free()) {
            rate[d as usize] += x;
        }
        check_finite(model, "the velocity", rate, state.time + dt)?;
        Ok(iterations)
    }
}

/// A matrix that is added to that of the window.
struct Contacts<'a, F> {
    supports: &'a Supports,
    factor: f64,
    add: F,
}

/// Solves in place with a factor, which `solve` solves with, as preconditioner, and returns the iterations. Scratch is two nodal vectors.
fn on_factor<F: FnMut(&[f64], &mut [f64])>(
    mut solve: impl FnMut(&mut [f64]) -> Result<(), SolveError>,
    x: &mut [f64],
    mut contacts: Contacts<'_, F>,
    [work, product]: [&mut [f64]; 2],
) -> Result<u32, SolveError> {
    let (supports, size) = (contacts.supports, x.len());
    let mut r = x.to_vec();
    x.fill(0.0);
    let (mut z, mut p, mut ap, mut q) = (vec![0.0; size], vec![0.0; size], vec![0.0; size], vec![0.0; size]);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut last, mut first, mut iterations) = (0.0, 0.0, 0);
    while iterations < ITERATIONS {
        z.copy_from_slice(&r);
        solve(&mut z)?;
        let rz = dot(&r, &z);
        if iterations == 0 {
            first = rz;
        }
        if rz <= TOLERANCE * TOLERANCE * first {
            break;
        }
        let beta = if iterations == 0 { 0.0 } else { rz / last };
        for i in 0..size {
            p[i] = z[i] + beta * p[i];
            ap[i] = r[i] + beta * ap[i];
        }
        work.fill(0.0);
        supports.scatter(&p, work);
        product.fill(0.0);
        (contacts.add)(work, product);
        supports.gather(product, &mut q);
        (0..size).for_each(|i| q[i] = ap[i] + contacts.factor * q[i]);
        let alpha = rz / dot(&p, &q);
        for i in 0..size {
            x[i] += alpha * p[i];
            r[i] -= alpha * q[i];
        }
        last = rz;
        iterations += 1;
    }
    Ok(iterations)
}
