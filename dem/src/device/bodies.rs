//! Flat device arrays of bodies, block by block.

use super::layout::MotionFlags;
use crate::Vec3;
use crate::bodies::block::Rotation;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::table::BodyKind;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;
use crate::lanes::V3;
use crate::lanes::quaternion::QuaternionLanes;
use nalgebra::UnitQuaternion;

/// Position, radius; velocity, inverse mass; angular velocity, material; with clumps orientation, angular
/// momentum.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub x: Vec<[f64; 4]>,
    pub v: Vec<[f64; 4]>,
    pub w: Vec<[f64; 4]>,
    pub orientation: Vec<[f64; 4]>,
    pub momentum: Vec<[f64; 4]>,
}

impl Motion {
    pub fn zeros(bodies: usize, clumps: bool) -> Motion {
        let zeros = |n: usize| vec![[0.0; 4]; n];
        let turning = if clumps { bodies } else { 0 };
        Motion {
            x: zeros(bodies),
            v: zeros(bodies),
            w: zeros(bodies),
            orientation: zeros(turning),
            momentum: zeros(turning),
        }
    }

    pub fn of(state: &State, clumps: bool) -> Motion {
        let mut out = Motion::default();
        for block in &state.blocks {
            out.x.extend(block.centre.iter().map(|r| r.0));
            out.v.extend(block.velocity.iter().map(|r| r.0));
            out.w.extend(block.spin.iter().map(|r| r.0));
            if clumps {
                let none = Rotation { orientation: Default::default(), momentum: Vec3::zeros() };
                for k in 0..block.bodies.len() {
                    let Rotation { orientation: q, momentum: l } = block.rotation.get(k).unwrap_or(&none);
                    out.orientation.push([q.i, q.j, q.k, q.w]);
                    out.momentum.push([l.x, l.y, l.z, 0.0]);
                }
            }
        }
        out
    }

    /// Writes motion to a state, member spheres to `work`.
    pub fn put(&self, state: &mut State, work: &mut Work) {
        let mut at = 0;
        for (block, members) in state.blocks.iter_mut().zip(&mut work.members) {
            let n = block.bodies.len();
            // The CPU moves solid bodies.
            if members.solid() {
                at += n;
                continue;
            }
            let lists =
                [(&mut block.centre, &self.x), (&mut block.velocity, &self.v), (&mut block.spin, &self.w)];
            for (to, from) in lists {
                to.iter_mut().zip(&from[at..at + n]).for_each(|(to, from)| to.0 = *from);
            }
            let turns = self.orientation.iter().zip(&self.momentum).skip(at);
            for (to, (q, [x, y, z, _])) in block.rotation.iter_mut().zip(turns) {
                *to = Rotation { orientation: quaternion(q), momentum: Vec3::new(*x, *y, *z) };
            }
            if members.rigid {
                (0..n).for_each(|k| {
                    members.place_spheres(k, &block.centre[k], &block.rotation[k].orientation);
                });
            }
            at += n;
        }
    }
}

/// As [`Motion::put`], positions and orientations only.
pub(super) fn put_places(x: &[[f64; 4]], orientation: &[[f64; 4]], state: &mut State, work: &mut Work) {
    let mut at = 0;
    for (block, members) in state.blocks.iter_mut().zip(&mut work.members) {
        let n = block.bodies.len();
        if !members.solid() {
            block.centre.iter_mut().zip(&x[at..at + n]).for_each(|(to, from)| to.0 = *from);
            let turns = orientation.iter().skip(at);
            block.rotation.iter_mut().zip(turns).for_each(|(to, q)| to.orientation = quaternion(q));
            if members.rigid {
                (0..n).for_each(|k| {
                    members.place_spheres(k, &block.centre[k], &block.rotation[k].orientation);
                });
            }
        }
        at += n;
    }
}

pub(super) fn quaternion([i, j, k, s]: &[f64; 4]) -> UnitQuaternion<f64> {
    QuaternionLanes { v: V3::new(*i, *j, *k), s: *s }.quaternion()
}

#[derive(Clone, Debug, Default)]
pub(super) struct Constants {
    /// Integration flags ([`MotionFlags`]).
    pub how: Vec<u32>,
    /// First body integrated singly, by block.
    pub first_single: Vec<u32>,
    /// Mass [kg] in first moments; in groups of four the inverse of the inverse mass.
    pub mass: Vec<f64>,
    /// Mass [kg], moment of inertia [kg m²].
    pub inertia: Vec<[f64; 2]>,
    /// Principal moments, bounding radius; fixed angular velocity.
    pub moments: Vec<[f64; 4]>,
    pub target: Vec<[f64; 4]>,
}

