//! The hot loops of contact, over lanes of four: detect, ask the law, add the forces. Generic in the law, in whether
//! bodies are spheres only (`RIGID = false`: the sphere is the body) or also clumps and boxes, and in whether rolling
//! is resisted (`ROLL`). Contacts that do not touch add zeros, so that they change no bit of a sum.

use super::groups::{Group, Groups};
use super::{Answer, ContactLaw, FRESH, Memory, PairTable, Touch};
use crate::Vec3;
use crate::detect;
use crate::error::Partner;
use crate::lanes::{Four, Kernel, Real, V3};
use crate::search::candidates::spheres;
use crate::state::{Block, Cross, Lanes, xyz};
use crate::work::{BlockWork, CrossWork, Failure, Sums};

/// Motion of one body as a contact needs it.
pub(crate) struct Motion<'a> {
    pub velocity: &'a Lanes,
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

/// One partner of four contacts, by lane: its sphere, and of its body the centre, the velocity and the spin.
pub(crate) trait End {
    fn sphere(&self, lane: usize) -> &Lanes;
    fn centre(&self, lane: usize) -> &Lanes;
    fn velocity(&self, lane: usize) -> &Lanes;
    fn spin(&self, lane: usize) -> &Lanes;
}

/// Bodies of one block.
pub(crate) struct Own<'a> {
    spheres: &'a [Lanes],
    centre: &'a [Lanes],
    velocity: &'a [Lanes],
    spin: &'a [Lanes],
    sphere: [usize; 4],
    body: [usize; 4],
}

