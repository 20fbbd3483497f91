//! `summary.json`: what a run did, how well its accounts close, and what it found.

use super::flow::FlowRecord;
use super::packing::{self, CompactionRecord, GrowthRecord, PackingRecord};
use crate::failure::Failure;
use crate::model::exchange::ContactClass;
use crate::write::WriteError;
use serde::{Deserialize, Serialize};
use std::path::Path;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::scheme::{Passes, Scheme};
use trackbed_coupling::stability::Stability;
use trackbed_coupling::track::extremes::TrackRecord;
use trackbed_coupling::track::jump::JumpSummary;
use trackbed_coupling::track::push::PushSummary;
use trackbed_coupling::track::settlement::Fit;
use trackbed_coupling::transfer::TransferAudit;
use trackbed_fem::nonlinear::Statistics;

/// The content of `summary.json`.
#[derive(Debug, Default, Serialize)]
pub struct Summary {
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
    /// Largest resident memory [bytes], where the system tells it.
    pub peak_memory: Option<u64>,
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
    /// Force and moment across the interface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupling: Option<CouplingRecord>,
    /// Static equilibrium of a solid that ran alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statics: Option<StaticsRecord>,
    /// How equilibrium was found in a plastic solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub newton: Option<NewtonRecord>,
    /// Sums of the reactions of named supports at the end.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reactions: Vec<ReactionRecord>,
    /// Search for the factor of safety.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub safety: Option<SafetyRecord>,
    /// Lateral push of a sleeper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub push: Option<PushSummary>,
    /// Settlement per load cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settlement: Option<SettlementRecord>,
    /// Sleepers under load.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub track: Option<TrackRecord>,
    /// Grains that came in and went out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowRecord>,
    /// Groups that have grown to their size.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub growth: Vec<GrowthRecord>,
    /// Stages of compaction.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub compaction: Vec<CompactionRecord>,
    /// The grains at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<PackingRecord>,
    /// Remarks that do not stop a run.
    pub warnings: Vec<String>,
    /// Sources of the models used.
    pub sources: Vec<&'static str>,
}

/// One stage of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StageRecord {
    /// Name.
    pub name: String,
    /// Wall time [s].
    pub seconds: f64,
    /// Steps of the grains.
    pub grain_steps: u64,
    /// Steps of the solid.
    pub solid_steps: u64,
}

/// Sizes of the model.
#[derive(Debug, Default, Serialize)]
pub struct ModelRecord {
    /// Nodes of the solid.
    pub nodes: usize,
    /// Elements of the solid.
    pub elements: usize,
    /// Unknowns of the solid.
    pub unknowns: usize,
    /// Bodies (grains and sleeper).
    pub bodies: usize,
    /// Spheres that carry the contacts.
    pub spheres: usize,
    /// Step of the grains [s].
    pub grain_step: Option<f64>,
    /// Limit of that step [s].
    pub grain_step_limit: Option<f64>,
    /// What sets the limit.
    pub grain_step_set_by: Option<String>,
    /// Step of the solid [s].
    pub solid_step: Option<f64>,
    /// Shapes and errors of a reduced solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<trackbed_fem::reduction::Estimate>,
    /// Memory that the solid was predicted to need [bytes].
    pub predicted_memory: Option<u64>,
    /// Mean number of touching partners per grain at the start of the run proper.
    pub coordination: Option<f64>,
}

/// Energy account.
#[derive(Debug, Serialize)]
pub struct EnergyRecord {
    /// Stored energy at the start [J].
    pub start: Stored,
    /// Stored energy at the end [J].
    pub end: Stored,
    /// Work and dissipation [J].
    pub spent: Spent,
    /// Δ stored + dissipated − work [J].
    pub error: f64,
    /// Work of the load [J].
    pub work: f64,
    /// |error| over the larger of |work of the load| and energy dissipated; absent when both are zero.
    pub relative_error: Option<f64>,
    /// Largest |error| at any row of the history [J].
    pub largest_error: f64,
}

