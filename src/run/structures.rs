//! Loads and motion of structures.

use super::recorder::{Now, Recorder};
use super::summary::LoadRecord;
use super::system::{GrainsView, System};
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_input::model::grains::StructurePlan;
use trackbed_io::columns::history;
use trackbed_io::write::csv::{Column, Row};

/// Motion, total load, moment, loads by sector and height.
pub struct Structures;

impl<S: System> Recorder<S> for Structures {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (Some(part), Some(view)) = (&now.job.grains, now.system.grains()) else { return };
        part.structures.iter().for_each(|plan| load(plan, view, row));
    }
}

fn load(plan: &StructurePlan, GrainsView { model, state }: GrainsView<'_>, row: &mut Row) {
    let foot = Vec3::from(plan.foot);
    let (mut force, mut moment) = (Vec3::zeros(), Vec3::zeros());
    let mut sectors = vec![0.0; plan.sectors];
    let mut layers = vec![Vec3::zeros(); if plan.levels.is_empty() { 0 } else { plan.levels.len() + 1 }];
    let body = |b: usize| state.present(b) && plan.groups.contains(&model.part(b));
    let wall = |w: usize| plan.walls.contains(&w);
    dem::measure::loads_on(model, state, (body, wall), |point, f| {
        force += f;
        moment += (point - foot).cross(&f);
        let way = point - foot;
        let distance = libm::hypot(way.x, way.y);
        if plan.sectors > 0 && distance > 0.0 {
            sectors[plan.sector(point.into())] -= (f.x * way.x + f.y * way.y) / distance;
        }
        if !layers.is_empty() {
            layers[plan.layer(point.into())] += f;
        }
    });
    let name = &plan.name;
    if let Some(wall) = plan.body {
        row.vector(history::STRUCTURE_MOTION.of(name), state.wall_offset(wall));
        row.vector(history::STRUCTURE_ACCELERATION.of(name), state.wall_acceleration(wall));
    }
    row.vector(history::STRUCTURE_LOAD.of(name), force);
    row.put(history::STRUCTURE_LOAD_LEVEL.of(name), libm::hypot(force.x, force.y));
    row.vector(history::STRUCTURE_LOAD_MOMENT.of(name), moment);
    for (k, sum) in sectors.iter().enumerate() {
        row.put(history::STRUCTURE_SECTOR.of(name).at(k), *sum);
    }
    for (k, sum) in layers.iter().enumerate() {
        row.put(history::STRUCTURE_LAYER.of(name).at(k), libm::hypot(sum.x, sum.y));
    }
}

/// Adds a history row to the records.
pub fn follow(columns: &[Column], values: &[f64], records: &mut Vec<LoadRecord>) {
    let [load, motion] = [history::STRUCTURE_LOAD.at(0), history::STRUCTURE_MOTION.at(0)];
    let heads = columns.iter().enumerate().filter_map(|(k, c)| Some((k, load.item_in(&c.name)?)));
    for (number, (k, name)) in heads.enumerate() {
        if records.len() == number {
            records.push(LoadRecord { name: name.into(), ..LoadRecord::default() });
        }
        let record = &mut records[number];
        let [x, y, level] = [values[k], values[k + 1], values[k + 3]];
        if level > record.largest {
            (record.largest, record.time) = (level, values[0]);
        }
        let share = 1.0 / (record.rows + 1) as f64;
        record.mean[0] += (x - record.mean[0]) * share;
        record.mean[1] += (y - record.mean[1]) * share;
        record.rows += 1;
        // Displacement and acceleration precede the load.
        if let Some(first) = k.checked_sub(6)
            && motion.item_in(&columns[first].name) == Some(name)
        {
            let level = |at: usize| libm::hypot(values[at], values[at + 1]);
            let (way, acceleration) = (level(first), level(first + 3));
            let motion = record.motion.get_or_insert_default();
            motion.largest_displacement = motion.largest_displacement.max(way);
            motion.mean_displacement[0] += (values[first] - motion.mean_displacement[0]) * share;
            motion.mean_displacement[1] += (values[first + 1] - motion.mean_displacement[1]) * share;
            motion.largest_acceleration = motion.largest_acceleration.max(acceleration);
            let square = motion.rms_acceleration * motion.rms_acceleration;
            motion.rms_acceleration = (square + (acceleration * acceleration - square) * share).sqrt();
        }
        let head = history::STRUCTURE_SECTOR.of(name).to_string();
        let of = columns.iter().zip(values).filter(|(c, _)| c.name.starts_with(&head));
        for (sector, (_, value)) in of.enumerate() {
            if record.sectors.len() == sector {
                record.sectors.push(0.0);
            }
            record.sectors[sector] = record.sectors[sector].max(*value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::MotionRecord;

    /// Checkpoint fields are unnamed and must be read in writing order.
    #[test]
    fn records_survive_checkpoint() {
        let still = LoadRecord { name: "pile".into(), largest: 3.0, ..LoadRecord::default() };
        let moved = LoadRecord { motion: Some(MotionRecord::default()), ..still.clone() };
        for record in [still, moved] {
            let bytes = postcard::to_stdvec(&(&record, 7_u64)).expect("bytes");
            let (read, behind): (LoadRecord, u64) =
                postcard::from_bytes(&bytes).expect("a record and a number");
            assert_eq!(
                (read.name, read.largest, read.motion.is_some(), behind),
                (record.name, 3.0, record.motion.is_some(), 7)
            );
        }
    }
}
