//! What every kind of bond makes: springs with their limits, damping, and the check of its numbers; the springs of those that are beams.
//!
//! Theory manual: equations (2.11), (2.12) of `docs/theory/shapes.md`.

use super::face::Face;
use super::parallel::ShearStrength;

/// What holds for a kind of bond wherever it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    /// Dashpots.
    pub damping: BondDamping,
    /// When it breaks.
    pub criterion: Criterion,
    /// Whether the contact of the pair acts beside it.
    pub contact: bool,
}

/// A kind of bond.
pub(super) trait BondKind {
    /// What is wrong with its numbers.
    fn problem(&self) -> Problem;

    /// Its springs between two bodies, and what breaks them.
    fn springs(&self, joint: &Joint) -> Springs;

    /// What holds for it wherever it is.
    fn rules(&self) -> Rules;

    /// Whether it fills a face between bodies of any shape; else it joins single spheres.
    fn fills_faces(&self) -> bool {
        false
    }

    /// The same bond without a limit of strength.
    fn unbreakable(&self) -> Self
    where
        Self: Sized;
}

/// Viscous damping of a bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BondDamping {
    /// None.
    None,
    /// This fraction of critical damping of the two spheres on each spring: c = 2 ζ √(k m*), with the reduced mass for
    /// tension and shear and the reduced moment of inertia for bending and twisting.
    Fraction(f64),
    /// Coefficients of tension and shear [N s/m], bending and twisting [N m s].
    Coefficients([f64; 4]),
}

/// When a bond breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// When the tensile or the shear stress reaches its strength.
    Stress,
    /// When the shares of strength that tension, bending, shear and twisting use up add up to 1.
    Sum,
}

/// Two bodies about to be joined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint {
    /// Radii of the spheres, or around the bodies [m].
    pub radii: [f64; 2],
    /// Distance of the centres [m].
    pub length: f64,
    /// Reduced mass [kg] and moment of inertia [kg m²]; zero between two fixed bodies.
    pub mass: f64,
    pub inertia: f64,
    /// Face between the bodies, of a bond that fills one.
    pub face: Option<Face>,
}

/// Four springs and what breaks them, as a kind of bond makes them for a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Springs {
    /// Tension and shear [N/m], bending and twisting [N m/rad].
    pub stiffness: [f64; 4],
    /// 1/strength in tension [1/N], bending [1/(N m)], shear [1/N], twisting [1/(N m)]; and the share of tension in the
    /// shear criterion [1/N].
    pub limit: [f64; 5],
    /// Difference of the lever arms of the two bodies [m]: where between the centres forces act; 0 in the middle.
    pub offset: f64,
}

/// The section of a bond that is a beam of cement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// Area [m²].
    pub area: f64,
    /// Second moment of area [m⁴], and the farthest fibre from its axis [m].
    pub bending: [f64; 2],
    /// Constant of torsion [m⁴], and what a moment over it is multiplied with to give the largest stress [m].
    pub torsion: [f64; 2],
}

/// What the cement of a bond is like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cement {
    /// Stiffness by area in tension and shear [Pa/m].
    pub stiffness: [f64; 2],
    /// Tensile strength [Pa].
    pub tensile_strength: f64,
    /// Shear strength.
    pub shear_strength: ShearStrength,
    /// Part of the bending moment that counts in the tensile stress.
    pub moment_factor: f64,
}

impl Section {
    /// Springs of a beam with this section.
    pub(super) fn springs(&self, cement: &Cement, offset: f64) -> Springs {
        let Section { area, bending: [second, fibre], torsion: [polar, rim] } = *self;
        let [kn, ks] = cement.stiffness;
        let tensile = 1.0 / cement.tensile_strength;
        let (shear, confined) = cement.shear_strength.inverse();
        Springs {
            stiffness: [kn * area, ks * area, kn * second, ks * polar],
            limit: [
                tensile / area,
                cement.moment_factor * fibre / second * tensile,
                shear / area,
                rim / polar * shear,
                confined / area,
            ],
            offset,
        }
    }
}

/// A quantity out of range: its name, value and what it must be.
pub(super) type Problem = Option<(&'static str, f64, &'static str)>;

const POSITIVE: &str = "be positive and finite";
const NOT_NEGATIVE: &str = "be zero or positive, and finite";
const STRENGTH: &str = "be positive (infinite for an unbreakable bond)";

pub(super) fn positive(name: &'static str, x: f64) -> Problem {
    (!(x > 0.0 && x.is_finite())).then_some((name, x, POSITIVE))
}

pub(super) fn not_negative(name: &'static str, x: f64) -> Problem {
    (!(x >= 0.0 && x.is_finite())).then_some((name, x, NOT_NEGATIVE))
}

pub(super) fn strength(name: &'static str, x: f64) -> Problem {
    (x.is_nan() || x <= 0.0).then_some((name, x, STRENGTH))
}

impl BondDamping {
    pub(super) fn problem(&self) -> Problem {
        match self {
            BondDamping::None => None,
            BondDamping::Fraction(f) => not_negative("fraction of critical damping", *f),
            BondDamping::Coefficients(c) => c.iter().find_map(|c| not_negative("damping coefficient", *c)),
        }
    }
}
