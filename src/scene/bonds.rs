//! Scene tables of bonds.

use super::units::{Angle, Force, Length, Quantity, Stiffness, Stress};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// `[[bond]]`: a kind of bond, and which grains it joins.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BondTable {
    /// Name in reports and `grains.bond`.
    pub name: String,
    /// Names of both groups; default any; with `gap`.
    pub between: Option<[String; 2]>,
    /// Surface distance of joined spheres [m]; or `pairs`, neither for stones, floes; ≥ 0, ≤ ten largest radii.
    pub gap: Option<Quantity<Length>>,
    /// CSV file of grain index pairs, from 0 over all groups; or `gap`; not with `deposition.level`.
    #[schemars(extend("format" = "path"))]
    pub pairs: Option<PathBuf>,
    /// Cement disc with moments; or `contact_point`, `direct`, `face`.
    pub parallel: Option<Parallel>,
    /// Adhesive point without moments; or `parallel`.
    pub contact_point: Option<ContactPoint>,
    /// Given stiffnesses and strengths; or `parallel`.
    pub direct: Option<Direct>,
    /// Beam between floes with their face's section; or `parallel`.
    pub face: Option<FaceTable>,
    /// Fraction of critical damping, each spring; default 0; ≥ 0.
    pub damping: Option<f64>,
    /// List of dashpots: tension, shear [N s/m], bending, twisting [N m s]; or `damping`; ≥ 0.
    pub damping_coefficients: Option<[f64; 4]>,
    /// Whether contacts act before the break, with `face` always; default false.
    #[serde(default)]
    pub contact: bool,
    /// Spread of strengths; default none.
    pub spread: Option<StrengthSpreadTable>,
    /// Spread of stiffnesses, one factor a bond; default none.
    pub stiffness_spread: Option<StiffnessSpreadTable>,
    /// Boxes with factors on bonds; default none.
    #[serde(default)]
    pub region: Vec<StrengthRegion>,
}

/// A parallel bond.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parallel {
    /// Disc radius over smaller sphere radius; default 1; > 0.
    pub radius_factor: Option<f64>,
    /// Young's modulus: stiffness per area times length [Pa]; or `normal_stiffness`; > 0.
    pub young: Option<Quantity<Stress>>,
    /// Normal over shear stiffness; default 1; > 0; with `young`.
    pub stiffness_ratio: Option<f64>,
    /// Normal stiffness per area [Pa/m]; or `young`; > 0.
    pub normal_stiffness: Option<f64>,
    /// Shear stiffness per area [Pa/m]; ≥ 0; with `normal_stiffness`.
    pub shear_stiffness: Option<f64>,
    /// Tensile strength [Pa]; default unbreakable; ≥ 0.
    pub tensile_strength: Option<Quantity<Stress>>,
    /// Shear strength, cohesion with `friction_angle` [Pa]; default unbreakable; ≥ 0.
    pub shear_strength: Option<Quantity<Stress>>,
    /// Friction angle of the shear strength [rad]; default 0; ≥ 0, < 90°; with `shear_strength`.
    pub friction_angle: Option<Quantity<Angle>>,
    /// Bending moment fraction in the tensile stress; default 1; 0–1.
    pub moment_factor: Option<f64>,
    /// Criterion of breakage; default `"stress"`.
    #[serde(default)]
    pub criterion: CriterionName,
}

/// A contact-point bond.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactPoint {
    /// Normal stiffness [N/m]; > 0.
    pub normal_stiffness: Quantity<Stiffness>,
    /// Shear stiffness [N/m]; ≥ 0.
    pub shear_stiffness: Quantity<Stiffness>,
    /// Largest tension [N]; default unbreakable; > 0.
    pub tension_limit: Option<Quantity<Force>>,
    /// Largest shear force [N]; default unbreakable; > 0.
    pub shear_limit: Option<Quantity<Force>>,
}

/// A bond by its own stiffnesses and strengths.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Direct {
    /// List: tension, shear [N/m], bending, twisting [N m/rad]; > 0 (tension), ≥ 0.
    pub stiffness: [f64; 4],
    /// List: tension, shear [N], bending, twisting moment [N m]; default unbreakable; > 0.
    pub strength: Option<[f64; 4]>,
    /// Criterion of breakage; default `"stress"`.
    #[serde(default)]
    pub criterion: CriterionName,
}

/// A bond that fills a face; its contact acts beside it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceTable {
    /// Young's modulus [Pa]; > 0.
    pub young: Quantity<Stress>,
    /// Normal over shear stiffness; default 2.5; > 0.
    pub stiffness_ratio: Option<f64>,
    /// Tensile or flexural strength [Pa]; default unbreakable; ≥ 0.
    pub tensile_strength: Option<Quantity<Stress>>,
    /// Shear strength, cohesion with `friction_angle` [Pa]; default unbreakable; ≥ 0.
    pub shear_strength: Option<Quantity<Stress>>,
    /// Friction angle of the shear strength [rad]; default 0; ≥ 0, < 90°; with `shear_strength`.
    pub friction_angle: Option<Quantity<Angle>>,
    /// Criterion of breakage; default `"stress"`.
    #[serde(default)]
    pub criterion: CriterionName,
}

/// When a bond breaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CriterionName {
    /// Tensile or shear stress reaches strength.
    #[default]
    Stress,
    /// Load fractions add up to 1.
    Sum,
}

/// Spread of the strengths.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename = "SpreadTable", deny_unknown_fields)]
pub struct StrengthSpreadTable {
    /// Distribution.
    pub kind: SpreadKind,
    /// Standard deviation over mean; > 0, ≤ 10; with `"normal"`.
    pub deviation: Option<f64>,
    /// Weibull modulus; > 0.05, ≤ 1000; with `"weibull"`.
    pub modulus: Option<f64>,
    /// Random seed; default 1.
    pub seed: Option<u64>,
    /// Whether tension and shear share a factor; default false.
    #[serde(default)]
    pub correlated: bool,
}

/// Spread of the stiffnesses: one factor for all of a bond.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StiffnessSpreadTable {
    /// Distribution.
    pub kind: SpreadKind,
    /// Standard deviation over mean; > 0, ≤ 10; with `"normal"`.
    pub deviation: Option<f64>,
    /// Weibull modulus; > 0.05, ≤ 1000; with `"weibull"`.
    pub modulus: Option<f64>,
    /// Random seed; default 1.
    pub seed: Option<u64>,
}

/// Distribution of strengths or stiffnesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpreadKind {
    /// Cut off at zero.
    Normal,
    /// Scale as given.
    Weibull,
}

/// A box in which bonds differ. Of several that hold a bond's middle, all factors apply.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrengthRegion {
    /// Lower corner [m].
    pub low: [Quantity<Length>; 3],
    /// Upper corner [m]; > `low`.
    pub high: [Quantity<Length>; 3],
    /// Factor on strength of bonds with middle inside; default 1; > 0.
    pub strength: Option<f64>,
    /// Factor on their stiffness; default 1; > 0.
    pub stiffness: Option<f64>,
}
