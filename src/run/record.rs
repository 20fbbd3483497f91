//! What a run leaves while it goes: `history.csv`, `cycles.csv`, frames for ParaView and Tecplot, and at the end the
//! settlement curve.

use super::bond_output;
use super::checkpoint::{Body, Loaded};
use super::flow::Flow;
use super::frames;
use super::system::System;
use super::track_output;
use super::wall_output;
use crate::failure::Failure;
use crate::model::Job;
use crate::write;
use crate::write::csv::{Column, History, Mark};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::{fs, io};
use trackbed_coupling::ledger::Balance;
use trackbed_coupling::track::cycles::{BedColumn, Cycle, CycleRecorder};
use trackbed_coupling::track::jump::{JumpSummary, Jumper};
use trackbed_coupling::track::{CyclicLoad, Track, settlement};

/// The files of one run.
pub struct Recorder<'a> {
    job: &'a Job,
    dir: PathBuf,
    series: write::pvd::Series,
    history: History,
    cycles_file: Option<History>,
    course: Course,
}

/// What a recorder has learnt by now: with the marks of its files all that a checkpoint needs of it.
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
    /// Largest |energy error| at any row [J].
    largest_error: f64,
    /// Settlement of each sleeper since the run began against time, for the plot.
    settlement: Vec<Vec<[f64; 2]>>,
    first_heights: Vec<f64>,
}

/// How far the files of a recorder have come.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Marks {
    history: Mark,
    cycles: Option<Mark>,
    series: usize,
}

