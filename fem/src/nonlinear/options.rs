//! Choices of Newton's iteration, and its counts.

use crate::error::SolveError;
use serde::{Deserialize, Serialize};

/// Which matrix the iterations after the first of a step take.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Variant {
    /// The consistent tangent of every iteration: quadratic convergence.
    Full,
    /// The tangent after the first iteration, renewed after every so many further ones (0: kept to the end of the step).
    Modified(u32),
    /// The elastic matrix: factored once, linear convergence.
    InitialStiffness,
}

/// How systems with an unsymmetric tangent are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinearMethod {
    /// L U up to 30,000 free dofs, iteration above.
    #[default]
    Auto,
    /// L U.
    Direct,
    /// GMRES, preconditioned with the elastic factor.
    Krylov,
}

/// Choices of the iteration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonOptions {
    /// Matrix of the iterations.
    pub variant: Variant,
    /// Whether the length of each correction is searched.
    pub line_search: bool,
    /// Residual at convergence, over the forces [-].
    pub force_tolerance: f64,
    /// Work of the residual on the last correction at convergence, over the largest work before a correction [-].
    pub energy_tolerance: f64,
    /// Iterations after which a step has failed.
    pub max_iterations: u32,
    /// Solver of unsymmetric systems.
    pub linear: LinearMethod,
}

impl NewtonOptions {
    /// The usual choices for a variant: tolerances 1e-6 and 1e-8, line search, 50 iterations (full), 60 (modified) or 400
    /// (elastic matrix).
    pub fn new(variant: Variant) -> NewtonOptions {
        let max_iterations = match variant {
            Variant::Full => 50,
            Variant::Modified(_) => 60,
            Variant::InitialStiffness => 400,
        };
        NewtonOptions {
            variant,
            line_search: true,
            force_tolerance: 1e-6,
            energy_tolerance: 1e-8,
            max_iterations,
            linear: LinearMethod::Auto,
        }
    }

    /// Refuses tolerances that are not above 0 and no iterations.
    ///
    /// # Errors
    /// [`SolveError::Option`].
    pub fn check(&self) -> Result<(), SolveError> {
        for (what, value) in
            [("the force tolerance", self.force_tolerance), ("the energy tolerance", self.energy_tolerance)]
        {
            if !(value > 0.0 && value < 1.0) {
                return Err(SolveError::Option { what, value, expected: "a number between 0 and 1" });
            }
        }
        if self.max_iterations == 0 {
            return Err(SolveError::Option {
                what: "the limit of iterations",
                value: 0.0,
                expected: "1 or more",
            });
        }
        Ok(())
    }
}

impl Default for NewtonOptions {
    fn default() -> Self {
        NewtonOptions::new(Variant::Full)
    }
}
