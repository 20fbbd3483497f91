//! What sets a kind of element apart besides its shape functions.

use super::natural_shape::NaturalShape;
use super::quadrature::VolumePoint;

/// Properties of a kind, declared in its module.
#[derive(Clone, Copy, Debug)]
pub struct Properties {
    /// Natural shape.
    pub shape: NaturalShape,
    /// Integration rules of the stiffness, by [`super::quadrature::Quadrature`]: wedge15, pyramid13 and tet10
    /// use the fewest points without zero-energy modes, or a rule exact for products of linear strains
    /// ("full").
    pub stiffness_rules: [&'static [VolumePoint]; 3],
    /// Integration rule of the mass; exact for products of shape functions on flat-faced elements.
    pub mass_rule: &'static [VolumePoint],
    /// Whether recovered stress is constant in the element, else as [`NaturalShape`] extrapolates and fits.
    pub constant_stress: bool,
    /// Whether the mean dilatation keeps linear functions.
    pub linear_dilatation: bool,
    /// Whether incompatible modes can be added; only for the nodes of the hex8.
    pub incompatible_modes: bool,
    /// When it locks near incompressibility.
    pub locking: Locking,
}

/// When a kind locks near incompressibility.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Locking {
    /// Never; linear kinds have the mean dilatation.
    Never,
    /// With pointwise dilatation, except by the reduced rule.
    FullRules,
    /// With pointwise dilatation.
    Pointwise,
    /// Also with the mean dilatation.
    Always,
}
