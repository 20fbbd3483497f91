//! Bonds as written in a scene.

use super::units::{Angle, Force, Length, Quantity, Stiffness, Stress};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// `[[bond]]`: a kind of bond, and which grains it joins.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BondTable {
    /// Name, for reports and for `bond` of bonded grains.
    pub name: String,
    /// The two groups whose grains are joined (the same name twice for one group); default: any.
    pub between: Option<[String; 2]>,
    /// Join spheres whose surfaces are nearer than this at the start of the run proper [m].
    pub gap: Option<Quantity<Length>>,
    /// Instead of a gap: CSV file with the numbers of two grains in each row, counted from 0 over all groups.
    pub pairs: Option<PathBuf>,
    /// A disk of cement: force and moment.
    pub parallel: Option<Parallel>,
    /// A glue at the contact point: force only.
    pub contact_point: Option<ContactPoint>,
    /// Stiffnesses and strengths of the bond itself.
    pub direct: Option<Direct>,
    /// What fills the faces between the floes of a sheet: force and moment.
    pub face: Option<FaceTable>,
    /// Fraction of critical damping; default 0.
    pub damping: Option<f64>,
    /// Instead: coefficients of tension and shear [N s/m], bending and twisting [N m s].
    pub damping_coefficients: Option<[f64; 4]>,
    /// Whether the contact of a joined pair acts beside the bond; default false.
    #[serde(default)]
    pub contact: bool,
    /// Spread of the strengths; default none.
    pub spread: Option<StrengthSpreadTable>,
    /// Spread of the stiffnesses; default none.
    pub stiffness_spread: Option<StiffnessSpreadTable>,
    /// Boxes in which strength or stiffness are others.
    #[serde(default)]
    pub region: Vec<StrengthRegion>,
}

/// A parallel bond.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parallel {
    /// Radius of the disk over the smaller radius of the two spheres; default 1.
    pub radius_factor: Option<f64>,
    /// Young's modulus [Pa]: normal stiffness per area E/L, L the distance of the centres.
    pub young: Option<Quantity<Stress>>,
    /// With `young`: normal over shear stiffness; default 1.
    pub stiffness_ratio: Option<f64>,
    /// Instead of `young`: normal stiffness per area [Pa/m].
    pub normal_stiffness: Option<f64>,
    /// With `normal_stiffness`: shear stiffness per area [Pa/m].
    pub shear_stiffness: Option<f64>,
    /// Tensile strength [Pa], 0: the first load breaks it; default unbreakable.
    pub tensile_strength: Option<Quantity<Stress>>,
    /// Shear strength [Pa], with `friction_angle` the cohesion; default unbreakable.
    pub shear_strength: Option<Quantity<Stress>>,
    /// Friction angle, by which pressure adds to the shear strength; default 0.
    pub friction_angle: Option<Quantity<Angle>>,
    /// Part of the bending moment that counts in the tensile stress, 0–1; default 1.
    pub moment_factor: Option<f64>,
    /// When it breaks; default `stress`.
    #[serde(default)]
    pub criterion: CriterionName,
}

/// A contact-point bond.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactPoint {
    /// Stiffness in tension and pressure [N/m].
    pub normal_stiffness: Quantity<Stiffness>,
    /// Stiffness in shear [N/m].
    pub shear_stiffness: Quantity<Stiffness>,
    /// Largest tension [N]; default unbreakable.
    pub tension_limit: Option<Quantity<Force>>,
    /// Largest shear force [N]; default unbreakable.
    pub shear_limit: Option<Quantity<Force>>,
}

/// A bond by its own stiffnesses and strengths.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Direct {
    /// Tension and shear [N/m], bending and twisting [N m/rad].
    pub stiffness: [f64; 4],
    /// Largest tension and shear [N], bending and twisting moment [N m]; default unbreakable.
    pub strength: Option<[f64; 4]>,
    /// When it breaks; default `stress`.
    #[serde(default)]
    pub criterion: CriterionName,
}

/// A bond that fills a face; its contact acts beside it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceTable {
    /// Young's modulus [Pa].
    pub young: Quantity<Stress>,
    /// Normal over shear stiffness; default 2.5.
    pub stiffness_ratio: Option<f64>,
    /// Strength in tension and bending [Pa], 0: the first load breaks it; default unbreakable.
    pub tensile_strength: Option<Quantity<Stress>>,
    /// Shear strength [Pa], with `friction_angle` the cohesion; default unbreakable.
    pub shear_strength: Option<Quantity<Stress>>,
    /// Friction angle, by which pressure adds to the shear strength; default 0.
    pub friction_angle: Option<Quantity<Angle>>,
    /// When it breaks; default `stress`.
    #[serde(default)]
    pub criterion: CriterionName,
}

/// When a bond breaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CriterionName {
    /// When the tensile or the shear stress reaches its strength.
    #[default]
    Stress,
    /// When the shares of all four loads add up to 1.
    Sum,
}

/// Spread of the strengths.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename = "SpreadTable", deny_unknown_fields)]
pub struct StrengthSpreadTable {
    /// Distribution.
    pub kind: SpreadKind,
    /// Standard deviation over the mean, of `normal`.
    pub deviation: Option<f64>,
    /// Modulus m of `weibull`.
    pub modulus: Option<f64>,
    /// Seed; default 1.
    pub seed: Option<u64>,
    /// Whether tension and shear of a bond have the same factor; default false, each draws its own.
    #[serde(default)]
    pub together: bool,
}

/// Spread of the stiffnesses: one factor for all of a bond.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StiffnessSpreadTable {
    /// Distribution.
    pub kind: SpreadKind,
    /// Standard deviation over the mean, of `normal`.
    pub deviation: Option<f64>,
    /// Modulus m of `weibull`.
    pub modulus: Option<f64>,
    /// Seed; default 1.
    pub seed: Option<u64>,
}

/// Distribution of strengths and stiffnesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpreadKind {
    /// Normal about the strength given, cut off at zero.
    Normal,
    /// Weibull, the strength given being its scale.
    Weibull,
}

/// A box in which bonds differ. Of several that hold a bond's middle, all factors apply.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrengthRegion {
    /// Lower corner [m].
    pub low: [Quantity<Length>; 3],
    /// Upper corner [m].
    pub high: [Quantity<Length>; 3],
    /// Factor on both strengths; default 1.
    pub strength: Option<f64>,
    /// Factor on all stiffnesses; default 1.
    pub stiffness: Option<f64>,
}
