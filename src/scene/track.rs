//! Sleeper and its load as written in a scene.

use super::after::{CycleJump, Push};
use super::units::{Force, Frequency, Length, Mass, Quantity, Time};
use serde::Deserialize;

/// `[track]`: what stands on the ballast.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Track {
    /// The sleepers.
    pub sleeper: Sleeper,
    /// The load on its seat; without it the sleeper only rests.
    pub load: Option<SeatLoad>,
    /// Cycles that are not simulated one by one.
    pub jump: Option<CycleJump>,
    /// Lateral push at the end.
    pub push: Option<Push>,
    /// Two loads between which the stiffness of the bed is taken in each cycle [N]; default a quarter and three quarters
    /// of the range.
    pub bed_stiffness: Option<[Quantity<Force>; 2]>,
}

/// Sleepers as rigid boxes, placed on the settled grains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sleeper {
    /// Edge lengths in x, y, z [m].
    pub size: [Quantity<Length>; 3],
    /// Mass [kg]; of the slice that is modelled.
    pub mass: Quantity<Mass>,
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
    pub hold: Vec<Motion>,
}

fn one() -> u32 {
    1
}

/// Direction of the track.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
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

/// Cyclic vertical load on the sleeper's top.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeatLoad {
    /// Shape of a cycle.
    pub kind: SeatLoadKind,
    /// Smallest downward force [N].
    pub minimum: Quantity<Force>,
    /// Largest downward force [N].
    pub maximum: Quantity<Force>,
    /// Cycles per second [Hz].
    pub frequency: Quantity<Frequency>,
    /// Number of cycles.
    pub cycles: u32,
    /// Time for the sleeper to come to rest under its own weight before any load [s]; default 0.1 s.
    #[serde(default = "tenth")]
    pub rest: Quantity<Time>,
    /// Time over which the load of the first instant is brought on [s]; default 0.1 s.
    #[serde(default = "tenth")]
    pub ramp: Quantity<Time>,
    /// Points of the sleeper's top that share the load, as offsets in x and y from its centre [m]; default the
    /// centre.
    #[serde(default)]
    pub seats: Vec<[Quantity<Length>; 2]>,
}

fn tenth() -> Quantity<Time> {
    Quantity::new(0.1)
}

/// Shape of one cycle between minimum and maximum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SeatLoadKind {
    /// Mean plus amplitude times sin 2πft: starts at the mean.
    Sine,
    /// Minimum plus range times (1 − cos 2πft)/2: starts and ends at the minimum.
    Haversine,
}
