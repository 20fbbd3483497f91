//! Springs, limits and damping of bonds.
//!
//! Theory manual: equations (2.11), (2.12) of `docs/theory/shapes.md`.

use super::face::Face;
use super::parallel::ShearStrength;

#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    pub damping: BondDamping,
    pub criterion: Criterion,
    /// The pair's contact acts in parallel.
    pub contact: bool,
}

pub(super) trait BondKind {
    fn problem(&self) -> Problem;

    fn springs(&self, joint: &Joint) -> Springs;

    fn rules(&self) -> Rules;

    fn fills_faces(&self) -> bool {
        false
    }

    /// Infinite strength.
    fn unbreakable(&self) -> Self
    where
        Self: Sized;
}

/// Viscous bond damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BondDamping {
    /// Undamped.
    None,
    /// Fraction of critical damping: c = 2 ζ √(k m*), reduced mass for tension and shear, reduced moment of
    /// inertia for bending and twisting.
    Fraction(f64),
    /// Tension and shear [N s/m], bending and twisting [N m s].
    Coefficients([f64; 4]),
}

/// Failure criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Tensile or shear stress reaches its strength.
    Stress,
    /// Utilisations of tension, bending, shear and twisting sum to 1.
    Sum,
}

#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// Sphere or bounding radii [m].
    pub radii: [f64; 2],
    /// Centre distance [m].
    pub length: f64,
    /// Reduced mass [kg] and moment of inertia [kg m²]; zero between fixed bodies.
    pub mass: f64,
    pub inertia: f64,
    pub face: Option<Face>,
}

#[derive(Clone, Copy, Debug)]
pub struct Springs {
    /// Tension and shear [N/m], bending and twisting [N m/rad].
    pub stiffness: [f64; 4],
    /// 1/strength in tension [1/N], bending [1/(N m)], shear [1/N], twisting [1/(N m)]; tension in the shear
    /// criterion [1/N].
    pub limit: [f64; 5],
    /// Lever arm difference [m]; 0 for forces at the middle.
    pub offset: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// Area [m²].
    pub area: f64,
    /// Second moment of area [m⁴], extreme fibre distance [m].
    pub bending: [f64; 2],
    /// Torsion constant [m⁴], torsional stress factor [m].
    pub torsion: [f64; 2],
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Cement {
    /// Stiffness per area: tension, shear [Pa/m].
    pub stiffness: [f64; 2],
    /// Tensile strength [Pa].
    pub tensile_strength: f64,
    pub shear_strength: ShearStrength,
    /// Fraction of the bending moment in the tensile stress.
    pub moment_factor: f64,
}

impl Section {
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

/// Invalid quantity: name, value, requirement.
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
