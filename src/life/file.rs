//! Life file: TOML; unknown keys are errors.

use serde::Deserialize;
use std::path::PathBuf;

/// Life of a track.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LifeFile {
    /// Title.
    #[serde(default)]
    pub title: String,
    /// Scene with `[track.load]`, relative to this file.
    pub scene: PathBuf,
    /// Overrides of all runs, as `--set` of `run`.
    #[serde(default)]
    pub set: Vec<String>,
    /// Seeds of independent packings, at least two.
    pub packings: Vec<u64>,
    /// Traffic.
    pub traffic: Traffic,
    /// Tampings; default none.
    pub tamping: Option<Tamping>,
    /// Lateral push of a copy of the bed before and after each tamping, as `[track.push]`; default none.
    pub push: Option<toml::Table>,
    /// Judgement of cycle jumps by the packings.
    #[serde(default)]
    pub control: Control,
}

/// Traffic of several axle loads.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Traffic {
    /// Axle load that a load cycle of the scene stands for [t].
    pub cycle: f64,
    /// Axle loads; default: only `cycle`.
    #[serde(default)]
    pub axles: Vec<AxleTable>,
    /// Exponent of settlement over axle load; default 1.6 (Hettler 1984).
    pub exponent: Option<f64>,
    /// Traffic at the end [MGT].
    pub until: f64,
    /// Traffic per year [MGT]; default none.
    pub per_year: Option<f64>,
}

/// Axles of one load.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxleTable {
    /// Axle load [t].
    pub load: f64,
    /// Share of all axles; shares add up to 1.
    pub share: f64,
}

/// Tampings.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tamping {
    /// Traffic at each tamping, ascending [MGT].
    pub at: Vec<f64>,
    /// Stages of a tamping, as `[[compaction]]`.
    pub stages: Vec<toml::Table>,
}

/// Judgement of cycle jumps.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// Largest difference of the packings in settlement during jumps, over its mean; default 0.3.
    pub tolerance: Option<f64>,
    /// Repetitions with jumps half as long, while the packings differ; default 1.
    pub repetitions: Option<u32>,
}