impl End for Own<'_> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Lanes {
        &self.spheres[self.sphere[lane]]
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Lanes {
        &self.centre[self.body[lane]]
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Lanes {
        &self.velocity[self.body[lane]]
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Lanes {
        &self.spin[self.body[lane]]
    }
}

/// Bodies of several blocks.
struct Far<'a> {
    blocks: [&'a Block; 4],
    spheres: [&'a [Lanes]; 4],
    sphere: [usize; 4],
    body: [usize; 4],
}

impl End for Far<'_> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Lanes {
        &self.spheres[lane][self.sphere[lane]]
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Lanes {
        &self.blocks[lane].centre[self.body[lane]]
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Lanes {
        &self.blocks[lane].velocity[self.body[lane]]
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Lanes {
        &self.blocks[lane].spin[self.body[lane]]
    }
}

/// Four records from a list.
#[inline(always)]
pub(crate) fn rows<R: Four>(records: &[Lanes], at: &[usize; 4]) -> [R; 4] {
    [R::load(&records[at[0]]), R::load(&records[at[1]]), R::load(&records[at[2]]), R::load(&records[at[3]])]
}

#[inline(always)]
fn sphere_rows<R: Four>(e: &impl End) -> [R; 4] {
    [R::load(e.sphere(0)), R::load(e.sphere(1)), R::load(e.sphere(2)), R::load(e.sphere(3))]
}

#[inline(always)]
fn centre_rows<R: Four>(e: &impl End) -> [R; 4] {
    [R::load(e.centre(0)), R::load(e.centre(1)), R::load(e.centre(2)), R::load(e.centre(3))]
}

#[inline(always)]
fn velocity_rows<R: Four>(e: &impl End) -> [R; 4] {
    [R::load(e.velocity(0)), R::load(e.velocity(1)), R::load(e.velocity(2)), R::load(e.velocity(3))]
}

#[inline(always)]
fn spin_rows<R: Four>(e: &impl End) -> [R; 4] {
    [R::load(e.spin(0)), R::load(e.spin(1)), R::load(e.spin(2)), R::load(e.spin(3))]
}

/// Differences of records, by lane of each number; the fourth numbers are multiplied by `last` before.
#[inline(always)]
fn difference<R: Four>(p: [R; 4], q: [R; 4], last: f64) -> [R; 4] {
    let sign = R::load(&[1.0, 1.0, 1.0, last]);
    R::transpose([p[0] - q[0] * sign, p[1] - q[1] * sign, p[2] - q[2] * sign, p[3] - q[3] * sign])
}

/// Records of a vector in lanes.
#[inline(always)]
pub(crate) fn records<R: Four>(v: V3<R>) -> [R; 4] {
    R::transpose([v.x, v.y, v.z, R::zero()])
}

/// Numbers of the bodies of four spheres.
#[inline(always)]
pub(crate) fn bodies<const RIGID: bool>(owner: &[u32], at: &[u32; 4]) -> [usize; 4] {
    let [a, b, c, d] = *at;
    let [a, b, c, d] = [a as usize, b as usize, c as usize, d as usize];
    if RIGID {
        [owner[a] as usize, owner[b] as usize, owner[c] as usize, owner[d] as usize]
    } else {
        [a, b, c, d]
    }
}

#[inline(always)]
pub(crate) fn wide(at: &[u32; 4]) -> [usize; 4] {
    [at[0] as usize, at[1] as usize, at[2] as usize, at[3] as usize]
}

/// The law of four contacts: one for all, or mixed lane by lane.
pub(crate) struct Mix<'a, L: ContactLaw, R: Real> {
    laws: &'a PairTable<L>,
    /// Set where there is one material only.
    one: Option<L::Lanes<R>>,
}

impl<'a, L: ContactLaw, R: Four> Mix<'a, L, R> {
    #[inline(always)]
    pub fn new(laws: &'a PairTable<L>) -> Mix<'a, L, R> {
        Mix { laws, one: if laws.count() == 1 { Some(laws.get(0, 0).splat()) } else { None } }
    }

    /// For materials in lanes.
    #[inline(always)]
    pub fn of(&self, a: R, b: R) -> L::Lanes<R> {
        match self.one {
            Some(law) => law,
            None => self.laws.lanes(a, b),
        }
    }
}

/// Lanes below `count` of a group.
#[inline(always)]
pub(crate) fn present<R: Four>(count: usize) -> R::Mask {
    R::load(&[0.0, 1.0, 2.0, 3.0]).lt(R::splat(count as f64))
}

/// Energy that contacts took, by lane.
pub(crate) struct Taken<R> {
    pub dashpot: R,
    pub friction: R,
}

impl<R: Real> Taken<R> {
    #[inline(always)]
    pub fn new() -> Taken<R> {
        Taken { dashpot: R::zero(), friction: R::zero() }
    }
}

/// Reads the memory of a group.
#[inline(always)]
pub(crate) fn recall<R: Four, const N: usize, const ROLL: bool>(
    group: &Group<N>,
    turn: &[Lanes; 4],
) -> Memory<R> {
    let [x, y, z] = &group.spring;
    let spring = V3::new(R::load(x), R::load(y), R::load(z));
    let rate = R::load(&group.rate);
    if ROLL {
        let [x, y, z, twist] = turn;
        Memory { spring, rate, roll: V3::new(R::load(x), R::load(y), R::load(z)), twist: R::load(twist) }
    } else {
        Memory { spring, rate, roll: V3::zero(), twist: R::zero() }
    }
}

/// Writes the memory of a group: that of the lanes `on`, nothing for the others.
#[inline(always)]
pub(crate) fn remember<R: Four, const N: usize, const ROLL: bool>(
    group: &mut Group<N>,
    turn: &mut [Lanes; 4],
    memory: &Memory<R>,
    on: R::Mask,
) {
    let spring = memory.spring.only(on);
    spring.x.store(&mut group.spring[0]);
    spring.y.store(&mut group.spring[1]);
    spring.z.store(&mut group.spring[2]);
    R::select(on, memory.rate, R::splat(FRESH)).store(&mut group.rate);
    if ROLL {
        let roll = memory.roll.only(on);
        roll.x.store(&mut turn[0]);
        roll.y.store(&mut turn[1]);
        roll.z.store(&mut turn[2]);
        memory.twist.only(on).store(&mut turn[3]);
    }
}

/// Forces of four contacts: records of the force on a, the torque on a and the torque on b; and what to complain of.
struct Outcome<R: Real> {
    force: [R; 4],
    torque_a: [R; 4],
    torque_b: [R; 4],
    /// Of single spheres: force times normal, and the levers of both.
    moment: V3<R>,
    levers: (R, R),
    /// The force in lanes.
    push: V3<R>,
    on: R::Mask,
    /// Lanes that overlap by more than the smaller radius.
    deep: u32,
    overlap: R,
    bound: R,
}

/// Four contacts between spheres. `None` when none of them touches. `law` mixes constants for materials in lanes.
#[inline(always)]
fn contacts<L: ContactLaw, R: Four, const RIGID: bool, const ROLL: bool, const N: usize>(
    law: &Mix<'_, L, R>,
    a: &impl End,
    b: &impl End,
    group: &mut Group<N>,
    turn: &mut [Lanes; 4],
    present: R::Mask,
    taken: &mut Taken<R>,
    dt: f64,
) -> Option<Outcome<R>> {
    // Differences of whole records, so that one transposition serves both partners; radii are added by the same token.
    let (xa, xb) = (sphere_rows::<R>(a), sphere_rows::<R>(b));
    let [dx, dy, dz, reach] = difference(xa, xb, -1.0);
    let between = V3::new(dx, dy, dz);
    let distance2 = between.norm2();
    let on = distance2.lt(reach * reach) & present;
    let mut memory = recall::<R, N, ROLL>(group, turn);
    let ended = !on & memory.rate.lt(R::splat(FRESH));
    if R::any(ended) {
        let (ma, mb) = (R::transpose(spin_rows::<R>(a))[3], R::transpose(spin_rows::<R>(b))[3]);
        taken.friction = taken.friction + L::left::<R, ROLL>(&law.of(ma, mb), &memory).only(ended);
        remember::<R, N, ROLL>(group, turn, &memory, on);
    }
    if !R::any(on) {
        return None;
    }
    let distance = distance2.sqrt();
    // distance/distance² rather than 1/distance: the division need not wait for the root.
    let mut normal = between * (distance * (R::splat(1.0) / distance2));
    let apart = R::zero().lt(distance);
    if !R::all(apart) {
        normal = V3::select(apart, normal, V3::new(R::zero(), R::zero(), R::splat(1.0)));
    }
    let overlap = reach - distance;
    let ra = R::transpose(xa)[3];
    let rb = reach - ra;
    // From the centres to the contact point, which halves the overlap.
    let la = ra - R::splat(0.5) * overlap;
    let lb = distance - la;

    let [ux, uy, uz, softness] = difference(velocity_rows::<R>(a), velocity_rows::<R>(b), -1.0);
    let [wax, way, waz, ma] = R::transpose(spin_rows::<R>(a));
    let [wbx, wby, wbz, mb] = R::transpose(spin_rows::<R>(b));
    let (wa, wb) = (V3::new(wax, way, waz), V3::new(wbx, wby, wbz));
    let translation = V3::new(ux, uy, uz);
    let (mut arm_a, mut arm_b) = (V3::zero(), V3::zero());
    let velocity = if RIGID {
        let [ax, ay, az, _] = difference(xa, centre_rows::<R>(a), 0.0);
        let [bx, by, bz, _] = difference(xb, centre_rows::<R>(b), 0.0);
        arm_a = V3::new(ax, ay, az) - normal * la;
        arm_b = V3::new(bx, by, bz) + normal * lb;
        translation + wa.cross(arm_a) - wb.cross(arm_b)
    } else {
        translation + normal.cross(wa * la + wb * lb)
    };
    let touch = Touch {
        mass: R::splat(1.0) / softness,
        radius: ra * rb / reach,
        overlap,
        normal,
        velocity,
        spin: wa - wb,
    };
    let Answer { force, moment, dashpot, friction, .. } =
        L::answer::<R, ROLL>(&law.of(ma, mb), &touch, &mut memory, on, dt);
    remember::<R, N, ROLL>(group, turn, &memory, on);
    taken.dashpot = taken.dashpot + dashpot.only(on);
    taken.friction = taken.friction + friction.only(on);
    let force = force.only(on);
    let lever = force.cross(normal).only(on);
    let (mut torque_a, mut torque_b) =
        if RIGID { (arm_a.cross(force), -arm_b.cross(force)) } else { (lever * la, lever * lb) };
    if RIGID || ROLL {
        let moment = moment.only(on);
        torque_a = (torque_a + moment).only(on);
        torque_b = (torque_b - moment).only(on);
    }
    let bound = ra.min(rb);
    Some(Outcome {
        force: records(force),
        torque_a: records(torque_a),
        torque_b: records(torque_b),
        moment: lever,
        levers: (la, lb),
        push: force,
        on,
        deep: R::bits(overlap.gt(bound) & on),
        overlap,
        bound,
    })
}

/// Contacts between spheres of one block.
pub(crate) struct Interior<'a, L, const RIGID: bool, const ROLL: bool> {
    pub laws: &'a PairTable<L>,
    pub block: &'a Block,
    pub pairs: &'a mut Groups<2>,
    pub w: &'a mut BlockWork,
    pub dt: f64,
}

impl<L: ContactLaw, const RIGID: bool, const ROLL: bool> Kernel for Interior<'_, L, RIGID, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Four>(self) {
        let Interior { laws, block, pairs, w, dt } = self;
        let n = block.centre.len();
        let (centre, velocity, spin) = (&block.centre[..n], &block.velocity[..n], &block.spin[..n]);
        let sums = &mut w.sums[..n];
        let spheres = if RIGID { &w.spheres[..] } else { centre };
        let owner = &w.owner[..];
        let law = Mix::new(laws);
        let mut taken = Taken::<R>::new();
        let mut failure = None;
        let len = pairs.len();
        let mut no_turn = [Lanes::default(); 4];
        for (g, group) in pairs.groups.iter_mut().enumerate() {
            let turn = if ROLL { &mut pairs.turns[g] } else { &mut no_turn };
            let names = group.names;
            let [i, j] = [wide(&names[0]), wide(&names[1])];
            let (body_a, body_b) = (bodies::<RIGID>(owner, &names[0]), bodies::<RIGID>(owner, &names[1]));
            let a = Own { spheres, centre, velocity, spin, sphere: i, body: body_a };
            let b = Own { spheres, centre, velocity, spin, sphere: j, body: body_b };
            let there = present::<R>(len - 4 * g);
            let Some(out) =
                contacts::<L, R, RIGID, ROLL, 2>(&law, &a, &b, group, turn, there, &mut taken, dt)
            else {
                continue;
            };
            for l in 0..4 {
                let (force, torque) = &mut sums[a.body[l]].both();
                (R::load(force) + out.force[l]).store(force);
                (R::load(torque) + out.torque_a[l]).store(torque);
                let (force, torque) = &mut sums[b.body[l]].both();
                (R::load(force) - out.force[l]).store(force);
                (R::load(torque) + out.torque_b[l]).store(torque);
            }
            if out.deep != 0 && failure.is_none() {
                let l = out.deep.trailing_zeros() as usize;
                let partner = Partner::Body(block.bodies[b.body[l]] as usize);
                let (overlap, bound) = (out.overlap.array()[l], out.bound.array()[l]);
                failure = Some(Failure::Overlap { body: block.bodies[a.body[l]], partner, overlap, bound });
            }
        }
        w.ledger.dissipated_dashpot += taken.dashpot.sum();
        w.ledger.dissipated_friction += taken.friction.sum();
        w.failure = w.failure.or(failure);
    }
}

