//! Contact materials and exceptions for pairs of them.

use serde::{Deserialize, Serialize};

/// A contact material.
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
}

/// Values of one pair of materials that replace the mixed ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
}
