//! What is written in a scene file: TOML, SI units, unknown keys refused.
//!
//! These types hold exactly what the file says; [`crate::model`] resolves them into models. Numbers may carry
//! units as strings (`"20 MPa"`). Only what is present is modelled: `[solid]` alone is a finite-element program,
//! `[[grains]]` alone a discrete-element program, both with `[coupling]` the coupled one.

pub mod after;
pub mod bonds;
pub mod compaction;
pub mod coupling;
pub mod deposition;
mod document;
pub mod flow;
pub mod grains;
pub mod history;
mod include;
pub mod material;
mod output;
pub mod periodic;
pub mod runout;
pub mod schema;
pub mod solid;
pub mod specimen;
pub mod structure;
mod table;
pub mod track;
pub mod units;
mod value;
pub mod walls;
pub mod water;
mod wind;
mod wording;

pub use crate::read::Problem;
/// Bad input in a scene: the same kind of sentence as from a mesh reader.
pub use crate::read::ReadError as SceneError;
pub use document::Document;
pub use output::{Chains, Output};
pub use table::{Number, Table, kinds, setting};
pub use wind::Wind;

use schemars::JsonSchema;
use serde::Deserialize;
use units::{Acceleration, Length, Quantity, Time, Velocity};

/// A whole scene.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line that says what the scene is; it heads the summary.
    #[serde(default)]
    pub title: String,
    /// Gravity [m/s²]; default (0, 0, −9.81).
    #[serde(default = "earth")]
    pub gravity: [Quantity<Acceleration>; 3],
    /// Solid part: mesh, materials, loads.
    pub solid: Option<solid::Solid>,
    /// Materials of grains, walls and sleeper.
    #[serde(default)]
    pub material: Vec<material::GrainMaterial>,
    /// Constants of single material pairs, in place of the mixing rules.
    #[serde(default)]
    pub contact: Vec<material::PairContact>,
    /// Groups of grains.
    #[serde(default)]
    pub grains: Vec<grains::Grains>,
    /// Where grains are taken out of the run.
    #[serde(default)]
    pub outlet: Vec<flow::Outlet>,
    /// Bonds between grains.
    #[serde(default)]
    pub bond: Vec<bonds::BondTable>,
    /// Air or another fluid that streams past grains.
    pub wind: Option<Wind>,
    /// Water that grains float or sink in.
    pub water: Option<water::Water>,
    /// Fixed or moving walls.
    #[serde(default)]
    pub walls: Vec<walls::Wall>,
    /// Structures whose loads are recorded.
    #[serde(default)]
    pub structure: Vec<structure::Structure>,
    /// Axes along which the grains repeat themselves.
    pub periodic: Option<periodic::Periodic>,
    /// Gravity deposition before the run proper.
    pub deposition: Option<deposition::Deposition>,
    /// Compaction after it, stage by stage.
    #[serde(default)]
    pub compaction: Vec<compaction::Compaction>,
    /// Boxes whose packing is measured.
    #[serde(default)]
    pub measure: Vec<compaction::Measure>,
    /// How far a slide runs and what it leaves.
    pub runout: Option<runout::Runout>,
    /// Stress and strain of a specimen between platens.
    pub specimen: Option<specimen::Specimen>,
    /// How breaks of bonds are joined to acoustic events.
    pub events: Option<specimen::Events>,
    /// Sleeper and its load.
    pub track: Option<track::TrackTable>,
    /// Exchange between grains and solid; needed when a scene has both.
    pub coupling: Option<coupling::Coupling>,
    /// Time steps and duration.
    #[serde(default)]
    pub time: TimeControl,
    /// What is written and how often.
    #[serde(default)]
    pub output: Output,
    /// Points whose history is recorded.
    #[serde(default)]
    pub probe: Vec<Probe>,
}

fn earth() -> [Quantity<Acceleration>; 3] {
    [Quantity::new(0.0), Quantity::new(0.0), Quantity::new(-9.81)]
}

/// Time steps and duration.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeControl {
    /// Physical time of the run proper [s], deposition not counted. Not needed for a static solid, nor with a
    /// counted cyclic load, which sets it.
    pub end: Option<Quantity<Time>>,
    /// Number of steps of the run proper, in place of `end`: of the solid that runs alone, else of the grains, with a `grain_step`.
    pub steps: Option<u64>,
    /// Step of a solid that runs alone [s]. In a coupled run the solid's step is `coupling.substeps` grain steps.
    pub solid_step: Option<Quantity<Time>>,
    /// Step of the grains [s]; default: `grain_step_fraction` of the limit.
    pub grain_step: Option<Quantity<Time>>,
    /// Fraction of the stability limit that the grains take, 0–1; default 0.9 (the limit is a safe bound).
    pub grain_step_fraction: Option<f64>,
    /// Accept a `grain_step` above the limit; default false.
    #[serde(default)]
    pub accept_step_above_limit: bool,
    /// Largest speed at which grains are expected to meet [m/s], for the step limit of contacts after Hertz;
    /// default: an estimate.
    pub impact_speed: Option<Quantity<Velocity>>,
    /// Distance beyond touch up to which the search lists neighbours, over the mean radius of all spheres, 0.01–2; default 0.2.
    pub search_skin: Option<f64>,
    /// Factor on the inertial mass of grains, rigid sleepers and rigid bodies in the run proper, 1–10,000, their weight kept;
    /// default 1.
    pub mass_factor: Option<f64>,
    /// Time between two looks at inlets and outlets of grains [s]; default 1 ms, at least one step or window.
    pub flow_interval: Option<Quantity<Time>>,
}

fn yes() -> bool {
    true
}

/// What is observed in `history.csv`: a node of the solid, by number or by the place nearest to it, a grain, a group, or the
/// grains in a box.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name used in the column heads; default `n<number>`.
    pub name: Option<String>,
    /// Node number of the mesh.
    pub node: Option<u32>,
    /// Place [m]; the nearest node is taken.
    pub at: Option<[Quantity<Length>; 3]>,
    /// Number of a grain, from 0.
    pub grain: Option<u32>,
    /// Name of a group of grains.
    pub group: Option<String>,
    /// Box `[[x, y, z], [x, y, z]]` whose grains are observed [m].
    pub region: Option<[[Quantity<Length>; 3]; 2]>,
}
