//! Contacts across periodic borders.

use super::scalar;
use crate::base::error::Partner;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::block_slice::BlockSlice;
use crate::lanes::vec4::{Vec4, xyz};
use crate::law::Laws;
use crate::pairs::cross::{Cross, CrossForces, ImagePair};
use crate::spatial::detect;
use crate::spatial::periodic::Periodic;

/// Image pairs of block `b`; slots follow the sphere and box slots.
pub fn images(
    periodic: &Periodic,
    laws: &Laws,
    blocks: BlockSlice<'_, Block>,
    members: BlockSlice<'_, BlockBodies>,
    b: usize,
    lists: &mut Cross,
    out: &mut CrossForces,
    dt: f64,
) {
    let (mine, own) = (&blocks[b], &members[b]);
    let (first, width) = (out.images_at, out.width);
    for (k, ImagePair { name, history }) in lists.images.iter_mut().enumerate() {
        let block = name.block as usize;
        let (other, theirs) = (&blocks[block], &members[block]);
        let (a, c) = (own.body(name.i) as usize, theirs.body(name.j) as usize);
        let (p, q) = (&own.spheres(mine)[name.i as usize], &theirs.spheres(other)[name.j as usize]);
        let way = periodic.image_offset(&name.shift);
        let materials = [mine.material(a), other.material(c)];
        let slot = &mut out.slots[first + k * width..][..width];
        let Some(g) = detect::sphere_sphere(&xyz(p), p[3], &(xyz(q) + way), q[3]) else {
            out.friction += scalar::end(laws, materials, history);
            slot.fill(Vec4::default());
            continue;
        };
        let (ma, mb) = (mine.motion(a, &g.point), other.motion(c, &(g.point - way)));
        let f = scalar::between(laws, materials, None, &g, (&ma, &mb), 1.0, history, dt);
        out.dashpot += f.dashpot;
        out.friction += f.friction;
        out.couple += way.cross(&f.force) * dt;
        if width == 3 {
            slot[0] = Vec4::of(&f.force, 0.0);
            slot[1] = Vec4::of(&f.torque_a, 0.0);
            slot[2] = Vec4::of(&f.torque_b, 0.0);
        } else {
            slot[0] = Vec4::of(&f.force, -ma.arm.dot(&g.normal));
            slot[1] = Vec4::of(&f.force.cross(&g.normal), mb.arm.dot(&g.normal));
        }
        let bound = p[3].min(q[3]);
        if g.overlap > bound && out.failure.is_none() {
            let partner = Partner::Body(other.bodies[c] as usize);
            out.failure = Some(Failure::Overlap { body: mine.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
}
