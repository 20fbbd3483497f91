//! The parameters of Newmark's method and of HHT-α, and which of them are stable.

use thiserror::Error;

/// The two parameters of Newmark's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newmark {
    /// Weight of the new acceleration in the displacement (beta of Hughes) [-].
    pub alpha: f64,
    /// Weight of the new acceleration in the velocity (gamma of Hughes) [-].
    pub delta: f64,
}

/// Parameters that are refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NewmarkError {
    /// Not unconditionally stable.
    #[error(
        "Newmark with alpha = {alpha}, delta = {delta} is not unconditionally stable: it needs delta >= 0.5 and \
         alpha >= 0.25 (0.5 + delta)^2 = {least_alpha}"
    )]
    Unstable {
        /// The alpha given.
        alpha: f64,
        /// The delta given.
        delta: f64,
        /// The least alpha for this delta.
        least_alpha: f64,
    },
    /// Negative, or not a finite number.
    #[error("Newmark's alpha = {alpha} and delta = {delta} must be finite numbers, 0 or above")]
    Range {
        /// The alpha given.
        alpha: f64,
        /// The delta given.
        delta: f64,
    },
    /// HHT's α out of range.
    #[error("HHT-alpha with alpha = {alpha} is not unconditionally stable: alpha must be between -1/3 and 0")]
    Hht {
        /// The α given.
        alpha: f64,
    },
    /// HHT-α weighs the loads of both ends of a step.
    #[error("HHT-alpha needs the load at the start of the step, too")]
    LoadAtStart,
    /// The displacement at the end does not depend on the acceleration there.
    #[error("Newmark with alpha = 0 cannot follow a prescribed motion")]
    Prescribed,
}

impl Newmark {
    /// alpha = 1/4, delta = 1/2: second order, conserves energy.
    pub const AVERAGE_ACCELERATION: Newmark = Newmark { alpha: 0.25, delta: 0.5 };

    /// The pair that HHT-α goes with: `alpha = (1 - a)²/4`, `delta = 1/2 - a` for its parameter a in [-1/3, 0].
    pub fn of_hht(a: f64) -> Newmark {
        Newmark { alpha: 0.25 * (1.0 - a) * (1.0 - a), delta: 0.5 - a }
    }

    /// Checks that the method is stable for every step size.
    ///
    /// # Errors
    /// [`NewmarkError`], with the alpha that would be enough.
    pub fn check(self) -> Result<(), NewmarkError> {
        let Newmark { alpha, delta } = self;
        self.check_range()?;
        let least_alpha = 0.25 * (0.5 + delta) * (0.5 + delta);
        // A last digit lost in a scene file must not refuse 0.3025 for 0.6.
        if delta >= 0.5 && alpha >= least_alpha * (1.0 - 1e-12) {
            Ok(())
        } else {
            Err(NewmarkError::Unstable { alpha, delta, least_alpha })
        }
    }

    /// Checks only that both parameters are finite and 0 or above; the method may be stable for small steps alone.
    ///
    /// # Errors
    /// [`NewmarkError::Range`].
    pub fn check_range(self) -> Result<(), NewmarkError> {
        let Newmark { alpha, delta } = self;
        let usable = |x: f64| x >= 0.0 && x.is_finite();
        if usable(alpha) && usable(delta) { Ok(()) } else { Err(NewmarkError::Range { alpha, delta }) }
    }
}
