//! Scene tables of sleepers, their load and the rail.

use super::after::{CycleJump, Push};
use super::units::{
    Bending, Dashpot, Density, Force, Frequency, Length, LineMass, Mass, Quantity, Stiffness, Stress, Time,
    Velocity,
};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// `[track]`: what stands on the ballast.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename = "Track", deny_unknown_fields)]
pub struct TrackTable {
    /// Sleepers.
    pub sleeper: Sleeper,
    /// Forces or wheels.
    pub load: Option<SeatLoad>,
    /// Extrapolated cycles.
    pub jump: Option<CycleJump>,
    /// Lateral push.
    pub push: Option<Push>,
    /// Two loads between which bed stiffness is evaluated [N]; default 25 %, 75 % of range; with cycles.
    pub bed_stiffness: Option<[Quantity<Force>; 2]>,
    /// Rail on the seats.
    pub rail: Option<RailTable>,
}

/// Sleepers as boxes, rigid or meshed, placed on the settled grains.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sleeper {
    /// Edge lengths in x, y, z [m]; > 0.
    pub size: [Quantity<Length>; 3],
    /// Mass of the modelled part [kg]; or `mesh.density`; > 0.
    pub mass: Option<Quantity<Mass>>,
    /// Name of a `[[material]]`.
    pub material: String,
    /// Position `[x, y]` of the first centre [m].
    pub centre: [Quantity<Length>; 2],
    /// Number of sleepers; default 1; 1–1000.
    #[serde(default = "one")]
    pub count: u32,
    /// Distance of centres [m]; > width; with `count`, `[track.rail]`.
    pub spacing: Option<Quantity<Length>>,
    /// Direction of the track; default `"y"`.
    #[serde(default)]
    pub along: Along,
    /// Fixed motions, meshed `["y", "rx", "rz"]`, `["x", "ry", "rz"]` or both; default none.
    #[serde(default)]
    pub hold: Vec<HeldMotion>,
    /// Elastic sleepers; default rigid.
    pub mesh: Option<SleeperMesh>,
}

/// `[track.sleeper.mesh]`: 20-node hexahedra of which each sleeper consists.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SleeperMesh {
    /// Elements along x, y, z; ≥ 1 (reduced: two ≥ 2), ≤ 100,000 in all.
    pub elements: [u32; 3],
    /// Young's modulus [Pa]; > 0.
    pub young: Quantity<Stress>,
    /// Poisson's ratio; > −1, < 0.5.
    pub poisson: f64,
    /// Density [kg/m³]; or `mass`; > 0.
    pub density: Option<Quantity<Density>>,
    /// Area `[x, y]` that spreads the force of a seat, within edges [m]; default 0.15 across track, full width along; ≥ 0.
    pub foot: Option<[Quantity<Length>; 2]>,
}

fn one() -> u32 {
    1
}

/// Direction of the track.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Along {
    /// Along x.
    X,
    /// Along y.
    #[default]
    Y,
}

impl Along {
    /// Axis index.
    pub fn axis(self) -> usize {
        match self {
            Along::X => 0,
            Along::Y => 1,
        }
    }
}

/// One rigid-body motion in world axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename = "Motion", rename_all = "snake_case")]
pub enum HeldMotion {
    /// Translation along x.
    X,
    /// Translation along y.
    Y,
    /// Translation along z.
    Z,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

impl HeldMotion {
    /// Name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            HeldMotion::X => "x",
            HeldMotion::Y => "y",
            HeldMotion::Z => "z",
            HeldMotion::Rx => "rx",
            HeldMotion::Ry => "ry",
            HeldMotion::Rz => "rz",
        }
    }
}

/// Vertical load on the sleepers' tops, or wheels on the rail.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeatLoad {
    /// Kind of cycle.
    pub kind: SeatLoadKind,
    /// Smallest downward force, negative pulls [N]; with `"sine"`, `"haversine"`, `"ramp"` (default 0).
    pub minimum: Option<Quantity<Force>>,
    /// Largest downward force, or pulse [N]; > `minimum`; with `"sine"`, `"haversine"`, `"ramp"`, `"gauss"`.
    pub maximum: Option<Quantity<Force>>,
    /// Frequency f [Hz]; > 0; with `"sine"`, `"haversine"`.
    pub frequency: Option<Quantity<Frequency>>,
    /// Cycles or passes; default 1; ≥ 1; needed with `"sine"`, `"haversine"`.
    pub cycles: Option<u32>,
    /// Rise time [s]; > 0; with `"ramp"`.
    pub rise: Option<Quantity<Time>>,
    /// Time at the maximum [s]; ≥ 0; with `"ramp"`.
    pub hold: Option<Quantity<Time>>,
    /// Fall time [s]; default stays; > 0; with `"ramp"`.
    pub fall: Option<Quantity<Time>>,
    /// CSV file `time, force` [s, N], header optional; for `"train"`, `"vehicle"` a table; with `"history"`, `"train"`, `"vehicle"`.
    #[schemars(extend("format" = "path"))]
    pub file: Option<PathBuf>,
    /// Factor on the force, not 0; default 1; with `"history"`.
    pub factor: Option<f64>,
    /// Speed along the track [m/s]; > 0; with `"gauss"`, `"bogie"`, `"train"`, `"vehicle"`, `"history"` (default infinite).
    pub speed: Option<Quantity<Velocity>>,
    /// Half width ℓ of a pulse at 1/e [m]; > 0; with `"gauss"`.
    pub width: Option<Quantity<Length>>,
    /// Distances behind the first pulse, ascending from 0 [m]; default `[0]`; with `"gauss"`.
    pub axles: Option<Vec<Quantity<Length>>>,
    /// Axle load, all rails together [N]; > 0; with `"bogie"`, `"train"` (default table).
    pub axle_load: Option<Quantity<Force>>,
    /// Axle distance [m]; > 0; with `"bogie"`.
    pub wheelbase: Option<Quantity<Length>>,
    /// Name of the train; with `"train"`.
    pub train: Option<String>,
    /// Name of the vehicle; with `"vehicle"`.
    pub vehicle: Option<String>,
    /// Part of its weight on the modelled rails; default 1; > 0, ≤ 1; 0.5 for half a track; with `"vehicle"`.
    pub share: Option<f64>,
    /// Number of cars; default 1; 1–1000; with `"train"`, `"vehicle"`.
    pub cars: Option<u32>,
    /// Uneven rail: Σ M a w² sin wt, w = 2πv/L; default none; with `"bogie"`, `"train"`.
    pub excitation: Option<Excitation>,
    /// Time at rest, before the rail is laid [s]; default 0.1; ≥ 0.
    #[serde(default = "tenth")]
    pub rest: Quantity<Time>,
    /// Pulses before the first cycle; default none.
    pub seating: Option<SeatingTable>,
    /// Time to reach first load and rail weight [s]; default 0.1; ≥ 0.
    #[serde(default = "tenth")]
    pub ramp: Quantity<Time>,
    /// Rail seats `[[x, y], …]` from the centre, with equal force [m]; default centre.
    #[serde(default)]
    pub seats: Vec<[Quantity<Length>; 2]>,
}

