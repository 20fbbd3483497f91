//! Main loop of grains and solid under load.

use super::coupling_remarks::{inaccurate_reduction, late, unconverged, unstable_interface};
use super::solid_loop::solid_alone;
use super::stage::{CoupledRun, GrainTime, GrainsState, RUN, RunState, Stage, Steps, planes};
use super::{statics, time_loop};
use crate::context::Run;
use crate::from::END;
use crate::packing;
use crate::summary::NewtonRecord;
use crate::system::{GrainsSystem, System};
use crate::validity::{grains_below_walls, load_near_mode, lost_bodies, small_strain};
use trackbed_fem as fem;
use trackbed_input::model::Job;
use trackbed_input::model::solid::Analysis;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::progress::Verbosity;
use trackbed_track::TrackSystem;

/// Main loop with loads, flow and push.
pub struct MainLoop;

impl Stage for MainLoop {
    fn name(&self) -> Option<&'static str> {
        Some(RUN)
    }

    fn applies(&self, job: &Job) -> bool {
        job.grains.is_some()
            || job
                .solid
                .as_ref()
                .is_some_and(|s| matches!(s.analysis, Analysis::Dynamic(_) | Analysis::QuasiStatic(_)))
    }

    fn report(&self, job: &Job, steps: Steps<'_>) -> Vec<String> {
        if let Some(grains) = &job.grains {
            let mut lines = vec![format!("run: {} s, {}", (1e9 * job.end).round() / 1e9, steps(job.end))];
            let waiting = |part| grains.groups.bodies.iter().filter(|b| b.absent && b.part == part).count();
            lines.extend(grains.flow.iter().flat_map(|f| f.lines(&grains.groups.names, waiting)));
            return lines;
        }
        let kind = match job.solid.as_ref().map(|s| &s.analysis) {
            Some(Analysis::QuasiStatic(_)) => "quasi-static",
            _ => "dynamics",
        };
        let line =
            |step: f64| format!("{kind}: {} s in {:.0} time steps of {step} s", job.end, job.end / step);
        job.solid_step.map(line).into_iter().collect()
    }

    fn grain_time(&self, job: &Job) -> Option<GrainTime> {
        job.grains.as_ref().map(|_| GrainTime::Exactly(job.end))
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        match (state.coupled.take(), &run.job.solid) {
            (Some(coupled), _) => coupled_loop(run, state, coupled),
            (None, Some(solid)) => solid_alone(run, solid, state),
            (None, None) => grains_alone(run, state),
        }
    }
}

fn grains_alone(run: &Run<'_>, state: &mut RunState<'_>) -> Result<(), Failure> {
    let grains = state.grains.as_ref().expect("a run with grains");
    let sharing = run.ranks.share(&grains.bodies, &planes(&grains.part));
    let model = state.grain_model(run)?;
    let interval = run.job.output.history_interval;
    let mut resumed = state.loaded.take();
    let mut system = match &mut resumed {
        Some(loaded) => GrainsSystem::resume(model, interval, loaded, run.device, sharing)?,
        None => {
            let start = state.grains.as_ref().expect("a run with grains").start(&model)?;
            let mut system = GrainsSystem::new(model, start, interval, run.device, sharing)?;
            if let Some(carried) = state.grains.as_ref().and_then(|grains| grains.carried.as_ref()) {
                let (model, state) = system.state_mut();
                carried.restore_history(model, state);
            }
            system
        }
    };
    if resumed.take_if(|loaded| loaded.moment.stage == END).is_some() {
        system.reset_time();
    }
    run.prepare()?;
    let grains = state.grains.as_ref().expect("a run with grains");
    time_loop::with_grains(run, &mut system, grains, resumed, &mut state.summary)?;
    if run.verbosity == Verbosity::Verbose {
        system.traffic().iter().for_each(|line| message::note(&format!("ranks: {line}")));
    }
    state.summary.bed.packing = record_packing(run, &system, grains)?;
    state.summary.validity.extend(system.grains().into_iter().flat_map(|v| packing::checks(v, &grains.part)));
    if let Some(view) = system.grains() {
        state.summary.validity.extend(grains_below_walls(view, &grains.part));
    }
    Ok(())
}

fn coupled_loop(run: &Run<'_>, state: &mut RunState<'_>, coupled: CoupledRun<'_>) -> Result<(), Failure> {
    let CoupledRun { mut system, solid, lowest } = coupled;
    run.prepare()?;
    let grains = state.grains.as_ref().expect("a run with grains");
    let (resumed, summary) = (state.loaded.take(), &mut state.summary);
    let outcome = time_loop::with_grains(run, &mut system, grains, resumed, summary);
    system.recover();
    if let Some(record) = &mut summary.coupling {
        record.transfer = system.state.audit;
        record.passes = system.state.passes;
        record.interface_work_error = system.spent().interface();
        record.interface = system.state.interface_check.largest;
        record.division = system.model.division;
        record.reduction = system.work.reduction().map(|_| (&system.state.reduction).into());
        summary.warnings.extend(record.reduction.as_ref().and_then(inaccurate_reduction));
        let plan = run.job.coupling.as_ref();
        summary.warnings.extend(plan.and_then(|plan| unstable_interface(&system, record, plan)));
    }
    summary.warnings.extend(unconverged(&system.state.passes));
    summary.warnings.extend(late(&system.spent()));
    if let Some(view) = system.grains() {
        let (check, few) = lost_bodies(view, lowest);
        summary.validity.push(check);
        summary.warnings.extend(few);
    }
    summary.validity.extend(small_strain(solid, &system.state.solid.u));
    summary.validity.extend(load_near_mode(run.job));
    outcome?;
    summary.bed.packing = record_packing(run, &system, grains)?;
    summary.validity.extend(system.grains().into_iter().flat_map(|v| packing::checks(v, &grains.part)));
    if run.job.output.tables {
        let moved = &system.state.solid;
        let reactions = fem::energy::reactions(solid, moved, system.work.load());
        statics::write_tables(solid, moved, &reactions, run.dir)?;
    }
    summary.solid.newton = system.work.newton().map(|s| NewtonRecord::of(&s));
    Ok(())
}

fn record_packing(
    run: &Run<'_>,
    system: &impl TrackSystem,
    grains: &GrainsState,
) -> Result<Option<packing::PackingRecord>, Failure> {
    system.grains().map(|view| packing::record(run.job, run.dir, view, &grains.part)).transpose()
}
