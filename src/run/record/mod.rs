//! Output during a run.

mod columns;
mod cycle_file;
mod histories;
mod plots;
mod solid_probes;

use super::checkpoint::{Body, Loaded};
use super::energy_watch::EnergyWatch;
use super::flow::Flow;
use super::folder;
use super::frames::{self, Shown};
use super::recorder::Now;
use super::runout::Passage;
use super::specimen::{self, SpecimenRecord};
use super::structures;
use super::summary::{FloatingRecord, LoadRecord};
use super::system::System;
use super::track_output;
use super::wall_output;
use serde::{Deserialize, Serialize};
use solid_probes::CycleStresses;
use std::io;
use std::path::{Path, PathBuf};
use trackbed_coupling::energy_balance::EnergyBalance;
use trackbed_input::model::Job;
use trackbed_input::model::grains::StructurePlan;
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Column, History, Mark, Row};
use trackbed_io::write::{self, WallFrame, WriteError, Writers};
use trackbed_track::cycle_jump::{CycleJumper, JumpSummary};
use trackbed_track::cycles::{Cycle, CycleRecorder};
use trackbed_track::{Track, settlement};

/// Output files of a run.
pub struct Results<'a> {
    job: &'a Job,
    dir: PathBuf,
    writers: Writers,
    history: History,
    columns: Vec<Column>,
    cycles_file: Option<History>,
    /// Of probes, if there are cycles.
    stresses: Vec<Column>,
    course: Course,
}

/// Saved in checkpoints with file positions.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Course {
    frame: usize,
    cycles: Option<CycleRecorder>,
    jumper: Option<CycleJumper>,
    jump_energy: f64,
    /// Energy error before a jump, whose energy follows from the next window [J].
    before_jump: Option<f64>,
    balance: EnergyBalance,
    largest_error: f64,
    watch: EnergyWatch,
    settlement: Vec<Vec<[f64; 2]>>,
    specimen: Vec<specimen::Point>,
    first_heights: Vec<f64>,
    #[serde(default)]
    loads: Vec<LoadRecord>,
    /// Time and horizontal load by structure, if the scene has statistics.
    #[serde(default)]
    load_rows: Vec<Vec<[f64; 2]>>,
    #[serde(default)]
    largest_kinetic: f64,
    #[serde(default)]
    cycle_stresses: CycleStresses,
    passage: Option<Passage>,
    floating: Vec<FloatingRecord>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Marks {
    history: Mark,
    cycles: Option<Mark>,
    writers: Vec<write::Mark>,
}

