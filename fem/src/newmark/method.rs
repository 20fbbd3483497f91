//! Parameters and stability of Newmark and HHT-α.

use crate::error::NewmarkError;

/// Newmark parameters (Hughes 1987).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newmark {
    /// Weight of the new acceleration in the displacement [-].
    pub beta: f64,
    /// Weight of the new acceleration in the velocity [-].
    pub gamma: f64,
}

impl Newmark {
    /// beta = 1/4, gamma = 1/2: second order, energy-conserving.
    pub const AVERAGE_ACCELERATION: Newmark = Newmark { beta: 0.25, gamma: 0.5 };

    /// HHT-α pair `beta = (1 - a)²/4`, `gamma = 1/2 - a`, a in [-1/3, 0].
    pub fn of_hht(a: f64) -> Newmark {
        Newmark { beta: 0.25 * (1.0 - a) * (1.0 - a), gamma: 0.5 - a }
    }

    pub(crate) fn of_hht_in_range(alpha: f64) -> Result<Newmark, NewmarkError> {
        // Tolerates a rounded -1/3 in scene files.
        if !(-1.0 / 3.0 - 1e-12..=0.0).contains(&alpha) {
            return Err(NewmarkError::Hht { alpha });
        }
        Ok(Newmark::of_hht(alpha))
    }

    /// Checks unconditional stability.
    ///
    /// # Errors
    /// [`NewmarkError`] with the smallest sufficient beta.
    pub fn check(self) -> Result<(), NewmarkError> {
        let Newmark { beta, gamma } = self;
        self.check_range()?;
        let least_beta = 0.25 * (0.5 + gamma) * (0.5 + gamma);
        // Tolerates a rounded 0.3025 for 0.6.
        if gamma >= 0.5 && beta >= least_beta * (1.0 - 1e-12) {
            Ok(())
        } else {
            Err(NewmarkError::Unstable { beta, gamma, least_beta })
        }
    }

    /// Checks only that both parameters are finite and 0 or above.
    ///
    /// # Errors
    /// [`NewmarkError::Range`].
    pub fn check_range(self) -> Result<(), NewmarkError> {
        let Newmark { beta, gamma } = self;
        let usable = |x: f64| x >= 0.0 && x.is_finite();
        if usable(beta) && usable(gamma) { Ok(()) } else { Err(NewmarkError::Range { beta, gamma }) }
    }
}
