//! Contact law of patches in lanes.

use super::group_history::{LawLanes, four};
use crate::base::Vec3;
use crate::bodies::block::Block;
use crate::lanes::vec4::{Vec4, xyz};
use crate::lanes::{Kernel, Real, SimdPack, V3};
use crate::law::{ContactLaw, History, HistoryLanes, LawInput, LawOutput, PairTable};

/// Sphere–patch contact; outputs replace inputs.
#[derive(Clone, Copy, Debug)]
pub struct PatchForce {
    pub body: u32,
    /// Local coordinates on the patch.
    pub local: [f64; 2],
    /// Contact point, overlap.
    point: Vec4,
    /// In: normal, radius. Out: moment of the torque.
    normal: Vec4,
    /// In: patch velocity, inverse wall mass. Out: force, dashpot loss.
    velocity: Vec4,
    /// In: wall angular velocity, material. Out: torque, friction loss.
    spin: Vec4,
    /// Tangential spring, previous approach speed.
    memory: Vec4,
    /// Rolling and twisting springs.
    turn: Vec4,
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
            point: Vec4::of(point, overlap),
            normal: Vec4::of(normal, radius),
            velocity: Vec4::of(velocity, inverse_mass),
            spin: Vec4::of(spin, f64::from(material)),
            memory: Vec4::of(&history.spring, history.rate),
            turn: Vec4(history.turn),
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
pub struct PatchContactInput<R> {
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
pub struct Forces<R> {
    pub force: V3<R>,
    pub torque: V3<R>,
    pub moment: V3<R>,
    pub dashpot: R,
    pub friction: R,
}

/// Forces in lanes `on` over a step [s]; advances history.
#[inline(always)]
pub fn acting<L: ContactLaw, R: Real, const ROLLING: bool>(
    law: &L::Lanes<R>,
    t: &PatchContactInput<R>,
    memory: &mut HistoryLanes<R>,
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
        L::acting::<R, ROLLING>(law, &input, memory, on, step);
    let mut torque = t.arm.cross(force);
    if ROLLING {
        torque = torque + moment;
    }
    Forces { force, torque, moment, dashpot, friction }
}

pub struct PatchLaw<'a, L, const ROLLING: bool> {
    pub laws: &'a PairTable<L>,
    pub block: &'a Block,
    pub forces: &'a mut [PatchForce],
    pub dt: f64,
}

impl<L: ContactLaw, const ROLLING: bool> Kernel for PatchLaw<'_, L, ROLLING> {
    type Output = ();

    #[inline(always)]
    fn run<R: SimdPack>(self) {
        let PatchLaw { laws, block, forces, dt } = self;
        let mix = LawLanes::<L, R>::new(laws, None, None);
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
            let touch = PatchContactInput {
                arm,
                overlap,
                radius,
                normal: V3::new(nx, ny, nz),
                body: (V3::new(vx, vy, vz), V3::new(wx, wy, wz)),
                wall: (V3::new(ux, uy, uz), V3::new(ox, oy, oz)),
                inverse_mass: inverse_mass + wall_inverse_mass,
            };
            let [sx, sy, sz, rate] = R::columns(R::rows(|l| &of(l).memory));
            let mut memory =
                HistoryLanes { spring: V3::new(sx, sy, sz), rate, roll: V3::zero(), twist: R::zero() };
            if ROLLING {
                let [rx, ry, rz, twist] = R::columns(R::rows(|l| &of(l).turn));
                (memory.roll, memory.twist) = (V3::new(rx, ry, rz), twist);
            }
            let law = mix.of(own, other);
            let Forces { force, torque, moment, dashpot, friction } =
                acting::<L, R, ROLLING>(&law, &touch, &mut memory, on, R::splat(dt));
            let results = R::records(four(force, dashpot), four(torque, friction));
            let springs = R::records(four(memory.spring, memory.rate), four(memory.roll, memory.twist));
            let moments = R::records(four(moment, radius), four(V3::zero(), R::zero()));
            for l in 0..count {
                let of = &mut forces[at + l];
                let mut two = [Vec4::default(); 2];
                R::store_record(results[l], &mut two);
                [of.velocity, of.spin] = two;
                R::store_record(springs[l], &mut two);
                [of.memory, of.turn] = two;
                R::store_record(moments[l], &mut two);
                of.normal = two[0];
            }
            at += count;
        }
    }
}
