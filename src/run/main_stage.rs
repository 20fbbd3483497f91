//! The run proper: steps, records, accounts.

use super::Stage;
use super::bond_output;
use super::checkpoint::{Loaded, Moment};
use super::flow::Flow;
use super::record::Results;
use super::summary::{BedStiffness, EnergyRecord, MomentumRecord, SettlementRecord, StageRecord, Summary};
use super::system::System;
use super::track_output;
use crate::failure::Failure;
use crate::model::grains::GrainsPart;
use crate::progress::Progress;
use serde::{Deserialize, Serialize};
use trackbed_coupling::track::cycles::Cycle;
use trackbed_coupling::track::{Track, TrackInput};
use trackbed_dem as dem;

/// Stage of a checkpoint from within the run proper.
pub(super) const RUN: &str = "run";

/// How the grains of a run were when it began.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Start {
    coordination: f64,
    linear: dem::Vec3,
    angular: dem::Vec3,
}

/// Where a run is.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Place {
    /// Windows done.
    done: u64,
    /// Frame that comes next, not counting the one of the start.
    next_frame: u64,
    /// Seconds by the clock.
    seconds: f64,
    /// Windows of the whole run, which are fewer where cycles are jumped over.
    windows: u64,
}

impl Stage<'_> {
    /// The run proper of a scene with grains, with its accounts.
    pub(super) fn grain_stage<S: System>(
        &self,
        system: &mut S,
        grains: &GrainsPart,
        mut resumed: Option<Loaded>,
        summary: &mut Summary,
    ) -> Result<(), Failure> {
        let momentum = |s: &S| {
            let g = s.grains().expect("a system with grains");
            dem::measure::momentum(g.model, g.state)
        };
        let start = match &mut resumed {
            Some(loaded) => loaded.take()?,
            None => {
                let view = system.grains().expect("a system with grains");
                let coordination = dem::measure::coordination(view.model, view.state);
                let dem::ledger::Impulse { linear, angular } = momentum(system);
                Start { coordination, linear, angular }
            }
        };
        summary.model.coordination = Some(start.coordination);
        self.main_stage(system, Some((grains, start)), resumed, summary)?;
        let after = momentum(system);
        let ledger = &system.grains().expect("a system with grains").state.ledger;
        let impulse = ledger.impulse();
        let (mut linear, mut angular) = (0.0, 0.0);
        let outside = [&ledger.gravity, &ledger.walls, &ledger.surface, &ledger.applied];
        for part in outside.into_iter().chain([&ledger.constraints, &ledger.flow]) {
            linear += part.linear.norm();
            angular += part.angular.norm();
        }
        let relative = |error: f64, scale: f64| if scale > 0.0 { error / scale } else { error };
        summary.momentum = Some(MomentumRecord {
            linear: relative((after.linear - start.linear - impulse.linear).norm(), linear),
            angular: relative((after.angular - start.angular - impulse.angular).norm(), angular),
        });
        Ok(())
    }

    /// Advances a system to the end of the run, recording; from where the checkpoint `resumed` has it, if there is one.
    pub(super) fn main_stage<S: System>(
        &self,
        system: &mut S,
        grains: Option<(&GrainsPart, Start)>,
        resumed: Option<Loaded>,
        summary: &mut Summary,
    ) -> Result<(), Failure> {
        let job = self.job;
        let (grains, start) = grains.unzip();
        let window = system.window();
        let mut windows = ((job.end / window).ceil() as u64).max(1);
        let frames = u64::from(job.output.frames).min(windows);
        let interval = job.output.history_interval;
        let every = ((interval / window).round() as u64).max(1);

        let mut track =
            Track::new(grains.map_or_else(TrackInput::default, GrainsPart::track), system.grains());
        let mut flow = Flow::new(grains, system.grains(), window, job.end);
        let load = grains.and_then(|g| g.load.as_ref());
        // What follows the cycles, whenever they end.
        let tail = load.map_or(0, |l| (((job.end - l.end()) / window).ceil() as u64).min(windows));
        let (mut recorder, from) = match resumed {
            Some(mut loaded) => {
                let from: Place = loaded.take()?;
                track = track.resume(loaded.take()?);
                flow = flow.map(|f| f.resume(&mut loaded)).transpose()?;
                windows = from.windows;
                (Results::resume(job, self.dir, system, &track, flow.as_ref(), &mut loaded)?, from)
            }
            None => {
                let mut recorder = Results::start(job, self.dir, system, &track, flow.as_ref())?;
                recorder.row(0.0, system, &track, flow.as_ref())?;
                recorder.frame(0.0, system, &track)?;
                (recorder, Place { done: 0, next_frame: 1, seconds: 0.0, windows })
            }
        };
        // With jumps neither time nor steps tell how far a run is.
        let jumps = grains.is_some_and(|g| g.after.jump.is_some());
        let share = |k: u64, windows: u64, recorder: &Results<'_>| match recorder.progress() {
            Some((number, total)) if jumps => (u64::from(number), u64::from(total)),
            _ => (k, windows),
        };
        let (begun, whole) = share(from.done, windows, &recorder);
        let progress =
            Progress::start("running", whole as f64, self.quiet).resumed(begun as f64, from.seconds);
        let mut next_frame = from.next_frame;
        let mut done = from.done;
        self.keeper.begin();
        let mut outcome = Ok(());
        while outcome.is_ok() && done < windows {
            outcome = (|| -> Result<(), Failure> {
                let k = done + 1;
                let time = k as f64 * window;
                track.begin_window();
                system.advance(&mut |t, model, state, out| track.apply(t, model, state, out))?;
                track.follow(time, system);
                if let Some(flow) = &mut flow {
                    flow.follow(k, time, system).map_err(|e| e.at(time))?;
                }
                if let Some(cycle) = recorder.follow(time, system, &track)? {
                    progress.message(format!(
                        "cycle {}: settlement {:.3} mm",
                        cycle.number,
                        1e3 * cycle.settlement
                    ));
                    if recorder.progress().is_some_and(|(number, total)| number >= total) {
                        track.end_cycles(time);
                        if jumps {
                            windows = (k + tail).min(windows);
                        }
                    }
                }
                if k % every == 0 || k == windows {
                    recorder.row(time, system, &track, flow.as_ref()).map_err(|e| e.at(time))?;
                }
                let (come, whole) = share(k, windows, &recorder);
                if frames > 0 && come * frames >= next_frame * whole && next_frame <= frames {
                    recorder.frame(time, system, &track).map_err(|e| e.at(time))?;
                    next_frame = come * frames / whole + 1;
                }
                progress.at(come as f64);
                done = k;
                if k == windows {
                    return Ok(());
                }
                self.keeper.step(
                    || Moment { stage: RUN.into(), step: k, time },
                    |body| {
                        // In the order in which a resumed run needs them.
                        if let Some(settled) = &*self.settled.borrow() {
                            body.put(settled)?;
                        }
                        system.save(body)?;
                        if let Some(start) = &start {
                            body.put(start)?;
                        }
                        body.put(&Place { done, next_frame, seconds: progress.seconds(), windows })?;
                        body.put(track.state())?;
                        if let Some(flow) = &flow {
                            flow.save(body)?;
                        }
                        recorder.save(body)
                    },
                )
            })();
        }
        self.keeper.end();
        // A step that found no equilibrium leaves the last one: it is what the user wants to see.
        if matches!(outcome, Err(Failure::Numerical(_)))
            && system.keeps_its_state()
            && let Some(time) = system.solid().map(|s| s.state.time)
        {
            recorder.row(time, system, &track, flow.as_ref())?;
            recorder.frame(time, system, &track)?;
        }
        if let (Some(part), Some(view)) = (grains, system.grains())
            && !part.bonds.is_empty()
        {
            bond_output::write_breaks(self.dir, view.state)?;
            summary.bonds = Some(bond_output::summary(view));
        }
        let (grain_steps, solid_steps) = system.steps_per_window();
        let seconds = progress.finish(&format!("{:.3} s simulated", done as f64 * window));
        summary.stages.push(StageRecord {
            name: "run".into(),
            seconds,
            grain_steps: done * grain_steps,
            solid_steps: done * solid_steps,
        });
        summary.push = track_output::push(&track, self.dir)?;
        if let (Some(flow), Some(view)) = (&flow, system.grains()) {
            flow.finish(done as f64 * window, view, summary);
        }
        summary.settlement = settlement(recorder.cycles(), grains, &recorder);
        summary.track = track.record();
        summary.warnings.extend(summary.track.iter().flat_map(|t| t.remarks()));
        let balance = recorder.balance();
        let work = balance.spent.work();
        let turnover = work.abs().max(balance.spent.dissipated());
        summary.energy = Some(EnergyRecord {
            start: balance.start,
            end: balance.now,
            spent: balance.spent,
            error: balance.error(),
            work,
            relative_error: (turnover > 0.0).then(|| balance.error().abs() / turnover),
            largest_error: recorder.largest_error(),
        });
        recorder.end()?;
        recorder.plot_settlement()?;
        outcome
    }
}

