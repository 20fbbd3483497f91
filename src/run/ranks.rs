//! Steps shared among processes: the first rank leads, others compute parts of the grains.

use super::device::Place;
use super::threads::thread_pool;
use std::fmt;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use trackbed_dem as dem;
use trackbed_dem::ranks::{self, Link, Lost};
use trackbed_input::model::{self, Job};
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;

/// Other ranks of a run, if any.
#[derive(Clone, Default)]
pub struct Ranked(Option<Arc<Waiting>>);

/// Dismissed without a model.
struct Waiting {
    link: Mutex<Option<Box<dyn Link>>>,
    size: usize,
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(link) = self.link.get_mut().unwrap_or_else(PoisonError::into_inner) {
            ranks::dismiss(link);
        }
    }
}

impl fmt::Debug for Ranked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ranks", self.size())
    }
}

impl Ranked {
    /// Creates the first rank's side of `link`; others [`follow`].
    pub fn first(link: Box<dyn Link>) -> Ranked {
        let size = link.size();
        Ranked(Some(Arc::new(Waiting { link: Mutex::new(Some(link)), size })))
    }

    /// Returns the number of ranks.
    pub fn size(&self) -> usize {
        self.0.as_ref().map_or(1, |waiting| waiting.size)
    }

    /// Shares a model, with plane positions after packing [m].
    pub fn share(&self, bodies: &[dem::BodyInput], planes: &[dem::Vec3]) -> Sharing<'_> {
        let description = match &self.0 {
            None => Vec::new(),
            Some(_) => postcard::to_stdvec(&(bodies, planes)).unwrap_or_default(),
        };
        Sharing { ranks: self, description }
    }
}

/// Ranks with the model description.
pub struct Sharing<'a> {
    ranks: &'a Ranked,
    description: Vec<u8>,
}

impl Sharing<'_> {
    /// Takes the link to ranks without a model.
    pub fn link(&self) -> Option<Box<dyn Link>> {
        self.ranks.0.as_ref()?.link.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Returns encoded bodies and plane positions.
    pub fn description(&self) -> &[u8] {
        &self.description
    }
}

/// Checks that ranks support a scene.
///
/// # Errors
/// Unsupported features.
pub fn check(ranked: &Ranked, place: Place, job: &Job) -> Result<(), Failure> {
    if ranked.0.is_none() {
        return Ok(());
    }
    let refused = |why: String| Failure::Input(format!("{} ranks: {why}", ranked.size()));
    let grains = match (&job.grains, &job.solid) {
        (Some(grains), None) => grains,
        _ => return Err(refused("not supported with several ranks: solids".into())),
    };
    if place != Place::Cpu {
        return Err(refused("found --device gpu, expected --device cpu".into()));
    }
    // Grain errors are reported where models are built.
    if let Ok(model) = dem::Model::new(grains.input(grains.groups.bodies.clone())) {
        ranks::check(&model).map_err(|e| refused(e.to_string()))?;
    }
    Ok(())
}

/// Follows the first rank through its run.
///
/// # Errors
/// A lost rank; the first rank reports scene errors.
pub fn follow(scene: &Path, set: &[String], threads: Option<usize>, link: Box<dyn Link>) -> Result<(), Lost> {
    let resolved = || -> Result<(rayon::ThreadPool, Job), Failure> {
        let mut document = Document::open(scene)?;
        document.set_all(set)?;
        let parsed = model::read_scene(&document)?;
        let pool = thread_pool(threads)?;
        let job = pool.install(|| model::resolve(&document, &parsed))?;
        Ok((pool, job))
    };
    match resolved() {
        Err(failure) => ranks::serve(link, |_| Err(failure.to_string())),
        Ok((pool, job)) => pool
            .install(|| ranks::serve(link, |description| made(&job, description).map_err(|e| e.to_string()))),
    }
}

fn made(job: &Job, description: &[u8]) -> Result<dem::Model, Failure> {
    let other = || Failure::Input("other scene than on the first rank".into());
    let (bodies, places): (Vec<dem::BodyInput>, Vec<dem::Vec3>) =
        postcard::from_bytes(description).map_err(|_| other())?;
    let mut grains = job.grains.clone().ok_or_else(other)?;
    if places.len() != grains.walls.planes.len() {
        return Err(other());
    }
    places.iter().enumerate().for_each(|(k, place)| grains.place_plane(k, *place));
    let mut model = dem::Model::new(grains.input(bodies)).map_err(|e| Failure::Input(e.to_string()))?;
    model.forget_start();
    Ok(model)
}
