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
    /// Frequency f [Hz]; > 0; with `"vibration"`, `"tamping"`, `"bedding"`.
    pub frequency: Option<Quantity<Frequency>>,
    /// Cycles, at each position; ≥ 1; with `"vibration"`, `"tamping"`, `"bedding"`.
    pub cycles: Option<u32>,
    /// Rigid box that moves vertically; with `"tamping"`.
    pub plate: Option<Plate>,
    /// Force F sin² πft, besides weight [N]; > 0; with `"tamping"` (plate), `"bedding"` (each rigid sleeper).
    pub force: Option<Quantity<Force>>,
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
