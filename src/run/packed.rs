//! From the bodies of a scene to the bed that the run proper starts with: growth, settling in layers, compaction.

use super::Stage;
use super::bed::Bed;
use super::summary::{CompactionRecord, GrowthRecord, StageRecord, Summary};
use crate::failure::Failure;
use crate::model::grains::{CompactionPlan, GrainsPart, Press, refused};
use crate::progress::Progress;
use std::f64::consts::TAU;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::insert::grow::{GrowError, grow};
use trackbed_dem::measure::{BoxRegion, porosity};
use trackbed_dem::{AppliedForce, BodyInput, Vec3};

impl Stage<'_> {
    /// Grows, settles and compacts. Walls may have moved: the grains come back with them.
    pub(super) fn packed(
        &self,
        grains: &GrainsPart,
        surface: Option<&SolidSurface>,
        summary: &mut Summary,
    ) -> Result<(GrainsPart, Vec<BodyInput>), Failure> {
        let mut grains = grains.clone();
        self.grow(&mut grains, summary)?;
        let layers = grains.deposition.as_ref().map_or(1, |plan| plan.layers);
        if layers > 1 {
            self.drop_layers(&mut grains, layers, surface, summary)?;
        }
        let mut bodies = self.deposit(&grains, surface, summary)?;
        for index in 0..grains.compaction.len() {
            bodies = self.compact(&mut grains, index, bodies, surface, summary)?;
        }
        Ok((grains, bodies))
    }

    /// Grows the groups that are to grow.
    fn grow(&self, grains: &mut GrainsPart, summary: &mut Summary) -> Result<(), Failure> {
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
            grains.bodies.splice(plan.bodies.clone(), grown.bodies.iter().cloned());
            summary.stages.push(StageRecord {
                name: format!("growing {}", plan.group),
                seconds,
                grain_steps: grown.steps,
                solid_steps: 0,
            });
            summary.growth.push(GrowthRecord {
                group: plan.group,
                porosity: grown.porosity,
                largest_overlap: grown.overlap,
                unbalanced_ratio: grown.unbalanced,
            });
        }
        Ok(())
    }

    /// Drops all layers but the last, each just above the settled ones; what is left for the deposition proper is the
    /// last one above the bed.
    fn drop_layers(
        &self,
        grains: &mut GrainsPart,
        layers: u32,
        surface: Option<&SolidSurface>,
        summary: &mut Summary,
    ) -> Result<(), Failure> {
        let Some(plan) = grains.deposition.clone() else { return Ok(()) };
        let mut order: Vec<usize> = (0..grains.bodies.len()).collect();
        order.sort_by(|&a, &b| grains.bodies[a].position.z.total_cmp(&grains.bodies[b].position.z));
        let size = order.len().div_ceil(layers as usize);
        let parts: Vec<&[usize]> = order.chunks(size).collect();
        let progress = Progress::start("layers", parts.len() as f64, self.quiet);
        let mut steps = 0;
        let mut rising: Vec<usize> = Vec::new();
        for (k, layer) in parts.iter().enumerate() {
            if k > 0 {
                lower(grains, &rising, layer)?;
            }
            rising.extend_from_slice(layer);
            if k + 1 == parts.len() {
                break;
            }
            let inputs: Vec<BodyInput> = rising.iter().map(|&b| grains.bodies[b].clone()).collect();
            let mut input = grains.deposition_input(&plan);
            input.bodies.clone_from(&inputs);
            let model = dem::Model::new(input).map_err(|e| refused(self.document, &e))?;
            let mut bed = Bed::new(model, surface, "settling in layers");
            // Until here nothing has fallen: the layer needs its time.
            if !bed.rest(&plan)? {
                summary.warnings.push(format!(
                    "layer {} of the grains was still moving at {:.2e} m/s (root mean square) after {} s",
                    k + 1,
                    bed.rms_speed(),
                    plan.max_time
                ));
            }
            for (&b, now) in rising.iter().zip(bed.at_rest(&inputs)) {
                grains.bodies[b] = now;
            }
            steps += bed.state.steps;
            progress.at(k as f64 + 1.0);
        }
        let seconds = progress.finish(&format!("{} layers", parts.len() - 1));
        summary.stages.push(StageRecord { name: "layers".into(), seconds, grain_steps: steps, solid_steps: 0 });
        Ok(())
    }

    /// One stage of compaction.
    fn compact(
        &self,
        grains: &mut GrainsPart,
        index: usize,
        bodies: Vec<BodyInput>,
        surface: Option<&SolidSurface>,
        summary: &mut Summary,
    ) -> Result<Vec<BodyInput>, Failure> {
        let plan = grains.compaction[index].clone();
        let progress = Progress::start("compacting", 1.0, self.quiet);
        let mut input = grains.deposition_input(&plan.rest);
        input.bodies.clone_from(&bodies);
        if let Press::Tamping { plate, half, at, .. } = &plan.press {
            // It waits above everything until it is set down at its first place.
            let top = bodies.iter().map(|b| b.position.z).fold(f64::NEG_INFINITY, f64::max);
            let z = top + grains_reach(grains, &bodies) + half[2];
            let position = Vec3::new(at[0][0], at[0][1], z);
            input.bodies.push(BodyInput { position, ..plate.clone() });
        }
        let gravity = input.gravity;
        let model = dem::Model::new(input.clone()).map_err(|e| refused(self.document, &e))?;
        let mut bed = Bed::new(model, surface, "being compacted");
        let measure = |bed: &Bed<'_>, region: &BoxRegion| {
            // The plate is no grain.
            let grains = (0..bodies.len()).map(|b| dem::measure::body_volume_in(&bed.model, &bed.state, b, region));
            1.0 - grains.sum::<f64>() / region.volume()
        };
        let before = measure(&bed, &plan.region);
        let mut region = plan.region;
        let mut peak = None;
        let rested;
        let mut steps = 0;
        let settled = match &plan.press {
            Press::Vibration { planes, amplitude, frequency, cycles } => {
                shake(&mut bed, planes, amplitude, *frequency, *cycles)?;
                rested = bed.rest(&plan.rest)?;
                bed.at_rest(&bodies)
            }
            Press::Tamping { plate, half, at, force, frequency, cycles } => {
                let mut settled = bodies.clone();
                let mut down = true;
                for place in at {
                    // A model for each place: the plate is set down just above the highest grain below it.
                    let mut here = input.clone();
                    here.bodies.truncate(bodies.len());
                    here.bodies.clone_from_slice(&settled);
                    let z = super::settle::highest_below(&bed_of(&here, self, surface)?, *place, half, surface);
                    let position = Vec3::new(place[0], place[1], z + half[2]);
                    here.bodies.push(BodyInput { position, ..plate.clone() });
                    let model = dem::Model::new(here).map_err(|e| refused(self.document, &e))?;
                    let mut press = Bed::new(model, surface, "being tamped");
                    tamp(&mut press, bodies.len(), *force, *frequency, *cycles)?;
                    steps += press.state.steps;
                    settled = press.at_rest(&settled);
                    // Without the plate.
                    let mut free = input.clone();
                    free.bodies.clone_from(&settled);
                    let model = dem::Model::new(free).map_err(|e| refused(self.document, &e))?;
                    bed = Bed::new(model, surface, "coming to rest");
                    down &= bed.rest(&plan.rest)?;
                    settled = bed.at_rest(&settled);
                    steps += bed.state.steps;
                }
                steps -= bed.state.steps;
                rested = down;
                settled
            }
            Press::Squeeze { plane, velocity, porosity, max_travel } => {
                let mut pressure = 0.0_f64;
                let stride = ((1e-3 / bed.model.dt()) as u64).max(1);
                bed.state.set_plane_velocity(*plane, *velocity);
                let reached = loop {
                    let travel = (bed.state.plane_point(&bed.model, *plane) - grains.planes()[*plane].point).norm();
                    region = cut_off(&plan.region, &bed, *plane);
                    if measure(&bed, &region) <= *porosity {
                        break true;
                    }
                    if travel >= *max_travel {
                        break false;
                    }
                    for _ in 0..stride {
                        bed.step(&[])?;
                    }
                };
                bed.state.set_plane_velocity(*plane, Vec3::zeros());
                rested = bed.rest(&plan.rest)?;
                if !reached {
                    summary.warnings.push(format!(
                        "squeezing stopped after {max_travel} m at the porosity {:.4}, above {porosity}",
                        measure(&bed, &region)
                    ));
                }
                for c in dem::measure::contacts(&bed.model, &bed.state) {
                    if c.b == dem::Partner::Plane(*plane) {
                        pressure += c.normal_force;
                    }
                }
                peak = Some(pressure);
                grains.place_plane(*plane, bed.state.plane_point(&bed.model, *plane));
                bed.at_rest(&bodies)
            }
        };
        let _ = gravity;
        steps += bed.state.steps;
        let after = measure(&bed, &region);
        if !rested {
            summary.warnings.push(format!(
                "the grains were still moving at {:.2e} m/s (root mean square) after stage {} of the compaction",
                bed.rms_speed(),
                index + 1
            ));
        }
        let name = plan.press.name();
        let seconds = progress.finish(&format!("{name}: porosity {before:.4} to {after:.4}"));
        summary.stages.push(StageRecord {
            name: format!("compaction {}: {name}", index + 1),
            seconds,
            grain_steps: steps,
            solid_steps: 0,
        });
        summary.compaction.push(CompactionRecord { kind: name, before, after, wall_force: peak });
        Ok(settled)
    }
}
