//! Parallel bond: a disk of cement between two spheres, which stretches, shears, bends and twists.
//!
//! With R the radius of the disk, A = πR², I = πR⁴/4, J = πR⁴/2 and stiffnesses kₙ, kₛ per area [Pa/m]:
//! tension kₙA, shear kₛA, bending kₙI, twisting kₛJ. Stresses at the rim
//!
//! σ = T/A + β|M_b|R/I,  τ = |F_s|/A + |M_t|R/J,
//!
//! T tension positive. The bond breaks where σ reaches the tensile or τ the shear strength; the latter is constant or
//! grows with pressure, τ_max = c + (−T/A) tan φ.
//!
//! Source: Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004, eq. 6–11; the moment factor β is that of Potyondy
//! (Proc. 45th US Rock Mech. Symp., 2011).

use super::springs::{
    BondDamping, BondKind, Cement, Criterion, Joint, Problem, Rules, Section, Springs, not_negative,
    positive, strength,
};
use std::f64::consts::PI;

/// Stiffness of the cement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParallelStiffness {
    /// Young's modulus E [Pa] of a bar as long as the distance of the centres, kₙ = E/L, and the ratio kₙ/kₛ [-].
    Modulus {
        /// Young's modulus [Pa].
        young: f64,
        /// kₙ/kₛ [-].
        ratio: f64,
    },
    /// kₙ and kₛ themselves.
    PerArea {
        /// kₙ [Pa/m].
        normal: f64,
        /// kₛ [Pa/m].
        shear: f64,
    },
}

/// Strength in shear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShearStrength {
    /// The same under any pressure [Pa].
    Constant(f64),
    /// Mohr–Coulomb.
    MohrCoulomb {
        /// Cohesion c [Pa].
        cohesion: f64,
        /// tan φ [-].
        friction: f64,
    },
}

impl ShearStrength {
    pub(super) fn problem(&self) -> Problem {
        match *self {
            ShearStrength::Constant(tau) => strength("shear strength", tau),
            ShearStrength::MohrCoulomb { cohesion, friction } => {
                strength("cohesion", cohesion).or(not_negative("tangent of the friction angle", friction))
            }
        }
    }

    /// 1/strength without pressure [1/Pa], and tan φ over it.
    pub(super) fn inverse(&self) -> (f64, f64) {
        match *self {
            ShearStrength::Constant(tau) => (1.0 / tau, 0.0),
            ShearStrength::MohrCoulomb { cohesion, friction } => (1.0 / cohesion, friction / cohesion),
        }
    }
}

/// A parallel bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelBond {
    /// Radius of the disk over the smaller radius of the two spheres [-].
    pub radius_factor: f64,
    /// Stiffness.
    pub stiffness: ParallelStiffness,
    /// Tensile strength [Pa]; infinite for none.
    pub tensile_strength: f64,
    /// Shear strength.
    pub shear_strength: ShearStrength,
    /// β: part of the bending moment that counts in the tensile stress, 0 to 1.
    pub moment_factor: f64,
    /// When it breaks.
    pub criterion: Criterion,
    /// Dashpots.
    pub damping: BondDamping,
    /// Whether the contact of the pair acts beside the bond; otherwise it starts when the bond has broken.
    pub contact: bool,
}

impl BondKind for ParallelBond {
    fn problem(&self) -> Problem {
        let stiffness = match self.stiffness {
            ParallelStiffness::Modulus { young, ratio } => {
                positive("Young's modulus", young).or(positive("stiffness ratio", ratio))
            }
            ParallelStiffness::PerArea { normal, shear } => positive("normal stiffness per area", normal)
                .or(not_negative("shear stiffness per area", shear)),
        };
        let factor = self.moment_factor;
        let in_range = (0.0..=1.0).contains(&factor);
        positive("radius factor", self.radius_factor)
            .or(stiffness)
            .or(strength("tensile strength", self.tensile_strength))
            .or(self.shear_strength.problem())
            .or((!in_range).then_some(("moment factor", factor, "lie in [0, 1]")))
            .or(self.damping.problem())
    }

    fn springs(&self, joint: &Joint) -> Springs {
        let r = self.radius_factor * joint.radii[0].min(joint.radii[1]);
        let area = PI * r * r;
        let second = 0.25 * area * r * r;
        let polar = 2.0 * second;
        let (kn, ks) = match self.stiffness {
            ParallelStiffness::Modulus { young, ratio } => {
                (young / joint.length, young / joint.length / ratio)
            }
            ParallelStiffness::PerArea { normal, shear } => (normal, shear),
        };
        let section = Section { area, bending: [second, r], torsion: [polar, r] };
        let cement = Cement {
            stiffness: [kn, ks],
            tensile_strength: self.tensile_strength,
            shear_strength: self.shear_strength,
            moment_factor: self.moment_factor,
        };
        section.springs(&cement, joint.radii[0] - joint.radii[1])
    }

    fn rules(&self) -> Rules {
        Rules { damping: self.damping, criterion: self.criterion, contact: self.contact }
    }

    fn unbreakable(&self) -> ParallelBond {
        let shear_strength = ShearStrength::Constant(f64::INFINITY);
        ParallelBond { tensile_strength: f64::INFINITY, shear_strength, ..*self }
    }
}
