//! The hot loops of contact: for each pair detect, ask the law, add the force. Generic in the law, and in whether
//! bodies are spheres only (`RIGID = false`: the sphere is the body) or also clumps and boxes.

use super::{ContactForce, ContactGeometry, ContactLaw, PairTable};
use crate::Vec3;
use crate::detect;
use crate::error::Partner;
use crate::model::{Kind, Model};
use crate::search::candidates::spheres;
use crate::shape::cuboid;
use crate::state::{Block, Cross, Lanes, Pair, xyz};
use crate::wall::triangulated::WallMotion;
use crate::work::{BlockWork, CrossWork, Failure, Slot};

/// Motion of one body as a contact needs it.
pub(crate) struct Motion<'a> {
    velocity: &'a Lanes,
    spin: &'a Lanes,
    /// From the body's centre to the contact point.
    pub arm: Vec3,
}

impl Motion<'_> {
    #[inline(always)]
    pub fn spin(&self) -> Vec3 {
        xyz(self.spin)
    }

    #[inline(always)]
    pub fn at_point(&self) -> Vec3 {
        xyz(self.velocity) + xyz(self.spin).cross(&self.arm)
    }
}

#[inline(always)]
pub(crate) fn motion<'a>(block: &'a Block, body: usize, point: &Vec3) -> Motion<'a> {
    let arm = point - xyz(&block.centre[body]);
    Motion { velocity: &block.velocity[body], spin: &block.spin[body], arm }
}

/// Force of a contact between two bodies.
#[inline(always)]
fn between<L: ContactLaw>(
    laws: &PairTable<L>,
    g: &ContactGeometry,
    a: &Motion<'_>,
    b: &Motion<'_>,
    history: &mut super::History,
    dt: f64,
) -> ContactForce {
    let law = laws.get(a.spin[3] as u32, b.spin[3] as u32);
    let mass = 1.0 / (a.velocity[3] + b.velocity[3]);
    law.respond(mass, g, &(a.at_point() - b.at_point()), &(xyz(a.spin) - xyz(b.spin)), history, dt)
}

/// Contacts between spheres of one block.
pub(crate) fn interior<L: ContactLaw, const RIGID: bool>(
    laws: &PairTable<L>,
    block: &mut Block,
    w: &mut BlockWork,
    dt: f64,
) {
    let mut pairs = std::mem::take(&mut block.pairs);
    if RIGID {
        members(laws, block, w, &mut pairs, dt);
    } else {
        lone_spheres(laws, block, w, &mut pairs, dt);
    }
    block.pairs = pairs;
}

