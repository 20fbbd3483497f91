//! Scene tables of load-cycle jumps and the final lateral push.

use super::units::{Force, Length, Quantity, Stiffness, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[track.jump]`: cycles that are not simulated one by one.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CycleJump {
    /// Method; default `"extrapolate"`; `"displace"` not with bonds, periodic axes, plastic solid, meshed sleepers.
    #[serde(default)]
    pub method: JumpMethod,
    /// Cycles before the first jump; default 100; ≥ 10, ≥ `measure` + 2, < `cycles`.
    #[serde(default = "hundred")]
    pub first: u32,
    /// Cycles of a measured rate (`"extrapolate"`: a tenth of all or more); default 10; ≥ 2.
    #[serde(default = "ten")]
    pub measure: u32,
    /// Cycles after a jump without measured rate; default 3; with `"displace"`.
    pub settle: Option<u32>,
    /// Relative error below which jumps double, else halve; default 0.02; > 0, ≤ 10.
    #[serde(default = "fiftieth")]
    pub tolerance: f64,
    /// Largest jump over preceding cycles, the first a quarter; default 1; > 0, ≤ 10.
    #[serde(default = "unity")]
    pub largest: f64,
    /// Largest mean relative change of overlaps; default 0.5; > 0, ≤ 2; with `"displace"`.
    pub overlap: Option<f64>,
}

/// What a jump extrapolates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JumpMethod {
    /// Advances the settlement.
    #[default]
    Extrapolate,
    /// Also displaces grains and sleepers.
    Displace,
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
    /// Direction in plan `[x, y]`, not held.
    pub direction: [f64; 2],
    /// Actuator speed [m/s]; > 0.
    pub speed: Quantity<Velocity>,
    /// Actuator displacement [m]; > 0.
    pub displacement: Quantity<Length>,
    /// Vertical force on the sleeper, besides weight [N]; default 0; ≥ 0.
    #[serde(default = "none")]
    pub load: Quantity<Force>,
    /// Preceding time, in which force becomes `load` [s]; default 0.1; ≥ 0.
    #[serde(default = "tenth")]
    pub rest: Quantity<Time>,
    /// Height above the sleeper's centre [m]; default 0.
    #[serde(default = "level")]
    pub height: Quantity<Length>,
    /// Actuator stiffness (0.7 of critical damping), limited by the step [N/m]; default `"20 MN/m"`; > 0.
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