fn tenth() -> Quantity<Time> {
    Quantity::new(0.1)
}

/// `[track.load.seating]`: pulses from the load of the first instant to `maximum` and back.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeatingTable {
    /// Number of pulses; 1–1,000,000.
    pub cycles: u32,
    /// Largest downward force on each sleeper [N]; > first load.
    pub maximum: Quantity<Force>,
    /// Frequency [Hz]; > 0.
    pub frequency: Quantity<Frequency>,
}

/// Shape of one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeatLoadKind {
    /// Starting at the mean.
    Sine,
    /// (1 − cos 2πft)/2 from the minimum.
    Haversine,
    /// Half cosines, hold.
    Ramp,
    /// Measured.
    History,
    /// Pulses Σ F exp(−((x − xᵢ − vt)/ℓ)²).
    Gauss,
    /// Two axles.
    Bogie,
    /// Axles of a train.
    Train,
    /// Vehicles with suspensions on a `"beam"`.
    Vehicle,
}

/// Forces of an uneven rail: Σ M a w² sin wt with w = 2πv/L.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Unsprung axle mass M [kg]; > 0.
    pub mass: Quantity<Mass>,
    /// Waves `[[L, a], …]` [m]; > 0 (L).
    pub waves: Vec<[Quantity<Length>; 2]>,
}

/// The rail.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RailTable {
    /// Model of the rail.
    pub kind: RailKind,
    /// Bending stiffness EI of one rail [N m²]; > 0.
    pub bending_stiffness: Quantity<Bending>,
    /// Stiffness of pad and bed, with `"beam"` of outer beds [N/m]; > 0.
    pub foundation: Quantity<Stiffness>,
    /// Damping of that bed [N s/m]; default 0; ≥ 0; with `"beam"`.
    pub foundation_damping: Option<Quantity<Dashpot>>,
    /// Mass of one rail [kg/m]; > 0; with `"beam"`.
    pub mass: Option<Quantity<LineMass>>,
    /// Stiffness of a pad, limited by the step [N/m]; > 0; with `"beam"`.
    pub pad_stiffness: Option<Quantity<Stiffness>>,
    /// Damping of a pad, limited by the step [N s/m]; default 0; ≥ 0; with `"beam"`.
    pub pad_damping: Option<Quantity<Dashpot>>,
    /// Rail beyond outer sleepers, load rising over two spacings [m]; ≥ three spacings; with `"beam"`.
    pub extension: Option<Quantity<Length>>,
    /// Elements between sleepers; default 4; 1–100; with `"beam"`.
    pub elements: Option<u32>,
    /// Sleepers that the rail lifts off the bed with the ramp; default none; with `"beam"`.
    #[serde(default)]
    pub hanging: Vec<Hanging>,
    /// Uneven running surface; default even; with `"vehicle"`.
    pub irregularity: Option<IrregularityTable>,
}

/// `[track.rail.irregularity]`: height of the running surface, the sum of all that is given.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename = "Irregularity", deny_unknown_fields)]
pub struct IrregularityTable {
    /// CSV file `position, height` [m] from the first sleeper, level beyond; default none.
    #[schemars(extend("format" = "path"))]
    pub file: Option<PathBuf>,
    /// Waves a sin 2πx/L as `[[L, a], …]` [m]; default none; > 0 (L).
    #[serde(default)]
    pub waves: Vec<[Quantity<Length>; 2]>,
    /// Dipped joints; default none.
    #[serde(default)]
    pub dips: Vec<DipRow>,
}

/// Dipped joint: two parabolas that meet in a kink of 8 `depth`/`length`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename = "Dip", deny_unknown_fields)]
pub struct DipRow {
    /// Position from the first sleeper [m].
    pub at: Quantity<Length>,
    /// Depth [m]; > 0.
    pub depth: Quantity<Length>,
    /// Length [m]; > 0.
    pub length: Quantity<Length>,
}

/// Sleeper over a void.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hanging {
    /// Number of the sleeper, from 1.
    pub sleeper: u32,
    /// Height by which its seats are too low for the rail [m]; > 0, ≤ 50 mm.
    pub gap: Quantity<Length>,
}

/// How a rail works.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RailKind {
    /// Quasi-static, on an elastic foundation.
    Winkler,
    /// Beam with mass on pads.
    Beam,
}
