//! What a run leaves while it goes: `history.csv`, `cycles.csv`, frames for ParaView and Tecplot, and at the end the
//! settlement curve.

mod columns;
mod cycle_file;
mod histories;
mod plots;

use super::checkpoint::{Body, Loaded};
use super::energy_watch::EnergyWatch;
use super::flow::Flow;
use super::folder;
use super::frames::{self, Shown};
use super::recorder::Now;
use super::specimen::{self, SpecimenRecord};
use super::structures;
use super::summary::LoadRecord;
use super::system::System;
use super::track_output;
use crate::failure::Failure;
use crate::model::Job;
use crate::write::csv::{Column, History, Mark, Row};
use crate::write::{self, WallFrame, WriteError, Writers};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};
use trackbed_coupling::ledger::Balance;
use trackbed_coupling::track::cycles::{Cycle, CycleRecorder};
use trackbed_coupling::track::jump::{JumpSummary, Jumper};
use trackbed_coupling::track::{Track, settlement};

/// The files of one run.
pub struct Results<'a> {
    job: &'a Job,
    dir: PathBuf,
    writers: Writers,
    history: History,
    /// Columns of the history, where structures have some.
    columns: Vec<Column>,
    cycles_file: Option<History>,
    course: Course,
}

/// What the results need to know of the run so far: with the marks of the files all that a checkpoint has of them.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Course {
    /// Number of the next frame.
    frame: usize,
    cycles: Option<CycleRecorder>,
    jumper: Option<Jumper>,
    /// Energy that cycle jumps brought in [J].
    jump_energy: f64,
    /// Energy error just before a jump whose energy is not known before the next window [J].
    before_jump: Option<f64>,
    balance: Balance,
    /// Largest |energy error| at any row [J], and how the account stands to what was turned over.
    largest_error: f64,
    watch: EnergyWatch,
    /// Settlement of each sleeper since the run began against time, for the plot.
    settlement: Vec<Vec<[f64; 2]>>,
    /// Stress and strain of a specimen.
    specimen: Vec<specimen::Point>,
    first_heights: Vec<f64>,
    /// Loads on structures.
    #[serde(default)]
    loads: Vec<LoadRecord>,
    /// Largest kinetic energy of the grains at any check [J].
    #[serde(default)]
    largest_kinetic: f64,
}

/// How far the files have come.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Marks {
    history: Mark,
    cycles: Option<Mark>,
    writers: Vec<write::Mark>,
}