fn settlement(
    cycles: &[Cycle],
    grains: Option<&GrainsPart>,
    recorder: &Results<'_>,
) -> Option<SettlementRecord> {
    if cycles.is_empty() {
        return None;
    }
    let per_cycle: Vec<f64> = cycles.iter().map(|c| c.settlement).collect();
    let increments: Vec<f64> =
        per_cycle.iter().enumerate().map(|(i, s)| if i == 0 { *s } else { s - per_cycle[i - 1] }).collect();
    let half = increments.len() / 2;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let slowing =
        (half > 0).then(|| mean(&increments[increments.len() - half..]) / mean(&increments[..half]));
    let last: Vec<f64> = cycles[cycles.len().saturating_sub(10)..].iter().map(|c| c.bed_stiffness).collect();
    // Cycles that never rise from the one load to the other tell none.
    let between = grains.and_then(|g| g.after.between).filter(|_| last.iter().any(|k| *k > 0.0));
    let bed_stiffness = between.map(|between| BedStiffness {
        between,
        last: last[last.len() - 1],
        mean_of_last_ten: mean(&last),
    });
    let (fits, jump) = (recorder.fits(), recorder.jumps());
    Some(SettlementRecord { per_cycle, increments, slowing, fits, bed_stiffness, jump })
}
