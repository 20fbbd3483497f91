//! `trackbed explain`: `check` with kernels, memory and run time.

use super::check::{self, Report};
use std::error::Error;
use std::time::{Duration, Instant};
use trackbed_dem as dem;
use trackbed_input::model::grains::{GrainsPart, refused};
use trackbed_io::failure::Failure;
use trackbed_post::preview::Source;
use trackbed_run::estimate::Estimate;
use trackbed_run::stages::{self, Stage};
use trackbed_run::{self as run, size};

const SIDE: usize = 16;
const STEPS: u32 = 200;
const LONGEST: f64 = 3600.0;

/// Options.
#[derive(Clone, Copy, Debug, Default)]
pub struct How {
    /// Memory limit of the solid [bytes].
    pub memory: Option<u64>,
    /// Reject implausible values.
    pub strict: bool,
    /// Threads; default all cores.
    pub threads: Option<usize>,
    /// Trial run time [s]; 0 for none.
    pub trial: f64,
}

/// Reports a scene with its cost.
///
/// # Errors
/// Input errors.
pub fn explain(source: &Source, how: &How) -> Result<Report, Failure> {
    if !(0.0..=LONGEST).contains(&how.trial) {
        let found = how.trial;
        return Err(Failure::Input(format!("--trial: found {found}, expected 0 to {LONGEST:.0} seconds")));
    }
    let (document, job) = source.resolve()?;
    let mut report = check::report(&document, &job, how.memory, how.strict)?;
    let names: Vec<_> = stages::of(&job).filter_map(Stage::name).collect();
    report.add(format!("stages: {}", names.join(", ")));
    if let Some(grains) = &job.grains {
        let model = dem::Model::new(grains.input(grains.groups.bodies.clone()))
            .map_err(|e| refused(&document, &e))?;
        report.add(format!("contact kernels: {}", dem::measure::kernels(&model)));
        match Probe::run(grains, &model) {
            Ok(probe) => report.add(probe.line(&model)),
            Err(error) => report.add(format!("no estimate of memory: trial bed failed: {error}")),
        }
    }
    if how.trial > 0.0 {
        let pool = run::thread_pool(how.threads)?;
        let budget = Duration::from_secs_f64(how.trial);
        match pool.install(|| Estimate::of(&document, &source.set, &job, how.threads, budget)) {
            Ok(estimate) => report.estimate(&estimate),
            Err(failure) => report.add(format!("no estimate of the run time: trial run failed: {failure}")),
        }
    }
    Ok(report)
}

struct Probe {
    seconds: f64,
    bytes: f64,
}

impl Probe {
    fn line(&self, model: &dem::Model) -> String {
        format!(
            "packed bed: {:.0} B per sphere and contacts, {} in all, constants and results apart; {:.1} M sphere-steps/s on one \
             core, by a probe of {} spheres",
            self.bytes,
            size((self.bytes * model.sphere_count() as f64) as u64),
            1e-6 / self.seconds,
            SIDE.pow(3),
        )
    }

    /// Simple cubic lattice of mean spheres with six contacts each, as in a packed bed.
    ///
    /// # Errors
    /// No stable time step.
    fn run(grains: &GrainsPart, model: &dem::Model) -> Result<Probe, Box<dyn Error>> {
        let radii = (0..model.body_count()).flat_map(|b| model.members(b)).map(|m| m.1);
        let radius = radii.sum::<f64>() / model.sphere_count().max(1) as f64;
        let radius = if radius > 0.0 { radius } else { 0.01 };
        let material = grains.groups.bodies.first().map_or(0, |b| b.material);
        // Bonds refer to scene bodies.
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
