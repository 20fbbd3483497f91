//! Deposition in layers.

use super::stage::Settled;
use crate::bed::{Bed, rms_speed};
use crate::context::Run;
use crate::summary::StageRecord;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
use trackbed_input::model::grains::{DepositionPlan, GrainsPart, GroupsPart, refused};
use trackbed_io::failure::Failure;
use trackbed_io::progress::Progress;

/// Drop gap over the largest grain radius.
const GAP: f64 = 1e-3;

/// Drops all layers but the last, which is placed above the bed.
///
/// # Errors
/// Numerical failures, interrupts.
pub fn drop_layers(
    run: &Run<'_>,
    grains: &mut GrainsPart,
    plan: &DepositionPlan,
    surface: Option<&SolidSurface>,
    bed: &mut Settled,
) -> Result<(), Failure> {
    // Queued grains do not fall.
    let bodies = &grains.groups.bodies;
    let mut order: Vec<usize> = (0..bodies.len()).filter(|&b| !bodies[b].absent).collect();
    let height = |b: &usize| bodies[*b].position.z;
    order.sort_by(|a, b| height(a).total_cmp(&height(b)));
    if order.is_empty() {
        return Ok(());
    }
    let layers: Vec<&[usize]> = order.chunks(order.len().div_ceil(plan.layers as usize)).collect();
    let mut progress = Progress::start("layers", layers.len() as f64, run.verbosity);
    let mut steps = 0;
    let mut below: Vec<usize> = Vec::new();
    for (k, layer) in layers.iter().enumerate() {
        lower(&mut grains.groups, &below, layer);
        below.extend_from_slice(layer);
        if k + 1 == layers.len() {
            break;
        }
        let inputs: Vec<BodyInput> = below.iter().map(|&b| grains.groups.bodies[b].clone()).collect();
        let mut input = grains.deposition_input(plan);
        input.bodies.clone_from(&inputs);
        let model = dem::Model::new(input).map_err(|e| refused(run.document, &e))?;
        let mut falling = Bed::new(model, surface, &run.checkpoints, "settling in layers");
        if !falling.rest(plan)? {
            let speed = rms_speed(&falling.model, &falling.state);
            bed.warnings.push(format!(
                "layer {} not at rest: root mean square speed {speed:.2e} m/s after {} s",
                k + 1,
                plan.max_time
            ));
        }
        bed.energy.push(falling.energy(&format!("layer {}", k + 1))?);
        for (&b, now) in below.iter().zip(falling.at_rest(&inputs)) {
            grains.groups.bodies[b] = now;
        }
        steps += falling.state.steps;
        progress.at(k as f64 + 1.0, String::new);
    }
    let seconds = progress.finish(&format!("{} layers at rest", layers.len() - 1));
    bed.stages.push(StageRecord {
        name: "layers".into(),
        seconds,
        grain_steps: steps,
        solid_steps: 0,
        windows: 0,
    });
    Ok(())
}

/// The first layer stays.
fn lower(groups: &mut GroupsPart, below: &[usize], layer: &[usize]) {
    let top = below.iter().map(|&b| groups.bodies[b].position.z + groups.reach(&groups.bodies[b]));
    let top = top.fold(f64::NEG_INFINITY, f64::max);
    let reach = |b: &usize| groups.reach(&groups.bodies[*b]);
    let largest = layer.iter().map(reach).fold(0.0, f64::max);
    let bottom = layer.iter().map(|b| groups.bodies[*b].position.z - reach(b)).fold(f64::INFINITY, f64::min);
    let shift = top + GAP * largest - bottom;
    if shift.is_finite() {
        layer.iter().for_each(|&b| groups.bodies[b].position.z += shift);
    }
}
