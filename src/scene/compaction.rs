//! Scene tables of compaction and measuring boxes.

use super::units::{Force, Frequency, Length, Mass, Quantity, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[[compaction]]`: a stage between settling and the main stage.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Compaction {
    /// Kind of stage.
    pub kind: CompactionKind,
    /// Box `[low, high]` of the measured porosity, inside the bed [m].
    pub region: [[Quantity<Length>; 3]; 2],
    /// Friction between grains; default unchanged; ≥ 0.
    pub friction: Option<f64>,
    /// Factor on contact stiffness, not corner strength; default 1; > 0, ≤ 1.
    pub stiffness_factor: Option<f64>,
    /// Non-viscous damping; default 0; ≥ 0, < 1.
    #[serde(default)]
    pub local_damping: f64,
    /// Longest time to rest afterwards, as in `[deposition]` [s]; default 0.2; > 0.
    pub rest: Option<Quantity<Time>>,
    /// Indices of moving planes in `[[walls]]`, from 0; default all planes; with `"vibration"`.
    pub walls: Option<Vec<usize>>,
    /// Direction of motion; default up; with `"vibration"`.
    pub direction: Option<[f64; 3]>,
    /// Amplitude A of A sin 2πft [m]; > 0; with `"vibration"`.
    pub amplitude: Option<Quantity<Length>>,
    /// Frequency f [Hz]; > 0; with `"vibration"`, `"tamping"`, `"bedding"`, `"tines"`, `"stabilizing"`.
    pub frequency: Option<Quantity<Frequency>>,
    /// Cycles, at each position; ≥ 1; with `"vibration"`, `"tamping"`, `"bedding"`, `"stabilizing"`.
    pub cycles: Option<u32>,
    /// Rigid box that moves vertically; with `"tamping"`.
    pub plate: Option<Plate>,
    /// Force F sin² πft, besides weight [N]; > 0; with `"tamping"` (plate), `"bedding"` (each rigid sleeper); constant with `"stabilizing"`.
    pub force: Option<Quantity<Force>>,
    /// Force F sin 2πft on each rigid sleeper across the track [N]; > 0; with `"stabilizing"`.
    pub sway: Option<Quantity<Force>>,
    /// Tines of a tamping machine; with `"tines"`.
    pub tines: Option<Tines>,
    /// Successive plate positions `[[x, y], …]` [m]; with `"tamping"`.
    pub at: Option<Vec<[Quantity<Length>; 2]>>,
    /// Index of a plane across an axis, from 0; with `"squeeze"`.
    pub wall: Option<usize>,
    /// Speed along the normal [m/s]; > 0; with `"squeeze"`.
    pub speed: Option<Quantity<Velocity>>,
    /// Final porosity of `region`, up to the plane; > 0, < 1; with `"squeeze"`.
    pub porosity: Option<f64>,
    /// Travel that ends it with a warning [m]; default half of `region`; > 0; with `"squeeze"`.
    pub max_travel: Option<Quantity<Length>>,
    /// Names of waiting groups; with `"pouring"`; not bonded, with `prescribed_velocity`, or only an `inlet`.
    pub groups: Option<Vec<String>>,
    /// Parts dropped successively, `rest` each; default 1; 1–1000; with `"pouring"`.
    pub layers: Option<u32>,
    /// Height above which centres are removed [m]; default none; with `"pouring"`.
    pub level: Option<Quantity<Length>>,
}

/// What a stage of compaction does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompactionKind {
    /// Oscillating planes.
    Vibration,
    /// Plate pressing from above.
    Tamping,
    /// Plane moving in.
    Squeeze,
    /// Sleepers placed and pressed.
    Bedding,
    /// Grains dropped around sleepers.
    Pouring,
    /// Sleepers lifted and tamped by vibrating tines, one after the other.
    Tines,
    /// Sleepers loaded and shaken across the track, held or not.
    Stabilizing,
}

impl CompactionKind {
    /// Name in scenes.
    pub fn name(self) -> &'static str {
        match self {
            CompactionKind::Vibration => "vibration",
            CompactionKind::Tamping => "tamping",
            CompactionKind::Squeeze => "squeeze",
            CompactionKind::Bedding => "bedding",
            CompactionKind::Pouring => "pouring",
            CompactionKind::Tines => "tines",
            CompactionKind::Stabilizing => "stabilizing",
        }
    }
}

/// `[compaction.tines]`: pairs of blades that enter beside a lifted sleeper and press the stones below it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tines {
    /// Width across the track, thickness along it, length of a blade [m]; > 0.
    pub size: [Quantity<Length>; 3],
    /// Name of a `[[material]]`.
    pub material: String,
    /// Positions of the pairs from the centre of a sleeper, across the track [m].
    pub at: Vec<Quantity<Length>>,
    /// Lift of the sleeper [m]; ≥ 0.
    pub lift: Quantity<Length>,
    /// Depth of the tips below the base of the lifted sleeper [m].
    pub depth: Quantity<Length>,
    /// Distance of a blade from the sleeper before it closes [m]; > `travel` + `amplitude`.
    pub gap: Quantity<Length>,
    /// Longest way of a blade towards the sleeper [m]; > 0.
    pub travel: Quantity<Length>,
    /// Amplitude A of A sin 2πft along the track [m]; ≥ 0.
    pub amplitude: Quantity<Length>,
    /// Force at which a blade closes no further, but vibrates [N]; default none; > 0.
    pub force: Option<Quantity<Force>>,
    /// Speed of insertion [m/s]; default 1; > 0.
    pub insertion: Option<Quantity<Velocity>>,
    /// Speed of lift and of closing [m/s]; default 0.1; > 0.
    pub squeeze: Option<Quantity<Velocity>>,
    /// Time closed, before the blades leave [s]; default 0.1; ≥ 0.
    pub hold: Option<Quantity<Time>>,
}

/// A rigid plate that presses.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plate {
    /// Edge lengths [m]; > 0.
    pub size: [Quantity<Length>; 3],
    /// Mass [kg]; > 0.
    pub mass: Quantity<Mass>,
    /// Name of a `[[material]]`.
    pub material: String,
}

/// `[[measure]]`: a box whose packing is measured at the end of the main stage, with `history` during it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Measure {
    /// Name in the summary.
    pub name: String,
    /// Box `[low, high]` [m].
    #[serde(rename = "box")]
    pub region: [[Quantity<Length>; 3]; 2],
    /// Whether `history.csv` has porosity, coordination number, mean stress; default false.
    #[serde(default)]
    pub history: bool,
    /// Radial distribution function, to `radial.csv`; default none.
    pub radial: Option<Radial>,
}

/// `radial = { reach = …, bins = … }` of a measure.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radial {
    /// Largest distance, with periodic images [m]; > 0, ≤ half the shortest side.
    pub reach: Quantity<Length>,
    /// Shells of equal width; 1–100,000.
    pub bins: usize,
}
