//! A bond given by its own stiffnesses and strengths, the same for spheres of any size: a beam between two centres.
//! Forces act in the middle of the line of centres.
//!
//! Source: Wang, Acta Geotechnica 4, 2009 (four springs, criterion by sum). With small rotations the springs are those
//! of the bonded-particle models that keep a quaternion per bond.

use super::springs::{
    BondDamping, BondKind, Criterion, Joint, Problem, Rules, Springs, not_negative, positive, strength,
};

/// A bond by stiffness and strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectBond {
    /// Stiffness in tension and shear [N/m], bending and twisting [N m/rad].
    pub stiffness: [f64; 4],
    /// Largest tension and shear [N], bending and twisting moment [N m]; infinite for none.
    pub strength: [f64; 4],
    /// When it breaks. With [`Criterion::Stress`], tension and bending add up, and shear and twisting do.
    pub criterion: Criterion,
    /// Dashpots.
    pub damping: BondDamping,
    /// Whether the contact of the pair acts beside the bond; otherwise it starts when the bond has broken.
    pub contact: bool,
}

impl BondKind for DirectBond {
    fn problem(&self) -> Problem {
        let [normal, shear, bending, twisting] = self.stiffness;
        positive("stiffness in tension", normal)
            .or(not_negative("stiffness in shear", shear))
            .or(not_negative("stiffness in bending", bending))
            .or(not_negative("stiffness in twisting", twisting))
            .or(self.strength.iter().find_map(|s| strength("strength", *s)))
            .or(self.damping.problem())
    }

    fn springs(&self, _: &Joint) -> Springs {
        let [tension, shear, bending, twisting] = self.strength.map(|s| 1.0 / s);
        Springs { stiffness: self.stiffness, limit: [tension, bending, shear, twisting, 0.0], offset: 0.0 }
    }

    fn rules(&self) -> Rules {
        Rules { damping: self.damping, criterion: self.criterion, contact: self.contact }
    }

    fn unbreakable(&self) -> DirectBond {
        DirectBond { strength: [f64::INFINITY; 4], ..*self }
    }
}
