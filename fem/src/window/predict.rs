//! The window that comes, with contacts linearized: what the stiffened scheme of the coupling goes on with.

use super::WindowSolver;
use crate::equations::system::Added;
use crate::error::SolveError;
use crate::model::Model;
use crate::state::State;
use crate::statics::{check_finite, check_load};

/// Residual at which a prediction is good enough [-].
const TOLERANCE: f64 = 1e-8;

impl WindowSolver {
    /// The mean velocity vt [m/s] that a step would have if the load fell by `contacts(w)` as the velocity vt exceeds the
    /// present one by w: a linearized contact on the body. `contacts` adds a symmetric, not negative product to its second
    /// argument, shapes `[3 * nodes]`. The state stays as it is. Returns the iterations.
    ///
    /// Solved by [`SystemSolver::solve_with`](crate::equations::system::SystemSolver::solve_with).
    ///
    /// # Errors
    /// A load or a result that is not finite; an iteration without the factor that does not converge.
    pub fn predict(
        &mut self,
        model: &Model,
        state: &State,
        mean_load: &[f64],
        mut contacts: impl FnMut(&[f64], &mut [f64]),
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
        let scratch = [&mut self.work[..], &mut self.product];
        let added = Added { factor: theta * dt, times: &mut contacts, scratch };
        let iterations = self.system.solve_with(supports, &mut self.equations, added, TOLERANCE)?;
        rate.copy_from_slice(&state.v);
        for (x, &d) in self.equations.iter().zip(supports.free()) {
            rate[d as usize] += x;
        }
        check_finite(model, "the velocity", rate, state.time + dt)?;
        Ok(iterations)
    }
}
