//! Device of the DEM steps.

use trackbed_dem as dem;
use trackbed_dem::device::{self, Cuda, Device};
use trackbed_dem::ranks::{Link, MessageCounters, Ranks};
use trackbed_dem::surface::{Surface, SurfaceContact};
use trackbed_dem::{AppliedForce, BackEnd, StepError};
use trackbed_input::model::Job;
use trackbed_io::failure::Failure;
use trackbed_io::message;

/// Compute device of the main stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Place {
    /// CPU.
    #[default]
    Cpu,
    /// CUDA device (GPU).
    Gpu,
}

/// Checks that the device supports a scene.
///
/// # Errors
/// Unsupported features, missing hardware.
pub fn check(place: Place, job: &Job) -> Result<(), Failure> {
    if place == Place::Cpu {
        return Ok(());
    }
    let refused = |why: String| Failure::Input(format!("--device gpu: {why}"));
    let Some(grains) = &job.grains else {
        return Err(refused("not supported on a GPU: scenes without grains".into()));
    };
    // Grain errors are reported where models are built.
    if let Ok(model) = dem::Model::new(grains.input(grains.groups.bodies.clone())) {
        device::check(&model).map_err(|e| refused(e.to_string()))?;
    }
    Cuda::missing().map_or(Ok(()), |what| Err(refused(what.into())))
}

/// DEM step executor.
pub enum Steps {
    /// CPU.
    Processor(Box<dem::Work>),
    /// GPU.
    Device(Box<Device<Cuda>>),
    /// Several ranks, this process first.
    Ranks(Box<Ranks<Box<dyn Link>>>),
}

impl Steps {
    /// Creates a CPU executor.
    pub fn processor(work: dem::Work) -> Steps {
        Steps::Processor(Box::new(work))
    }

    /// Creates a GPU executor that owns the state.
    ///
    /// # Errors
    /// Unsupported features, no device, insufficient memory.
    pub fn device(model: &dem::Model, state: &dem::State) -> Result<Steps, Failure> {
        let refused = |why: String| Failure::Input(format!("--device gpu: {why}"));
        let text = device::source(model).map_err(|e| refused(e.to_string()))?;
        let machine = Cuda::new(&text, device::kernels(model)).map_err(refused)?;
        message::note(&format!("main stage: DEM steps on {}", machine.name));
        let device = Device::new(machine, model, state).map_err(|e| refused(e.to_string()))?;
        Ok(Steps::Device(Box::new(device)))
    }

    /// Creates a rank executor that owns the state; ranks build the model from `description`.
    ///
    /// # Errors
    /// A lost rank, or a failed model.
    pub fn ranks(
        link: Box<dyn Link>,
        model: &dem::Model,
        state: &dem::State,
        description: &[u8],
    ) -> Result<Steps, Failure> {
        message::note(&format!("main stage: DEM steps on {} ranks", link.size()));
        let ranks = Ranks::new(link, model, state, description).map_err(failed(model))?;
        Ok(Steps::Ranks(Box::new(ranks)))
    }

    /// Whether state changes must be transferred to the executor.
    pub fn elsewhere(&self) -> bool {
        !matches!(self, Steps::Processor(_))
    }

    /// Returns message counters between ranks.
    pub fn traffic(&self) -> Option<&MessageCounters> {
        if let Steps::Ranks(ranks) = self { Some(ranks.traffic()) } else { None }
    }
}

/// Converts a step error, with names of bodies and walls.
pub fn failed(model: &dem::Model) -> impl Fn(StepError) -> Failure {
    |error| {
        let text = model.name_objects(&error);
        // A lost rank is no numerical failure.
        if matches!(error, StepError::Rank { .. }) { Failure::Other(text) } else { Failure::Numerical(text) }
    }
}

impl BackEnd for Steps {
    fn upload(&mut self, model: &dem::Model, state: &dem::State) -> Result<(), StepError> {
        match self {
            Steps::Processor(work) => work.upload(model, state),
            Steps::Device(device) => device.upload(model, state),
            Steps::Ranks(ranks) => ranks.upload(model, state),
        }
    }

    fn step<S: Surface>(
        &mut self,
        model: &dem::Model,
        state: &mut dem::State,
        surface: &S,
        applied: &[AppliedForce],
    ) -> Result<(), StepError> {
        match self {
            Steps::Processor(work) => work.step(model, state, surface, applied),
            Steps::Device(device) => device.step(model, state, surface, applied),
            Steps::Ranks(ranks) => ranks.step(model, state, surface, applied),
        }
    }

    fn download(&mut self, model: &dem::Model, state: &mut dem::State) -> Result<(), StepError> {
        match self {
            Steps::Processor(work) => work.download(model, state),
            Steps::Device(device) => device.download(model, state),
            Steps::Ranks(ranks) => ranks.download(model, state),
        }
    }

    fn surface_contacts(&self) -> &[SurfaceContact] {
        match self {
            Steps::Processor(work) => BackEnd::surface_contacts(&**work),
            Steps::Device(device) => device.surface_contacts(),
            Steps::Ranks(ranks) => ranks.surface_contacts(),
        }
    }
}
