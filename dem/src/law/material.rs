//! Contact materials and exceptions for pairs of them.
//!
//! Theory manual: equation (1.2) of `docs/theory/contacts.md`.

use super::damping::Damping;

/// A contact material. The law of a pair of materials is that of [`PairOverride::normal`], else the one that both have
/// (`table.rs`): [`Material::normal`], or Hertz's where there is a Young's modulus and the linear one where there is a
/// stiffness. A material with neither is rigid and takes the law of its partner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Mass per volume of the body [kg/m³].
    pub density: f64,
    /// Normal stiffness k of a contact between two bodies of this material [N/m]; infinite for a rigid wall.
    /// Two materials give K = 2 k₁k₂/(k₁ + k₂), so a rigid partner gives 2k.
    pub stiffness: f64,
    /// Tangential over normal stiffness, Ks/Kn [-].
    pub tangential_ratio: f64,
    /// Tangential over normal damping coefficient, Cs/Cn [-].
    pub tangential_damping_ratio: f64,
    /// Coulomb friction coefficient [-]; with asperities that at large forces.
    pub friction: f64,
    /// Friction that asperities add at vanishing force [-] (`rough.rs`); zero: none.
    pub asperity_friction: f64,
    /// Normal force over the square of the effective radius at which half of it is left [Pa].
    pub asperity_pressure: f64,
    /// Coefficient of restitution of a central impact, in (0, 1].
    pub restitution: f64,
    /// Young's modulus [Pa]; the stiffness of contacts then follows from their sizes.
    pub young: Option<f64>,
    /// Poisson's ratio [-]; used with a Young's modulus.
    pub poisson: f64,
    /// Factor on the stiffness of edges of dilated bodies [-]; used with a Young's modulus (`edges.rs`).
    pub edge_factor: f64,
    /// Largest pressure that corners bear [Pa] (`conical_damage.rs`); infinite: they do not crush.
    pub corner_strength: f64,
    /// Half the angle of the cone of a corner [rad].
    pub corner_angle: f64,
    /// Rolling resistance: largest moment over R* F [-]; zero: none.
    pub rolling_friction: f64,
    /// Twisting resistance: largest moment about the normal over R* F [-]; zero: none.
    pub twisting_friction: f64,
    /// Normal law of its contacts; absent: that of its constants.
    pub normal: Option<LawName>,
}

impl Material {
    /// A rigid wall without friction, for the fields that a material does not care about.
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
    };
}

impl Material {
    /// The same material with one coefficient of friction at all forces.
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

/// Values of one pair of materials that replace the mixed ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairOverride {
    /// First material (index).
    pub a: usize,
    /// Second material (index); may equal the first.
    pub b: usize,
    /// Friction coefficient [-]; in place of that of asperities too.
    pub friction: Option<f64>,
    /// Coefficient of restitution, in (0, 1].
    pub restitution: Option<f64>,
    /// Normal stiffness K of the contact itself [N/m].
    pub stiffness: Option<f64>,
    /// Work of adhesion w [J/m²]: spheres and walls in touch attract each other with 2π w R*; absent: they do not.
    pub adhesion: Option<f64>,
    /// Normal law.
    pub normal: Option<LawName>,
    /// Tangential law; absent: the one that belongs to the normal law.
    pub tangential: Option<LawName>,
    /// Where the damping ratio is from; absent: from the restitution.
    pub damping: Option<Damping>,
    /// Rolling resistance: largest moment over R* F [-].
    pub rolling_friction: Option<f64>,
    /// Twisting resistance: largest moment about the normal over R* F [-].
    pub twisting_friction: Option<f64>,
}

/// Name of a law of the table (`table.rs`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LawName(pub(super) &'static str);

impl LawName {
    /// No tangential force.
    pub const NONE: LawName = LawName("none");

    /// As written in a scene.
    pub fn as_str(&self) -> &'static str {
        self.0
    }
}

/// Two materials and what a scene says of the pair.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    /// One material.
    pub a: &'a Material,
    /// The other.
    pub b: &'a Material,
    /// Values in place of the mixed ones.
    pub exception: Option<&'a PairOverride>,
}

impl<'a> Pair<'a> {
    /// The pair of two materials by index, the same for (i, j) and (j, i). Of several exceptions for it the last holds.
    pub fn of(materials: &'a [Material], exceptions: &'a [PairOverride], i: usize, j: usize) -> Pair<'a> {
        let exception = exceptions.iter().rfind(|e| (e.a, e.b) == (i, j) || (e.a, e.b) == (j, i));
        // In index order, so that (i, j) and (j, i) have the same bits.
        Pair { a: &materials[i.min(j)], b: &materials[i.max(j)], exception }
    }

    /// A value of the exception.
    pub fn given<T>(&self, pick: fn(&PairOverride) -> Option<T>) -> Option<T> {
        self.exception.and_then(pick)
    }

    /// The smaller value of the two materials, if the exception has none.
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
pub(crate) fn harmonic(x: f64, y: f64) -> f64 {
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
