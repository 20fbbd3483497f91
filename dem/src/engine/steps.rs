//! Time step and its bounds, from input and limits.

use super::collision;
use super::input::TimeStep;
use super::timestep::DtLimit;
use crate::base::error::ModelError;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps {
    /// First step, or constant step [s].
    pub first: f64,
    /// Fraction of the critical step of current contacts, if followed.
    pub share: Option<f64>,
    /// Bound by rigid-body walls, polyhedra on faces and input [s].
    pub longest: f64,
    /// Bounds by collisions: frequent ones, and with lasting contacts [s].
    pub collision: f64,
    pub lasting: f64,
}

impl Steps {
    /// `rigid`: limit of walls and polyhedra on faces [s]; `collision`: of collisions [s].
    ///
    /// # Errors
    /// A fixed step above the limit; values out of floating-point range.
    pub fn new(
        input: &TimeStep,
        (limit, cause): (&DtLimit, &str),
        rigid: f64,
        collision: f64,
    ) -> Result<Steps, ModelError> {
        let lasting = collision::PACKED * collision;
        let steps = |first: f64| Steps { first, share: None, longest: rigid, collision, lasting };
        let steps = match *input {
            TimeStep::Auto { fraction } => steps(fraction * limit.dt),
            TimeStep::Measured { share, longest, collisions } => {
                let longest = longest.min(rigid);
                // A reduced fraction also shortens collision steps.
                let shorter = (share / TimeStep::SHARE).min(1.0);
                let [collision, lasting] = [collision, lasting].map(|dt| shorter * dt);
                let collision = if collisions { collision } else { lasting };
                let first = (share * limit.dt).min(longest).min(collision);
                Steps { first, share: Some(share), longest, collision, lasting }
            }
            TimeStep::Fixed(dt) if dt > limit.dt => {
                return Err(ModelError::TimeStep { dt, limit: limit.dt, cause: cause.into() });
            }
            TimeStep::Fixed(dt) | TimeStep::FixedAboveLimit(dt) => steps(dt),
        };
        let quantities = [
            ("time step", steps.first),
            ("critical time step", limit.dt),
            ("effective mass", limit.mass),
            ("contact stiffness", limit.stiffness),
        ];
        // Mass is 0 without moving bodies, stiffness without contact partners.
        let bad = |(k, value): (usize, f64)| !value.is_finite() || (k < 2 && value <= 0.0);
        match quantities.iter().enumerate().find(|(k, (_, value))| bad((*k, *value))) {
            Some((_, &(quantity, _))) => Err(ModelError::NotFinite { quantity }),
            None => Ok(steps),
        }
    }
}
