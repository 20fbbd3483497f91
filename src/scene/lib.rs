//! Types of a scene file (TOML, SI units), exactly as written; unknown keys are rejected.
//!
//! The crate trackbed-input builds models of them. Numbers may have units (`"20 MPa"`). `[solid]` gives a FEM model,
//! `[[grains]]` a DEM model, both with `[coupling]` the coupled one.

// Closed or full output must not stop a run.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

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
pub mod reference;
mod renames;
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

pub use document::Document;
pub use include::IncludedText;
pub use output::{Chains, Output};
pub use table::{Number, Table, kinds, setting};
pub use trackbed_io::read::Problem;
/// Input error of a scene, of the same form as from mesh readers.
pub use trackbed_io::read::ReadError as SceneError;
pub use wind::Wind;

use schemars::JsonSchema;
use serde::Deserialize;
use units::{Acceleration, Length, Quantity, Time, Velocity};

/// A whole scene.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title of the summary; default file name.
    #[serde(default)]
    pub title: String,
    /// Gravity [m/s²]; default `[0, 0, -9.81]`.
    #[serde(default = "earth")]
    pub gravity: [Quantity<Acceleration>; 3],
    /// Finite element model.
    pub solid: Option<solid::Solid>,
    /// Contact materials.
    #[serde(default)]
    pub material: Vec<material::GrainMaterial>,
    /// Constants of material pairs.
    #[serde(default)]
    pub contact: Vec<material::PairContact>,
    /// Own contact law by formulas.
    pub contact_law: Option<material::ContactLawTable>,
    /// Groups of grains.
    #[serde(default)]
    pub grains: Vec<grains::Grains>,
    /// Removal of grains.
    #[serde(default)]
    pub outlet: Vec<flow::Outlet>,
    /// Bonds between grains.
    #[serde(default)]
    pub bond: Vec<bonds::BondTable>,
    /// Uniform flow of a fluid.
    pub wind: Option<Wind>,
    /// Water with waves.
    pub water: Option<water::Water>,
    /// Walls and rigid bodies.
    #[serde(default)]
    pub walls: Vec<walls::Wall>,
    /// Structures with recorded loads.
    #[serde(default)]
    pub structure: Vec<structure::Structure>,
    /// Periodic axes of grains.
    pub periodic: Option<periodic::Periodic>,
    /// Deposition under gravity.
    pub deposition: Option<deposition::Deposition>,
    /// Stages of compaction.
    #[serde(default)]
    pub compaction: Vec<compaction::Compaction>,
    /// Boxes of packing measurements.
    #[serde(default)]
    pub measure: Vec<compaction::Measure>,
    /// Run-out of a slide.
    pub runout: Option<runout::Runout>,
    /// Stress and strain between platens.
    pub specimen: Option<specimen::Specimen>,
    /// Acoustic events of bond breaks.
    pub events: Option<specimen::Events>,
    /// Sleepers, load and rail; default none.
    pub track: Option<track::TrackTable>,
    /// Coupling of grains and solid.
    pub coupling: Option<coupling::Coupling>,
    /// Duration and time steps.
    #[serde(default)]
    pub time: TimeControl,
    /// Written files.
    #[serde(default)]
    pub output: Output,
    /// Nodes, grains, boxes in `history.csv`.
    #[serde(default)]
    pub probe: Vec<Probe>,
}

fn earth() -> [Quantity<Acceleration>; 3] {
    [Quantity::new(0.0), Quantity::new(0.0), Quantity::new(-9.81)]
}

impl Document {
    /// Deserialises a scene: compiled here once, not in every crate that reads scenes.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn scene(&self) -> Result<Scene, SceneError> {
        self.read()
    }
}

