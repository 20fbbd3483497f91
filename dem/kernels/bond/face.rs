//! Face bond: rectangle of ice or cement between bodies of any shape.
//!
//! Beam from centre to centre of width w (along the sheet), thickness t; Saint-Venant's J = ab³ (1/3 − 0.21
//! b/a (1 − b⁴/12a⁴)), a the longer, b the shorter side (Roark's formulas, 8th ed., table 10.7). Largest
//! stresses, tension positive:
//!
//! σ = T/wt + 6|M_b|/wt²,  τ = |F_s|/wt + |M_t| b/J.
//!
//! Shear strength constant, or Mohr–Coulomb: c + (−T/wt) tan φ. Forces act in the face; contacts act in
//! parallel.

use super::parallel::ShearStrength;
use super::springs::{
    BondDamping, BondKind, Cement, Criterion, Joint, Problem, Rules, Section, Springs, positive, strength,
};

/// Face bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceBond {
    /// Young's modulus E [Pa].
    pub young: f64,
    /// kₙ/kₛ [-].
    pub ratio: f64,
    /// Tensile and bending strength [Pa], may be infinite.
    pub tensile_strength: f64,
    /// Shear strength.
    pub shear_strength: ShearStrength,
    /// Failure criterion.
    pub criterion: Criterion,
    /// Dashpots.
    pub damping: BondDamping,
}

/// Bonded face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Width and thickness [m].
    pub size: [f64; 2],
    /// Distance of the first body's centre from the face minus the second's [m].
    pub offset: f64,
}

/// Saint-Venant torsion constant [m⁴]; shorter side [m].
fn torsion([w, t]: [f64; 2]) -> [f64; 2] {
    let (a, b) = (w.max(t), w.min(t));
    let slender = b / a;
    [a * b.powi(3) * (1.0 / 3.0 - 0.21 * slender * (1.0 - slender.powi(4) / 12.0)), b]
}

impl BondKind for FaceBond {
    fn problem(&self) -> Problem {
        positive("Young's modulus", self.young)
            .or(positive("stiffness ratio", self.ratio))
            .or(strength("tensile strength", self.tensile_strength))
            .or(self.shear_strength.problem())
            .or(self.damping.problem())
    }

    fn springs(&self, joint: &Joint) -> Springs {
        let face = joint.face.expect("bonds that fill faces are checked to have one");
        let [w, t] = face.size;
        let section =
            Section { area: w * t, bending: [w * t.powi(3) / 12.0, 0.5 * t], torsion: torsion(face.size) };
        let kn = self.young / joint.length;
        let cement = Cement {
            stiffness: [kn, kn / self.ratio],
            tensile_strength: self.tensile_strength,
            shear_strength: self.shear_strength,
            moment_factor: 1.0,
        };
        section.springs(&cement, face.offset)
    }

    fn rules(&self) -> Rules {
        Rules { damping: self.damping, criterion: self.criterion, contact: true }
    }

    fn fills_faces(&self) -> bool {
        true
    }

    fn unbreakable(&self) -> FaceBond {
        let shear_strength = ShearStrength::Constant(f64::INFINITY);
        FaceBond { tensile_strength: f64::INFINITY, shear_strength, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Timoshenko & Goodier (Theory of Elasticity, 3rd ed., table of section 109): square 0.1406, 2 × 1
    /// 0.229, 10 × 1 0.312, times ab³.
    #[test]
    fn torsion_of_rectangles() {
        for (w, t, exact) in [(1.0, 1.0, 0.1406), (2.0, 1.0, 2.0 * 0.229), (0.1, 1.0, 0.312e-3)] {
            let [j, shorter] = torsion([w, t]);
            assert!((j / exact - 1.0).abs() < 3e-3, "{w} × {t}: {j}");
            assert_eq!(shorter, f64::min(w, t));
        }
    }
}
