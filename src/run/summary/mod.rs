//! `summary.json`: stages, balances, checks, results.

mod records;
mod report;
mod verdict;

pub use records::*;
pub use verdict::Verdict;

use super::bibtex;
use super::flow::FlowRecord;
use super::packing::{BedStage, CompactionRecord, GrowthRecord, PackingRecord, StageEnergy, TampingRecord};
use super::runout::RunoutRecord;
use super::specimen::SpecimenRecord;
use super::validity::{Check, LoadCheck};
use serde::Serialize;
use std::path::{Path, PathBuf};
use trackbed_io::failure::Failure;
use trackbed_io::write::WriteError;
use trackbed_track::extremes::TrackRecord;
use trackbed_track::push_test::PushTestSummary;

/// Content of `summary.json`, in this order.
#[derive(Debug, Default, Serialize)]
pub struct Summary {
    /// Results directory.
    #[serde(skip)]
    pub dir: PathBuf,
    /// Run data.
    #[serde(flatten)]
    pub run: RunRecord,
    /// Balance checks.
    pub verdict: Verdict,
    /// Validity checks.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub validity: Vec<Check>,
    /// Applied loads and motions against their targets.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadCheck>,
    /// Stages with wall time and steps.
    pub stages: Vec<StageRecord>,
    /// Sizes of the model.
    pub model: ModelRecord,
    /// Energy balance of the main stage.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyRecord>,
    /// Momentum balance of the grains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub momentum: Option<MomentumRecord>,
    /// Bonds between grains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bonds: Option<BondSummary>,
    /// Loads on structures.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub structures: Vec<LoadRecord>,
    /// Floating walls.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub floating: Vec<FloatingRecord>,
    /// Interface force and moment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupling: Option<CouplingRecord>,
    /// Solid.
    #[serde(flatten)]
    pub solid: SolidRecord,
    /// Sleepers and load.
    #[serde(flatten)]
    pub track: TrackSummary,
    /// Grain bed.
    #[serde(flatten)]
    pub bed: BedRecord,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Literature sources.
    pub sources: Vec<&'static str>,
}

/// Run data and status.
#[derive(Debug, Default, Serialize)]
pub struct RunRecord {
    /// `"done"`, or the failure.
    pub status: String,
    /// Scene title.
    pub title: String,
    /// Program version.
    pub version: String,
    /// 64-bit FNV-1a hash of scene, overrides, files.
    pub scene_hash: String,
    /// Command-line overrides.
    pub overrides: Vec<String>,
    /// Threads; results do not depend on them.
    pub threads: usize,
    /// Peak resident memory [bytes], if available.
    pub peak_memory: Option<u64>,
    /// CPU time of all threads since the last start [s].
    pub cpu_seconds: Option<f64>,
}

/// Results of the solid.
#[derive(Debug, Default, Serialize)]
pub struct SolidRecord {
    /// Static equilibrium of a solid-only model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statics: Option<StaticsRecord>,
    /// Newton statistics of a plastic solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub newton: Option<NewtonRecord>,
    /// Plastic state.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plastic: Option<PlasticRecord>,
    /// Final reactions by support name.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reactions: Vec<ReactionRecord>,
    /// Libraries of user materials.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub libraries: Vec<LibraryRecord>,
    /// Factor of safety search.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub safety: Option<SafetyRecord>,
}

/// Results of sleepers.
#[derive(Debug, Default, Serialize)]
pub struct TrackSummary {
    /// Lateral push.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub push: Option<PushTestSummary>,
    /// Settlement per cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settlement: Option<SettlementRecord>,
    /// Sleepers under load.
    #[serde(rename = "track", skip_serializing_if = "Option::is_none")]
    pub sleepers: Option<TrackRecord>,
}

/// Results of the bed.
#[derive(Debug, Default, Serialize)]
pub struct BedRecord {
    /// Inflow and outflow.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowRecord>,
    /// Groups after growth.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub growth: Vec<GrowthRecord>,
    /// Compaction stages of an earlier run, not in the records.
    #[serde(skip)]
    pub earlier: usize,
    /// Compaction stages.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub compaction: Vec<CompactionRecord>,
    /// Tamped sleepers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tamping: Vec<TampingRecord>,
    /// Bed after packing stages.
    #[serde(rename = "bed", skip_serializing_if = "Vec::is_empty")]
    pub beds: Vec<BedStage>,
    /// Energy balances of packing stages.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stage_energy: Vec<StageEnergy>,
    /// Final packing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<PackingRecord>,
    /// Runout.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runout: Option<RunoutRecord>,
    /// Specimen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specimen: Option<SpecimenRecord>,
}

impl Summary {
    /// Writes `summary.json` in `dir`.
    ///
    /// # Errors
    /// I/O errors.
    pub fn write(&self, dir: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(|e| Failure::Other(e.to_string()))?;
        let file = dir.join("summary.json");
        trackbed_io::write::atomic::write(&file, |out| {
            writeln!(out, "{text}").map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        Ok(())
    }

    /// Writes `log.txt` and `sources.bib` in `dir`.
    ///
    /// # Errors
    /// I/O errors.
    pub fn write_log(&self, dir: &Path) -> Result<(), Failure> {
        let file = dir.join("log.txt");
        trackbed_io::write::atomic::write(&file, |out| {
            let sources: String = self.sources.iter().map(|s| format!("source: {s}\n")).collect();
            write!(out, "{}\nstatus: {}\n{}{sources}", self.run.title, self.run.status, self.report(true))
                .map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        bibtex::write(dir, &self.sources)
    }
}

/// Returns the peak resident memory [bytes].
pub fn peak_memory() -> Option<u64> {
    trackbed_io::system::peak_memory()
}