/// Contacts of block `b`'s spheres with spheres of other blocks: forces go to slots.
pub(crate) struct Between<'a, L, const RIGID: bool, const ROLL: bool> {
    pub laws: &'a PairTable<L>,
    pub blocks: &'a [Block],
    pub works: &'a [BlockWork],
    pub b: usize,
    pub lists: &'a mut Cross,
    pub out: &'a mut CrossWork,
    pub dt: f64,
}

impl<L: ContactLaw, const RIGID: bool, const ROLL: bool> Kernel for Between<'_, L, RIGID, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Four>(self) {
        let Between { laws, blocks, works, b: own, lists, out, dt } = self;
        let (mine, wa) = (&blocks[own], &works[own]);
        let pairs = &mut lists.spheres;
        let len = pairs.len();
        let law = Mix::new(laws);
        let mut taken = Taken::<R>::new();
        let mut no_turn = [Lanes::default(); 4];
        for (g, group) in pairs.groups.iter_mut().enumerate() {
            let turn = if ROLL { &mut pairs.turns[g] } else { &mut no_turn };
            let names = group.names;
            let [i, block, j] = [wide(&names[0]), wide(&names[1]), wide(&names[2])];
            let count = (len - 4 * g).min(4);
            let a = Own {
                spheres: spheres(mine, wa, RIGID),
                centre: &mine.centre,
                velocity: &mine.velocity,
                spin: &mine.spin,
                sphere: i,
                body: bodies::<RIGID>(&wa.owner, &names[0]),
            };
            let b = Far {
                blocks: block.map(|k| &blocks[k]),
                spheres: block.map(|k| spheres(&blocks[k], &works[k], RIGID)),
                sphere: j,
                body: if RIGID { std::array::from_fn(|l| works[block[l]].owner[j[l]] as usize) } else { j },
            };
            let there = present::<R>(count);
            let width = if RIGID || ROLL { 3 } else { 2 };
            let slots = &mut out.slots[4 * g * width..(4 * g + count) * width];
            match contacts::<L, R, RIGID, ROLL, 3>(&law, &a, &b, group, turn, there, &mut taken, dt) {
                None => slots.fill(Lanes::default()),
                Some(o) => {
                    if RIGID || ROLL {
                        for (l, slot) in slots.chunks_exact_mut(3).enumerate() {
                            o.force[l].store(&mut slot[0]);
                            o.torque_a[l].store(&mut slot[1]);
                            o.torque_b[l].store(&mut slot[2]);
                        }
                    } else {
                        let (f, m, (la, lb)) = (o.push, o.moment, o.levers);
                        let (la, lb) = (R::select(o.on, la, R::zero()), R::select(o.on, lb, R::zero()));
                        let force = R::transpose([f.x, f.y, f.z, la]);
                        let moment = R::transpose([m.x, m.y, m.z, lb]);
                        for (l, slot) in slots.chunks_exact_mut(2).enumerate() {
                            force[l].store(&mut slot[0]);
                            moment[l].store(&mut slot[1]);
                        }
                    }
                    if o.deep != 0 && out.failure.is_none() {
                        let l = o.deep.trailing_zeros() as usize;
                        let partner = Partner::Body(b.blocks[l].bodies[b.body[l]] as usize);
                        let (overlap, bound) = (o.overlap.array()[l], o.bound.array()[l]);
                        let body = mine.bodies[a.body[l]];
                        out.failure = Some(Failure::Overlap { body, partner, overlap, bound });
                    }
                }
            }
        }
        out.dashpot += taken.dashpot.sum();
        out.friction += taken.friction.sum();
    }
}