impl<'a> Recorder<'a> {
    /// Starts the files of a run in `dir`; frames of an earlier run there are removed.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn start<S: System>(
        job: &'a Job,
        dir: &Path,
        system: &S,
        track: &Track<'_>,
    ) -> Result<Self, Failure> {
        let history = History::create(&dir.join("history.csv"), columns(job, system, track))?;
        let load = job.grains.as_ref().and_then(|g| g.load.as_ref());
        let cycles_file =
            load.map(|_| History::create(&dir.join("cycles.csv"), cycle_columns(job))).transpose()?;
        let stored = system.stored();
        let course = Course {
            cycles: load.map(|load| cycle_recorder(job, system, load)),
            jumper: job.grains.as_ref().and_then(|g| g.after.jump.as_ref()).map(Jumper::new),
            balance: Balance { start: stored, now: stored, spent: system.spent() },
            ..Course::default()
        };
        let series = write::pvd::Series::new(&dir.join("results.pvd"));
        Ok(Recorder { job, dir: dir.to_path_buf(), series, history, cycles_file, course })
    }

    /// Takes up the files of a run in `dir` where a checkpoint has them; what was written later is taken away.
    ///
    /// # Errors
    /// Files that are not those of the run that the checkpoint is of; the folder cannot be written.
    pub fn resume<S: System>(
        job: &'a Job,
        dir: &Path,
        system: &S,
        track: &Track<'_>,
        loaded: &mut Loaded,
    ) -> Result<Self, Failure> {
        let unfit = |e: write::WriteError| Failure::Input(format!("--resume: {e}"));
        let marks: Marks = loaded.take()?;
        let course: Course = loaded.take()?;
        let file = dir.join("history.csv");
        let history = History::resume(&file, columns(job, system, track), marks.history).map_err(unfit)?;
        let cycles_file = marks
            .cycles
            .map(|mark| History::resume(&dir.join("cycles.csv"), cycle_columns(job), mark))
            .transpose()
            .map_err(unfit)?;
        let series = write::pvd::Series::resume(&dir.join("results.pvd"), marks.series).map_err(unfit)?;
        let recorder = Recorder { job, dir: dir.to_path_buf(), series, history, cycles_file, course };
        recorder.remove_later_frames()?;
        if job.output.vtk {
            recorder.series.write()?;
        }
        Ok(recorder)
    }

    /// Puts into a checkpoint what [`Recorder::resume`] goes on from. The rows written are on the disk then.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        let mark = |history: &History| history.mark().map_err(io::Error::other);
        body.put(&Marks {
            history: mark(&self.history)?,
            cycles: self.cycles_file.as_ref().map(mark).transpose()?,
            series: self.series.entries(),
        })?;
        body.put(&self.course)
    }

    /// Removes the frames from the next one on.
    fn remove_later_frames(&self) -> Result<(), Failure> {
        let fail = |e: io::Error| Failure::Other(format!("{}: {e}", self.dir.display()));
        for folder in ["frames", "tecplot"].map(|sub| self.dir.join(sub)).iter().filter(|f| f.is_dir()) {
            for entry in fs::read_dir(folder).map_err(fail)? {
                let path = entry.map_err(fail)?.path();
                let number = path.file_stem().and_then(|s| s.to_str()).and_then(|s| s.rsplit_once('_'));
                let later =
                    number.and_then(|(_, n)| n.parse::<usize>().ok()).is_some_and(|n| n >= self.course.frame);
                if is_frame(&path) && later {
                    fs::remove_file(&path).map_err(fail)?;
                }
            }
        }
        Ok(())
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
        let mut row = vec![time];
        for (k, s) in (0..track.count()).filter_map(|k| Some((k, track.sleeper(k, time, system)?))) {
            row.push(s.load);
            row.extend(s.place);
            row.push(s.tilt);
            if let Some(meshed) = s.meshed {
                row.extend([meshed.moved.seats, meshed.moved.bend]);
                row.extend(meshed.contact);
            }
            let course = &mut self.course;
            if course.first_heights.len() == k {
                course.first_heights.push(s.height);
                course.settlement.push(Vec::new());
            }
            course.settlement[k].push([time, 1e3 * (course.first_heights[k] - s.height)]);
        }
        if system.grains().is_some() && system.solid().is_some() {
            row.extend(system.contact_force());
            row.push(system.peak_pressure());
        }
        let course = &mut self.course;
        course.balance.now = system.stored();
        course.balance.spent = system.spent();
        course.balance.spent.jumps = course.jump_energy;
        track.account(&mut course.balance.now, &mut course.balance.spent);
        let (now, spent) = (&course.balance.now, &course.balance.spent);
        let error = course.balance.error();
        course.largest_error = course.largest_error.max(error.abs());
        row.extend([
            now.grains_kinetic,
            now.contact_springs,
            now.grains_gravity,
            now.solid_kinetic,
            now.solid_strain,
            now.solid_gravity,
            spent.work(),
            spent.dashpot,
            spent.friction,
            spent.rayleigh + spent.absorbed + spent.plastic + spent.numerical,
            spent.interface(),
            error,
        ]);
        if track.has_rails() {
            (0..track.count()).for_each(|k| row.push(track.rail_deflection(k)));
            row.extend([now.rail, spent.wheels, spent.pads + spent.track_beyond]);
        }
        if let (Some(part), Some(view)) = (&self.job.grains, system.grains()) {
            bond_output::values(part, view, now, spent, &mut row);
        }
        if let Some(part) = &self.job.solid
            && !part.named_supports.is_empty()
            && let Some(reactions) = system.reactions()
        {
            part.named_sums(&reactions).for_each(|(_, force)| row.extend(force));
        }
        if let Some(solid) = system.solid() {
            for &(_, node) in &self.job.probes {
                row.extend_from_slice(&solid.state.u[3 * node..3 * node + 3]);
                row.extend_from_slice(&solid.state.v[3 * node..3 * node + 3]);
            }
        }
        if let (Some(part), Some(view)) = (&self.job.grains, system.grains()) {
            wall_output::values(part, view, &mut row);
        }
        if let (Some(flow), Some(view)) = (flow, system.grains()) {
            flow.values(view, &mut row);
        }
        self.history.row(&row)?;
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
            file.row(&cycle_values(self.job, &cycle))?;
        }
        if let Some(plan) = self.job.grains.as_ref().and_then(|g| g.after.jump.as_ref()) {
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
        Balance { start: self.course.balance.start, now: system.stored(), spent }.error()
    }

    /// Number of the last finished cycle and of all cycles; none without a cyclic load.
    pub fn progress(&self) -> Option<(u32, u32)> {
        self.course.cycles.as_ref().map(|c| (c.number(), c.total()))
    }

    /// Settlement laws fitted to the cycles.
    pub fn fits(&self) -> Vec<settlement::Fit> {
        let load = self.job.grains.as_ref().and_then(|g| g.load.as_ref());
        match (&self.course.cycles, load) {
            (Some(cycles), Some(load)) => settlement::fits(&cycles.measured, load.range()[1]),
            _ => Vec::new(),
        }
    }

    /// What became of the cycle jumps.
    pub fn jumps(&self) -> Option<JumpSummary> {
        let plan = self.job.grains.as_ref()?.after.jump.as_ref()?;
        let course = &self.course;
        Some(course.jumper.as_ref()?.summary(plan, course.cycles.as_ref()?, course.jump_energy))
    }

    /// Writes a frame of the animation.
    ///
    /// # Errors
    /// A field is not finite, or the disk refuses.
    pub fn frame<S: System>(&mut self, time: f64, system: &S, track: &Track<'_>) -> Result<(), Failure> {
        let k = self.course.frame;
        let vtk = self.job.output.vtk;
        if let Some(solid) = system.solid() {
            let name = format!("frames/solid_{k:05}.vtu");
            let vtu = self.dir.join(&name);
            let dat = self.dir.join(format!("tecplot/solid_{k:05}.dat"));
            let tecplot = self.job.output.tecplot.then_some((dat.as_path(), time));
            frames::write_solid(solid, vtk.then_some(vtu.as_path()), tecplot)?;
            self.series.push(time, 0, "solid", &name);
        }
        if let (Some(view), Some(part), true) = (system.grains(), &self.job.grains, vtk) {
            let name = |kind: &str| format!("frames/{kind}_{k:05}.vtp");
            write::vtp::write_grains(&self.dir.join(name("grains")), &frames::grains(view))?;
            write::vtp::write_chains(
                &self.dir.join(name("chains")),
                &frames::chains(view, self.job.output.strong_chains),
            )?;
            self.series.push(time, 1, "grains", &name("grains"));
            self.series.push(time, 2, "force chains", &name("chains"));
            let mut walls = frames::walls(view, part);
            track_output::draw(track, &mut walls);
            if !walls.polygons.is_empty() {
                write::vtp::write_walls(&self.dir.join(name("walls")), &walls)?;
                self.series.push(time, 3, "walls and sleeper", &name("walls"));
            }
        }
        if vtk {
            self.series.write()?;
        }
        self.course.frame += 1;
        Ok(())
    }

    /// Energy account as of the last row.
    pub fn balance(&self) -> &Balance {
        &self.course.balance
    }

    /// Largest |energy error| at any row [J].
    pub fn largest_error(&self) -> f64 {
        self.course.largest_error
    }

    /// Finished load cycles.
    pub fn cycles(&self) -> &[Cycle] {
        self.course.cycles.as_ref().map_or(&[], |c| &c.done)
    }

    /// Draws the settlement curves.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn plot_settlement(&self) -> Result<(), Failure> {
        let cycles = self.cycles();
        let lowering = &self.course.settlement;
        if !lowering.is_empty() {
            let (several, whose) = if lowering.len() > 1 { (true, "sleepers") } else { (false, "sleeper") };
            let name = |k: usize| if several { format!("sleeper {}", k + 1) } else { "sleeper".into() };
            write::svg::LinePlot {
                title: format!("{}: lowering of the {whose}", self.job.title),
                x_label: "time [s]".into(),
                y_label: "lowering [mm]".into(),
                series: lowering
                    .iter()
                    .enumerate()
                    .map(|(k, points)| write::svg::Series { name: name(k), points: points.clone() })
                    .collect(),
            }
            .write(&self.dir.join("sleeper.svg"))?;
        }
        if !cycles.is_empty() {
            let points =
                |f: fn(&Cycle) -> f64| cycles.iter().map(|c| [f64::from(c.number), 1e3 * f(c)]).collect();
            write::svg::LinePlot {
                title: format!("{}: settlement", self.job.title),
                x_label: "load cycle".into(),
                y_label: "[mm]".into(),
                series: vec![
                    write::svg::Series { name: "settlement".into(), points: points(|c| c.settlement) },
                    write::svg::Series {
                        name: "resilient deflection".into(),
                        points: points(|c| c.resilient_deflection),
                    },
                ],
            }
            .write(&self.dir.join("settlement.svg"))?;
        }
        Ok(())
    }
}

