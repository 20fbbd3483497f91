//! Loads and motion of structures.

use super::hazard;
use super::recorder::{Now, Recorder};
use super::summary::LoadRecord;
use super::system::{GrainsView, System};
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_input::model::grains::StructurePlan;
use trackbed_io::columns::{Definition, history};
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

/// Adds time and horizontal load of a history row, of structures with statistics only.
pub fn follow_loads(
    columns: &[Column],
    values: &[f64],
    plans: &[StructurePlan],
    rows: &mut Vec<Vec<[f64; 2]>>,
) {
    if plans.iter().all(|plan| plan.hazard.is_none()) {
        return;
    }
    rows.resize(plans.len(), Vec::new());
    for (plan, rows) in plans.iter().zip(rows).filter(|(plan, _)| plan.hazard.is_some()) {
        let name = history::STRUCTURE_LOAD_LEVEL.of(&plan.name).to_string();
        let level = columns.iter().position(|c| c.name == name);
        rows.extend(level.map(|k| [values[0], values[k]]));
    }
}

/// Completes the records with statistics of their rows.
pub fn with_hazards(
    records: &[LoadRecord],
    plans: &[StructurePlan],
    rows: &[Vec<[f64; 2]>],
) -> Vec<LoadRecord> {
    let mut records = records.to_vec();
    for ((record, plan), rows) in records.iter_mut().zip(plans).zip(rows) {
        record.hazard = plan.hazard.as_ref().map(|plan| hazard::record(plan, rows));
    }
    records
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
        let of = |list: &'static Definition| {
            let head = list.of(name).to_string();
            columns
                .iter()
                .zip(values)
                .filter(move |(c, _)| c.name.starts_with(&head))
                .map(|(_, value)| *value)
        };
        follow_parts(of(history::STRUCTURE_SECTOR), &mut record.sectors, &mut record.mean_sectors, share);
        follow_parts(of(history::STRUCTURE_LAYER), &mut record.layers, &mut record.mean_layers, share);
    }
}

/// Adds a row of loads to the largest and the mean ones, weighted by `share`.
fn follow_parts(values: impl Iterator<Item = f64>, largest: &mut Vec<f64>, mean: &mut Vec<f64>, share: f64) {
    for (part, value) in values.enumerate() {
        if largest.len() == part {
            largest.push(0.0);
            mean.push(0.0);
        }
        largest[part] = largest[part].max(value);
        mean[part] += (value - mean[part]) * share;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::MotionRecord;

    #[test]
    fn means_follow_rows() {
        let names = [
            "time",
            "pile_load_x",
            "pile_load_y",
            "pile_load_z",
            "pile_load_level",
            "pile_sector0",
            "pile_sector1",
            "pile_layer0",
        ];
        let columns: Vec<Column> =
            names.iter().map(|name| Column { name: name.to_string(), unit: "N".into() }).collect();
        let mut records = Vec::new();
        for row in [[0.0, 1.0, 0.0, 0.0, 1.0, 5.0, -2.0, 1.0], [0.1, 3.0, 4.0, 0.0, 5.0, 1.0, 0.0, 5.0]] {
            follow(&columns, &row, &mut records);
        }
        let record = &records[0];
        assert_eq!((record.largest, record.time, record.mean), (5.0, 0.1, [2.0, 2.0]));
        assert_eq!((&record.sectors[..], &record.mean_sectors[..]), (&[5.0, 0.0][..], &[3.0, -1.0][..]));
        assert_eq!((&record.layers[..], &record.mean_layers[..]), (&[5.0][..], &[3.0][..]));
    }

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
