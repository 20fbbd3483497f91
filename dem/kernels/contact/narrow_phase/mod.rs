//! Shape pairs in contact: each pair type is a geometry file and an entry of [`KINDS`].
//!
//! Separate kernels: spheres (`sphere_pair.rs`, `images.rs`), planes (`planes.rs`), patches merged over seams
//! (`surface_contacts.rs`).

mod box_box;
mod corner_plane;
mod dilated;
mod facet;
mod handler;
mod pair;
mod patch;
mod round;
mod scene;
mod sheet;
pub mod shell;
pub mod shell_pass;
mod side;
mod sphere_box;

pub use dilated::{DEEPEST, LENGTH};
pub use handler::{OnGround, PairHandler};
pub use pair::{ContactView, Visited};
pub use scene::{BodyAccess, Configuration, PlaneView, Pose, PosedBody, Search, SheetView};
pub use side::Renumbering;

use crate::contact::scalar::StepContext;
use crate::pairs::cross::{Cross, CrossForces};
use handler::{ContactTotals, Handler};

/// The order of summation affects results.
pub const KINDS: [&dyn PairHandler; 8] = [
    &Handler(sphere_box::SphereBox),
    &Handler(corner_plane::CornerPlane),
    &Handler(box_box::BoxBox),
    &Handler(dilated::SphereDilated),
    &Handler(dilated::DilatedPlane),
    &Handler(dilated::DilatedDilated),
    &Handler(patch::DilatedPatch),
    &Handler(sheet::DilatedSheet),
];

/// Forces of block `b`; slots follow the sphere slots.
pub fn forces(
    setting: &StepContext<'_>,
    now: &Configuration<'_>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossForces,
) {
    let mut slots = &mut out.slots[out.kinds_at..];
    let (mut dashpot, mut friction) = (0.0, 0.0);
    for (kind, list) in KINDS.iter().zip(&mut lists.kinds) {
        let own;
        (own, slots) = slots.split_at_mut(3 * list.len());
        let mut books = ContactTotals {
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
