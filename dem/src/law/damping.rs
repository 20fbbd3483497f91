//! Where the damping ratio ζ of a pair is from.

use super::restitution;

/// The damping part of a law: it gives ζ when materials are mixed; the dashpot itself belongs to the normal law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Damping {
    /// ζ of the clipped law with the restitution of the pair (`restitution.rs`).
    #[default]
    Restitution,
    /// ζ itself [-], zero or more.
    Ratio(f64),
    /// None.
    None,
}

impl Damping {
    /// Damping ratio ζ [-], given the restitution of the pair.
    pub fn ratio(self, restitution: f64) -> f64 {
        match self {
            Damping::Restitution => restitution::damping_ratio(restitution),
            Damping::Ratio(zeta) => zeta,
            Damping::None => 0.0,
        }
    }

    /// Where it is published.
    pub fn source(self) -> Option<&'static str> {
        match self {
            Damping::Restitution => Some(restitution::SOURCE),
            Damping::Ratio(_) | Damping::None => None,
        }
    }
}