/// What is added to the name of a column of a sleeper: its number from 1, where there are several.
fn numbered(track: &Track<'_>, k: usize) -> String {
    if track.count() > 1 { format!("_{}", k + 1) } else { String::new() }
}

/// Columns of the history.
fn columns<S: System>(job: &Job, system: &S, track: &Track<'_>) -> Vec<Column> {
    let mut columns = vec![Column::new("time", "s")];
    let vector = |columns: &mut Vec<Column>, name: &str, unit: &str| {
        for d in ["x", "y", "z"] {
            columns.push(Column::new(format!("{name}_{d}"), unit));
        }
    };
    for k in 0..track.count() {
        let number = numbered(track, k);
        columns.push(Column::new(format!("load{number}"), "N"));
        vector(&mut columns, &format!("sleeper{number}"), "m");
        columns.push(Column::new(format!("sleeper{number}_tilt"), "rad"));
        if track.is_meshed() {
            columns.push(Column::new(format!("sleeper{number}_seats"), "m"));
            columns.push(Column::new(format!("sleeper{number}_bend"), "m"));
            vector(&mut columns, &format!("sleeper{number}_contact"), "N");
        }
    }
    if system.grains().is_some() && system.solid().is_some() {
        vector(&mut columns, "contact_force_on_solid", "N");
        columns.push(Column::new("peak_formation_pressure", "Pa"));
    }
    for name in ENERGY_COLUMNS {
        columns.push(Column::new(name, "J"));
    }
    if track.has_rails() {
        for k in 0..track.count() {
            columns.push(Column::new(format!("rail{}", numbered(track, k)), "m"));
        }
        columns.extend(["rail_energy", "wheels_work", "dissipated_track"].map(|name| Column::new(name, "J")));
    }
    if system.grains().is_some() {
        columns.extend(job.grains.iter().flat_map(bond_output::columns));
    }
    if let Some(part) = &job.solid
        && system.reactions().is_some()
    {
        for (name, _) in &part.named_supports {
            vector(&mut columns, &format!("{name}_reaction"), "N");
        }
    }
    for (name, _) in &job.probes {
        vector(&mut columns, &format!("{name}_u"), "m");
        vector(&mut columns, &format!("{name}_v"), "m/s");
    }
    columns.extend(job.grains.iter().flat_map(wall_output::columns));
    if job.grains.as_ref().is_some_and(|g| g.flow.is_some()) {
        columns.extend(Flow::columns());
    }
    columns
}

