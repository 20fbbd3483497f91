//! Shape pairs in contact: each pair type is a geometry file and an entry of [`KINDS`]; `pass.rs` does
//! everything else.
//!
//! Separate kernels: spheres (`sphere_pair.rs`, `images.rs`), planes (`planes.rs`), patches merged over seams
//! (`patches.rs`).

mod box_box;
mod corner_plane;
mod dilated;
mod facet;
mod pair;
mod pass;
mod patch;
mod round;
mod scene;
mod sheet;
pub(crate) mod shell;
pub(crate) mod shell_pass;
mod side;
mod sphere_box;

pub(crate) use dilated::{DEEPEST, LENGTH};
pub(crate) use pair::{ContactNow, Visited};
pub(crate) use pass::{Kind, OnGround};
pub(crate) use scene::{Now, Placed, PlaneView, Pose, Scene, Search, SheetView};
pub(crate) use side::Renamed;

use crate::contact::single::Setting;
use crate::pairs::cross::{Cross, CrossForces};
use pass::{Books, Of};

/// The order of summation affects results.
pub(crate) const KINDS: [&dyn Kind; 8] = [
    &Of(sphere_box::SphereBox),
    &Of(corner_plane::CornerPlane),
    &Of(box_box::BoxBox),
    &Of(dilated::SphereDilated),
    &Of(dilated::DilatedPlane),
    &Of(dilated::DilatedDilated),
    &Of(patch::DilatedPatch),
    &Of(sheet::DilatedSheet),
];

/// Forces of block `b`; slots follow the sphere slots.
pub(crate) fn forces(
    setting: &Setting<'_>,
    now: &Now<'_>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossForces,
) {
    let mut slots = &mut out.slots[out.kinds_at..];
    // Separate sums: sphere contacts may be computed elsewhere.
    let (mut dashpot, mut friction) = (0.0, 0.0);
    for (kind, list) in KINDS.iter().zip(&mut lists.kinds) {
        let own;
        (own, slots) = slots.split_at_mut(3 * list.len());
        let mut books = Books {
            slots: own,
            dashpot: &mut dashpot,
            friction: &mut friction,
            work_walls: &mut out.work_walls,
            walls: &mut out.walls,
            wall_sums: &mut out.wall_sums,
            couple: &mut out.couple,
            surface: &mut out.surface,
            failure: &mut out.failure,
        };
        kind.forces(setting, now, b, list, &mut books);
    }
    out.dashpot += dashpot;
    out.friction += friction;
}
