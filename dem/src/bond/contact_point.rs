//! Contact-point bond: a spring in tension and one in shear at the point where two spheres meet. It resists no relative
//! rotation, and breaks where the tension or the shear force reaches its limit.
//!
//! Source: Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004, sec. 2 (contact bond, a glue of no size).

use super::springs::{
    BondDamping, BondKind, Criterion, Joint, Problem, Rules, Springs, not_negative, positive, strength,
};

/// A contact-point bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Stiffness in tension and pressure [N/m].
    pub normal: f64,
    /// Stiffness in shear [N/m].
    pub shear: f64,
    /// Largest tension [N]; infinite for none.
    pub tension_limit: f64,
    /// Largest shear force [N]; infinite for none.
    pub shear_limit: f64,
    /// Dashpots.
    pub damping: BondDamping,
    /// Whether the contact of the pair acts beside the bond; otherwise it starts when the bond has broken.
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
