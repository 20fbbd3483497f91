//! Time loop over coupling windows: steps, records, balances.

use super::cadence::Cadence;
use super::stage::{GrainsState, Packed, RUN, Settled};
use crate::bond_output;
use crate::checkpoint::{Loaded, Moment};
use crate::companion::Shown;
use crate::context::Run;
use crate::events;
use crate::flow::Flow;
use crate::from::{self, END};
use crate::packing::StageEnergy;
use crate::record::Results;
use crate::runout;
use crate::summary::{
    BedStiffness, BondSummary, EnergyRecord, MomentumRecord, PlasticRecord, SettlementRecord, StageRecord,
    Summary,
};
use crate::system::System;
use crate::track_output;
use crate::validity::{
    Check, Fall, applied_loads, bond_rotation, free_sleeper, jump_error, load_error, scaled_inertia,
    stiffness_drift,
};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;
use trackbed_input::model::grains::GrainsPart;
use trackbed_io::failure::Failure;
use trackbed_io::progress::{Progress, Verbosity};
use trackbed_track::cycles::Cycle;
use trackbed_track::{Track, TrackInput};

/// Initial state of the grains.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Start {
    coordination: f64,
    linear: dem::Vec3,
    angular: dem::Vec3,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Place {
    done: u64,
    /// Without the initial frame.
    next_frame: u64,
    seconds: f64,
    /// Fewer with cycle jumps.
    windows: u64,
}

struct TimeLoop<'a> {
    run: &'a Run<'a>,
    grains: Option<(&'a GrainsPart, Start)>,
    settled: Option<&'a Settled>,
    cadence: Cadence,
    track: Track<'a>,
    flow: Option<Flow<'a>>,
    recorder: Results<'a>,
    place: Place,
    progress: Progress,
    /// Whether the last window was shortened to end with the run.
    shortened: bool,
}