/// Momentum account: change of momentum against the impulses of all forces.
#[derive(Debug, Serialize)]
pub struct MomentumRecord {
    /// Largest deviation of linear momentum over the sum of |impulses|.
    pub linear: f64,
    /// Largest deviation of angular momentum about the origin over the sum of |angular impulses|.
    pub angular: f64,
}

/// Bonds between grains at the end.
#[derive(Debug, Serialize)]
pub struct BondSummary {
    /// Bonds at the start of the run proper.
    pub made: usize,
    /// Broken by tension and bending.
    pub broken_by_tension: u64,
    /// Broken by shear and twisting.
    pub broken_by_shear: u64,
    /// Energy set free by breaks [J].
    pub energy_of_breaks: f64,
    /// Pieces, unbonded bodies among them.
    pub fragments: usize,
    /// Bodies of the largest piece.
    pub largest_fragment: u32,
}

/// Interface audit.
#[derive(Debug, Serialize)]
pub struct CouplingRecord {
    /// Largest relative errors of force and moment over all exchanges.
    pub transfer: TransferAudit,
    /// Order of the exchange.
    pub scheme: Scheme,
    /// Steps of the grains per step of the solid.
    pub substeps: u32,
    /// Stability of the exchange: the largest numbers of all classes of contacts.
    pub stability: Stability,
    /// Every class of contacts with its numbers and limits.
    pub classes: Vec<ContactClass>,
    /// Windows, and how often they were repeated.
    pub passes: Passes,
    /// Interface work seen by grains plus that seen by the solid [J], which should vanish.
    pub interface_work_error: f64,
    /// How contact forces are transferred.
    pub transfer_kind: String,
}

/// Static equilibrium.
#[derive(Debug, Serialize)]
pub struct StaticsRecord {
    /// Sum of all loads [N].
    pub load: [f64; 3],
    /// Sum of all reactions [N].
    pub reaction: [f64; 3],
    /// |Σ load + Σ reaction| over the sum of their absolute values.
    pub equilibrium_error: f64,
    /// Largest displacement [m] and its node number.
    pub largest_displacement: (f64, u32),
    /// Strain energy [J].
    pub strain_energy: f64,
}

/// How equilibrium was found in a plastic solid.
#[derive(Debug, Serialize)]
pub struct NewtonRecord {
    /// Steps accepted.
    pub steps: u64,
    /// Steps given up and halved.
    pub halvings: u64,
    /// Iterations in all.
    pub iterations: u64,
    /// Factorizations of a symmetric matrix.
    pub factorizations_symmetric: u64,
    /// Factorizations of an unsymmetric matrix.
    pub factorizations_unsymmetric: u64,
    /// Seconds in stresses and matrices.
    pub assembly_seconds: f64,
    /// Seconds in factorizations.
    pub factor_seconds: f64,
    /// Seconds in solves.
    pub solve_seconds: f64,
}

impl NewtonRecord {
    /// Of the counts of a solver.
    pub fn of(s: &Statistics) -> NewtonRecord {
        NewtonRecord {
            steps: s.steps,
            halvings: s.halvings,
            iterations: s.iterations,
            factorizations_symmetric: s.factorizations_symmetric,
            factorizations_unsymmetric: s.factorizations_unsymmetric,
            assembly_seconds: s.assembly_seconds,
            factor_seconds: s.factor_seconds,
            solve_seconds: s.solve_seconds,
        }
    }
}

/// Sum of the reactions of a named support.
#[derive(Debug, Serialize)]
pub struct ReactionRecord {
    /// Name.
    pub name: String,
    /// Force of the support on the solid [N].
    pub force: [f64; 3],
}

/// Search for the factor of safety.
#[derive(Debug, Serialize)]
pub struct SafetyRecord {
    /// Largest factor at which the solid found equilibrium.
    pub stands_at: f64,
    /// Smallest factor at which it did not.
    pub fails_at: f64,
    /// Every factor tried.
    pub trials: Vec<TrialRecord>,
}

/// One factor tried.
#[derive(Debug, Serialize)]
pub struct TrialRecord {
    /// Factor by which the strength was divided.
    pub factor: f64,
    /// Whether equilibrium was found.
    pub stands: bool,
    /// Share of the load that was carried.
    pub share_of_load: f64,
    /// Newton iterations.
    pub iterations: u64,
    /// Largest displacement reached [m].
    pub largest_displacement: f64,
}

