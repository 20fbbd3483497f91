//! `trackbed explain`: what `check` says, and which stages a run will go through, with which loops, how much memory, and
//! how long it may take on this machine.

use super::check;
use crate::failure::Failure;
use crate::model::Job;
use crate::model::grains::{GrainsPart, refused};
use crate::run::size;
use crate::scene::{Document, Scene};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;
use trackbed_dem as dem;

/// Spheres along a side of the probe.
const SIDE: usize = 16;
/// Steps that are timed.
const STEPS: u32 = 200;
/// What a clump costs, in spheres, per member: ten-sphere clumps cost 3.4 spheres (guide, speed).
const MEMBER: f64 = 0.34;

/// The text of `check`, and what a run will do and cost.
///
/// # Errors
/// The same bad input that a run would refuse.
pub fn explain(scene: &Path, set: &[String], memory: Option<u64>) -> Result<String, Failure> {
    let mut text = check::check(scene, set, memory)?;
    let mut document = Document::open(scene)?;
    for assignment in set {
        document.set(assignment)?;
    }
    let parsed: Scene = document.read()?;
    let job = Job::new(&document, &parsed)?;
    let mut line = |t: String| writeln!(text, "  {t}").expect("writing to a string does not fail");
    line(format!("stages: {}", stages(&job).join(", ")));
    if let Some(grains) = &job.grains {
        let model =
            dem::Model::new(grains.input(grains.bodies.clone())).map_err(|e| refused(&document, &e))?;
        line(format!("contact loop: {}", dem::measure::kernels(&model)));
        let probe = Probe::run(grains, &model).map_err(|e| refused(&document, &e))?;
        line(format!(
            "memory of a packed bed: {:.0} B per sphere and contacts, {} in all, constants and results apart",
            probe.bytes,
            size((probe.bytes * model.sphere_count() as f64) as u64)
        ));
        let seconds = |time: f64| time / model.dt() * probe.seconds * share(&model);
        line(format!(
            "time of the grains on one core, from {:.1} M sphere-steps/s of a probe of {} spheres: run {}{}",
            1e-6 / probe.seconds,
            SIDE.pow(3),
            duration(seconds(job.end)),
            grains.deposition.as_ref().map_or(String::new(), |d| {
                format!(", settling at most {}", duration(seconds(d.max_time)))
            })
        ));
    }
    Ok(text)
}

/// The stages of a run, in order.
fn stages(job: &Job) -> Vec<&'static str> {
    let mut out = Vec::new();
    if let Some(grains) = &job.grains {
        let stage = [
            (!grains.growths.is_empty(), "growth"),
            (grains.deposition.is_some(), "settling"),
            (!grains.compaction.is_empty(), "compaction"),
            (grains.sleeper.is_some(), "sleeper set down"),
            (job.coupling.is_some(), "equilibrium of the solid"),
        ];
        out.extend(stage.iter().filter(|s| s.0).map(|s| s.1));
    }
    out.push("run");
    out
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
    /// Spheres of the scene's mean size on a simple cubic lattice, each pressed against six: about the contacts of a
    /// packed bed. The step is so short that they stay there.
    fn run(grains: &GrainsPart, model: &dem::Model) -> Result<Probe, dem::ModelError> {
        let radii = (0..model.body_count()).flat_map(|b| model.members(b)).map(|m| m.1);
        let radius = radii.sum::<f64>() / model.sphere_count().max(1) as f64;
        let radius = if radius > 0.0 { radius } else { 0.01 };
        let material = grains.bodies.first().map_or(0, |b| b.material);
        let mut input = grains.input(Vec::new());
        let sphere =
            |position| dem::BodyInput { material, position, scale: radius, ..dem::BodyInput::default() };
        let lattice = dem::insert::lattice::Lattice::Simple;
        let places = lattice.block(dem::Vec3::zeros(), radius * (1.0 - 1e-4), [SIDE; 3]);
        input = dem::ModelInput {
            materials: input.materials,
            contacts: input.contacts,
            shapes: vec![dem::Shape::Sphere { radius: 1.0 }],
            bodies: places.into_iter().map(sphere).collect(),
            time_step: dem::TimeStep::Auto { fraction: 1e-6 },
            gravity: dem::Vec3::zeros(),
            ..dem::ModelInput::default()
        };
        let model = dem::Model::new(input)?;
        let mut state = dem::State::new(&model);
        let mut work = dem::Work::new(&model, &state);
        let mut advance = |steps: u32| {
            let begun = Instant::now();
            for _ in 0..steps {
                // Spheres that hardly move and overlap by a ten-thousandth are far from every bound.
                dem::step(&model, &mut state, &mut work, &dem::surface::NoSurface, &[])
                    .expect("the probe stands still");
            }
            begun.elapsed().as_secs_f64()
        };
        advance(STEPS / 4);
        let count = SIDE.pow(3) as f64;
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let elapsed = match one {
            Ok(pool) => pool.install(|| advance(STEPS)),
            Err(_) => advance(STEPS),
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
