//! Sleepers, their load and the rail as written in a scene.

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
    /// The sleepers.
    pub sleeper: Sleeper,
    /// The load on their seats, or the wheels on the rail; without it the sleepers only rest.
    pub load: Option<SeatLoad>,
    /// Cycles that are not simulated one by one.
    pub jump: Option<CycleJump>,
    /// Lateral push at the end.
    pub push: Option<Push>,
    /// Two loads between which the stiffness of the bed is taken in each cycle [N]; default a quarter and three quarters
    /// of the range.
    pub bed_stiffness: Option<[Quantity<Force>; 2]>,
    /// The rail that brings the loads of axles to the sleepers.
    pub rail: Option<RailTable>,
}

/// Sleepers as boxes, rigid or meshed, placed on the settled grains.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sleeper {
    /// Edge lengths in x, y, z [m].
    pub size: [Quantity<Length>; 3],
    /// Mass [kg]; of the slice that is modelled. A meshed sleeper may have a density instead.
    pub mass: Option<Quantity<Mass>>,
    /// Name of its material.
    pub material: String,
    /// Place of its centre in x and y [m], of the first of several; it is lowered onto the highest grain below it.
    pub centre: [Quantity<Length>; 2],
    /// Number of sleepers in a row; default 1.
    #[serde(default = "one")]
    pub count: u32,
    /// Distance from centre to centre [m]; needed by several sleepers and by a rail.
    pub spacing: Option<Quantity<Length>>,
    /// Direction of the track, in which the row goes on and wheels roll; default y.
    #[serde(default)]
    pub along: Along,
    /// Motions that are held: any of "x", "y", "z", "rx", "ry", "rz"; default none.
    #[serde(default)]
    pub hold: Vec<HeldMotion>,
    /// Elements that make it an elastic body of the solid; default a rigid body.
    pub mesh: Option<SleeperMesh>,
}

/// `[track.sleeper.mesh]`: 20-node hexahedra of which each sleeper consists.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SleeperMesh {
    /// Number of elements along x, y, z.
    pub elements: [u32; 3],
    /// Young's modulus [Pa].
    pub young: Quantity<Stress>,
    /// Poisson's ratio, above −1 and below 0.5.
    pub poisson: f64,
    /// Density [kg/m³], where `mass` is not given.
    pub density: Option<Quantity<Density>>,
    /// Lengths in x and y of the rectangle about each seat over which its force is spread [m]; default 0.15 m across the
    /// track and the whole width along it, no farther than to the edge.
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
    /// Number of the axis.
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

/// Vertical load on the sleepers' tops, or wheels on the rail.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeatLoad {
    /// Shape of a cycle.
    pub kind: SeatLoadKind,
    /// Smallest downward force [N]: `sine`, `haversine`, `ramp`.
    pub minimum: Option<Quantity<Force>>,
    /// Largest downward force [N]: `sine`, `haversine`, `ramp`; peak of one pulse: `gauss`.
    pub maximum: Option<Quantity<Force>>,
    /// Cycles per second [Hz]: `sine`, `haversine`.
    pub frequency: Option<Quantity<Frequency>>,
    /// Number of cycles, or passes; default 1, needed by `sine` and `haversine`.
    pub cycles: Option<u32>,
    /// Times of rise, of the largest force and of the fall [s]: `ramp`; without a fall the load stays.
    pub rise: Option<Quantity<Time>>,
    /// See `rise`.
    pub hold: Option<Quantity<Time>>,
    /// See `rise`.
    pub fall: Option<Quantity<Time>>,
    /// Measured force: `history`; table of trains: `train`.
    pub file: Option<PathBuf>,
    /// Factor on a measured force: `history`; default 1.
    pub factor: Option<f64>,
    /// Speed along the track [m/s].
    pub speed: Option<Quantity<Velocity>>,
    /// Half the width ℓ of a Gaussian pulse where it has fallen to 1/e [m]: `gauss`.
    pub width: Option<Quantity<Length>>,
    /// Distances of the pulses behind the first one [m]: `gauss`; default one pulse.
    pub axles: Option<Vec<Quantity<Length>>>,
    /// Load of an axle [N]: `bogie`; `train`, in place of the table's.
    pub axle_load: Option<Quantity<Force>>,
    /// Distance of the two axles [m]: `bogie`.
    pub wheelbase: Option<Quantity<Length>>,
    /// Name of the train: `train`.
    pub train: Option<String>,
    /// Number of its cars: `train`; default 1.
    pub cars: Option<u32>,
    /// What an uneven rail adds to the load of an axle: `bogie`, `train`.
    pub excitation: Option<Excitation>,
    /// Time for the sleepers to come to rest under their own weight before any load [s]; default 0.1 s.
    #[serde(default = "tenth")]
    pub rest: Quantity<Time>,
    /// Pulses that press the sleepers into the bed before the first cycle, and do not count.
    pub seating: Option<SeatingTable>,
    /// Time over which the load of the first instant, and the rail's weight, are brought on [s]; default 0.1 s.
    #[serde(default = "tenth")]
    pub ramp: Quantity<Time>,
    /// Points of a sleeper's top that share the load, and carry the rails, as offsets in x and y from its centre [m];
    /// default the centre.
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
    /// Number of pulses.
    pub cycles: u32,
    /// Largest downward force on each sleeper [N].
    pub maximum: Quantity<Force>,
    /// Pulses per second [Hz].
    pub frequency: Quantity<Frequency>,
}

/// Shape of one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeatLoadKind {
    /// Mean plus amplitude times sin 2πft: starts at the mean.
    Sine,
    /// Minimum plus range times (1 − cos 2πft)/2: starts and ends at the minimum.
    Haversine,
    /// Smooth rise, hold and fall.
    Ramp,
    /// A measured force.
    History,
    /// Gaussian pulses that run along the sleepers.
    Gauss,
    /// Two axles on the rail.
    Bogie,
    /// The axles of a train on the rail.
    Train,
}

/// Forces of an uneven rail: Σ M a w² sin wt with w = 2πv/L.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Unsprung mass of an axle [kg].
    pub mass: Quantity<Mass>,
    /// Waves: [length L, amplitude a] [m].
    pub waves: Vec<[Quantity<Length>; 2]>,
}

/// The rail.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RailTable {
    /// How it shares the load of an axle among the sleepers.
    pub kind: RailKind,
    /// Bending stiffness EI of one rail [N m²].
    pub bending_stiffness: Quantity<Bending>,
    /// Stiffness under one seat of a sleeper [N/m]: of pad and bed together with `winkler`, of the bed under the
    /// sleepers beyond the model with `beam`.
    pub foundation: Quantity<Stiffness>,
    /// Damping of that bed [N s/m]: `beam`; default 0.
    pub foundation_damping: Option<Quantity<Dashpot>>,
    /// Mass of one rail per length [kg/m]: `beam`.
    pub mass: Option<Quantity<LineMass>>,
    /// Stiffness of a pad [N/m]: `beam`.
    pub pad_stiffness: Option<Quantity<Stiffness>>,
    /// Damping of a pad [N s/m]: `beam`; default 0.
    pub pad_damping: Option<Quantity<Dashpot>>,
    /// Length of rail beyond the first and the last sleeper [m]: `beam`.
    pub extension: Option<Quantity<Length>>,
    /// Beam elements between two sleepers: `beam`; default 4.
    pub elements: Option<u32>,
}

/// How a rail works.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RailKind {
    /// Quasi-static, by the formula of a beam on a continuous elastic foundation.
    Winkler,
    /// A beam with mass on pads.
    Beam,
}
