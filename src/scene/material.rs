//! Contact materials and exceptions for pairs of them, as written in a scene.

use super::units::{Adhesion, Angle, Density, Quantity, Stiffness, Stress};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[[material]]`: contact by a linear spring and dashpot, or after Hertz and Mindlin where materials have a Young's
/// modulus, unless `normal` names another law; with Coulomb friction.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainMaterial {
    /// Name by which groups and walls refer to it.
    pub name: String,
    /// Density [kg/m³]; needed by materials of grains and sleepers.
    pub density: Option<Quantity<Density>>,
    /// Contact stiffness of a like pair [N/m]; absent: rigid (a contact with it is twice as stiff as a like pair).
    pub stiffness: Option<Quantity<Stiffness>>,
    /// Normal law of its contacts, by name; default: `hertz` with a Young's modulus, `linear` with a stiffness.
    pub normal: Option<String>,
    /// Young's modulus [Pa], in place of a stiffness: contact after Hertz and Mindlin.
    pub young: Option<Quantity<Stress>>,
    /// Poisson's ratio, above −1 and at most 0.5; needed with a Young's modulus.
    pub poisson: Option<f64>,
    /// Factor on the stiffness of edges of polyhedra and disks after Hertz, 0.01 to 100; default 1.
    pub edge_factor: Option<f64>,
    /// Pressure that its corners bear before they crush [Pa]; beside a Young's modulus; absent: they do not crush.
    pub corner_strength: Option<Quantity<Stress>>,
    /// Half the angle of the cones that corners are, above 0 and below 90 degrees; needed with `corner_strength`.
    pub corner_angle: Option<Quantity<Angle>>,
    /// Tangential over normal stiffness, 0–1; default 0.5.
    pub tangential_ratio: Option<f64>,
    /// Tangential over normal damping coefficient, 0–1; default 0.
    #[serde(default)]
    pub tangential_damping_ratio: f64,
    /// Coulomb friction coefficient, 0 or more.
    pub friction: f64,
    /// Friction that asperities add at vanishing force: μ + μₐ/(1 + F/(p R²)); default 0, none.
    #[serde(default)]
    pub asperity_friction: f64,
    /// p of it [Pa]: normal force over the effective radius squared at which half is left (mean pressure beside `corner_strength`); needed with
    /// `asperity_friction`.
    pub asperity_pressure: Option<Quantity<Stress>>,
    /// Coefficient of restitution, above 0 and at most 1.
    pub restitution: f64,
    /// Rolling resistance: largest moment over effective radius times normal force; default 0, none.
    #[serde(default)]
    pub rolling_friction: f64,
    /// Twisting resistance: largest moment about the normal over effective radius times normal force; default 0, none.
    #[serde(default)]
    pub twisting_friction: f64,
}

/// `[[contact]]`: constants of one pair of materials.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairContact {
    /// Names of the two materials (twice the same for a like pair).
    pub between: [String; 2],
    /// Friction coefficient of the pair.
    pub friction: Option<f64>,
    /// Restitution of the pair.
    pub restitution: Option<f64>,
    /// Normal stiffness of the pair [N/m].
    pub stiffness: Option<Quantity<Stiffness>>,
    /// Work of adhesion [J/m²].
    pub adhesion: Option<Quantity<Adhesion>>,
    /// Normal law of the pair, by name; default: that of both materials.
    pub normal: Option<String>,
    /// Tangential law of the pair, by name, or `none`; default: the one that belongs to the normal law.
    pub tangential: Option<String>,
    /// Where the normal damping is from; default: the restitution.
    pub damping: Option<DampingKind>,
    /// Damping ratio of the pair [-], with `damping = "ratio"`.
    pub damping_ratio: Option<f64>,
    /// Rolling resistance; default: a spring where both materials have a coefficient.
    pub rolling: Option<Resistance>,
    /// Rolling resistance of the pair: largest moment over effective radius times normal force.
    pub rolling_friction: Option<f64>,
    /// Twisting resistance; default: a spring where both materials have a coefficient.
    pub twisting: Option<Resistance>,
    /// Twisting resistance of the pair: largest moment about the normal over effective radius times normal force.
    pub twisting_friction: Option<f64>,
}

/// `contact.damping`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DampingKind {
    /// The dashpot that gives the restitution.
    Restitution,
    /// The dashpot of a damping ratio.
    Ratio,
    /// No dashpot.
    None,
}

/// `contact.rolling` and `contact.twisting`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Resistance {
    /// A spring that yields.
    Spring,
    /// None.
    None,
}
