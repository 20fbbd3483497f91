//! `summary.json`: what a run did, how well its accounts close, and what it found.

mod records;
mod report;
mod verdict;

pub use records::*;
pub use verdict::Verdict;

use super::flow::FlowRecord;
use super::packing::{CompactionRecord, GrowthRecord, PackingRecord, StageEnergy};
use super::runout::RunoutRecord;
use super::specimen::SpecimenRecord;
use super::validity::Check;
use crate::failure::Failure;
use crate::write::WriteError;
use serde::Serialize;
use std::path::{Path, PathBuf};
use trackbed_coupling::track::extremes::TrackRecord;
use trackbed_coupling::track::push::PushSummary;

/// The content of `summary.json`. Parts that are flattened stand in it key by key, in this order.
#[derive(Debug, Default, Serialize)]
pub struct Summary {
    /// Folder of the results.
    #[serde(skip)]
    pub dir: PathBuf,
    /// The run itself.
    #[serde(flatten)]
    pub run: RunRecord,
    /// What the run was judged by.
    pub verdict: Verdict,
    /// Whether the run has stayed within the limits of its theory.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub validity: Vec<Check>,
    /// Stages in order, with seconds of wall time and steps.
    pub stages: Vec<StageRecord>,
    /// Sizes of the model.
    pub model: ModelRecord,
    /// Energy account of the run proper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyRecord>,
    /// Momentum account of the grains in the run proper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub momentum: Option<MomentumRecord>,
    /// Bonds between grains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bonds: Option<BondSummary>,
    /// Loads on structures.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub structures: Vec<LoadRecord>,
    /// Force and moment across the interface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupling: Option<CouplingRecord>,
    /// The solid.
    #[serde(flatten)]
    pub solid: SolidRecord,
    /// Sleepers and their load.
    #[serde(flatten)]
    pub track: TrackSummary,
    /// The bed of grains.
    #[serde(flatten)]
    pub bed: BedRecord,
    /// Remarks that do not stop a run.
    pub warnings: Vec<String>,
    /// Sources of the models used.
    pub sources: Vec<&'static str>,
}

/// What was run, and how it ended.
#[derive(Debug, Default, Serialize)]
pub struct RunRecord {
    /// `"done"`, or what stopped the run.
    pub status: String,
    /// Title of the scene.
    pub title: String,
    /// Version of the program.
    pub version: String,
    /// 64-bit FNV-1a hash of the scene file, its overrides and the files it names, in hexadecimal.
    pub scene_hash: String,
    /// Keys overridden on the command line.
    pub overrides: Vec<String>,
    /// Threads used; the results do not depend on it.
    pub threads: usize,
    /// Largest resident memory [bytes], where the system reports it.
    pub peak_memory: Option<u64>,
    /// Processor time of the process, user and system, all threads [s], where the system reports it; since the last start of a run that
    /// was resumed.
    pub cpu_seconds: Option<f64>,
}

/// How a solid was solved, and what it ended with.
#[derive(Debug, Default, Serialize)]
pub struct SolidRecord {
    /// Static equilibrium of a solid that ran alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statics: Option<StaticsRecord>,
    /// How equilibrium was found in a plastic solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub newton: Option<NewtonRecord>,
    /// How far a solid has yielded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plastic: Option<PlasticRecord>,
    /// Sums of the reactions of named supports at the end.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reactions: Vec<ReactionRecord>,
    /// Search for the factor of safety.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub safety: Option<SafetyRecord>,
}

/// What became of sleepers under their load.
#[derive(Debug, Default, Serialize)]
pub struct TrackSummary {
    /// Lateral push of a sleeper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub push: Option<PushSummary>,
    /// Settlement per load cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settlement: Option<SettlementRecord>,
    /// Sleepers under load.
    #[serde(rename = "track", skip_serializing_if = "Option::is_none")]
    pub sleepers: Option<TrackRecord>,
}

/// Grains that came and went, and how the bed was made and ended.
#[derive(Debug, Default, Serialize)]
pub struct BedRecord {
    /// Grains that came in and went out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowRecord>,
    /// Groups that have grown to their size.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub growth: Vec<GrowthRecord>,
    /// Stages of compaction.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub compaction: Vec<CompactionRecord>,
    /// Energy balances of the stages of packing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stage_energy: Vec<StageEnergy>,
    /// The grains at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<PackingRecord>,
    /// How far a slide has run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runout: Option<RunoutRecord>,
    /// Constants of a specimen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specimen: Option<SpecimenRecord>,
}

impl Summary {
    /// Writes the summary as `summary.json` in `dir`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, dir: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(|e| Failure::Other(e.to_string()))?;
        let file = dir.join("summary.json");
        crate::write::atomic::write(&file, |out| {
            writeln!(out, "{text}").map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        Ok(())
    }

    /// Writes `log.txt` in `dir`: what a run prints, its status and the sources of the models it used.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_log(&self, dir: &Path) -> Result<(), Failure> {
        let file = dir.join("log.txt");
        crate::write::atomic::write(&file, |out| {
            let sources: String = self.sources.iter().map(|s| format!("source: {s}\n")).collect();
            write!(out, "{}\nstatus: {}\n{}{sources}", self.run.title, self.run.status, self.report(true))
                .map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        Ok(())
    }
}

/// Largest resident memory of this process so far [bytes], from the system's own account.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}
