//! From the bodies of a scene to the bed that the run proper starts with: growth, settling (in layers), compaction.

use super::Stage;
use super::bed::{Bed, rms_speed};
use super::checkpoint::Moment;
use super::packing::GrowthRecord;
use super::settle::{SETTLING, Settled};
use super::summary::StageRecord;
use crate::failure::Failure;
use crate::model::grains::{DepositionPlan, GrainsPart, refused};
use crate::progress::Progress;
use serde::{Deserialize, Serialize};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
use trackbed_dem::insert::grow::{GrowError, grow};

/// Gap between a layer of grains and the bed that it falls on, as a share of the largest grain's radius.
const GAP: f64 = 1e-3;

/// Stage of a checkpoint between two stages of packing.
const PACKING: &str = "packing";

/// How far the packing has come; compaction counts its own stages.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
pub(super) enum Packed {
    Nothing,
    Grown,
    Layered,
    Settled,
}

/// The head of a checkpoint from within the packing.
#[derive(Deserialize)]
struct Packing {
    done: Packed,
    /// The grains that are to settle.
    bodies: Vec<BodyInput>,
    bed: Settled,
}

/// Points of the planes [m].
pub(super) fn planes(grains: &GrainsPart) -> Vec<dem::Vec3> {
    grains.planes().iter().map(|p| p.point).collect()
}

