//! Contact law of patches in lanes.

use super::group_memory::{Mix, four};
use crate::base::Vec3;
use crate::bodies::block::Block;
use crate::lanes::record::{Record, xyz};
use crate::lanes::{Kernel, Pack, Real, V3};
use crate::law::{ContactLaw, History, LawInput, LawOutput, Memory, PairTable};

/// Sphere–patch contact; outputs replace inputs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchForce {
    pub body: u32,
    /// Local coordinates on the patch.
    pub local: [f64; 2],
    /// Contact point, overlap.
    point: Record,
    /// In: normal, radius. Out: moment of the torque.
    normal: Record,
    /// In: patch velocity, inverse wall mass. Out: force, dashpot loss.
    velocity: Record,
    /// In: wall angular velocity, material. Out: torque, friction loss.
    spin: Record,
    /// Tangential spring, previous approach speed.
    memory: Record,
    /// Rolling and twisting springs.
    turn: Record,
}

impl PatchForce {
    #[inline(always)]
    pub fn new(
        body: u32,
        (point, overlap): (&Vec3, f64),
        (normal, radius): (&Vec3, f64),
        (velocity, inverse_mass): (&Vec3, f64),
        (spin, material): (&Vec3, u32),
        local: [f64; 2],
        history: &History,
    ) -> PatchForce {
        PatchForce {
            body,
            local,
            point: Record::of(point, overlap),
            normal: Record::of(normal, radius),
            velocity: Record::of(velocity, inverse_mass),
            spin: Record::of(spin, f64::from(material)),
            memory: Record::of(&history.spring, history.rate),
            turn: Record(history.turn),
        }
    }

    #[inline(always)]
    pub fn radius(&self) -> f64 {
        self.normal[3]
    }

    #[inline(always)]
    pub fn history(&self) -> History {
        History { spring: xyz(&self.memory), rate: self.memory[3], turn: *self.turn }
    }

    #[inline(always)]
    pub fn force(&self) -> Vec3 {
        xyz(&self.velocity)
    }

    #[inline(always)]
    pub fn torque(&self) -> Vec3 {
        xyz(&self.spin)
    }

    /// Rolling and twisting moment [N m].
    #[inline(always)]
    pub fn moment(&self) -> Vec3 {
        xyz(&self.normal)
    }

    /// Dashpot and sliding loss [J].
    #[inline(always)]
    pub fn dissipated(&self) -> (f64, f64) {
        (self.velocity[3], self.spin[3])
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch<R> {
    /// Body centre to contact point.
    pub arm: V3<R>,
    pub overlap: R,
    pub radius: R,
    pub normal: V3<R>,
    /// Velocity and angular velocity of the body, and of the wall at the point.
    pub body: (V3<R>, V3<R>),
    pub wall: (V3<R>, V3<R>),
    /// Sum of inverse masses.
    pub inverse_mass: R,
}

/// Force, torque about the centre, its moment part, dissipation.
pub(crate) struct Forces<R> {
    pub force: V3<R>,
    pub torque: V3<R>,
    pub moment: V3<R>,
    pub dashpot: R,
    pub friction: R,
}

/// Forces in lanes `on` over a step [s]; advances history.
#[inline(always)]
pub(crate) fn acting<L: ContactLaw, R: Real, const ROLL: bool>(
    law: &L::Lanes<R>,
    t: &Touch<R>,
    memory: &mut Memory<R>,
    on: R::Mask,
    step: R,
) -> Forces<R> {
    let ((velocity, spin), (wall, wall_spin)) = (t.body, t.wall);
    let input = LawInput {
        inverse_mass: t.inverse_mass,
        radius: t.radius,
        overlap: t.overlap,
        normal: t.normal,
        velocity: velocity + spin.cross(t.arm) - wall,
        spin: spin - wall_spin,
    };
    let LawOutput { force, moment, dashpot, friction, .. } =
        L::acting::<R, ROLL>(law, &input, memory, on, step);
    let mut torque = t.arm.cross(force);
    if ROLL {
        torque = torque + moment;
    }
    Forces { force, torque, moment, dashpot, friction }
}

pub(crate) struct PatchLaw<'a, L, const ROLL: bool> {
    pub laws: &'a PairTable<L>,
    pub block: &'a Block,
    pub forces: &'a mut [PatchForce],
    pub dt: f64,
}

impl<L: ContactLaw, const ROLL: bool> Kernel for PatchLaw<'_, L, ROLL> {
    type Output = ();

    #[inline(always)]
    fn run<R: Pack>(self) {
        let PatchLaw { laws, block, forces, dt } = self;
        let mix = Mix::<L, R>::new(laws, None, None);
        let mut at = 0;
        while at < forces.len() {
            let count = (forces.len() - at).min(R::LANES);
            let of = |l: usize| &forces[at + if l < count { l } else { count - 1 }];
            let body = |l: usize| of(l).body as usize;
            let on = R::below(count);
            let [px, py, pz, overlap] = R::columns(R::rows(|l| &of(l).point));
            let [nx, ny, nz, radius] = R::columns(R::rows(|l| &of(l).normal));
            let [cx, cy, cz, _] = R::columns(R::rows(|l| &block.centre[body(l)]));
            let arm = V3::new(px - cx, py - cy, pz - cz);
            let [vx, vy, vz, inverse_mass] = R::columns(R::rows(|l| &block.velocity[body(l)]));
            let [wx, wy, wz, own] = R::columns(R::rows(|l| &block.spin[body(l)]));
            let [ux, uy, uz, wall_inverse_mass] = R::columns(R::rows(|l| &of(l).velocity));
            let [ox, oy, oz, other] = R::columns(R::rows(|l| &of(l).spin));
            let touch = Touch {
                arm,
                overlap,
                radius,
                normal: V3::new(nx, ny, nz),
                body: (V3::new(vx, vy, vz), V3::new(wx, wy, wz)),
                wall: (V3::new(ux, uy, uz), V3::new(ox, oy, oz)),
                inverse_mass: inverse_mass + wall_inverse_mass,
            };
            let [sx, sy, sz, rate] = R::columns(R::rows(|l| &of(l).memory));
            let mut memory = Memory { spring: V3::new(sx, sy, sz), rate, roll: V3::zero(), twist: R::zero() };
            if ROLL {
                let [rx, ry, rz, twist] = R::columns(R::rows(|l| &of(l).turn));
                (memory.roll, memory.twist) = (V3::new(rx, ry, rz), twist);
            }
            let law = mix.of(own, other);
            let Forces { force, torque, moment, dashpot, friction } =
                acting::<L, R, ROLL>(&law, &touch, &mut memory, on, R::splat(dt));
            let results = R::records(four(force, dashpot), four(torque, friction));
            let springs = R::records(four(memory.spring, memory.rate), four(memory.roll, memory.twist));
            let moments = R::records(four(moment, radius), four(V3::zero(), R::zero()));
            for l in 0..count {
                let of = &mut forces[at + l];
                let mut two = [Record::default(); 2];
                R::put(results[l], &mut two);
                [of.velocity, of.spin] = two;
                R::put(springs[l], &mut two);
                [of.memory, of.turn] = two;
                R::put(moments[l], &mut two);
                of.normal = two[0];
            }
            at += count;
        }
    }
}