/// Settlement under a cyclic load.
#[derive(Debug, Serialize)]
pub struct SettlementRecord {
    /// Settlement of the sleeper after each cycle [m].
    pub per_cycle: Vec<f64>,
    /// Increase of settlement in each cycle [m].
    pub increments: Vec<f64>,
    /// Mean increment of the second half of the cycles over that of the first half.
    pub slowing: Option<f64>,
    /// Settlement laws fitted to the cycles from the tenth on.
    pub fits: Vec<Fit>,
    /// Slope of the loading branch between two loads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bed_stiffness: Option<BedStiffness>,
    /// Cycle jumps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jump: Option<JumpSummary>,
}

/// Stiffness of the bed under a sleeper.
#[derive(Debug, Serialize)]
pub struct BedStiffness {
    /// The two loads [N].
    pub between: [f64; 2],
    /// In the last cycle [N/m].
    pub last: f64,
    /// Mean of the last ten cycles [N/m].
    pub mean_of_last_ten: f64,
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
            write!(out, "{}\nstatus: {}\n{}{sources}", self.title, self.status, self.report())
                .map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
        Ok(())
    }

    /// What a user wants to see when a run has ended.
    pub fn report(&self) -> String {
        let mut lines = Vec::new();
        if let Some(r) = &self.model.reduction {
            lines.push(format!("solid reduced: {r}"));
        }
        for stage in &self.stages {
            lines.push(format!(
                "{}: {:.1} s, {} grain steps, {} solid steps",
                stage.name, stage.seconds, stage.grain_steps, stage.solid_steps
            ));
        }
        if let Some(s) = &self.statics {
            let (u, node) = s.largest_displacement;
            lines.push(format!("largest displacement {u:.6e} m at node {node}"));
            lines.push(format!("equilibrium of loads and reactions: {:.1e} relative", s.equilibrium_error));
        }
        if let Some(n) = &self.newton {
            lines.push(format!(
                "Newton: {} steps ({} halved), {} iterations, {} symmetric and {} unsymmetric factorizations; seconds in \
                 assembly {:.1}, factorization {:.1}, solves {:.1}",
                n.steps,
                n.halvings,
                n.iterations,
                n.factorizations_symmetric,
                n.factorizations_unsymmetric,
                n.assembly_seconds,
                n.factor_seconds,
                n.solve_seconds
            ));
        }
        for r in &self.reactions {
            let [x, y, z] = r.force;
            lines.push(format!("reaction of {}: ({x:.6e}, {y:.6e}, {z:.6e}) N", r.name));
        }
        if let Some(s) = &self.safety {
            lines.push(format!(
                "factor of safety: stands at {:.4}, fails at {:.4} ({} trials)",
                s.stands_at,
                s.fails_at,
                s.trials.len()
            ));
        }
        if let Some(e) = &self.energy {
            let relative = e
                .relative_error
                .map_or(String::new(), |r| format!(" ({:.4} % of what was turned over)", 100.0 * r));
            lines.push(format!("work {:.6} J, energy error {:.2e} J{relative}", e.work, e.error));
        }
        if let Some(m) = &self.momentum {
            lines.push(format!(
                "momentum error {:.1e}, angular {:.1e} (relative to the impulses)",
                m.linear, m.angular
            ));
        }
        if let Some(b) = &self.bonds {
            lines.push(format!(
                "bonds: {} of {} broken ({} by tension, {} by shear), {:.3e} J set free; {} fragments, the largest of {} bodies",
                b.broken_by_tension + b.broken_by_shear,
                b.made,
                b.broken_by_tension,
                b.broken_by_shear,
                b.energy_of_breaks,
                b.fragments,
                b.largest_fragment
            ));
        }
        if let Some(c) = &self.coupling {
            lines.push(format!(
                "interface: force error {:.1e}, moment error {:.1e} (relative), W = {:.2}, D = {:.2}; scheme {}, {} sub-steps, \
                 transfer {}",
                c.transfer.force,
                c.transfer.moment,
                c.stability.stiffness,
                c.stability.damping,
                c.scheme,
                c.substeps,
                c.transfer_kind
            ));
            for class in &c.classes {
                lines.push(format!("  {}", class.line()));
            }
            if matches!(c.scheme, Scheme::Iterated { .. }) && c.passes.windows > 0 {
                lines.push(format!(
                    "  {:.2} passes per window, {} windows not converged",
                    c.passes.passes as f64 / c.passes.windows as f64,
                    c.passes.unconverged
                ));
            }
        }
        if let Some(s) = &self.settlement {
            let list: Vec<String> = s.per_cycle.iter().map(|s| format!("{:.3}", 1e3 * s)).collect();
            if list.len() <= 20 {
                lines.push(format!("settlement after each cycle [mm]: {}", list.join(" ")));
            } else {
                let last = list.len() - 1;
                lines.push(format!(
                    "settlement [mm]: {} after the first cycle, {} after the last",
                    list[0], list[last]
                ));
            }
            for fit in &s.fits {
                let p: Vec<String> = fit.parameters.iter().map(|(n, v)| format!("{n} = {v:.4e}")).collect();
                lines.push(format!("{}: s = {}, {}, R2 = {:.4}", fit.law, fit.form, p.join(", "), fit.r2));
            }
            if let Some(b) = &s.bed_stiffness {
                let [low, high] = b.between.map(|f| 1e-3 * f);
                lines.push(format!(
                    "bed stiffness between {low:.1} and {high:.1} kN: {:.3} kN/mm",
                    1e-6 * b.mean_of_last_ten
                ));
            }
            if let Some(j) = &s.jump {
                lines.push(format!(
                    "cycle jumps ({}): {} cycles simulated, {} jumped over; error of the settlement estimated {:.3} mm ({:.1} %)",
                    j.method,
                    j.simulated,
                    j.skipped,
                    1e3 * j.error_estimate,
                    100.0 * j.relative_error_estimate
                ));
            }
        }
        if let Some(p) = &self.push {
            let at_two =
                p.resistance_at_2_mm.map_or(String::new(), |f| format!("{:.3} kN at 2 mm, ", 1e-3 * f));
            lines.push(format!(
                "lateral push: {at_two}peak {:.3} kN at {:.2} mm, under {:.3} kN",
                1e-3 * p.peak,
                1e3 * p.displacement_at_peak,
                1e-3 * p.vertical_force
            ));
        }
        for (k, s) in self.track.iter().flat_map(|t| t.sleepers.iter().enumerate()) {
            let share = s.load_share.map_or(String::new(), |p| format!(" ({:.1} % of an axle)", 100.0 * p));
            let factor =
                s.dynamic_amplification.map_or(String::new(), |f| format!(", {f:.3} times the static force"));
            let bend = s.bend.map_or(String::new(), |[low, high]| {
                format!(", ends {:.4} to {:.4} mm over the middle", 1e3 * low, 1e3 * high)
            });
            lines.push(format!(
                "sleeper {}: force {:.2} to {:.2} kN{share}{factor}, lowered by {:.3} mm{bend}",
                k + 1,
                1e-3 * s.smallest_force,
                1e-3 * s.largest_force,
                1e3 * s.lowering
            ));
        }
        lines.extend(self.flow.iter().flat_map(FlowRecord::report));
        lines.extend(packing::report(self));
        for warning in &self.warnings {
            lines.push(format!("note: {warning}"));
        }
        lines.join("\n") + "\n"
    }
}

/// Largest resident memory of this process so far [bytes], from the system's own account.
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}

/// 64-bit FNV-1a hash (Fowler, Noll, Vo) of a sequence of texts.
#[derive(Clone, Copy, Debug)]
pub struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Hash(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    /// Takes in some bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.0 = (self.0 ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// The hash as a number.
    pub fn value(self) -> u64 {
        self.0
    }

    /// The hash in hexadecimal.
    pub fn hex(self) -> String {
        format!("{:016x}", self.0)
    }
}
