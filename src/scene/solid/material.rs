//! Materials of the solid as written in a scene.

use crate::scene::units::{Angle, Density, Quantity, Stress};
use serde::Deserialize;

/// `[[solid.material]]`: one for each material number of the mesh.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidMaterial {
    /// Material number of the mesh.
    pub id: u32,
    /// Name for reports.
    #[serde(default)]
    pub name: String,
    /// Yield criterion; default `elastic`.
    #[serde(default)]
    pub model: MaterialModel,
    /// Young's modulus [Pa], above 0.
    pub young: Quantity<Stress>,
    /// Poisson's ratio, above −1 and below 0.5.
    pub poisson: f64,
    /// Density [kg/m³], above 0.
    pub density: Quantity<Density>,
    /// Cohesion [Pa].
    pub cohesion: Option<Quantity<Stress>>,
    /// Friction angle [rad].
    pub friction: Option<Quantity<Angle>>,
    /// Angle of dilation [rad].
    pub dilation: Option<Quantity<Angle>>,
    /// Tension cut-off [Pa]: largest principal stress (Mohr–Coulomb) or mean stress (Drucker–Prager).
    pub tension: Option<Quantity<Stress>>,
    /// Which meridian of Mohr–Coulomb the cone of `drucker_prager` passes through.
    pub cone: Option<Cone>,
    /// Yield stress in uniaxial tension [Pa], of `von_mises` and `tresca`.
    pub yield_stress: Option<Quantity<Stress>>,
    /// Rise of the cohesion, or of the yield stress, per unit of equivalent plastic strain [Pa].
    pub hardening: Option<Quantity<Stress>>,
    /// Cohesion, or yield stress, against equivalent plastic strain: [[strain, Pa], …].
    pub hardening_table: Option<Vec<(f64, Quantity<Stress>)>>,
    /// Friction angle against equivalent plastic strain: [[strain, angle], …].
    pub friction_table: Option<Vec<(f64, Quantity<Angle>)>>,
    /// Horizontal over vertical initial stress; default that of `initial_stress`.
    pub k0: Option<f64>,
}

/// Yield criterion of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MaterialModel {
    /// No yield.
    #[default]
    Elastic,
    /// Mohr–Coulomb.
    MohrCoulomb,
    /// Drucker–Prager.
    DruckerPrager,
    /// von Mises.
    VonMises,
    /// Tresca.
    Tresca,
}

/// Meridian of Mohr–Coulomb that the cone of Drucker–Prager passes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cone {
    /// That of triaxial compression: the cone around the hexagon.
    Compression,
    /// That of triaxial extension.
    Extension,
    /// The same collapse load as Mohr–Coulomb in plane strain.
    PlaneStrain,
}
