//! `[output]`: what a run writes.

use super::units::{Quantity, Time};
use schemars::JsonSchema;
use serde::Deserialize;

/// What a run writes.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Number of frames of the animation over the run proper, 0–100000; default 20. The start is one more.
    pub frames: Option<u32>,
    /// Time between rows of `history.csv` [s]; default a thousandth of the run proper. Rows fall on steps of the
    /// solid (coupled and solid runs) or of the grains.
    pub history_interval: Option<Quantity<Time>>,
    /// Steps between two frames, in place of `frames`: as `time.steps` counts them.
    pub frame_steps: Option<u64>,
    /// Steps between two rows of `history.csv`, in place of `history_interval`.
    pub history_steps: Option<u64>,
    /// Time by the clock after which the state of the run is kept anew for `--resume` [s]; default 10 minutes. The state is
    /// kept too when settling ends and when the run is interrupted.
    pub checkpoint: Option<Quantity<Time>>,
    /// Write nodal displacements, reactions and Gauss-point stresses of the last state as CSV; default false.
    pub tables: Option<bool>,
    /// Write the grains at the end as `packing.csv`, which `[[grains]] packing` reads; default false.
    pub packing: Option<bool>,
    /// Keep the state at the end, from which another run can go on (`run NEXT --from DIR`); default true.
    pub state: Option<bool>,
    /// Force chains of the frames: all contacts (default), or those above the mean normal force.
    pub chains: Option<Chains>,
    /// Fields of solid and grains that frames hold beside what they need to be drawn; default all.
    pub fields: Option<Vec<String>>,
    /// Last part of the run, with frames of its own.
    pub last: Option<Last>,
    /// Write frames as VTK files with a series `results.pvd`; default true.
    pub vtk: Option<bool>,
    /// Write frames of the solid as Tecplot files; default false.
    pub tecplot: Option<bool>,
    /// Write all frames into VTKHDF files; default false.
    pub vtkhdf: Option<bool>,
}

impl Output {
    /// Whether a format of frames is switched on or off by its key.
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
    /// How long it is [s].
    pub time: Quantity<Time>,
    /// Frames in it.
    pub frames: u32,
}

/// Contacts that the frames show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Chains {
    /// All of them.
    #[default]
    All,
    /// Those with more than the mean normal force.
    Strong,
}
