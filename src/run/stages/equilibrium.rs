//! Coupling of grains and solid in equilibrium.

use super::carried::Carried;
use super::reduction;
use super::stage::{CoupledRun, RunState, Stage};
use crate::checkpoint::Loaded;
use crate::context::Run;
use crate::device::{Place, Steps};
use crate::from::END;
use crate::initial;
use crate::summary::{CouplingRecord, Summary};
use crate::system::{CoupledSystem, Meshed, SavedCoupling};
use trackbed_coupling as coupling;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_input::model::Job;
use trackbed_input::model::exchange::{self, CouplingPart, Windows};
use trackbed_input::model::solid::SolidPart;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::progress::{Progress, Verbosity};
use trackbed_track::CyclicLoad;

/// Static equilibrium with grains at rest.
pub struct Equilibrium;

impl Stage for Equilibrium {
    fn name(&self) -> Option<&'static str> {
        Some("equilibrium of the solid")
    }

    fn applies(&self, job: &Job) -> bool {
        job.coupling.is_some()
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let (Some(plan), Some(part)) = (&run.job.coupling, &run.job.solid) else { return Ok(()) };
        let model = state.grain_model(run)?;
        let grains = state.grains.as_mut().expect("a coupled run has grains");
        let ground = grains.ground.take().expect("a coupled run has a ground");
        let transfer_kind = plan.transfer_kind(&ground);
        let Windows { classes, substeps, theta } = plan.windows(&grains.part, &model, part, &ground);
        plan.refuse(run.document, &classes, substeps, model.dt())?;
        let bases = std::mem::take(&mut grains.bases);
        let whole = part.sleepers.as_ref().map(|s| s.set_down(&part.model, &bases));
        let (solid, surface) = match whole {
            Some(whole) => {
                let solid: &'a fem::Model = run.set_down.get_or_init(|| whole);
                (solid, plan.surface(solid, &grains.part))
            }
            None => (&part.model, ground),
        };
        let load = run.job.grains.as_ref().and_then(|g| g.track.load.as_ref());
        let (loaded, summary) = (state.loaded.as_mut(), &mut state.summary);
        let body = Body { part, model: solid };
        let start = grains.start(&model)?;
        let bed = Bed { model, start, carried: grains.carried.as_ref() };
        let system = couple(run, body, bases, bed, plan, (substeps, theta), surface, load, loaded, summary)?;
        state.loaded.take_if(|loaded| loaded.moment.stage == END);
        let substeps = system.model.substeps;
        let remarks = exchange::remarks(&classes, plan.scheme, substeps);
        if run.verbosity > Verbosity::Quiet {
            // Before a possible instability.
            remarks.iter().for_each(|r| message::warn(r));
        }
        summary.warnings.extend(remarks);
        let lowest = system.work.surface.lowest();
        summary.coupling = Some(CouplingRecord {
            transfer: Default::default(),
            scheme: plan.scheme,
            substeps,
            theta,
            interface: Default::default(),
            division: 1,
            stability: exchange::stability(&classes),
            classes,
            passes: Default::default(),
            interface_work_error: 0.0,
            transfer_kind,
            reduction: None,
        });
        state.coupled = Some(CoupledRun { system, solid, lowest });
        Ok(())
    }
}

