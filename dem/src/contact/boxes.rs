//! Contacts of spheres with boxes, and of the corners of boxes with planes, one by one.

use super::single;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::members::Members;
use crate::bodies::part::Part;
use crate::bodies::sums::Tally;
use crate::lanes::record::{Record, xyz};
use crate::law::{ContactGeometry, Laws};
use crate::pairs::cross::{Cross, CrossForces};
use crate::pairs::groups::Groups;
use crate::shape::cuboid;
use crate::shape::plane::{Plane, PlaneMotion};
use crate::spatial::detect;

/// Contacts of block `b`'s spheres with boxes; their slots follow those of the spheres.
pub(crate) fn boxes(
    laws: &Laws,
    blocks: Part<'_, Block>,
    members: Part<'_, Members>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossForces,
    dt: f64,
) {
    let (mine, own) = (&blocks[b], &members[b]);
    for k in 0..lists.boxes.len() {
        let [i, block, j] = lists.boxes.name(k);
        let (other, theirs, j) = (&blocks[block as usize], &members[block as usize], j as usize);
        let (a, p) = (own.body(i) as usize, &own.spheres(mine)[i as usize]);
        let materials = [mine.material(a), other.material(j)];
        let mut history = lists.boxes.history(k);
        let (x, q) = (xyz(&other.centre[j]), &other.rotation[j].orientation);
        let at = out.boxes_at + 3 * k;
        let slot = &mut out.slots[at..][..3];
        let Some(g) = detect::sphere_box(&xyz(p), p[3], &x, q, &theirs.half[j]) else {
            if !history.is_fresh() {
                out.friction += single::end(laws, materials, &mut history);
                lists.boxes.set_history(k, &history);
            }
            slot.fill(Record::default());
            continue;
        };
        let motions = (&mine.motion(a, &g.point), &other.motion(j, &g.point));
        let f = single::between(laws, materials, &g, motions, &mut history, dt);
        lists.boxes.set_history(k, &history);
        out.dashpot += f.dashpot;
        out.friction += f.friction;
        slot[0] = Record::of(&f.force, 0.0);
        slot[1] = Record::of(&f.torque_a, 0.0);
        slot[2] = Record::of(&f.torque_b, 0.0);
        // The nearest face resolves a centre inside the box, up to one more radius.
        let bound = 2.0 * p[3];
        if g.overlap > bound && out.failure.is_none() {
            let partner = Partner::Body(other.bodies[j] as usize);
            out.failure = Some(Failure::Overlap { body: mine.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
}

/// Corners of the boxes of a block against planes.
pub(crate) fn corners(
    laws: &Laws,
    (planes, motions): (&[Plane], &[PlaneMotion]),
    block: &Block,
    members: &Members,
    pairs: &mut Groups<2>,
    tally: &mut Tally,
    dt: f64,
) {
    for k in 0..pairs.len() {
        let [corner, index] = pairs.name(k).map(|n| n as usize);
        let (plane, wall) = (&planes[index], &motions[index]);
        let a = corner / 8;
        let half = members.half[a];
        let x = xyz(&block.centre[a]) + block.rotation[a].orientation * cuboid::corner(&half, corner % 8);
        let materials = [block.material(a), plane.material as u32];
        let mut history = pairs.history(k);
        let touch = detect::sphere_plane(&x, 0.0, &(plane.point + wall.offset), &plane.normal);
        // A corner has no radius of its own: laws that need one take the shortest half side.
        let Some(g) = touch.map(|g| ContactGeometry { radius: half.min(), ..g }) else {
            if !history.is_fresh() {
                tally.ledger.dissipated_friction += single::end(laws, materials, &mut history);
                pairs.set_history(k, &history);
            }
            continue;
        };
        let own = block.motion(a, &g.point);
        let (relative, mass) = (own.at_point() - wall.velocity, 1.0 / own.inverse_mass());
        let f = single::evaluate(laws, materials, mass, &g, &relative, &own.spin(), &mut history, dt);
        pairs.set_history(k, &history);
        let ledger = &mut tally.ledger;
        ledger.dissipated_dashpot += f.dashpot;
        ledger.dissipated_friction += f.friction;
        ledger.work_walls += f.force.dot(&wall.velocity) * dt;
        ledger.walls.add(&g.point, &(f.force * dt));
        ledger.walls.angular += f.moment * dt;
        tally.sums[a].push(&f.force, &(own.arm.cross(&f.force) + f.moment));
        let bound = half.min();
        if g.overlap > bound && tally.failure.is_none() {
            let partner = Partner::Plane(index);
            let overlap = g.overlap;
            tally.failure = Some(Failure::Overlap { body: block.bodies[a], partner, overlap, bound });
        }
    }
}
