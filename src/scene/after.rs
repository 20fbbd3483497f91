//! What goes on about the load cycles: jumps over many of them, and the lateral push at their end, as written in a scene.

use super::units::{Force, Length, Quantity, Stiffness, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[track.jump]`: cycles that are not simulated one by one.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CycleJump {
    /// What jumps; default `account`.
    #[serde(default)]
    pub method: JumpMethod,
    /// Cycles simulated before the first jump; default 100.
    #[serde(default = "hundred")]
    pub first: u32,
    /// Cycles of each stretch whose rate is measured; default 10.
    #[serde(default = "ten")]
    pub measure: u32,
    /// Cycles after a jump whose rate does not count, for `grains`; default 3.
    pub settle: Option<u32>,
    /// Error of a jump over the settlement, up to which the next jump is longer; default 0.02.
    #[serde(default = "fiftieth")]
    pub tolerance: f64,
    /// Largest jump over the cycles before it; default 1, which doubles them.
    #[serde(default = "unity")]
    pub largest: f64,
    /// Share by which a jump may change the overlaps of the contacts in the mean, for `grains`; default 0.5.
    pub overlap: Option<f64>,
}

/// What a jump extrapolates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JumpMethod {
    /// The settlement only; the grains stay where they are.
    #[default]
    Account,
    /// The places of the grains and the sleepers.
    Grains,
}

fn hundred() -> u32 {
    100
}
fn ten() -> u32 {
    10
}
fn fiftieth() -> f64 {
    0.02
}
fn unity() -> f64 {
    1.0
}

/// `[track.push]`: a ram pushes a sleeper sideways when the cycles are over.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Push {
    /// Horizontal direction across the track or along it, any length.
    pub direction: [f64; 2],
    /// Speed of the ram [m/s].
    pub speed: Quantity<Velocity>,
    /// How far it goes [m].
    pub displacement: Quantity<Length>,
    /// Vertical force on the sleeper meanwhile, beside its weight [N]; default 0.
    #[serde(default = "none")]
    pub load: Quantity<Force>,
    /// Time from the last cycle to the push, in which the vertical force goes over to `load` [s]; default 0.1 s.
    #[serde(default = "tenth")]
    pub rest: Quantity<Time>,
    /// Height of the ram above the sleeper's centre [m]; default 0.
    #[serde(default = "level")]
    pub height: Quantity<Length>,
    /// Stiffness of the ram [N/m]; default 20 MN/m.
    #[serde(default = "stiff")]
    pub stiffness: Quantity<Stiffness>,
}

fn none() -> Quantity<Force> {
    Quantity::new(0.0)
}
fn tenth() -> Quantity<Time> {
    Quantity::new(0.1)
}
fn level() -> Quantity<Length> {
    Quantity::new(0.0)
}
fn stiff() -> Quantity<Stiffness> {
    Quantity::new(2e7)
}