impl Stage<'_> {
    /// Grows, settles and compacts. A checkpoint is written between these stages.
    pub(super) fn packed(
        &self,
        mut grains: GrainsPart,
        surface: Option<&SolidSurface>,
    ) -> Result<Settled, Failure> {
        let mut resumed = self.resumed(PACKING).or_else(|| self.resumed(SETTLING));
        let (mut bed, done) = match &mut resumed {
            Some(loaded) => {
                let Packing { done, bodies, bed } = loaded.take()?;
                grains.bodies = bodies;
                bed.planes.iter().enumerate().for_each(|(k, point)| grains.place_plane(k, *point));
                (bed, done)
            }
            None => (Settled::default(), Packed::Nothing),
        };
        if done < Packed::Grown {
            self.grow(&mut grains, &mut bed)?;
        }
        if let Some(plan) = grains.deposition.clone() {
            if done < Packed::Layered && plan.layers > 1 {
                self.keep(Packed::Grown, &grains, &mut bed)?;
                self.keeper.begin();
                self.drop_layers(&mut grains, &plan, surface, &mut bed)?;
                self.keeper.end();
                self.keep(Packed::Layered, &grains, &mut bed)?;
            }
            if done < Packed::Settled {
                let resumed = resumed.filter(|loaded| loaded.moment.stage == SETTLING);
                self.settle(&grains, &plan, surface, &mut bed, resumed)?;
            }
        } else if done < Packed::Settled {
            bed.bodies.clone_from(&grains.bodies);
        }
        for index in bed.compaction.len()..grains.compaction.len() {
            self.keep(Packed::Settled, &grains, &mut bed)?;
            self.keeper.begin();
            self.compact(&mut grains, index, surface, &mut bed)?;
            self.keeper.end();
        }
        bed.planes = planes(&grains);
        Ok(bed)
    }

    /// Writes the checkpoint between two stages.
    fn keep(&self, done: Packed, grains: &GrainsPart, bed: &mut Settled) -> Result<(), Failure> {
        bed.planes = planes(grains);
        let step = bed.stages.iter().map(|s| s.grain_steps).sum();
        let moment = Moment { stage: PACKING.into(), step, time: bed.time };
        self.keeper.save(moment, |body| body.put(&(done, &grains.bodies, &*bed)))
    }

    /// Grows the groups that are to grow.
    fn grow(&self, grains: &mut GrainsPart, bed: &mut Settled) -> Result<(), Failure> {
        for plan in grains.growths.clone() {
            let progress = Progress::start("growing", 1.0, self.quiet);
            let bodies = &grains.bodies[plan.bodies.clone()];
            let material = grains.material(&bodies[0]);
            let grown = grow(&plan.container, grains.shapes(), bodies, material, &plan.how);
            let grown = grown.map_err(|e| match e {
                GrowError::Model(e) => Failure::from(refused(self.document, &e)),
                other => Failure::Numerical(format!("group {}: {other}", plan.group)),
            })?;
            let text = format!("{} grains of {}: porosity {:.4}", bodies.len(), plan.group, grown.porosity);
            let seconds = progress.finish(&text);
            bed.stages.push(StageRecord {
                name: format!("growing {}", plan.group),
                seconds,
                grain_steps: grown.steps,
                solid_steps: 0,
            });
            bed.growth.push(GrowthRecord {
                group: plan.group,
                porosity: grown.porosity,
                largest_overlap: grown.overlap,
                unbalanced_ratio: grown.unbalanced,
            });
            grains.bodies.splice(plan.bodies, grown.bodies);
        }
        Ok(())
    }

    /// Drops all layers but the last, each just above the settled ones, and puts the last one there: it is left for the
    /// settling proper.
    fn drop_layers(
        &self,
        grains: &mut GrainsPart,
        plan: &DepositionPlan,
        surface: Option<&SolidSurface>,
        bed: &mut Settled,
    ) -> Result<(), Failure> {
        // Grains that wait for their inlet do not fall.
        let mut order: Vec<usize> = (0..grains.bodies.len()).filter(|&b| !grains.bodies[b].absent).collect();
        let height = |b: &usize| grains.bodies[*b].position.z;
        order.sort_by(|a, b| height(a).total_cmp(&height(b)));
        if order.is_empty() {
            return Ok(());
        }
        let layers: Vec<&[usize]> = order.chunks(order.len().div_ceil(plan.layers as usize)).collect();
        let progress = Progress::start("layers", layers.len() as f64, self.quiet);
        let mut steps = 0;
        let mut below: Vec<usize> = Vec::new();
        for (k, layer) in layers.iter().enumerate() {
            lower(grains, &below, layer);
            below.extend_from_slice(layer);
            if k + 1 == layers.len() {
                break;
            }
            let inputs: Vec<BodyInput> = below.iter().map(|&b| grains.bodies[b].clone()).collect();
            let mut input = grains.deposition_input(plan);
            input.bodies.clone_from(&inputs);
            let model = dem::Model::new(input).map_err(|e| refused(self.document, &e))?;
            let mut falling = Bed::new(model, surface, &self.keeper, "settling in layers");
            if !falling.rest(plan)? {
                let speed = rms_speed(&falling.model, &falling.state);
                bed.warnings.push(format!(
                    "layer {} of the grains was still moving at {speed:.2e} m/s (root mean square) after {} s",
                    k + 1,
                    plan.max_time
                ));
            }
            for (&b, now) in below.iter().zip(falling.at_rest(&inputs)) {
                grains.bodies[b] = now;
            }
            steps += falling.state.steps;
            progress.at(k as f64 + 1.0);
        }
        let seconds = progress.finish(&format!("{} layers at rest", layers.len() - 1));
        bed.stages.push(StageRecord { name: "layers".into(), seconds, grain_steps: steps, solid_steps: 0 });
        Ok(())
    }
}

/// Brings a layer down (or up) to just above the bodies `below`; the first one stays where it is.
fn lower(grains: &mut GrainsPart, below: &[usize], layer: &[usize]) {
    let top = below.iter().map(|&b| grains.bodies[b].position.z + grains.reach(&grains.bodies[b]));
    let top = top.fold(f64::NEG_INFINITY, f64::max);
    let reach = |b: &usize| grains.reach(&grains.bodies[*b]);
    let largest = layer.iter().map(reach).fold(0.0, f64::max);
    let bottom = layer.iter().map(|b| grains.bodies[*b].position.z - reach(b)).fold(f64::INFINITY, f64::min);
    let shift = top + GAP * largest - bottom;
    if shift.is_finite() {
        layer.iter().for_each(|&b| grains.bodies[b].position.z += shift);
    }
}