/// Time steps and duration.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeControl {
    /// Duration of the main stage [s]; default end of cycles or push; > 0; not with a static solid.
    pub end: Option<Quantity<Time>>,
    /// Number of FEM steps, with grains DEM steps; or `end`; 1–10¹²; with `solid_step`, `grain_step`; rounded up to whole windows.
    pub steps: Option<u64>,
    /// FEM time step without `[[grains]]` [s]; > 0, ≤ `end`, ≤ 10⁹ steps; with `dynamics`, `quasi_static`.
    pub solid_step: Option<Quantity<Time>>,
    /// Fixed DEM time step, within the limit of possible contacts [s]; default follows contacts; > 0, ≤ 10¹² steps.
    pub grain_step: Option<Quantity<Time>>,
    /// Fraction of the critical time step, below 0.8 for collisions too; default 0.8; 1e-6 – 1; not with `grain_step`.
    pub grain_step_fraction: Option<f64>,
    /// Whether `grain_step` may exceed the limit; default false; with `grain_step`.
    #[serde(default)]
    pub accept_step_above_limit: bool,
    /// Impact speed of the step limit, larger under loads [m/s]; default from motion, fall, weight; ≥ 0; with `young`.
    pub impact_speed: Option<Quantity<Velocity>>,
    /// Neighbour cut-off over mean sphere radius, affects speed only; default 0.2; 0.01–2.
    pub search_skin: Option<f64>,
    /// Factor on inertia at constant weight, for quasi-static results; default 1; 1–10,000; not with `[wind]`, `[water]`, `[runout]`,
    /// inlets, outlets, `scarring`, `mount`, rail mass.
    pub mass_factor: Option<f64>,
    /// Interval between checks of inlets, outlets [s]; default 1 ms; > 0.
    pub flow_interval: Option<Quantity<Time>>,
}

fn yes() -> bool {
    true
}

/// What is observed in `history.csv`: a node or point of the solid, an area or a box in it, a grain, a group, or the grains
/// in a box.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Header of columns; default `n<number>`, `point`, `line`, `plane`, `box`, `grain<number>`, group, `region`.
    pub name: Option<String>,
    /// Number of a node of the solid; or `at`, `line`, `plane`, `box`, `grain`, `group`, `region`.
    pub node: Option<u32>,
    /// Point of the undeformed solid, without `fields` its nearest node [m]; or `node`.
    pub at: Option<[Quantity<Length>; 3]>,
    /// From, to: equally spaced points of the undeformed solid, `<name>_1`, … [m]; or `node`.
    pub line: Option<[[Quantity<Length>; 3]; 2]>,
    /// Points of the `line`; default 11; 2–1000; with `line`.
    pub points: Option<u32>,
    /// Fields of a node or point, with the values of frames; default displacement, velocity; with `node`, `at`, `line`.
    pub fields: Option<Vec<ProbeField>>,
    /// Horizontal rectangle `[low, high]` in the undeformed solid: mean, largest vertical stress [m]; or `node`.
    pub plane: Option<[[Quantity<Length>; 3]; 2]>,
    /// Box `[low, high]` of the undeformed solid: mean, largest vertical and mean stress [m]; or `node`.
    #[serde(rename = "box")]
    pub solid_box: Option<[[Quantity<Length>; 3]; 2]>,
    /// Index of a grain, from 0: position, velocity, spin, mean stress; or `node`.
    pub grain: Option<u32>,
    /// Name of a group: number, means of these; or `node`.
    pub group: Option<String>,
    /// Box `[low, high]`: number, means of centres inside [m]; or `node`.
    pub region: Option<[[Quantity<Length>; 3]; 2]>,
}

impl Probe {
    /// Name and length [m] of a line, if the probe is one; its points are `<name>_1`, ….
    pub fn named_line(&self) -> Option<(&str, f64)> {
        let [from, to] = self.line?;
        let length = (0..3).map(|d| (to[d].si - from[d].si).powi(2)).sum::<f64>().sqrt();
        Some((self.name.as_deref().unwrap_or(LINE), length))
    }
}

/// Default name of a line.
pub const LINE: &str = "line";

/// Field of the solid at a node or point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProbeField {
    /// Displacement.
    Displacement,
    /// Velocity.
    Velocity,
    /// Mean of the last step if coupled.
    Acceleration,
    /// Six components.
    Stress,
    /// Six tensor components.
    Strain,
}