impl Constants {
    pub fn of(model: &Model, state: &State, work: &Work) -> Constants {
        let mut out = Constants::default();
        for (block, members) in state.blocks.iter().zip(&work.members) {
            let n = block.bodies.len();
            let first = out.how.len();
            for (k, &body) in block.bodies.iter().enumerate() {
                let fixed = members.fixed.get(k).copied().unwrap_or(0);
                let number = body as usize;
                let body = model.body(number);
                let by_four = by_four(members, k, n);
                let group = if by_four { k - k % 4..k - k % 4 + 4 } else { k..k + 1 };
                let turns = members.rigid && members.kind[group].contains(&BodyKind::Clump);
                let single = if by_four { 0 } else { MotionFlags::SINGLE | MotionFlags::fixed(fixed) };
                let bit = |on: bool, of: u32| if on { of } else { 0 };
                let elsewhere = bit(members.solid(), MotionFlags::ON_HOST);
                out.how.push(
                    single
                        | bit(turns, MotionFlags::TURNS)
                        | bit(members.rigid, MotionFlags::ORIENTED)
                        | elsewhere,
                );
                out.inertia.push([body.mass, body.inertia.x]);
                out.mass.push(if by_four { 1.0 / block.velocity[k].0[3] } else { body.mass });
                if model.clumps {
                    let (i, reach) =
                        (body.inertia, if body.kind == BodyKind::Sphere { 0.0 } else { body.radius });
                    let spin = model.bodies.spin(number);
                    out.moments.push([i.x, i.y, i.z, reach]);
                    out.target.push([spin.x, spin.y, spin.z, 0.0]);
                }
            }
            let single = out.how[first..].iter().position(|how| how & MotionFlags::SINGLE != 0);
            out.first_single.push((first + single.unwrap_or(n)) as u32);
        }
        out
    }
}

/// Integrated in a group of four (`integrate/leapfrog.rs`).
fn by_four(members: &BlockBodies, k: usize, n: usize) -> bool {
    let group = k - k % 4;
    group + 4 <= n && (members.plain() || members.all_free(group))
}

/// Member spheres with any clump; otherwise bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Spheres {
    pub clumps: bool,
    pub count: usize,
    pub base: Vec<u32>,
    /// First sphere of each body, with end.
    pub first: Vec<u32>,
    /// Body; centre and radius in the body frame and in the global frame.
    pub owner: Vec<u32>,
    pub local: Vec<[f64; 4]>,
    pub world: Vec<[f64; 4]>,
}

impl Spheres {
    pub fn of(model: &Model, state: &State, work: &Work) -> Spheres {
        let mut out = Spheres { clumps: model.clumps, ..Spheres::default() };
        let mut bodies = 0;
        for (block, members) in state.blocks.iter().zip(&work.members) {
            out.base.push(if model.clumps { out.owner.len() as u32 } else { bodies });
            if model.clumps {
                out.world.extend(members.spheres(block).iter().map(|r| r.0));
                if members.rigid {
                    let first = out.owner.len() as u32;
                    out.first.extend(members.first[..block.bodies.len()].iter().map(|k| first + k));
                    out.owner.extend(members.owner.iter().map(|k| bodies + k));
                    out.local.extend(members.local.iter().map(|r| r.0));
                } else {
                    let own = bodies..bodies + block.bodies.len() as u32;
                    out.first.extend(own.clone().map(|k| out.owner.len() as u32 + k - bodies));
                    out.owner.extend(own);
                    out.local.extend(block.centre.iter().map(|r| [0.0, 0.0, 0.0, r[3]]));
                }
            }
            bodies += block.bodies.len() as u32;
        }
        out.first.push(out.owner.len() as u32);
        out.count = if model.clumps { out.owner.len() } else { bodies as usize };
        out
    }

    pub fn at(&self, block: usize, sphere: u32) -> u32 {
        self.base[block] + sphere
    }

    pub fn owner(&self, sphere: u32) -> u32 {
        self.owner.get(sphere as usize).copied().unwrap_or(sphere)
    }
}
