//! The law of contacts with patches, in lanes: what detection found of a block, force by force.

use super::pass::{Mix, four};
use crate::Vec3;
use crate::lanes::{Kernel, Pack, V3};
use crate::law::{ContactLaw, History, LawInput, LawOutput, Memory, PairTable};
use crate::state::{Block, Lanes, xyz};

/// A contact of a sphere with a patch: what the law asks, and what it answers in the same places.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// Body within the block.
    pub body: u32,
    /// The patch's own coordinates of the place.
    pub local: [f64; 2],
    /// Where they touch, and the overlap.
    point: Lanes,
    /// The normal, and the sphere's radius. Then the part of the torque that is a moment of its own.
    normal: Lanes,
    /// Velocity of the patch there, and one over the mass of its wall. Then the force on the body, and what dashpots took.
    velocity: Lanes,
    /// Angular velocity of its wall, and its material. Then the torque about the body's centre, and what sliding took.
    spin: Lanes,
    /// Tangential spring, and approach speed before.
    memory: Lanes,
    /// Rolling and twisting springs.
    turn: Lanes,
}

fn record(v: &Vec3, last: f64) -> Lanes {
    Lanes([v.x, v.y, v.z, last])
}

impl Hit {
    #[inline(always)]
    pub fn new(
        body: u32,
        (point, overlap): (&Vec3, f64),
        (normal, radius): (&Vec3, f64),
        (velocity, inverse_mass): (&Vec3, f64),
        (spin, material): (&Vec3, u32),
        local: [f64; 2],
        history: &History,
    ) -> Hit {
        Hit {
            body,
            local,
            point: record(point, overlap),
            normal: record(normal, radius),
            velocity: record(velocity, inverse_mass),
            spin: record(spin, f64::from(material)),
            memory: record(&history.spring, history.rate),
            turn: Lanes(history.turn),
        }
    }

    /// Radius of the sphere [m].
    #[inline(always)]
    pub fn radius(&self) -> f64 {
        self.normal[3]
    }

    /// What the contact remembers.
    #[inline(always)]
    pub fn history(&self) -> History {
        History { spring: xyz(&self.memory), rate: self.memory[3], turn: *self.turn }
    }

    /// Force on the body [N].
    #[inline(always)]
    pub fn force(&self) -> Vec3 {
        xyz(&self.velocity)
    }

    /// Torque on the body about its centre [N m].
    #[inline(always)]
    pub fn torque(&self) -> Vec3 {
        xyz(&self.spin)
    }

    /// Moment of rolling and twisting resistance on the body [N m].
    #[inline(always)]
    pub fn moment(&self) -> Vec3 {
        xyz(&self.normal)
    }

    /// Energy that dashpots and that sliding took [J].
    #[inline(always)]
    pub fn dissipated(&self) -> (f64, f64) {
        (self.velocity[3], self.spin[3])
    }
}

/// Asks the law for all hits of a block.
pub(crate) struct Ask<'a, L, const ROLL: bool> {
    pub laws: &'a PairTable<L>,
    pub block: &'a Block,
    pub hits: &'a mut [Hit],
    pub dt: f64,
}

impl<L: ContactLaw, const ROLL: bool> Kernel for Ask<'_, L, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Pack>(self) {
        let Ask { laws, block, hits, dt } = self;
        let mix = Mix::<L, R>::new(laws, None, None);
        let mut at = 0;
        while at < hits.len() {
            let count = (hits.len() - at).min(R::LANES);
            // Lanes to spare repeat the last hit.
            let hit = |l: usize| &hits[at + if l < count { l } else { count - 1 }];
            let body = |l: usize| hit(l).body as usize;
            let on = R::below(count);
            let [px, py, pz, overlap] = R::columns(R::rows(|l| &hit(l).point));
            let [nx, ny, nz, radius] = R::columns(R::rows(|l| &hit(l).normal));
            let [cx, cy, cz, _] = R::columns(R::rows(|l| &block.centre[body(l)]));
            let arm = V3::new(px - cx, py - cy, pz - cz);
            let [vx, vy, vz, softness] = R::columns(R::rows(|l| &block.velocity[body(l)]));
            let [wx, wy, wz, own] = R::columns(R::rows(|l| &block.spin[body(l)]));
            let [ux, uy, uz, other_softness] = R::columns(R::rows(|l| &hit(l).velocity));
            let [ox, oy, oz, other] = R::columns(R::rows(|l| &hit(l).spin));
            let spin = V3::new(wx, wy, wz);
            let touch = LawInput {
                mass: R::splat(1.0) / (softness + other_softness),
                radius,
                overlap,
                normal: V3::new(nx, ny, nz),
                velocity: V3::new(vx, vy, vz) + spin.cross(arm) - V3::new(ux, uy, uz),
                spin: spin - V3::new(ox, oy, oz),
            };
            let [sx, sy, sz, rate] = R::columns(R::rows(|l| &hit(l).memory));
            let mut memory = Memory { spring: V3::new(sx, sy, sz), rate, roll: V3::zero(), twist: R::zero() };
            if ROLL {
                let [rx, ry, rz, twist] = R::columns(R::rows(|l| &hit(l).turn));
                (memory.roll, memory.twist) = (V3::new(rx, ry, rz), twist);
            }
            let LawOutput { force, moment, dashpot, friction, .. } =
                L::evaluate::<R, ROLL>(&mix.of(own, other), &touch, &mut memory, on, dt);
            let mut torque = arm.cross(force);
            if ROLL {
                torque = torque + moment;
            }
            let answers = R::records(four(force, dashpot), four(torque, friction));
            let springs = R::records(four(memory.spring, memory.rate), four(memory.roll, memory.twist));
            let moments = R::records(four(moment, radius), four(V3::zero(), R::zero()));
            for l in 0..count {
                let hit = &mut hits[at + l];
                let mut two = [Lanes::default(); 2];
                R::put(answers[l], &mut two);
                [hit.velocity, hit.spin] = two;
                R::put(springs[l], &mut two);
                [hit.memory, hit.turn] = two;
                R::put(moments[l], &mut two);
                hit.normal = two[0];
            }
            at += count;
        }
    }
}