const ENERGY_COLUMNS: [&str; 12] = [
    "grains_kinetic",
    "contact_springs",
    "grains_gravity",
    "solid_kinetic",
    "solid_strain",
    "solid_gravity",
    "work",
    "dissipated_dashpot",
    "dissipated_friction",
    "dissipated_solid",
    "interface_error",
    "energy_error",
];

/// What follows the cycles of a load.
fn cycle_recorder<S: System>(job: &Job, system: &S, load: &CyclicLoad) -> CycleRecorder {
    let part = job.grains.as_ref();
    let between = part.and_then(|g| g.after.between).unwrap_or(load.range());
    let column = match (part.and_then(|g| g.sleeper.as_ref()), system.grains()) {
        (Some(sleeper), Some(g)) => {
            let spheres = (0..g.model.body_count())
                .filter(|&b| g.state.present(b))
                .flat_map(|b| g.state.spheres(g.model, b));
            let bottom = spheres.map(|(x, r)| x.z - r).fold(f64::INFINITY, f64::min);
            let area = 4.0 * sleeper.row.half[0] * sleeper.row.half[1];
            let below = -sleeper.row.half[2] - bottom;
            if bottom.is_finite() { BedColumn { area, below } } else { BedColumn::default() }
        }
        _ => BedColumn::default(),
    };
    CycleRecorder::new(load, between, column)
}

/// Columns of `cycles.csv`, each with its value.
fn cycle_table(job: &Job, c: &Cycle) -> Vec<(&'static str, &'static str, f64)> {
    let mut table = vec![
        ("cycle", "", f64::from(c.number)),
        ("settlement", "m", c.settlement),
        ("resilient_deflection", "m", c.resilient_deflection),
        ("secant_stiffness", "N/m", c.secant_stiffness),
        ("dissipated_energy", "J", c.dissipated_energy),
        ("peak_formation_pressure", "Pa", c.peak_formation_pressure),
        ("rate", "m", c.rate),
        ("bed_stiffness", "N/m", c.bed_stiffness),
    ];
    if job.solid.is_none() {
        table.push(("resilient_modulus", "Pa", c.resilient_modulus));
    }
    if job.grains.as_ref().is_some_and(|g| g.after.jump.is_some()) {
        table.push(("simulated", "", f64::from(c.simulated)));
        table.push(("jump_error", "m", c.jump_error));
    }
    table
}

