//! Walls in history and frames.

use super::recorder::{Now, Recorder};
use super::summary::{FloatingRecord, PropulsionRecord};
use super::system::{GrainsView, System};
use trackbed_dem::Vec3;
use trackbed_input::model::grains::GrainsPart;
use trackbed_io::columns::history;
use trackbed_io::write::csv::Row;
use trackbed_io::write::{WallFrame, WallKind};

/// Support energies; force, moment about the centre and displacement of recorded walls.
pub struct Walls;

impl<S: System> Recorder<S> for Walls {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (Some(part), Some(view)) = (&now.job.grains, now.system.grains()) else { return };
        if part.walls.others.iter().filter_map(|w| w.body.as_ref()).any(|b| b.mount.is_some()) {
            row.put(history::MOUNT_ENERGY, now.balance.now.mounts);
            row.put(history::DISSIPATED_MOUNTS, now.balance.spent.mounts);
        }
        for wall in &part.walls.recorded {
            let (name, wall) = (&wall.name, wall.wall);
            if let Some(servo) = &part.walls.others[wall].servo {
                let driven = servo.driven.is_some_and(|[from, _]| now.time >= from);
                row.put(history::WALL_TARGET.of(name), if driven { 0.0 } else { servo.target(now.time) });
            }
            let (force, moment) = view.state.wall_force(wall);
            row.vector(history::WALL_FORCE.of(name), force);
            row.vector(history::WALL_MOMENT.of(name), moment);
            row.vector(history::WALL_DISPLACEMENT.of(name), view.state.wall_offset(wall));
            if let Some(load) = view.state.water_load(view.model, wall) {
                row.vector(history::WALL_VELOCITY.of(name), view.state.wall_velocity(wall).0);
                row.vector(history::WALL_ROTATION.of(name), view.state.wall_angles(wall));
                row.vector(history::WALL_WATER.of(name), load.force);
                row.vector(history::WALL_WATER_MOMENT.of(name), load.moment);
                let drive = part.walls.others[wall].body.as_ref().and_then(|b| b.propulsion.as_ref());
                if let Some(drive) = drive {
                    row.put(history::WALL_THRUST.of(name), load.thrust[1]);
                    if drive.rudder.is_some() {
                        row.vector(history::WALL_RUDDER.of(name), load.rudder);
                        row.put(history::WALL_RUDDER_ANGLE.of(name), load.angle);
                    }
                }
            }
        }
    }
}

/// Adds a history row to the records of floating walls.
pub fn follow(part: &GrainsPart, view: GrainsView<'_>, records: &mut Vec<FloatingRecord>) {
    let walls = part.walls.others.iter().zip(&part.walls.names).enumerate();
    let afloat = walls.filter_map(|(k, (wall, name))| {
        let driven = wall.body.as_ref().is_some_and(|b| b.propulsion.is_some());
        Some((k, name, driven, view.state.water_load(view.model, k)?))
    });
    for (number, (k, name, driven, load)) in afloat.enumerate() {
        if records.len() == number {
            let propulsion = driven.then(PropulsionRecord::default);
            records.push(FloatingRecord { name: name.clone(), propulsion, ..FloatingRecord::default() });
        }
        let record = &mut records[number];
        let share = 1.0 / (record.rows + 1) as f64;
        let mean = |old: &mut f64, new: f64| *old += (new - *old) * share;
        let (velocity, _) = view.state.wall_velocity(k);
        let (contact, _) = view.state.wall_force(k);
        mean(&mut record.mean_speed, libm::hypot(velocity.x, velocity.y));
        for d in 0..3 {
            mean(&mut record.mean_contact_force[d], contact[d]);
            mean(&mut record.mean_water_force[d], load.force[d]);
        }
        record.travel = view.state.wall_travel(k).into();
        record.rotation = view.state.wall_angles(k).into();
        if let Some(p) = &mut record.propulsion {
            mean(&mut p.mean_requested, load.thrust[0]);
            mean(&mut p.mean_applied, load.thrust[1]);
            p.largest_rudder_angle = p.largest_rudder_angle.max(load.angle.abs());
            p.largest_rudder_force = p.largest_rudder_force.max(load.rudder.norm());
        }
        record.rows += 1;
    }
}

/// Adds patch walls, numbered from `id`.
pub fn polygons(
    view: GrainsView<'_>,
    part: &GrainsPart,
    extent: (Vec3, f64),
    mut id: u32,
    frame: &mut WallFrame,
) -> u32 {
    for (k, wall) in part.walls.others.iter().enumerate() {
        let first = frame.points.len() as u32;
        let (points, polygons) = wall.shape.outline(|x| view.state.wall_point(view.model, k, &x), extent);
        frame.points.extend(points.iter().map(|p| <[f64; 3]>::from(*p)));
        for polygon in polygons {
            frame.polygons.push(polygon.iter().map(|v| v + first).collect());
            frame.id.push(id);
            frame.kind.push(WallKind::Wall as u32);
        }
        id += 1;
    }
    id
}
