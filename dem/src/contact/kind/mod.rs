//! Kinds of pairs: which two shapes can touch, and where. A kind is one file with the geometry and one entry of [`KINDS`];
//! search, memory, forces, slots, new orders of the bodies, checkpoints and measures are written once, in `pass.rs`, for
//! all of them.
//!
//! Two kinds carry most contacts of a scene and have loops over lanes of their own instead: sphere with sphere
//! (`sphere_pair.rs`, its images in `images.rs`) and sphere with plane (`planes.rs`). Patches of surfaces are joined over
//! seams (`patches.rs`).

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

/// All kinds. The order is that of their forces in sums, hence part of a scene's numbers.
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

/// Forces of all pairs of kinds of block `b`; their slots follow those of the spheres.
pub(crate) fn forces(
    setting: &Setting<'_>,
    now: &Now<'_>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossForces,
) {
    let mut slots = &mut out.slots[out.kinds_at..];
    // Summed apart from what contacts of spheres took, so that these may be computed elsewhere.
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
