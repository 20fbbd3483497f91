//! Source of a pair's damping ratio ζ.

use super::restitution;

/// Definition of ζ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Damping {
    /// From restitution (`restitution.rs`).
    #[default]
    Restitution,
    /// Given ζ [-], not negative.
    Ratio(f64),
    /// None.
    None,
}

impl Damping {
    /// Returns ζ [-].
    pub fn ratio(self, restitution: f64) -> f64 {
        match self {
            Damping::Restitution => restitution::damping_ratio(restitution),
            Damping::Ratio(zeta) => zeta,
            Damping::None => 0.0,
        }
    }

    /// Publication.
    pub fn source(self) -> Option<&'static str> {
        match self {
            Damping::Restitution => Some(restitution::SOURCE),
            Damping::Ratio(_) | Damping::None => None,
        }
    }
}