/// Spheres that are bodies of their own. Levers lie along the normal, which leaves one cross product for the
/// velocity and one for both torques.
fn lone_spheres<L: ContactLaw>(
    laws: &PairTable<L>,
    block: &Block,
    w: &mut BlockWork,
    pairs: &mut [Pair],
    dt: f64,
) {
    let n = block.centre.len();
    let (centre, velocity, spin) = (&block.centre[..n], &block.velocity[..n], &block.spin[..n]);
    let (force, torque) = (&mut w.force[..n], &mut w.torque[..n]);
    // Most blocks hold one material: then no look-up per pair.
    let first = spin.first().map_or(0.0, |s| s[3]);
    let single = spin.iter().all(|s| s[3] == first).then(|| *laws.get(first as u32, first as u32));
    let law = |a: usize, b: usize| single.unwrap_or_else(|| *laws.get(spin[a][3] as u32, spin[b][3] as u32));
    let (mut dashpot, mut friction) = (0.0, 0.0);
    for pair in pairs {
        let (a, b) = (pair.i as usize, pair.j as usize);
        let (p, q) = (&centre[a], &centre[b]);
        let Some(g) = detect::sphere_sphere(&xyz(p), p[3], &xyz(q), q[3]) else {
            if !pair.history.is_fresh() {
                friction += law(a, b).release(&mut pair.history);
            }
            continue;
        };
        let (la, lb) = (p[3] - 0.5 * g.overlap, q[3] - 0.5 * g.overlap);
        let (va, vb) = (&velocity[a], &velocity[b]);
        let turning = xyz(&spin[a]) * la + xyz(&spin[b]) * lb;
        let relative = xyz(va) - xyz(vb) + g.normal.cross(&turning);
        let spin_difference = xyz(&spin[a]) - xyz(&spin[b]);
        let f =
            law(a, b).respond(1.0 / (va[3] + vb[3]), &g, &relative, &spin_difference, &mut pair.history, dt);
        dashpot += f.dashpot;
        friction += f.friction;
        force[a] += f.force;
        force[b] -= f.force;
        let moment = f.force.cross(&g.normal);
        torque[a] += moment * la + f.moment;
        torque[b] += moment * lb - f.moment;
        let bound = p[3].min(q[3]);
        if g.overlap > bound && w.failure.is_none() {
            let partner = Partner::Body(block.bodies[b] as usize);
            w.failure = Some(Failure::Overlap { body: block.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
    w.ledger.dissipated_dashpot += dashpot;
    w.ledger.dissipated_friction += friction;
}

/// Member spheres of clumps, and single spheres among them.
fn members<L: ContactLaw>(
    laws: &PairTable<L>,
    block: &Block,
    w: &mut BlockWork,
    pairs: &mut [Pair],
    dt: f64,
) {
    let (mut dashpot, mut friction) = (0.0, 0.0);
    for pair in pairs {
        let (i, j) = (pair.i as usize, pair.j as usize);
        let (p, q) = (&w.spheres[i], &w.spheres[j]);
        let (a, b) = (w.owner[i] as usize, w.owner[j] as usize);
        let Some(g) = detect::sphere_sphere(&xyz(p), p[3], &xyz(q), q[3]) else {
            if !pair.history.is_fresh() {
                let law = laws.get(block.spin[a][3] as u32, block.spin[b][3] as u32);
                friction += law.release(&mut pair.history);
            }
            continue;
        };
        let (ma, mb) = (motion(block, a, &g.point), motion(block, b, &g.point));
        let f = between(laws, &g, &ma, &mb, &mut pair.history, dt);
        dashpot += f.dashpot;
        friction += f.friction;
        w.force[a] += f.force;
        w.force[b] -= f.force;
        w.torque[a] += ma.arm.cross(&f.force) + f.moment;
        w.torque[b] -= mb.arm.cross(&f.force) + f.moment;
        let bound = p[3].min(q[3]);
        if g.overlap > bound && w.failure.is_none() {
            let partner = Partner::Body(block.bodies[b] as usize);
            w.failure = Some(Failure::Overlap { body: block.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
    w.ledger.dissipated_dashpot += dashpot;
    w.ledger.dissipated_friction += friction;
}

/// Contacts of block `b`'s spheres with spheres and boxes elsewhere: forces go to slots.
pub(crate) fn cross<L: ContactLaw, const RIGID: bool>(
    laws: &PairTable<L>,
    blocks: &[Block],
    works: &[BlockWork],
    b: usize,
    lists: &mut Cross,
    out: &mut CrossWork,
    dt: f64,
) {
    (out.dashpot, out.friction, out.failure) = (0.0, 0.0, None);
    let boxes_from = lists.spheres.len();
    for (slot, pair) in lists.spheres.iter_mut().chain(&mut lists.boxes).enumerate() {
        let (mine, other) = (&blocks[b], &blocks[pair.block as usize]);
        let (wa, wb) = (&works[b], &works[pair.block as usize]);
        let i = pair.i as usize;
        let p = &spheres(mine, wa, RIGID)[i];
        let a = if RIGID { wa.owner[i] as usize } else { i };
        let j = pair.j as usize;
        let (body_b, bound, touch) = if slot < boxes_from {
            let q = &spheres(other, wb, RIGID)[j];
            let body = if RIGID { wb.owner[j] as usize } else { j };
            (body, p[3].min(q[3]), detect::sphere_sphere(&xyz(p), p[3], &xyz(q), q[3]))
        } else {
            let (x, q) = (xyz(&other.centre[j]), &other.rotation[j].orientation);
            // The nearest face resolves a centre inside the box, up to one more radius.
            (j, 2.0 * p[3], detect::sphere_box(&xyz(p), p[3], &x, q, &wb.half[j]))
        };
        let Some(g) = touch else {
            if !pair.history.is_fresh() {
                let law = laws.get(mine.spin[a][3] as u32, other.spin[body_b][3] as u32);
                out.friction += law.release(&mut pair.history);
            }
            out.slots[slot] = Slot::default();
            continue;
        };
        let (ma, mb) = (motion(mine, a, &g.point), motion(other, body_b, &g.point));
        let f = between(laws, &g, &ma, &mb, &mut pair.history, dt);
        out.dashpot += f.dashpot;
        out.friction += f.friction;
        out.slots[slot] = Slot { force: f.force, point: g.point, moment: f.moment };
        if g.overlap > bound && out.failure.is_none() {
            let partner = Partner::Body(other.bodies[body_b] as usize);
            out.failure = Some(Failure::Overlap { body: mine.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
}

/// Adds the slots of contacts with other blocks, in their fixed order.
pub(crate) fn gather(block: &Block, w: &mut BlockWork, cross: &[CrossWork]) {
    for entry in &w.gather {
        let slot = &cross[entry.block as usize].slots[entry.slot as usize];
        let k = entry.place as usize;
        let force = slot.force * entry.sign;
        w.force[k] += force;
        w.torque[k] += (slot.point - xyz(&block.centre[k])).cross(&force) + slot.moment * entry.sign;
    }
}

/// Contacts with planes: spheres, and corners of boxes.
pub(crate) fn planes<L: ContactLaw, const RIGID: bool>(
    model: &Model,
    laws: &PairTable<L>,
    motions: &[WallMotion],
    block: &mut Block,
    w: &mut BlockWork,
    dt: f64,
) {
    let mut pairs = std::mem::take(&mut block.planes);
    let boxes = RIGID && w.kind.first() == Some(&Kind::Box);
    for pair in &mut pairs {
        let (i, plane) = (pair.i as usize, &model.planes[pair.plane as usize]);
        let wall = &motions[pair.plane as usize];
        let (a, x, r, bound) = if boxes {
            let a = i / 8;
            let half = &w.half[a];
            let corner = block.rotation[a].orientation * cuboid::corner(half, i % 8);
            (a, xyz(&block.centre[a]) + corner, 0.0, half.min())
        } else {
            let p = if RIGID { &w.spheres[i] } else { &block.centre[i] };
            (if RIGID { w.owner[i] as usize } else { i }, xyz(p), p[3], p[3])
        };
        let law = laws.get(block.spin[a][3] as u32, plane.material as u32);
        let Some(g) = detect::sphere_plane(&x, r, &(plane.point + wall.offset), &plane.normal) else {
            if !pair.history.is_fresh() {
                w.ledger.dissipated_friction += law.release(&mut pair.history);
            }
            continue;
        };
        let ma = motion(block, a, &g.point);
        let relative = ma.at_point() - wall.velocity;
        let f = law.respond(1.0 / ma.velocity[3], &g, &relative, &ma.spin(), &mut pair.history, dt);
        w.ledger.dissipated_dashpot += f.dashpot;
        w.ledger.dissipated_friction += f.friction;
        w.ledger.work_walls += f.force.dot(&wall.velocity) * dt;
        w.ledger.walls.add(&g.point, &(f.force * dt));
        w.force[a] += f.force;
        w.torque[a] += ma.arm.cross(&f.force) + f.moment;
        w.ledger.walls.angular += f.moment * dt;
        if g.overlap > bound && w.failure.is_none() {
            let partner = Partner::Plane(pair.plane as usize);
            w.failure = Some(Failure::Overlap { body: block.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
    block.planes = pairs;
}
