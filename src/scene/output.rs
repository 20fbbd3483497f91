//! Scene table `[output]`.

use super::units::{Quantity, Time};
use schemars::JsonSchema;
use serde::Deserialize;

/// What a run writes.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Frames of the run, after the first; default 20; 0–100,000.
    pub frames: Option<u32>,
    /// Interval of `history.csv`, rows within 64 steps shorten them [s]; default duration/1000; > 0.
    pub history_interval: Option<Quantity<Time>>,
    /// Steps between frames; or `frames`; ≥ 1; with `grain_step`, `solid_step`.
    pub frame_steps: Option<u64>,
    /// Steps between rows; or `history_interval`; ≥ 1; with `grain_step`, `solid_step`.
    pub history_steps: Option<u64>,
    /// Wall time between checkpoints, for `--resume` [s]; default `"10 min"`; > 0.
    pub checkpoint: Option<Quantity<Time>>,
    /// Whether `nodes.csv`, `gauss.csv` are written; default false; with `[solid]`.
    pub tables: Option<bool>,
    /// Whether `packing.csv` (`packing_0.csv`, … by group) is written; default false.
    pub packing: Option<bool>,
    /// Whether `end.state` is written, for `run --from`; default true; with `[[grains]]`.
    pub state: Option<bool>,
    /// Contacts in frames; default `"all"`; with `[[grains]]`.
    pub chains: Option<Chains>,
    /// Fields in frames, see below; default unmarked.
    pub fields: Option<Vec<String>>,
    /// Times of additional frames, each at the end of the nearest step [s]; default none; > 0, ≤ duration.
    pub frames_at: Option<Vec<Quantity<Time>>>,
    /// Whether each load cycle has an additional frame at its largest load; default false; with `[track.load]`, not with `"beam"`.
    pub frames_at_peaks: Option<bool>,
    /// Separate frames of the last part; default none; not with `[track.jump]`.
    pub last: Option<Last>,
    /// Whether `results.pvd`, `frames/` are written; default true.
    pub vtk: Option<bool>,
    /// Whether `tecplot/` is written; default false; with `[solid]`.
    pub tecplot: Option<bool>,
    /// Whether `grains.vtkhdf`, `solid.vtkhdf` are written; default false.
    pub vtkhdf: Option<bool>,
}

impl Output {
    /// Whether the key of a frame format enables or disables it.
    pub fn format(&self, key: &str) -> Option<bool> {
        match key {
            "vtk" => self.vtk,
            "tecplot" => self.tecplot,
            "vtkhdf" => self.vtkhdf,
            other => unreachable!("the format {other} has no key"),
        }
    }
}

/// Last part of a run, with frames of its own.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Last {
    /// Length of that part [s]; > 0, < duration.
    pub time: Quantity<Time>,
    /// Number of its frames; 1–100,000 with `frames`.
    pub frames: u32,
}

/// Contacts that the frames show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Chains {
    /// All.
    #[default]
    All,
    /// Above mean normal force.
    Strong,
}
