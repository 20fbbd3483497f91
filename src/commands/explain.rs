//! `trackbed explain`: the report of `check`, and which stages a run will go through, with which loops, how much memory, and
//! how long it may take on this machine.

use super::check;
use crate::failure::Failure;
use crate::model::Job;
use crate::model::grains::{GrainsPart, refused};
use crate::run::size;
use crate::run::stages::{self, GrainTime, Stage};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;
use trackbed_dem as dem;

/// Spheres along a side of the probe.
const SIDE: usize = 16;
/// Steps that are timed.
const STEPS: u32 = 200;
/// Mean step of beds over the first one where steps follow the contacts: 1.5 to 6 (guide, "Step limit").
const GROWTH: f64 = 4.0;
/// What a clump costs, in spheres, per member: ten-sphere clumps cost 3.4 spheres (guide, speed).
const MEMBER: f64 = 0.34;

/// The text of `check`, and what a run will do and cost.
///
/// # Errors
/// The same bad input that a run would refuse.
pub fn explain(scene: &Path, set: &[String], memory: Option<u64>, strict: bool) -> Result<String, Failure> {
    let (document, job) = check::read(scene, set)?;
    let mut text = check::report(&document, &job, memory, strict)?.text();
    let mut line = |t: String| writeln!(text, "  {t}").expect("writing to a string does not fail");
    let names: Vec<_> = stages::of(&job).filter_map(Stage::name).collect();
    line(format!("stages: {}", names.join(", ")));
    if let Some(grains) = &job.grains {
        let model = dem::Model::new(grains.input(grains.groups.bodies.clone()))
            .map_err(|e| refused(&document, &e))?;
        line(format!("contact loop: {}", dem::measure::kernels(&model)));
        match Probe::run(grains, &model) {
            Ok(probe) => probe.report(&job, &model).into_iter().for_each(line),
            Err(error) => {
                line(format!("no estimate of memory and time: a probe of the grains fails: {error}"))
            }
        }
    }
    Ok(text)
}

/// How many spheres' worth of work a step of all bodies is.
fn share(model: &dem::Model) -> f64 {
    let cost = |n: usize| if n <= 1 { 1.0 } else { MEMBER * n as f64 };
    (0..model.body_count()).map(|b| cost(model.members(b).len())).sum()
}

/// A small bed with the scene's law, timed.
struct Probe {
    /// Seconds of one step of one sphere.
    seconds: f64,
    /// Bytes per sphere.
    bytes: f64,
}

impl Probe {
    /// Memory and time of a run.
    fn report(&self, job: &Job, model: &dem::Model) -> [String; 2] {
        let memory = format!(
            "memory of a packed bed: {:.0} B per sphere and contacts, {} in all, constants and results apart",
            self.bytes,
            size((self.bytes * model.sphere_count() as f64) as u64)
        );
        let step = match model.measured() {
            None => model.dt(),
            Some(_) => (GROWTH * model.dt()).min(model.longest(true)),
        };
        let time = |simulated: f64| duration(simulated / step * self.seconds * share(model));
        let times = stages::of(job).rev().filter_map(|stage| {
            let name = stage.name()?;
            Some(match stage.grain_time(job)? {
                GrainTime::Exactly(simulated) => format!("{name} {}", time(simulated)),
                GrainTime::AtMost(simulated) => format!("{name} at most {}", time(simulated)),
            })
        });
        let times: Vec<String> = times.collect();
        let time = format!(
            "time of the grains on one core, from {:.1} M sphere-steps/s of a probe of {} spheres: {}",
            1e-6 / self.seconds,
            SIDE.pow(3),
            times.join(", ")
        );
        [memory, time]
    }

    /// Spheres of the scene's mean size on a simple cubic lattice, each pressed against six: about the contacts of a
    /// packed bed. The step is so short that they stay there.
    ///
    /// # Errors
    /// Contacts so stiff or soft that no step can be made.
    fn run(grains: &GrainsPart, model: &dem::Model) -> Result<Probe, Box<dyn Error>> {
        let radii = (0..model.body_count()).flat_map(|b| model.members(b)).map(|m| m.1);
        let radius = radii.sum::<f64>() / model.sphere_count().max(1) as f64;
        let radius = if radius > 0.0 { radius } else { 0.01 };
        let material = grains.groups.bodies.first().map_or(0, |b| b.material);
        // Without bonds: these join the bodies of the scene.
        let (materials, contacts) = (grains.materials.all.clone(), grains.materials.pairs.clone());
        let sphere =
            |position| dem::BodyInput { material, position, scale: radius, ..dem::BodyInput::default() };
        let lattice = dem::insert::lattice::Lattice::Simple;
        let places = lattice.block(dem::Vec3::zeros(), radius * (1.0 - 1e-4), [SIDE; 3]);
        let input = dem::ModelInput {
            materials,
            contacts,
            shapes: vec![dem::Shape::Sphere { radius: 1.0 }],
            bodies: places.into_iter().map(sphere).collect(),
            time_step: dem::TimeStep::Auto { fraction: 1e-6 },
            gravity: dem::Vec3::zeros(),
            ..dem::ModelInput::default()
        };
        let model = dem::Model::new(input)?;
        let mut state = dem::State::new(&model);
        let mut work = dem::Work::new(&model, &state);
        let mut advance = |steps: u32| -> Result<f64, dem::StepError> {
            let begun = Instant::now();
            for _ in 0..steps {
                dem::step(&model, &mut state, &mut work, &dem::surface::NoSurface, &[])?;
            }
            Ok(begun.elapsed().as_secs_f64())
        };
        advance(STEPS / 4)?;
        let count = SIDE.pow(3) as f64;
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let elapsed = match one {
            Ok(pool) => pool.install(|| advance(STEPS))?,
            Err(_) => advance(STEPS)?,
        };
        let bytes = dem::measure::bytes(&state, &work) as f64 / count;
        Ok(Probe { seconds: elapsed / (f64::from(STEPS) * count), bytes })
    }
}

/// A time for people.
fn duration(seconds: f64) -> String {
    if seconds < 100.0 {
        format!("{seconds:.1} s")
    } else if seconds < 6000.0 {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}
