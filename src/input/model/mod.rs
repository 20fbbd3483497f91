//! Scene → models: names resolved, ranges checked, values derived.

mod duration;
pub mod exchange;
mod faults;
pub mod grains;
mod output;
mod probe;
pub mod solid;
mod tables;
pub mod track;

pub use faults::{read_scene, resolve};
pub use output::OutputPlan;
pub use probe::{Observed, PointProbe};

use crate::scene::units::vector;
use crate::scene::{Document, Scene, SceneError, Table};
use std::sync::Arc;
use trackbed_coupling::surface::SolidSurface;
use trackbed_fem as fem;
use trackbed_io::failure::Failure;
use trackbed_io::message::shown;

const LONGEST: usize = 200;

/// Resolved scene.
pub struct Job {
    /// Title.
    pub title: String,
    /// The solid.
    pub solid: Option<solid::SolidPart>,
    /// The grains.
    pub grains: Option<grains::GrainsPart>,
    /// DEM–FEM coupling.
    pub coupling: Option<exchange::CouplingPart>,
    /// Main-stage duration [s]; 0 for a static solid.
    pub end: f64,
    /// Time step of a solid-only model [s].
    pub solid_step: Option<f64>,
    /// Output.
    pub output: OutputPlan,
    /// Named probes.
    pub probes: Vec<(String, Observed)>,
}

impl Job {
    /// Returns the ground surface, if coupled.
    pub fn ground(&self) -> Option<SolidSurface> {
        let (plan, solid, grains) = (self.coupling.as_ref()?, self.solid.as_ref()?, self.grains.as_ref()?);
        Some(plan.ground(solid, grains))
    }

    /// Resolves a scene.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, scene: &Scene) -> Result<Job, Failure> {
        let scene = &Table::root(document, scene);
        if scene.solid.is_none() && scene.grains.is_empty() {
            let error = scene.error("scene", "neither [solid] nor [[grains]]", "at least one of them");
            return Err(error.into());
        }
        refuse_idle_keys(scene)?;
        let gravity = vector(&scene.gravity);
        let coupled = !scene.grains.is_empty();
        let mut sleepers = track::sleeper::meshed(scene, gravity)?;
        let build = |s| solid::build(document, s, gravity, coupled, sleepers.take());
        let solid = scene.solid.as_ref().map(build).transpose()?;
        // Only elastic dynamic solid-only runs start without a static solve.
        if let Some(part) = &solid
            && (coupled || !matches!(part.analysis, solid::Analysis::Dynamic(_)) || !part.is_linear())
        {
            let ground = part.ground().expect("a part of a model that was made");
            fem::statics::check_rigid_body_motion(ground.as_ref().unwrap_or(&part.model))
                .map_err(|e| part.failure(&e))?;
        }
        let mut grains = if scene.grains.is_empty() { None } else { Some(grains::build(scene, gravity)?) };
        if grains.is_none() {
            refuse_tables_of_grains(scene)?;
        }
        let coupling = match (scene.optional("coupling", &scene.coupling), &solid, &grains) {
            (Some(c), Some(s), Some(g)) => Some(exchange::build(&c, s, g.groups.polyhedra())?),
            (Some(_), _, _) => {
                return Err(scene
                    .requirement("coupling", if solid.is_some() { "[[grains]]" } else { "[solid]" })
                    .into());
            }
            (None, Some(_), Some(_)) => {
                let expected = "[coupling], since the scene has [solid] and [[grains]]";
                return Err(scene.missing("coupling", expected).into());
            }
            (None, _, _) => None,
        };
        if let (Some(c), Some(s), Some(g)) = (&coupling, &solid, &grains) {
            c.check_periodic(scene, s, g)?;
        }
        if let (Some(c), Some(g)) = (&coupling, &mut grains) {
            g.set_sleeper_faces(c.ground_faces as u32);
            if let Some(s) = solid.as_ref().filter(|_| g.groups.polyhedra()) {
                g.surface.mesh = c.surface_mesh(s).map(Arc::new);
            }
        }
        let jumps = grains.as_ref().and_then(|g| g.track.after.jump).is_some_and(|j| j.grains);
        if jumps && solid.as_ref().is_some_and(|s| !s.is_linear()) {
            let expected = "\"extrapolate\". The state of a plastic solid is not extrapolated";
            return Err(scene.error("track.jump.method", "\"displace\"", expected).into());
        }
        let end = duration::end_time(scene, grains.as_ref())?;
        let solid_step = duration::solid_step(scene, end)?;
        let probes = probe::probes(scene, solid.as_ref(), grains.as_ref())?;
        let output = OutputPlan::new(scene, end)?;
        let title = if scene.title.is_empty() {
            document.file().display().to_string()
        } else {
            shown(&scene.title.replace(['\r', '\n'], " "), LONGEST)
        };
        Ok(Job { title, solid, grains, coupling, end, solid_step, output, probes })
    }
}

fn refuse_idle_keys(scene: &Table<Scene>) -> Result<(), SceneError> {
    if scene.grains.is_empty() {
        scene.reject_without([("wind", scene.wind.is_some())], "[[grains]]")?;
        let time = scene.below("time", &scene.time);
        let idle = [
            ("grain_step", time.grain_step.is_some()),
            ("grain_step_fraction", time.grain_step_fraction.is_some()),
            ("accept_step_above_limit", time.accept_step_above_limit),
            ("impact_speed", time.impact_speed.is_some()),
            ("search_skin", time.search_skin.is_some()),
            ("mass_factor", time.mass_factor.is_some()),
            ("flow_interval", time.flow_interval.is_some()),
        ];
        time.reject_without(idle, "[[grains]]")?;
    } else if let Some(solid) = scene.optional("solid", &scene.solid) {
        let idle = [
            ("dynamics", solid.dynamics.is_some()),
            ("quasi_static", solid.quasi_static.is_some()),
            ("strength_reduction", solid.strength_reduction.is_some()),
        ];
        solid
            .reject_with(idle, "[[grains]]")
            .map_err(|e| e.remedy("`coupling.theta` sets the time integration of a coupled solid"))?;
        for support in solid.rows("support", &solid.support) {
            support
                .reject_with([("history", support.history.is_some())], "[[grains]]")
                .map_err(|e| e.remedy("Supports of a coupled solid are fixed"))?;
        }
    }
    Ok(())
}

fn refuse_tables_of_grains(scene: &Table<Scene>) -> Result<(), SceneError> {
    let tables = [
        ("material", !scene.material.is_empty()),
        ("contact", !scene.contact.is_empty()),
        ("walls", !scene.walls.is_empty()),
        ("periodic", scene.periodic.is_some()),
        ("structure", !scene.structure.is_empty()),
        ("outlet", !scene.outlet.is_empty()),
        ("deposition", scene.deposition.is_some()),
        ("compaction", !scene.compaction.is_empty()),
        ("measure", !scene.measure.is_empty()),
        ("runout", scene.runout.is_some()),
        ("specimen", scene.specimen.is_some()),
        ("events", scene.events.is_some()),
        ("track", scene.track.is_some()),
    ];
    match tables.into_iter().find(|(_, there)| *there) {
        Some((key, _)) => Err(scene.no_effect(key, "[[grains]]")),
        None => Ok(()),
    }
}