impl<'a> Results<'a> {
    /// Starts the files of a run in `dir`.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn start<S: System>(
        job: &'a Job,
        dir: &Path,
        system: &S,
        track: &Track<'_>,
        flow: Option<&Flow<'_>>,
    ) -> Result<Self, Failure> {
        let load = job.grains.as_ref().and_then(|g| g.track.load.as_ref());
        let stored = system.stored();
        let course = Course {
            cycles: load.map(|load| cycle_file::recorder(job, system, load)),
            jumper: job.grains.as_ref().and_then(|g| g.track.after.jump.as_ref()).map(Jumper::new),
            balance: Balance { start: stored, now: stored, spent: system.spent(), ..Balance::default() },
            ..Course::default()
        };
        let now = Now { time: 0.0, system, job, track, flow, balance: &course.balance };
        let columns = columns::columns(&now);
        let history = History::create(&dir.join("history.csv"), columns.clone())?;
        let columns = of_structures(job, columns);
        let cycles_file =
            load.map(|_| History::create(&dir.join("cycles.csv"), cycle_file::columns(job))).transpose()?;
        let writers = Writers::begin(dir, &job.output.formats)?.only(&job.output.fields);
        Ok(Results { job, dir: dir.to_path_buf(), writers, history, columns, cycles_file, course })
    }

    /// Resumes the files of a run in `dir` where a checkpoint has them; what was written later is removed.
    ///
    /// # Errors
    /// Files that are not those of the run that the checkpoint is of; the folder cannot be written.
    pub fn resume<S: System>(
        job: &'a Job,
        dir: &Path,
        system: &S,
        track: &Track<'_>,
        flow: Option<&Flow<'_>>,
        loaded: &mut Loaded,
    ) -> Result<Self, Failure> {
        let unfit = |e: WriteError| Failure::Input(format!("--resume: {e}"));
        let marks: Marks = loaded.take()?;
        let course: Course = loaded.take()?;
        let now = Now { time: 0.0, system, job, track, flow, balance: &course.balance };
        let file = dir.join("history.csv");
        let columns = columns::columns(&now);
        let history = History::resume(&file, columns.clone(), marks.history).map_err(unfit)?;
        let columns = of_structures(job, columns);
        let cycles_file = marks
            .cycles
            .map(|mark| History::resume(&dir.join("cycles.csv"), cycle_file::columns(job), mark))
            .transpose()
            .map_err(unfit)?;
        let writers = Writers::resume(dir, &job.output.formats, &marks.writers).map_err(unfit)?;
        let writers = writers.only(&job.output.fields);
        folder::remove_later_frames(dir, course.frame)?;
        Ok(Results { job, dir: dir.to_path_buf(), writers, history, columns, cycles_file, course })
    }

    /// Puts into a checkpoint what [`Results::resume`] goes on from. The rows written are on the disk then.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        let mark = |history: &History| history.mark().map_err(io::Error::other);
        body.put(&Marks {
            history: mark(&self.history)?,
            cycles: self.cycles_file.as_ref().map(mark).transpose()?,
            writers: self.writers.marks(),
        })?;
        body.put(&self.course)
    }

    /// Brings the energy balance to the present state: before a row, and before a check.
    pub fn measure<S: System>(&mut self, system: &S, track: &Track<'_>) {
        self.course.take(system, track);
    }

    /// Checks the energy balance.
    ///
    /// # Errors
    /// The balance does not close.
    pub fn check(&mut self) -> Result<(), Failure> {
        let course = &mut self.course;
        course.largest_kinetic = course.largest_kinetic.max(course.balance.now.grains_kinetic);
        course.largest_error = course.largest_error.max(course.balance.error().abs());
        course.watch.follow(&course.balance)
    }

    /// Adds a row to the history.
    ///
    /// # Errors
    /// A value is not finite, or the disk refuses.
    pub fn row<S: System>(
        &mut self,
        time: f64,
        system: &S,
        track: &Track<'_>,
        flow: Option<&Flow<'_>>,
    ) -> Result<(), Failure> {
        let course = &mut self.course;
        course.settle(time, system, track);
        let plan = self.job.grains.as_ref().and_then(|g| g.specimen.as_ref());
        if let Some((plan, view)) = plan.zip(system.grains()) {
            course.specimen.push(specimen::point(plan, view, time));
        }
        let now = Now { time, system, job: self.job, track, flow, balance: &course.balance };
        let values = columns::values(&now);
        self.history.row(&values)?;
        structures::follow(&self.columns, &values, &mut self.course.loads);
        Ok(())
    }

    /// Follows the load cycles; call after every window.
    ///
    /// # Errors
    /// A value is not finite, or the disk refuses.
    pub fn follow<S: System>(
        &mut self,
        time: f64,
        system: &mut S,
        track: &Track<'_>,
    ) -> Result<Option<Cycle>, Failure> {
        // All that the window after a jump does not account for came in with the jump.
        if let Some(before) = self.course.before_jump.take() {
            self.course.jump_energy += self.energy_error(system) - before;
        }
        let sleeper = track.observed().and_then(|k| track.sleeper(k, time, system));
        let (Some(cycles), Some(s)) = (&mut self.course.cycles, sleeper) else { return Ok(None) };
        let (work, pressure) = (system.seat_work(), system.peak_pressure());
        let Some(cycle) = cycles.record(time, system.window(), s.height, s.load, work, pressure) else {
            return Ok(None);
        };
        if let Some(file) = &mut self.cycles_file {
            let broken = system.grains().map_or((0, 0), |g| g.state.broken_bonds());
            file.row(&Row::values_of(|row| cycle_file::record(self.job, &cycle, broken, row)))?;
        }
        if let Some(plan) = self.job.grains.as_ref().and_then(|g| g.track.after.jump.as_ref()) {
            let error = if plan.grains { self.energy_error(system) } else { 0.0 };
            let course = &mut self.course;
            if let (Some(jumper), Some(cycles)) = (&mut course.jumper, &mut course.cycles)
                && jumper.after_cycle(plan, cycles, system)
            {
                course.before_jump = Some(error);
            }
        }
        Ok(Some(cycle))
    }

    /// Energy error of the present state [J].
    fn energy_error<S: System>(&self, system: &S) -> f64 {
        let mut spent = system.spent();
        spent.jumps = self.course.jump_energy;
        Balance { start: self.course.balance.start, now: system.stored(), spent, ..Balance::default() }
            .error()
    }

    /// Number of the last finished cycle and of all cycles; none without a cyclic load.
    pub fn progress(&self) -> Option<(u32, u32)> {
        self.course.cycles.as_ref().map(|c| (c.number(), c.total()))
    }

    /// Settlement by the pulses that seat the sleeper [m].
    pub fn seating(&self) -> f64 {
        self.course.cycles.as_ref().map_or(0.0, CycleRecorder::seating)
    }

    /// Settlement laws fitted to the cycles.
    pub fn fits(&self) -> Vec<settlement::Fit> {
        let load = self.job.grains.as_ref().and_then(|g| g.track.load.as_ref());
        match (&self.course.cycles, load) {
            (Some(cycles), Some(load)) => settlement::fits(&cycles.measured, load.range()[1]),
            _ => Vec::new(),
        }
    }

    /// What became of the cycle jumps.
    pub fn jumps(&self) -> Option<JumpSummary> {
        let plan = self.job.grains.as_ref()?.track.after.jump.as_ref()?;
        let course = &self.course;
        Some(course.jumper.as_ref()?.summary(plan, course.cycles.as_ref()?, course.jump_energy))
    }

    /// Writes a frame of the animation.
    ///
    /// # Errors
    /// A field is not finite, or the disk refuses.
    pub fn frame<S: System>(&mut self, time: f64, system: &S, track: &Track<'_>) -> Result<(), Failure> {
        let draw: &dyn Fn(&mut WallFrame) = &|walls| track_output::draw(track, walls);
        let grains = system.grains().zip(self.job.grains.as_ref()).map(|(view, part)| Shown {
            view,
            part,
            strong_only: self.job.output.strong_chains,
            extra: &self.job.output.extra,
            draw,
        });
        let solid = (system.solid(), self.job.output.tensors.as_slice());
        frames::write(&mut self.writers, (self.course.frame, time), solid, grains)?;
        self.course.frame += 1;
        Ok(())
    }

    /// Ends the files of the frames.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn end(&mut self) -> Result<(), Failure> {
        Ok(self.writers.end()?)
    }

    /// Energy account as of the last row.
    pub fn balance(&self) -> &Balance {
        &self.course.balance
    }

    /// Largest |energy error| at any row [J].
    pub fn largest_error(&self) -> f64 {
        self.course.largest_error
    }

    /// Largest kinetic energy of the grains at any check [J].
    pub fn largest_kinetic(&self) -> f64 {
        self.course.largest_kinetic
    }

    /// How the energy account stands to what was turned over.
    pub fn energy_watch(&self) -> &EnergyWatch {
        &self.course.watch
    }

    /// Constants of the specimen, and its curve as a plot.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn specimen<S: System>(&self, system: &S) -> Result<Option<SpecimenRecord>, Failure> {
        let plan = self.job.grains.as_ref().and_then(|g| g.specimen.as_ref());
        let Some((plan, view)) = plan.zip(system.grains()) else { return Ok(None) };
        self.plot_specimen(plan.brazilian)?;
        Ok(specimen::record(plan, &self.course.specimen, view))
    }

    /// Loads on structures.
    pub fn loads(&self) -> &[LoadRecord] {
        &self.course.loads
    }

    /// Finished load cycles.
    pub fn cycles(&self) -> &[Cycle] {
        self.course.cycles.as_ref().map_or(&[], |c| &c.done)
    }
}

/// The columns, where any are of structures.
fn of_structures(job: &Job, columns: Vec<Column>) -> Vec<Column> {
    let there = job.grains.as_ref().is_some_and(|part| !part.structures.is_empty());
    if there { columns } else { Vec::new() }
}

impl Course {
    /// Brings the balance to the present state.
    fn take<S: System>(&mut self, system: &S, track: &Track<'_>) {
        let balance = &mut self.balance;
        balance.now = system.stored();
        balance.spent = system.spent();
        balance.spent.jumps = self.jump_energy;
        balance.reference = system.reference_energy();
        track.account(&mut balance.now, &mut balance.spent);
    }

    /// Takes the heights of the sleepers into the settlement curves.
    fn settle<S: System>(&mut self, time: f64, system: &S, track: &Track<'_>) {
        for (k, s) in (0..track.count()).filter_map(|k| Some((k, track.sleeper(k, time, system)?))) {
            if self.first_heights.len() == k {
                self.first_heights.push(s.height);
                self.settlement.push(Vec::new());
            }
            self.settlement[k].push([time, 1e3 * (self.first_heights[k] - s.height)]);
        }
    }
}
