//! Walls in history and frames.

use super::recorder::{Now, Recorder};
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
        }
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