impl<'a> Results<'a> {
    /// Creates the output files in `dir`.
    ///
    /// # Errors
    /// I/O errors.
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
            jumper: job.grains.as_ref().and_then(|g| g.track.after.jump.as_ref()).map(CycleJumper::new),
            balance: EnergyBalance {
                start: stored,
                now: stored,
                spent: system.spent(),
                ..EnergyBalance::default()
            },
            ..Course::default()
        };
        let now = Now { time: 0.0, system, job, track, flow, balance: &course.balance };
        let columns = columns::columns(&now);
        let history = History::create(&dir.join("history.csv"), columns.clone())?;
        let columns = of_structures(job, columns);
        let stresses = stresses(job, system);
        let cycles_file = load
            .map(|_| History::create(&dir.join("cycles.csv"), cycle_file::columns(job, &stresses)))
            .transpose()?;
        let writers = Writers::begin(dir, &job.output.formats)?.only(&job.output.fields);
        let dir = dir.to_path_buf();
        Ok(Results { job, dir, writers, history, columns, cycles_file, stresses, course })
    }

    /// Resumes output and truncates later rows.
    ///
    /// # Errors
    /// Files of another run; I/O errors.
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
        let stresses = stresses(job, system);
        let cycles_file = marks
            .cycles
            .map(|mark| History::resume(&dir.join("cycles.csv"), cycle_file::columns(job, &stresses), mark))
            .transpose()
            .map_err(unfit)?;
        let writers = Writers::resume(dir, &job.output.formats, &marks.writers).map_err(unfit)?;
        let writers = writers.only(&job.output.fields);
        folder::remove_later_frames(dir, course.frame)?;
        let dir = dir.to_path_buf();
        Ok(Results { job, dir, writers, history, columns, cycles_file, stresses, course })
    }

    /// Saves the state after flushing rows.
    ///
    /// # Errors
    /// I/O errors.
    pub fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        let mark = |history: &History| history.mark().map_err(io::Error::other);
        body.put(&Marks {
            history: mark(&self.history)?,
            cycles: self.cycles_file.as_ref().map(mark).transpose()?,
            writers: self.writers.marks(),
        })?;
        body.put(&self.course)
    }

    /// Updates the energy balance.
    pub fn measure<S: System>(&mut self, system: &S, track: &Track<'_>) {
        self.course.take(system, track);
    }

    /// Checks the energy balance.
    ///
    /// # Errors
    /// Energy error above its limit.
    pub fn check(&mut self) -> Result<(), Failure> {
        let course = &mut self.course;
        course.largest_kinetic = course.largest_kinetic.max(course.balance.now.grains_kinetic);
        course.largest_error = course.largest_error.max(course.balance.error().abs());
        course.watch.follow(&course.balance)
    }

    /// Adds a history row.
    ///
    /// # Errors
    /// Non-finite values; I/O errors.
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
        let plan = self.job.grains.as_ref().and_then(|g| g.runout.as_ref()).filter(|plan| plan.passage);
        if let Some((plan, view)) = plan.zip(system.grains())
            && let Some(cell) = plan.cell
        {
            course.passage.get_or_insert_default().follow(view, plan, cell);
        }
        let now = Now { time, system, job: self.job, track, flow, balance: &course.balance };
        let values = columns::values(&now);
        self.history.row(&values)?;
        structures::follow(&self.columns, &values, &mut self.course.loads);
        if let (Some(part), Some(view)) = (&self.job.grains, system.grains()) {
            wall_output::follow(part, view, &mut self.course.floating);
        }
        structures::follow_loads(&self.columns, &values, structures_of(self.job), &mut self.course.load_rows);
        Ok(())
    }

    /// Follows load cycles.
    ///
    /// # Errors
    /// Non-finite values; I/O errors.
    pub fn follow<S: System>(
        &mut self,
        time: f64,
        system: &mut S,
        track: &Track<'_>,
    ) -> Result<Option<Cycle>, Failure> {
        // The error of this window is energy of the jump.
        if let Some(before) = self.course.before_jump.take() {
            self.course.jump_energy += self.energy_error(system) - before;
        }
        let sleeper = track.observed().and_then(|k| track.sleeper(k, time, system));
        let (Some(cycles), Some(s)) = (&mut self.course.cycles, sleeper) else { return Ok(None) };
        if !self.stresses.is_empty() && cycles.counts(time, system.window()) {
            system.recover();
        }
        if let Some(view) = system.solid()
            && !self.stresses.is_empty()
            && cycles.counts(time, system.window())
        {
            self.course.cycle_stresses.add(self.job, view);
        }
        let (work, pressure) = (system.seat_work(), system.peak_pressure());
        let Some(cycle) = cycles.record(time, system.window(), s.height, s.load, work, pressure) else {
            return Ok(None);
        };
        let stresses = std::mem::take(&mut self.course.cycle_stresses);
        if let Some(file) = &mut self.cycles_file {
            let broken = system.grains().map_or((0, 0), |g| g.state.broken_bonds());
            file.row(&Row::values_of(|row| {
                cycle_file::record(self.job, &cycle, broken, row);
                stresses.record(&self.stresses, row);
            }))?;
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

    fn energy_error<S: System>(&self, system: &S) -> f64 {
        let mut spent = system.spent();
        spent.jumps = self.course.jump_energy;
        EnergyBalance {
            start: self.course.balance.start,
            now: system.stored(),
            spent,
            ..EnergyBalance::default()
        }
        .error()
    }

    /// Returns completed and total cycles; none without cyclic load.
    pub fn progress(&self) -> Option<(u32, u32)> {
        self.course.cycles.as_ref().map(|c| (c.number(), c.total()))
    }

    /// Returns the seating settlement [m].
    pub fn seating(&self) -> f64 {
        self.course.cycles.as_ref().map_or(0.0, CycleRecorder::seating)
    }

    /// Fits settlement laws to the cycles.
    pub fn fits(&self) -> Vec<settlement::Fit> {
        let load = self.job.grains.as_ref().and_then(|g| g.track.load.as_ref());
        match (&self.course.cycles, load) {
            (Some(cycles), Some(load)) => settlement::fits(&cycles.measured, load.range()[1]),
            _ => Vec::new(),
        }
    }

    /// Summarises cycle jumps.
    pub fn jumps(&self) -> Option<JumpSummary> {
        let plan = self.job.grains.as_ref()?.track.after.jump.as_ref()?;
        let course = &self.course;
        Some(course.jumper.as_ref()?.summary(plan, course.cycles.as_ref()?, course.jump_energy))
    }

    /// Writes a frame.
    ///
    /// # Errors
    /// Non-finite fields; I/O errors.
    pub fn frame<S: System>(&mut self, time: f64, system: &S, track: &Track<'_>) -> Result<(), Failure> {
        let draw: &dyn Fn(&mut WallFrame) = &|walls| track_output::draw(track, walls);
        let grains = system.grains().zip(self.job.grains.as_ref()).map(|(view, part)| Shown {
            view,
            part,
            strong_only: self.job.output.strong_chains,
            extra: &self.job.output.extra,
            draw,
        });
        let solid = (system.solid(), self.job.output.solid_extra.as_slice());
        frames::write(&mut self.writers, (self.course.frame, time), solid, grains)?;
        self.course.frame += 1;
        Ok(())
    }

    /// Cells that grains passed.
    pub fn passage(&self) -> Option<&Passage> {
        self.course.passage.as_ref()
    }

    /// Closes the frame files.
    ///
    /// # Errors
    /// I/O errors.
    pub fn end(&mut self) -> Result<(), Failure> {
        Ok(self.writers.end()?)
    }

    /// Energy balance of the last row.
    pub fn balance(&self) -> &EnergyBalance {
        &self.course.balance
    }

    /// Largest |energy error| at any row [J].
    pub fn largest_error(&self) -> f64 {
        self.course.largest_error
    }

    /// Largest kinetic energy of grains at any check [J].
    pub fn largest_kinetic(&self) -> f64 {
        self.course.largest_kinetic
    }

    /// Relative energy error.
    pub fn energy_watch(&self) -> &EnergyWatch {
        &self.course.watch
    }

    /// Evaluates and plots the specimen.
    ///
    /// # Errors
    /// I/O errors.
    pub fn specimen<S: System>(&self, system: &S) -> Result<Option<SpecimenRecord>, Failure> {
        let plan = self.job.grains.as_ref().and_then(|g| g.specimen.as_ref());
        let Some((plan, view)) = plan.zip(system.grains()) else { return Ok(None) };
        self.plot_specimen(plan.brazilian)?;
        Ok(specimen::record(plan, &self.course.specimen, view))
    }

    /// Loads on structures, with their statistics.
    pub fn loads(&self) -> Vec<LoadRecord> {
        structures::with_hazards(&self.course.loads, structures_of(self.job), &self.course.load_rows)
    }

    /// Floating walls.
    pub fn floating(&self) -> &[FloatingRecord] {
        &self.course.floating
    }

    /// Completed load cycles.
    pub fn cycles(&self) -> &[Cycle] {
        self.course.cycles.as_ref().map_or(&[], |c| &c.done)
    }
}

/// Columns of probes whose stresses are followed over load cycles.
fn stresses<S: System>(job: &Job, system: &S) -> Vec<Column> {
    let cycles = job.grains.as_ref().is_some_and(|g| g.track.load.is_some());
    solid_probes::stress_columns(job, system.solid().filter(|_| cycles))
}

fn of_structures(job: &Job, columns: Vec<Column>) -> Vec<Column> {
    if structures_of(job).is_empty() { Vec::new() } else { columns }
}

fn structures_of(job: &Job) -> &[StructurePlan] {
    job.grains.as_ref().map_or(&[], |part| &part.structures)
}

impl Course {
    fn take<S: System>(&mut self, system: &S, track: &Track<'_>) {
        let balance = &mut self.balance;
        balance.now = system.stored();
        balance.spent = system.spent();
        balance.spent.jumps = self.jump_energy;
        balance.reference = system.reference_energy();
        let rail = track.rail_energy();
        balance.now.rail += rail.kinetic + rail.elastic;
        balance.spent.wheels += rail.wheels;
        balance.spent.pads_on_sleepers += rail.on_seats;
        balance.spent.pads += rail.pads;
        balance.spent.far_field_track += rail.beyond;
    }

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
