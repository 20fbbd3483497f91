//! Bond with given stiffness and strength, independent of sphere size.
//!
//! Source: Wang, Acta Geotechnica 4, 2009 (four springs, additive criterion).

use super::springs::{
    BondDamping, BondKind, Criterion, Joint, Problem, Rules, Springs, not_negative, positive, strength,
};

/// Bond with given stiffness and strength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectBond {
    /// Stiffness: tension, shear [N/m], bending, twisting [N m/rad].
    pub stiffness: [f64; 4],
    /// Strength: tension, shear [N], bending, twisting [N m]; may be infinite.
    pub strength: [f64; 4],
    /// Failure criterion. [`Criterion::Stress`] adds tension and bending, shear and twisting.
    pub criterion: Criterion,
    /// Dashpots.
    pub damping: BondDamping,
    /// The pair's contact acts in parallel, not only after breakage.
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
