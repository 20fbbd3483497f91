//! Compaction of a settled bed and boxes for measures, as written in a scene.

use super::units::{Force, Frequency, Length, Mass, Quantity, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[[compaction]]`: a stage between settling and the run proper.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Compaction {
    /// What is done.
    pub kind: CompactionKind,
    /// Corners of the box whose porosity is measured before and after [m].
    pub region: [[Quantity<Length>; 3]; 2],
    /// Friction between grains in this stage, instead of their own.
    pub friction: Option<f64>,
    /// Contact stiffness in this stage, as a share of their own; default 1.
    pub stiffness_factor: Option<f64>,
    /// Local non-viscous damping in this stage, 0–1; default 0.
    #[serde(default)]
    pub local_damping: f64,
    /// Longest time of coming to rest afterwards [s]; default 0.2 s.
    pub rest: Option<Quantity<Time>>,
    /// Of `vibration`: numbers of the planes in `[[walls]]` that move, from 0; default all planes.
    pub walls: Option<Vec<usize>>,
    /// Of `vibration`: direction of the motion; default up.
    pub direction: Option<[f64; 3]>,
    /// Of `vibration`: largest displacement from the middle [m].
    pub amplitude: Option<Quantity<Length>>,
    /// Of `vibration`, `tamping` and `bedding`.
    pub frequency: Option<Quantity<Frequency>>,
    /// Of `vibration`, `tamping` and `bedding`: number of cycles (at each place).
    pub cycles: Option<u32>,
    /// Of `tamping`: the plate.
    pub plate: Option<Plate>,
    /// Of `tamping` and `bedding`: largest force on the plate or on each sleeper, downwards [N].
    pub force: Option<Quantity<Force>>,
    /// Of `tamping`: places of the plate's centre in x and y, one after the other [m].
    pub at: Option<Vec<[Quantity<Length>; 2]>>,
    /// Of `squeeze`: number of the plane in `[[walls]]` that moves, from 0.
    pub wall: Option<usize>,
    /// Of `squeeze`: its speed along its normal [m/s].
    pub speed: Option<Quantity<Velocity>>,
    /// Of `squeeze`: porosity of `region`, cut off at the wall, at which the wall stops.
    pub porosity: Option<f64>,
    /// Of `squeeze`: longest way of the wall [m].
    pub max_travel: Option<Quantity<Length>>,
    /// Of `pouring`: names of the groups of grains that wait for it.
    pub groups: Option<Vec<String>>,
    /// Of `pouring`: parts that they are dropped in, one after the other; default 1.
    pub layers: Option<u32>,
    /// Of `pouring`: those with their centre above are taken away at its end [m].
    pub level: Option<Quantity<Length>>,
}

/// What a stage of compaction does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompactionKind {
    /// Planes swing.
    Vibration,
    /// A plate presses from above.
    Tamping,
    /// A plane moves in until a porosity is reached.
    Squeeze,
    /// The sleepers are set down, and pressed into the bed.
    Bedding,
    /// Grains are dropped on the bed, around the sleepers that lie there.
    Pouring,
}

/// A rigid plate that presses.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plate {
    /// Edge lengths [m].
    pub size: [Quantity<Length>; 3],
    /// Mass [kg].
    pub mass: Quantity<Mass>,
    /// Name of its `[[material]]`.
    pub material: String,
}

/// `[[measure]]`: a box whose packing is measured at the start and the end of the run proper.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Measure {
    /// Name in the summary.
    pub name: String,
    /// Corners of the box [m].
    #[serde(rename = "box")]
    pub region: [[Quantity<Length>; 3]; 2],
    /// Radial distribution function of the grains inside.
    pub radial: Option<Radial>,
}

/// `radial = { reach = …, bins = … }` of a measure.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radial {
    /// Largest distance [m].
    pub reach: Quantity<Length>,
    /// Number of shells of equal width up to it.
    pub bins: usize,
}