/// Runs the main loop with grains.
///
/// # Errors
/// As [`advance`].
pub fn with_grains<S: System>(
    run: &Run<'_>,
    system: &mut S,
    grains: &GrainsState,
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
            let dem::balance_terms::Impulse { linear, angular } = momentum(system);
            Start { coordination, linear, angular }
        }
    };
    summary.model.coordination = Some(start.coordination);
    let settled = (grains.done == Packed::Finished).then_some(&grains.bed);
    advance(run, system, Some((&grains.part, start)), resumed, settled, summary)?;
    let after = momentum(system);
    let ledger = &system.grains().expect("a system with grains").state.balance;
    let impulse = ledger.impulse();
    let (mut linear, mut angular) = (0.0, 0.0);
    let outside = [&ledger.gravity, &ledger.walls, &ledger.surface, &ledger.applied, &ledger.body_forces];
    for part in outside.into_iter().chain([&ledger.constraints, &ledger.flow, &ledger.mounts]) {
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

/// Advances a system to the end, from checkpoint `resumed` if any.
///
/// # Errors
/// Numerical failures, interrupts, I/O errors.
pub fn advance<S: System>(
    run: &Run<'_>,
    system: &mut S,
    grains: Option<(&GrainsPart, Start)>,
    resumed: Option<Loaded>,
    settled: Option<&Settled>,
    summary: &mut Summary,
) -> Result<(), Failure> {
    let mut looped = TimeLoop::begin(run, system, grains, resumed, settled)?;
    looped.show(system)?;
    run.checkpoints.begin();
    let mut outcome = Ok(());
    while outcome.is_ok() && looped.place.done < looped.place.windows {
        outcome = looped.window(system);
    }
    run.checkpoints.end();
    if outcome.is_ok() {
        looped.keep_end(system)?;
    }
    looped.finish(system, matches!(outcome, Err(Failure::Numerical(_))), summary)?;
    outcome
}

impl<'a> TimeLoop<'a> {
    fn begin<S: System>(
        run: &'a Run<'a>,
        system: &S,
        grains: Option<(&'a GrainsPart, Start)>,
        resumed: Option<Loaded>,
        settled: Option<&'a Settled>,
    ) -> Result<TimeLoop<'a>, Failure> {
        let job = run.job;
        let window = system.window();
        // Tolerates rounding of a whole number of windows.
        let windows = ((job.end / window * (1.0 - 1e-12)).ceil() as u64).max(1);
        let part = grains.map(|(part, _)| part);
        let input = part.map_or_else(TrackInput::default, |part| part.track.input());
        let mut track = Track::new(input, system.grains());
        let load = part.and_then(|g| g.track.load.as_ref());
        let observed = load.map(|load| (load, track.observed().unwrap_or(0)));
        let jumps = part.is_some_and(|g| g.track.after.jump.is_some());
        let cadence = Cadence::new(job, (window, windows), observed, jumps);
        let mut flow = Flow::new(part, system.grains(), window, job.end);
        let (recorder, place) = match resumed {
            Some(mut loaded) => {
                let place: Place = loaded.take()?;
                track = track.resume(loaded.take()?);
                flow = flow.map(|f| f.resume(&mut loaded)).transpose()?;
                (Results::resume(job, run.dir, system, &track, flow.as_ref(), &mut loaded)?, place)
            }
            None => {
                let mut recorder = Results::start(job, run.dir, system, &track, flow.as_ref())?;
                recorder.measure(system, &track);
                recorder.row(0.0, system, &track, flow.as_ref())?;
                recorder.check()?;
                recorder.frame(0.0, system, &track)?;
                (recorder, Place { done: 0, next_frame: 1, seconds: 0.0, windows })
            }
        };
        let (begun, whole) = share(&cadence, &recorder, &place);
        let progress =
            Progress::start("running", whole as f64, run.verbosity).resumed(begun as f64, place.seconds);
        Ok(TimeLoop {
            run,
            grains,
            settled,
            cadence,
            track,
            flow,
            recorder,
            place,
            progress,
            shortened: false,
        })
    }

    fn time(&self, done: u64) -> f64 {
        let (time, end) = (done as f64 * self.cadence.window, self.run.job.end);
        let ends = done == self.place.windows && (self.shortened || (time - end).abs() < 1e-9 * end);
        if ends { end } else { time }
    }

    fn window<S: System>(&mut self, system: &mut S) -> Result<(), Failure> {
        let k = self.place.done + 1;
        if k == self.place.windows {
            self.shortened = system.shorten(self.run.job.end - self.time(k - 1));
        }
        let (time, track) = (self.time(k), &mut self.track);
        track.begin_window();
        let companion = self.run.accompanied.0.as_deref();
        let mut apply = |t: f64, model: &dem::Model, state: &dem::State, out: &mut Vec<dem::AppliedForce>| {
            track.apply(t, model, state, out);
            companion.iter().for_each(|c| c.push(model, state, out));
        };
        match system.advance(&mut apply) {
            // An aborted step leaves the previous state.
            Err(Failure::Interrupted(_)) => {
                return self.keep(self.time(self.place.done), system);
            }
            outcome => outcome?,
        }
        track.follow(time, system);
        if let Some(flow) = &mut self.flow {
            flow.follow(k, time, system).map_err(|e| e.at(time))?;
        }
        if let Some(cycle) = self.recorder.follow(time, system, &self.track)? {
            self.after_cycle(&cycle, k, time);
        }
        let [row, check] = [self.cadence.every, self.cadence.checked]
            .map(|n| k.is_multiple_of(n) || k == self.place.windows);
        if row || check {
            self.recorder.measure(system, &self.track);
        }
        if row {
            if self.cadence.reads_solid {
                system.recover();
            }
            self.row(time, system).map_err(|e| e.at(time))?;
        }
        if check {
            self.recorder.check().map_err(|e| e.at(time))?;
        }
        self.place.done = k;
        let (reached, whole) = share(&self.cadence, &self.recorder, &self.place);
        let next = self.cadence.frame_after(self.place.next_frame, reached, whole);
        let frame = next.is_some() || self.cadence.has_extra_frame(k);
        if frame || k == self.place.windows {
            system.recover();
            system.examine().map_err(|e| e.at(time))?;
        }
        if frame {
            self.recorder.frame(time, system, &self.track).map_err(|e| e.at(time))?;
            self.place.next_frame = next.unwrap_or(self.place.next_frame);
        }
        if let Some(text) = system.progress() {
            self.progress.message(text);
        }
        self.progress.at(reached as f64, || details(system, time, k, self.run.verbosity));
        self.show(system)?;
        if k == self.place.windows { Ok(()) } else { self.keep(time, system) }
    }

    fn show<S: System>(&self, system: &mut S) -> Result<(), Failure> {
        let Some(companion) = &self.run.accompanied.0 else { return Ok(()) };
        let Place { done, windows, .. } = self.place;
        if !companion.is_due(self.time(done), done, windows) {
            return Ok(());
        }
        system.recover();
        companion.follow(&Shown {
            time: self.time(done),
            done,
            windows,
            grains: system.grains(),
            solid: system.solid(),
            stored: system.stored(),
            spent: system.spent(),
        })
    }

    fn after_cycle(&mut self, cycle: &Cycle, k: u64, time: f64) {
        let settlement = 1e3 * cycle.settlement;
        self.progress.message(format!("cycle {}: {settlement:.3} mm", cycle.number));
        if self.recorder.progress().is_some_and(|(number, total)| number >= total) {
            self.track.end_cycles(time);
            if self.cadence.jumps {
                self.place.windows = (k + self.cadence.tail).min(self.place.windows);
            }
        }
    }

    fn row<S: System>(&mut self, time: f64, system: &S) -> Result<(), Failure> {
        self.recorder.row(time, system, &self.track, self.flow.as_ref())
    }

    fn keep<S: System>(&self, time: f64, system: &S) -> Result<(), Failure> {
        let place = Place { seconds: self.progress.seconds(), ..self.place };
        self.run.checkpoints.step(
            || Moment { stage: RUN.into(), step: place.done, time },
            |body| {
                // In reading order of a resumed run.
                if let Some(settled) = self.settled {
                    body.put(settled)?;
                }
                system.save(body)?;
                if let Some((_, start)) = &self.grains {
                    body.put(start)?;
                }
                body.put(&place)?;
                body.put(self.track.state())?;
                if let Some(flow) = &self.flow {
                    flow.save(body)?;
                }
                self.recorder.save(body)
            },
        )
    }

    fn keep_end<S: System>(&self, system: &S) -> Result<(), Failure> {
        if self.grains.is_none() || !self.run.job.output.state {
            return Ok(());
        }
        let done = self.place.done;
        let moment = Moment { stage: END.into(), step: done, time: self.time(done) };
        self.run.checkpoints.save_file(&self.run.dir.join(from::FILE), moment, |body| {
            body.put(&self.settled.map(Settled::places))?;
            system.save_end(body)
        })
    }

    /// `failed`: a step had no solution.
    fn finish<S: System>(mut self, system: &S, failed: bool, summary: &mut Summary) -> Result<(), Failure> {
        // The last converged state.
        if failed
            && system.keeps_its_state()
            && let Some(time) = system.solid().map(|s| s.state.time)
        {
            self.recorder.measure(system, &self.track);
            self.row(time, system)?;
            self.recorder.frame(time, system, &self.track)?;
        }
        let (part, dir) = (self.grains.map(|(part, _)| part), self.run.dir);
        if let (Some(part), Some(view)) = (part, system.grains())
            && !part.bonds.is_empty()
        {
            bond_output::write_breaks(dir, view.state)?;
            let events = events::record(dir, view.state.breaks(), part.events)?;
            summary.bonds = Some(BondSummary { events, ..bond_output::summary(view) });
        }
        summary.structures = self.recorder.loads();
        summary.floating = self.recorder.floating().to_vec();
        let done = self.place.done;
        let (grain_steps, solid_steps) = system.steps_done(done);
        let end = self.time(done);
        let seconds = self.progress.finish(&format!("{end:.3} s simulated"));
        summary.stages.push(StageRecord {
            name: "run".into(),
            seconds,
            grain_steps,
            solid_steps,
            windows: done,
        });
        if let Some(view) = system.grains().filter(|v| v.model.measured().is_some() && grain_steps > 0) {
            summary.model.grain_step = Some(view.state.time / grain_steps as f64);
            summary.model.grain_step_limit = view.state.measured_limit().or(summary.model.grain_step_limit);
        }
        summary.track.push = track_output::push(&self.track, dir)?;
        if let (Some(flow), Some(view)) = (&self.flow, system.grains()) {
            let (record, warnings) = flow.finish(end, view);
            summary.warnings.extend(warnings);
            summary.bed.flow = Some(record);
        }
        summary.track.settlement = settlement(self.recorder.cycles(), part, &self.recorder);
        summary.track.sleepers = self.track.record();
        summary.warnings.extend(summary.track.sleepers.iter().flat_map(|t| t.warnings()));
        summary.energy = Some(energy(&self.recorder));
        summary.validity.extend(summary.track.sleepers.as_ref().and_then(|t| free_sleeper(t, end)));
        summary.validity.extend(validity_of(system, part, &self.recorder));
        if let (Some(part), Some(view)) = (part, system.grains()) {
            summary.loads = applied_loads(part, view, &self.track, end);
            summary.validity.extend(load_error(&summary.loads));
        }
        let stages = self.settled.map_or(&[][..], |settled| &settled.energy);
        let balance = self.recorder.balance();
        summary.validity.extend(StageEnergy::check_changes(
            stages,
            [balance.start.contact_springs, balance.reference_energy().max(balance.negligible_energy())],
        ));
        summary.bed.specimen = self.recorder.specimen(system)?;
        if let (Some(part), Some(view), false) = (part, system.grains(), failed) {
            summary.bed.runout = runout::record(dir, view, part, self.recorder.passage())?;
        }
        summary.solid.plastic = system.solid().and_then(PlasticRecord::of);
        self.recorder.end()?;
        self.recorder.plot_settlement()
    }
}

/// Cycles if some are jumped over, else windows.
fn share(cadence: &Cadence, recorder: &Results<'_>, place: &Place) -> (u64, u64) {
    match recorder.progress() {
        Some((number, total)) if cadence.jumps => (u64::from(number), u64::from(total)),
        _ => (place.done, place.windows),
    }
}

fn energy(recorder: &Results<'_>) -> EnergyRecord {
    let balance = recorder.balance();
    let watch = recorder.energy_watch();
    EnergyRecord {
        start: balance.start,
        end: balance.now,
        flows: balance.spent,
        error: balance.error(),
        work: balance.spent.work(),
        reference_energy: balance.reference_energy(),
        relative_error: watch.now(),
        largest_error: recorder.largest_error(),
        largest_relative_error: watch.worst(),
    }
}

/// Cyclic stiffness, cycle jumps, kinetic energy with mass scaling, bond rotation.
fn validity_of<S: System>(system: &S, grains: Option<&GrainsPart>, recorder: &Results<'_>) -> Vec<Check> {
    let secants: Vec<f64> = recorder.cycles().iter().map(|c| c.secant_stiffness).collect();
    let scaled = grains.filter(|g| g.steps.mass_factor > 1.0).zip(system.grains());
    let inertia = scaled.map(|(g, view)| {
        let (kinetic, reference) = (recorder.largest_kinetic(), recorder.balance().reference_energy());
        scaled_inertia(g.steps.mass_factor, kinetic, reference, Fall::of(view))
    });
    let bonds = system.grains().and_then(bond_rotation);
    let jumps = recorder.jumps().as_ref().map(jump_error);
    stiffness_drift(&secants).into_iter().chain(jumps).chain(inertia).chain(bonds).collect()
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
    // Cycles that never span both loads.
    let between = grains.and_then(|g| g.track.after.between).filter(|_| last.iter().any(|k| *k > 0.0));
    let bed_stiffness = between.map(|between| BedStiffness {
        between,
        last: last[last.len() - 1],
        mean_of_last_ten: mean(&last),
    });
    let (fits, jump) = (recorder.fits(), recorder.jumps());
    let seated = grains.and_then(|g| g.track.load.as_ref()).is_some_and(|l| l.seating.is_some());
    let seating = seated.then(|| recorder.seating());
    Some(SettlementRecord { seating, per_cycle, increments, slowing, fits, bed_stiffness, jump })
}

fn details<S: System>(system: &S, time: f64, k: u64, verbosity: Verbosity) -> String {
    let time = if time < 1e-3 { format!("t = {time:.4e} s") } else { format!("t = {time:.4} s") };
    if verbosity < Verbosity::Verbose {
        return time;
    }
    let (grain_steps, solid_steps) = system.steps_done(k);
    let mut parts = vec![time];
    if let Some(grains) = system.grains() {
        parts.push(format!("{grain_steps} DEM steps"));
        parts.push(format!("{} contacts", dem::measure::contacts(grains.model, grains.state).len()));
    }
    if system.solid().is_some() {
        parts.push(format!("{solid_steps} FEM steps"));
    }
    parts.join(", ")
}
