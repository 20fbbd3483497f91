//! Parallel bond: cement disk between two spheres.
//!
//! R disk radius, A = πR², I = πR⁴/4, J = πR⁴/2, stiffness per area kₙ, kₛ [Pa/m]. Rim stresses, tension
//! positive:
//!
//! σ = T/A + β|M_b|R/I,  τ = |F_s|/A + |M_t|R/J.
//!
//! Source: Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004, eq. 6–11; β: Potyondy (Proc. 45th US
//! Rock Mech. Symp., 2011).

use super::springs::{
    BondDamping, BondKind, Cement, Criterion, Joint, Problem, Rules, Section, Springs, not_negative,
    positive, strength,
};
use std::f64::consts::PI;

/// Cement stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParallelStiffness {
    /// Modulus E [Pa] over centre distance, kₙ = E/L, and kₙ/kₛ [-].
    Modulus {
        /// Young's modulus [Pa].
        young: f64,
        /// kₙ/kₛ [-].
        ratio: f64,
    },
    /// Stiffness per area.
    PerArea {
        /// kₙ [Pa/m].
        normal: f64,
        /// kₛ [Pa/m].
        shear: f64,
    },
}

/// Shear strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShearStrength {
    /// Pressure-independent [Pa].
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

    /// 1/strength at zero pressure [1/Pa]; tan φ over it.
    pub(super) fn inverse(&self) -> (f64, f64) {
        match *self {
            ShearStrength::Constant(tau) => (1.0 / tau, 0.0),
            ShearStrength::MohrCoulomb { cohesion, friction } => (1.0 / cohesion, friction / cohesion),
        }
    }
}

/// Parallel bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelBond {
    /// Disk radius over smaller sphere radius [-].
    pub radius_factor: f64,
    /// Stiffness.
    pub stiffness: ParallelStiffness,
    /// Tensile strength [Pa], may be infinite.
    pub tensile_strength: f64,
    /// Shear strength.
    pub shear_strength: ShearStrength,
    /// β: fraction of the bending moment in the tensile stress, 0–1.
    pub moment_factor: f64,
    /// Failure criterion.
    pub criterion: Criterion,
    /// Dashpots.
    pub damping: BondDamping,
    /// The pair's contact acts in parallel, not only after breakage.
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
