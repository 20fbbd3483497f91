//! Contact materials and pair exceptions.
//!
//! Theory manual: eq. (1.2), `docs/theory/contacts.md`.

use super::damping::Damping;
use super::formula::Formula;

/// Contact material. Law of a pair: [`PairOverride::normal`], else the common [`Material::normal`], else
/// Hertz with a Young's modulus, linear with a stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Body density [kg/m³].
    pub density: f64,
    /// Normal stiffness k between equal bodies [N/m], infinite if rigid: K = 2 k₁k₂/(k₁ + k₂), 2k with a
    /// rigid partner.
    pub stiffness: f64,
    /// Tangential over normal stiffness, Ks/Kn [-].
    pub tangential_ratio: f64,
    /// Tangential over normal damping, Cs/Cn [-].
    pub tangential_damping_ratio: f64,
    /// Coulomb friction [-]; with asperities at large forces.
    pub friction: f64,
    /// Asperity friction at vanishing force [-] (`rough.rs`).
    pub asperity_friction: f64,
    /// Half-value pressure [Pa]: normal force over R², with conical damage over πR².
    pub asperity_pressure: f64,
    /// Restitution of a central impact, in (0, 1].
    pub restitution: f64,
    /// Young's modulus [Pa]; stiffness then depends on size.
    pub young: Option<f64>,
    /// Poisson's ratio [-].
    pub poisson: f64,
    /// Stiffness factor of dilated edges [-] (`line_contact.rs`).
    pub edge_factor: f64,
    /// Corner strength [Pa] (`conical_damage.rs`); infinite: no crushing.
    pub corner_strength: f64,
    /// Half-angle of corners [rad].
    pub corner_angle: f64,
    /// Rolling resistance: largest moment over R* F [-].
    pub rolling_friction: f64,
    /// Twisting resistance: largest moment over R* F [-].
    pub twisting_friction: f64,
    /// Normal law; `None`: from the constants.
    pub normal: Option<LawName>,
    /// Formulas of an own normal law.
    pub formula: Option<&'static Formula>,
}

impl Material {
    /// Rigid frictionless wall.
    pub const RIGID: Material = Material {
        density: 1.0,
        stiffness: f64::INFINITY,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.0,
        friction: 0.0,
        asperity_friction: 0.0,
        asperity_pressure: f64::INFINITY,
        restitution: 1.0,
        young: None,
        poisson: 0.0,
        edge_factor: 1.0,
        corner_strength: f64::INFINITY,
        corner_angle: std::f64::consts::FRAC_PI_2,
        rolling_friction: 0.0,
        twisting_friction: 0.0,
        normal: None,
        formula: None,
    };

    /// Soft frictional material of tests.
    #[doc(hidden)]
    pub const SOFT: Material =
        Material { density: 2600.0, stiffness: 1e5, friction: 0.5, restitution: 0.5, ..Material::RIGID };
}

impl Material {
    /// Returns the material with constant friction.
    pub fn with_friction(self, friction: f64) -> Material {
        Material { friction, asperity_friction: 0.0, ..self }
    }
}

impl Default for Material {
    /// [`Material::RIGID`].
    fn default() -> Material {
        Material::RIGID
    }
}

/// Pair exceptions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairOverride {
    /// First material (index).
    pub a: usize,
    /// Second material (index), may equal the first.
    pub b: usize,
    /// Friction [-], without asperities.
    pub friction: Option<f64>,
    /// Restitution, in (0, 1].
    pub restitution: Option<f64>,
    /// Normal stiffness K [N/m].
    pub stiffness: Option<f64>,
    /// Work of adhesion w [J/m²]: attraction 2π w R* of spheres and walls.
    pub adhesion: Option<f64>,
    /// Normal law.
    pub normal: Option<LawName>,
    /// Formulas of an own normal law.
    pub formula: Option<&'static Formula>,
    /// Tangential law; `None`: by normal law.
    pub tangential: Option<LawName>,
    /// Damping; `None`: from restitution.
    pub damping: Option<Damping>,
    /// Rolling resistance: largest moment over R* F [-].
    pub rolling_friction: Option<f64>,
    /// Twisting resistance: largest moment over R* F [-].
    pub twisting_friction: Option<f64>,
}

/// Law name (`table.rs`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LawName(pub(super) &'static str);

impl LawName {
    /// No tangential force.
    pub const NONE: LawName = LawName("none");

    /// Row of an own law.
    pub fn of(formula: &Formula) -> LawName {
        LawName(formula.law())
    }

    /// Scene name.
    pub fn as_str(&self) -> &'static str {
        self.0
    }
}

/// Two materials and their exception.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    /// First material.
    pub a: &'a Material,
    /// Second material.
    pub b: &'a Material,
    /// Exception, if any.
    pub exception: Option<&'a PairOverride>,
}

impl<'a> Pair<'a> {
    /// Returns the pair of two indices, any order; its last exception applies.
    pub fn of(materials: &'a [Material], exceptions: &'a [PairOverride], i: usize, j: usize) -> Pair<'a> {
        let exception = exceptions.iter().rfind(|e| (e.a, e.b) == (i, j) || (e.a, e.b) == (j, i));
        // Makes (i, j) and (j, i) bitwise equal.
        Pair { a: &materials[i.min(j)], b: &materials[i.max(j)], exception }
    }

    /// Returns a value of the exception.
    pub fn given<T>(&self, pick: fn(&PairOverride) -> Option<T>) -> Option<T> {
        self.exception.and_then(pick)
    }

    /// Returns the exception, or the smaller value.
    pub fn smaller(&self, given: fn(&PairOverride) -> Option<f64>, own: fn(&Material) -> f64) -> f64 {
        self.given(given).unwrap_or(own(self.a).min(own(self.b)))
    }

    /// Coefficient of restitution.
    pub fn restitution(&self) -> f64 {
        self.smaller(|e| e.restitution, |m| m.restitution)
    }

    /// Normal stiffness [N/m].
    pub fn stiffness(&self) -> f64 {
        self.given(|e| e.stiffness).unwrap_or(harmonic(self.a.stiffness, self.b.stiffness))
    }
}

/// 2xy/(x + y), also for infinite values.
pub fn harmonic(x: f64, y: f64) -> f64 {
    if x.is_infinite() {
        2.0 * y
    } else if y.is_infinite() {
        2.0 * x
    } else if x + y > 0.0 {
        2.0 * x * y / (x + y)
    } else {
        0.0
    }
}