/// Starts in static equilibrium. The mesh describes the loaded shape, like a survey.
fn couple<'b>(
    run: &Run<'b>,
    body: Body<'b>,
    bases: Vec<f64>,
    bed: Bed<'_>,
    plan: &CouplingPart,
    (substeps, theta): (u32, f64),
    mut surface: SolidSurface,
    load: Option<&'b CyclicLoad>,
    resumed: Option<&mut Loaded>,
    summary: &mut Summary,
) -> Result<CoupledSystem<'b>, Failure> {
    let progress = Progress::start("equilibrium", 1.0, run.verbosity);
    let solid = body.part;
    let dead_load = solid.dead_load(body.model);
    let Bed { model: grains, start, carried } = bed;
    let (reference, memory, mut state, seat_work) = match resumed {
        Some(loaded) => {
            let SavedCoupling { reference, memory, state, seat_work } = saved(loaded)?;
            (reference.into_owned(), memory, state.into_owned(), seat_work)
        }
        None => {
            let (state, mut resting, contacts) =
                equilibrium(body, (&grains, start), &mut surface, &dead_load)?;
            if let Some(carried) = carried {
                carried.restore_history(&grains, &mut resting);
            }
            let reference = state.u.clone();
            let start = coupling::step::State::new(state, resting);
            // Only the lagged scheme keeps the previous load.
            let lagged = plan.scheme == Scheme::Lagged;
            (reference, None, if lagged { start.with_initial_contact_load(contacts) } else { start }, 0.0)
        }
    };
    let model = coupling::step::Model {
        solid: body.model,
        dead_load,
        reference,
        substeps,
        division: state.interface_check.division.max(1),
        scheme: plan.scheme,
        theta,
        newton: solid.newton,
        grains,
    };
    let steps = match run.device {
        Place::Cpu => Steps::processor(dem::Work::new(&model.grains, &state.grains)),
        Place::Gpu => Steps::device(&model.grains, &state.grains)?,
    };
    let mut work = coupling::step::Work::with_back_end(&model, &state, surface, steps)
        .and_then(|mut work| work.restore(&model, memory.as_ref()).map(|()| work))
        .map_err(|e| solid.failure(&e))?;
    reduction::reduce(run, solid, (&model, &mut state), &mut work, summary)?;
    // Undivided, also when resumed.
    summary.model.solid_step = Some(model.grains.dt() * f64::from(model.substeps));
    progress.finish("solid in equilibrium with its weight and the bed, matrix factorized");
    let seats = solid.sleepers.as_ref().map(|bodies| Meshed {
        bodies,
        bases,
        load,
        first_face: plan.ground_faces,
        work: seat_work,
    });
    Ok(CoupledSystem {
        last_window: model.window(),
        model,
        state,
        work,
        changed: false,
        automatic: plan.automatic(),
        loads: &solid.loads,
        ground_faces: plan.ground_faces,
        seats,
    })
}

/// Reads a checkpoint. The end of another run restarts the balances.
fn saved(loaded: &mut Loaded) -> Result<SavedCoupling<'static>, Failure> {
    let mut saved: SavedCoupling<'_> = loaded.take()?;
    if loaded.moment.stage == END {
        saved.state.to_mut().reset_time_and_balances();
        saved = SavedCoupling { memory: None, seat_work: 0.0, ..saved };
    }
    Ok(saved)
}

struct Bed<'a> {
    model: dem::Model,
    start: dem::State,
    carried: Option<&'a Carried>,
}

#[derive(Clone, Copy)]
struct Body<'a> {
    part: &'a SolidPart,
    model: &'a fem::Model,
}

/// Equilibrium with weight, loads and grains; returns grain contacts and load [N].
fn equilibrium(
    body: Body<'_>,
    (grains, start): (&dem::Model, dem::State),
    surface: &mut SolidSurface,
    dead_load: &[f64],
) -> Result<(fem::State, dem::State, Vec<f64>), Failure> {
    let Body { part: solid, model, .. } = body;
    let mut load = dead_load.to_vec();
    solid.add_loads(0.0, &mut load);
    let (contacts, resting) = coupling::step::initial_contact_load(grains, start, surface, model.mesh())
        .map_err(|e| Failure::Numerical(grains.name_objects(&e)))?;
    for (l, c) in load.iter_mut().zip(&contacts) {
        *l += c;
    }
    // Sleepers do not yet rest on the grains.
    let ground = solid.ground().map_err(|e| Failure::Other(e.to_string()))?;
    let standing = ground.as_ref().unwrap_or(model);
    let (load, dead_load) = (&load[..standing.dof_count()], &dead_load[..standing.dof_count()]);
    let rest = if solid.is_linear() {
        let rest = fem::statics::solve(standing, load).map_err(|e| solid.failure(&e))?;
        let mut state = fem::state::State::new(standing);
        state.u.copy_from_slice(&rest.u);
        state
    } else {
        initial::under_load(solid, standing, dead_load, load)?
    };
    if ground.is_none() {
        return Ok((rest, resting, contacts));
    }
    let mut state = fem::state::State::new(model);
    for (all, own) in [(&mut state.u, &rest.u), (&mut state.v, &rest.v), (&mut state.a, &rest.a)] {
        all[..own.len()].copy_from_slice(own);
    }
    state.points = rest.points;
    if !state.points.is_empty() {
        state.points.resize(model.point_count(), model.value_count());
    }
    Ok((state, resting, contacts))
}
