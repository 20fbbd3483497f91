//! Contact materials and exceptions for pairs of them.

use serde::{Deserialize, Serialize};

/// A contact material. Either all materials of a model that are not rigid have a `stiffness` (linear contact), or all
/// have a Young's modulus (contact after Hertz and Mindlin).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Coulomb friction coefficient [-].
    pub friction: f64,
    /// Coefficient of restitution of a central impact, in (0, 1].
    pub restitution: f64,
    /// Young's modulus [Pa]; the stiffness is then infinite, and that of contacts follows from their sizes.
    pub young: Option<f64>,
    /// Poisson's ratio [-]; used with a Young's modulus.
    pub poisson: f64,
    /// Rolling resistance: largest moment over R* F [-]; zero: none.
    pub rolling_friction: f64,
    /// Twisting resistance: largest moment about the normal over R* F [-]; zero: none.
    pub twisting_friction: f64,
}

impl Material {
    /// A rigid wall without friction, for the fields that a material does not care about.
    pub const RIGID: Material = Material {
        density: 1.0,
        stiffness: f64::INFINITY,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.0,
        friction: 0.0,
        restitution: 1.0,
        young: None,
        poisson: 0.0,
        rolling_friction: 0.0,
        twisting_friction: 0.0,
    };
}

impl Default for Material {
    /// [`Material::RIGID`].
    fn default() -> Material {
        Material::RIGID
    }
}

/// Values of one pair of materials that replace the mixed ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PairOverride {
    /// First material (index).
    pub a: usize,
    /// Second material (index); may equal the first.
    pub b: usize,
    /// Friction coefficient [-].
    pub friction: Option<f64>,
    /// Coefficient of restitution, in (0, 1].
    pub restitution: Option<f64>,
    /// Normal stiffness K of the contact itself [N/m].
    pub stiffness: Option<f64>,
    /// Work of adhesion w [J/m²]: spheres and walls in touch attract each other with 2π w R*; absent: they do not.
    pub adhesion: Option<f64>,
}
