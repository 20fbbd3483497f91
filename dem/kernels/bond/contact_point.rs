//! Contact-point bond: tension and shear spring, no rotational resistance.
//!
//! Source: Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004, sec. 2 (contact bond).

use super::springs::{
    BondDamping, BondKind, Criterion, Joint, Problem, Rules, Springs, not_negative, positive, strength,
};

/// Contact-point bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Normal stiffness [N/m].
    pub normal: f64,
    /// Shear stiffness [N/m].
    pub shear: f64,
    /// Tensile limit [N], may be infinite.
    pub tension_limit: f64,
    /// Shear limit [N], may be infinite.
    pub shear_limit: f64,
    /// Dashpots.
    pub damping: BondDamping,
    /// The pair's contact acts in parallel, not only after breakage.
    pub contact: bool,
}

impl BondKind for ContactPoint {
    fn problem(&self) -> Problem {
        positive("normal stiffness", self.normal)
            .or(not_negative("shear stiffness", self.shear))
            .or(strength("largest tension", self.tension_limit))
            .or(strength("largest shear force", self.shear_limit))
            .or(self.damping.problem())
    }

    fn springs(&self, joint: &Joint) -> Springs {
        Springs {
            stiffness: [self.normal, self.shear, 0.0, 0.0],
            limit: [1.0 / self.tension_limit, 0.0, 1.0 / self.shear_limit, 0.0, 0.0],
            offset: joint.radii[0] - joint.radii[1],
        }
    }

    fn rules(&self) -> Rules {
        Rules { damping: self.damping, criterion: Criterion::Stress, contact: self.contact }
    }

    fn unbreakable(&self) -> ContactPoint {
        ContactPoint { tension_limit: f64::INFINITY, shear_limit: f64::INFINITY, ..*self }
    }
}