/// Contacts of block `b`'s spheres with boxes, one by one; their slots follow those of the spheres.
pub(crate) fn boxes<L: ContactLaw>(
    laws: &PairTable<L>,
    blocks: &[Block],
    works: &[BlockWork],
    b: usize,
    lists: &mut Cross,
    out: &mut CrossWork,
    dt: f64,
) {
    let first = lists.spheres.len();
    let (mine, wa) = (&blocks[b], &works[b]);
    for k in 0..lists.boxes.len() {
        let [i, block, j] = lists.boxes.name(k).map(|n| n as usize);
        let (other, wb) = (&blocks[block], &works[block]);
        let (a, p) = (wa.owner[i] as usize, &wa.spheres[i]);
        let law = laws.get(mine.spin[a][3] as u32, other.spin[j][3] as u32);
        let mut history = lists.boxes.history(k);
        let (x, q) = (xyz(&other.centre[j]), &other.rotation[j].orientation);
        let slot = &mut out.slots[3 * (first + k)..][..3];
        let Some(g) = detect::sphere_box(&xyz(p), p[3], &x, q, &wb.half[j]) else {
            if !history.is_fresh() {
                out.friction += law.release(&mut history);
                lists.boxes.set_history(k, &history);
            }
            slot.fill(Lanes::default());
            continue;
        };
        let (ma, mb) = (motion(mine, a, &g.point), motion(other, j, &g.point));
        let mass = 1.0 / (ma.velocity[3] + mb.velocity[3]);
        let (velocity, spin) = (ma.at_point() - mb.at_point(), ma.spin() - mb.spin());
        let f = law.respond(mass, &g, &velocity, &spin, &mut history, dt);
        lists.boxes.set_history(k, &history);
        out.dashpot += f.dashpot;
        out.friction += f.friction;
        let lanes = |v: Vec3| Lanes([v.x, v.y, v.z, 0.0]);
        slot[0] = lanes(f.force);
        slot[1] = lanes(ma.arm.cross(&f.force) + f.moment);
        slot[2] = lanes(-(mb.arm.cross(&f.force) + f.moment));
        // The nearest face resolves a centre inside the box, up to one more radius.
        let bound = 2.0 * p[3];
        if g.overlap > bound && out.failure.is_none() {
            let partner = Partner::Body(other.bodies[j] as usize);
            out.failure = Some(Failure::Overlap { body: mine.bodies[a], partner, overlap: g.overlap, bound });
        }
    }
}

/// Adds the slots of contacts with other blocks, in their fixed order. `WIDE`: slots hold both torques.
pub(crate) fn gather<const WIDE: bool>(w: &mut BlockWork, cross: &[CrossWork]) {
    let width = if WIDE { 3 } else { 2 };
    for entry in &w.gather {
        let (slot, first) = entry.slot();
        let slot = &cross[entry.block as usize].slots[slot * width..][..width];
        let Sums { force, torque } = &mut w.sums[entry.place as usize];
        let sign = if first { 1.0 } else { -1.0 };
        let lever = if first { slot[0][3] } else { slot[1][3] };
        let turn = if first { &slot[1] } else { &slot[width - 1] };
        for d in 0..3 {
            force[d] += sign * slot[0][d];
            torque[d] += if WIDE { turn[d] } else { slot[1][d] * lever };
        }
    }
}
