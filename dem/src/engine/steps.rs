//! What the input and the limits mean for the steps of a run.

use super::collision;
use super::input::TimeStep;
use super::timestep::DtLimit;
use crate::base::error::ModelError;

/// The first step, and what bounds the others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps {
    /// The first step; all of them where they do not follow the contacts [s].
    pub first: f64,
    /// Share of what the contacts allow that steps take, where they follow them.
    pub share: Option<f64>,
    /// Longest step that rigid bodies of walls, polyhedra on their faces and the input allow [s].
    pub longest: f64,
    /// Longest step that collisions allow, while they are many and where most contacts last [s].
    pub collision: f64,
    pub lasting: f64,
}

impl Steps {
    /// `rigid`: limit of the rigid bodies of walls and of polyhedra on their faces [s]; `collision`: see [`collision::longest`] [s].
    ///
    /// # Errors
    /// A fixed step above the limit; numbers too large or too small to be computed with.
    pub fn new(input: &TimeStep, limit: &DtLimit, rigid: f64, collision: f64) -> Result<Steps, ModelError> {
        let lasting = collision::PACKED * collision;
        let steps = |first: f64| Steps { first, share: None, longest: rigid, collision, lasting };
        let steps = match *input {
            TimeStep::Auto { fraction } => steps(fraction * limit.dt),
            TimeStep::Measured { share, longest, collisions } => {
                let longest = longest.min(rigid);
                // Who asks for shorter steps than usual has them in collisions too.
                let shorter = (share / TimeStep::SHARE).min(1.0);
                let [collision, lasting] = [collision, lasting].map(|dt| shorter * dt);
                let collision = if collisions { collision } else { lasting };
                let first = (share * limit.dt).min(longest).min(collision);
                Steps { first, share: Some(share), longest, collision, lasting }
            }
            TimeStep::Fixed(dt) if dt > limit.dt => {
                return Err(ModelError::TimeStep { dt, limit: limit.dt, cause: limit.to_string() });
            }
            TimeStep::Fixed(dt) | TimeStep::FixedAboveLimit(dt) => steps(dt),
        };
        let quantities = [
            ("time step", steps.first),
            ("critical time step", limit.dt),
            ("effective mass", limit.mass),
            ("contact stiffness", limit.stiffness),
        ];
        // Masses are 0 where no body can move, stiffnesses where nothing is touched.
        let bad = |(k, value): (usize, f64)| !value.is_finite() || (k < 2 && value <= 0.0);
        match quantities.iter().enumerate().find(|(k, (_, value))| bad((*k, *value))) {
            Some((_, &(quantity, _))) => Err(ModelError::NotFinite { quantity }),
            None => Ok(steps),
        }
    }
}