fn cycle_columns(job: &Job) -> Vec<Column> {
    cycle_table(job, &Cycle::default()).into_iter().map(|(name, unit, _)| Column::new(name, unit)).collect()
}

fn cycle_values(job: &Job, cycle: &Cycle) -> Vec<f64> {
    cycle_table(job, cycle).into_iter().map(|(_, _, value)| value).collect()
}

/// What a run may leave beside its frames.
const FILES: [&str; 16] = [
    "push.csv",
    "breaks.csv",
    "summary.json",
    "log.txt",
    "history.csv",
    "cycles.csv",
    "nodes.csv",
    "gauss.csv",
    "safety.csv",
    "results.pvd",
    "settlement.svg",
    "sleeper.svg",
    "gradation.csv",
    "gradation.svg",
    "radial.csv",
    "packing.csv",
];

/// The packing of one of several groups.
fn of_a_group(path: &Path) -> bool {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let number = name.strip_prefix("packing_").and_then(|rest| rest.strip_suffix(".csv"));
    number.is_some_and(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()))
}

/// Whether a file is one of the frames that this program writes, or the beginning of one.
fn is_frame(path: &Path) -> bool {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let name = name.strip_suffix(".part").unwrap_or(&name);
    ["vtu", "vtp", "dat"].iter().any(|kind| Path::new(name).extension().is_some_and(|e| e == *kind))
}

/// Makes the folder of the results ready for a run that goes on there: files that a stopped program left half-written go.
///
/// # Errors
/// The folder cannot be made or cleaned.
pub fn take_up(dir: &Path, output: &crate::model::OutputPlan) -> Result<(), Failure> {
    let fail = |e: io::Error| Failure::Other(format!("{}: {e}", dir.display()));
    for (sub, wanted) in [("", true), ("frames", output.vtk), ("tecplot", output.tecplot)] {
        let folder = dir.join(sub);
        if wanted {
            fs::create_dir_all(&folder).map_err(fail)?;
        }
        for half in FILES.map(|name| folder.join(format!("{name}.part"))).iter().filter(|f| f.is_file()) {
            fs::remove_file(half).map_err(fail)?;
        }
        if folder.is_dir() && !sub.is_empty() {
            for entry in fs::read_dir(&folder).map_err(fail)? {
                let path = entry.map_err(fail)?.path();
                if is_frame(&path) && path.extension().is_some_and(|e| e == "part") {
                    fs::remove_file(&path).map_err(fail)?;
                }
            }
        }
    }
    Ok(())
}

/// Makes the folder of the results; what an earlier run left there is removed, so that no result of another run is
/// taken for one of this. Files that are not of this program stay.
///
/// # Errors
/// The folder cannot be made or cleaned.
pub fn prepare(dir: &Path, output: &crate::model::OutputPlan) -> Result<(), Failure> {
    let fail = |e: std::io::Error| Failure::Other(format!("{}: {e}", dir.display()));
    fs::create_dir_all(dir).map_err(fail)?;
    // Only in a folder of results: a user's own `nodes.csv` elsewhere is not ours to remove.
    let of_a_run = dir.join("summary.json").is_file();
    for file in FILES.map(|name| dir.join(name)).iter().filter(|file| of_a_run && file.is_file()) {
        fs::remove_file(file).map_err(fail)?;
    }
    if of_a_run {
        for entry in fs::read_dir(dir).map_err(fail)? {
            let path = entry.map_err(fail)?.path();
            if of_a_group(&path) {
                fs::remove_file(&path).map_err(fail)?;
            }
        }
    }
    for (sub, wanted) in [("frames", output.vtk), ("tecplot", output.tecplot)] {
        let folder = dir.join(sub);
        if folder.is_dir() {
            for entry in fs::read_dir(&folder).map_err(fail)? {
                let path = entry.map_err(fail)?.path();
                if is_frame(&path) {
                    fs::remove_file(&path).map_err(fail)?;
                }
            }
        }
        if wanted {
            fs::create_dir_all(&folder).map_err(fail)?;
        }
    }
    Ok(())
}
