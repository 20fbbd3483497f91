//! Scene tables of contact materials and material pairs.

use super::bonds::SpreadKind;
use super::units::{Adhesion, Angle, Density, Quantity, Stiffness, Stress};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// `[[material]]`: contact by a linear spring and dashpot, or after Hertz and Mindlin where materials have a Young's
/// modulus, unless `normal` names another law; with Coulomb friction.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainMaterial {
    /// Name, each once.
    pub name: String,
    /// Density [kg/m³]; > 0; needed for grains.
    pub density: Option<Quantity<Density>>,
    /// Normal stiffness of two of this material [N/m]; default rigid; > 0.
    pub stiffness: Option<Quantity<Stiffness>>,
    /// Normal law, see `[[contact]]`; default by `young`, `corner_strength`, `stiffness`.
    pub normal: Option<String>,
    /// Young's modulus, of Hertzian laws [Pa]; default none; > 0.
    pub young: Option<Quantity<Stress>>,
    /// Spread of `young` or `stiffness` over the grains; default none.
    pub stiffness_spread: Option<GrainStiffnessSpread>,
    /// Poisson's ratio; > −1, ≤ 0.5; with `young`.
    pub poisson: Option<f64>,
    /// Factor on edge stiffness, 3.14 for line contact; default 1; 0.01–100; with `young`.
    pub edge_factor: Option<f64>,
    /// Pressure at which corners crush [Pa]; default none; > 0, < limit by modulus, angle; with `young`.
    pub corner_strength: Option<Quantity<Stress>>,
    /// Half cone angle of corners [rad]; > 0, < 90°; with `corner_strength`.
    pub corner_angle: Option<Quantity<Angle>>,
    /// Tangential over normal stiffness, linear law; default 0.5; 0–1.
    pub tangential_ratio: Option<f64>,
    /// Tangential over normal dashpot; default 0; 0–1.
    #[serde(default)]
    pub tangential_damping_ratio: f64,
    /// Friction coefficient μ, at large forces; ≥ 0.
    pub friction: f64,
    /// Friction μₐ of asperities in μ + μₐ/(1 + F/(p R²)); default 0; ≥ 0; with `"linear"`, `corner_strength`.
    #[serde(default)]
    pub asperity_friction: f64,
    /// Pressure p of it: force over R², with `corner_strength` over πR² [Pa]; > 0; with `asperity_friction`.
    pub asperity_pressure: Option<Quantity<Stress>>,
    /// Coefficient of restitution; 0.0001–1; shorter steps if small.
    pub restitution: f64,
    /// Largest rolling moment over R F; default 0; ≥ 0.
    #[serde(default)]
    pub rolling_friction: f64,
    /// Largest twisting moment over R F; default 0; ≥ 0.
    #[serde(default)]
    pub twisting_friction: f64,
}

/// Spread of stiffness over the grains of each group, in 16 classes of equal number.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainStiffnessSpread {
    /// Distribution.
    pub kind: SpreadKind,
    /// Standard deviation over mean; > 0, ≤ 10; with `"normal"`.
    pub deviation: Option<f64>,
    /// Weibull modulus; > 0.05, ≤ 1000; with `"weibull"`.
    pub modulus: Option<f64>,
    /// Random seed; default 1.
    pub seed: Option<u64>,
}

/// `[[contact]]`: constants of one pair of materials.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairContact {
    /// Names of the two materials.
    pub between: [String; 2],
    /// Friction coefficient; default the smaller; ≥ 0.
    pub friction: Option<f64>,
    /// Coefficient of restitution; default the smaller; 0.0001–1; not with `"none"`.
    pub restitution: Option<f64>,
    /// Normal stiffness [N/m]; default mixed; > 0; with `"linear"`, `"walton_braun"`.
    pub stiffness: Option<Quantity<Stiffness>>,
    /// Work of adhesion w, force 2π w R in contact [J/m²]; default 0; ≥ 0; not with boxes, bonds, rigid bodies.
    pub adhesion: Option<Quantity<Adhesion>>,
    /// Normal law, `"linear"` and others; default by materials.
    pub normal: Option<String>,
    /// Tangential law, `"none"` or others; default by normal law.
    pub tangential: Option<String>,
    /// Damping; default `"restitution"`; not with `"walton_braun"`.
    pub damping: Option<DampingKind>,
    /// Damping ratio C/(2 √(m* K)); ≥ 0; with `"ratio"`.
    pub damping_ratio: Option<f64>,
    /// Rolling resistance; default `"spring"`.
    pub rolling: Option<Resistance>,
    /// Coefficient of `rolling`; default the smaller; ≥ 0.
    pub rolling_friction: Option<f64>,
    /// Twisting resistance; default `"spring"`.
    pub twisting: Option<Resistance>,
    /// Coefficient of `twisting`; default the smaller; ≥ 0.
    pub twisting_friction: Option<f64>,
}

/// `[contact_law]`: an own normal law by formulas.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactLawTable {
    /// Name, for `normal` of materials and pairs.
    pub name: String,
    /// Spring force [N], a formula.
    pub force: String,
    /// Dashpot coefficient [N s/m], a formula; default none; not with `D` in `force`.
    pub damping: Option<String>,
    /// Spring energy [J], a formula; default integrated; needed with `D`.
    pub energy: Option<String>,
    /// Energy dissipated in a step [J], a formula; with `D` in `force`.
    pub loss: Option<String>,
    /// Numbers by name; default none.
    #[serde(default)]
    pub constants: BTreeMap<String, f64>,
}

/// `contact.damping`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DampingKind {
    /// Restitution.
    Restitution,
    /// Ratio.
    Ratio,
    /// None.
    None,
}

/// `contact.rolling` and `contact.twisting`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Resistance {
    /// Spring.
    Spring,
    /// None.
    None,
}
