//! Constants of a block's bodies in block order, and their spheres.

use super::block::Block;
use super::table::{Bodies, BodyKind, for_members};
use crate::base::Vec3;
use crate::base::capacity::capacity_bytes;
use crate::lanes::V3;
use crate::lanes::quaternion::{QuaternionLanes, placed};
use crate::lanes::vec4::{Vec4, xyz};
use crate::shape::Shape;
use nalgebra::UnitQuaternion;
use std::ops::Range;

#[derive(Clone, Debug, Default)]
pub struct BlockBodies {
    /// Whether any body is not a single sphere, so that sphere and body indices differ.
    pub rigid: bool,
    pub round: bool,
    pub mass_sum: f64,
    pub material: Option<u32>,
    /// Like the next fields, empty for single spheres.
    pub kind: Vec<BodyKind>,
    pub inertia: Vec<Vec3>,
    /// Bounding radius; zero for single spheres.
    pub reach: Vec<f64>,
    /// Bits 0–2 translation, 3–5 rotation; empty if all are free.
    pub fixed: Vec<u8>,
    /// Shape (index), scale; half sides of a bounding box. Only for bodies not made of spheres.
    pub solids: Vec<(u32, f64)>,
    pub half: Vec<Vec3>,
    /// First sphere of each body, and the total.
    pub first: Vec<u32>,
    pub count: usize,
    /// Body of each sphere; centre and radius in body frame and world.
    pub owner: Vec<u32>,
    pub local: Vec<Vec4>,
    spheres: Vec<Vec4>,
}

pub fn common<T: Copy + PartialEq>(mut all: impl Iterator<Item = T>) -> Option<T> {
    let first = all.next()?;
    all.all(|x| x == first).then_some(first)
}

impl BlockBodies {
    #[inline]
    pub fn in_clumps(&self) -> usize {
        let counts = self.first.windows(2).map(|w| (w[1] - w[0]) as usize);
        counts.filter(|count| *count > 1).sum()
    }

    /// Rebuilds constants in block order and positions spheres.
    pub fn arrange(&mut self, table: &Bodies, shapes: &[Shape], block: &Block) {
        *self = BlockBodies::default();
        let bodies = &block.bodies;
        self.rigid = bodies.iter().any(|&b| table.kind(b as usize) != BodyKind::Sphere);
        self.round = bodies.iter().all(|&b| table.kind(b as usize) != BodyKind::Solid);
        self.fixed.reserve_exact(bodies.len());
        self.material = common(bodies.iter().map(|&b| table.get(b as usize).material));
        for (k, &body) in bodies.iter().enumerate() {
            let b = table.get(body as usize);
            self.fixed.push(b.fixed);
            self.mass_sum += b.mass;
            if self.rigid {
                self.first.push(self.owner.len() as u32);
                self.kind.push(b.kind);
                self.inertia.push(b.inertia);
                self.reach.push(if b.kind == BodyKind::Sphere { 0.0 } else { b.radius });
                if !self.round {
                    self.solids.push((b.shape as u32, b.scale));
                    self.half.push(shapes[b.shape].bounding_half(b.scale));
                }
                for_members(&shapes[b.shape], b.scale, |c, r| {
                    self.owner.push(k as u32);
                    self.local.push(Vec4([c.x, c.y, c.z, r]));
                });
            }
        }
        self.count = if self.rigid { self.owner.len() } else { bodies.len() };
        if self.fixed.iter().all(|&f| f == 0) {
            self.fixed = Vec::new();
        }
        if self.rigid {
            self.first.push(self.owner.len() as u32);
            self.spheres.resize(self.local.len(), Vec4::default());
            for k in 0..bodies.len() {
                self.place_spheres(k, &block.centre[k], &block.rotation[k].orientation);
            }
        }
    }

    #[inline]
    pub fn solid(&self) -> bool {
        self.kind.first() == Some(&BodyKind::Solid)
    }

    /// Whether all bodies are free and consist of spheres.
    #[inline]
    pub fn plain(&self) -> bool {
        self.round && self.fixed.is_empty()
    }

    /// Likewise for bodies k to k + 3.
    #[inline(always)]
    pub fn all_free(&self, k: usize) -> bool {
        self.round && (self.fixed.is_empty() || self.fixed[k..k + 4] == [0; 4])
    }

    #[inline(always)]
    pub fn body(&self, sphere: u32) -> u32 {
        self.owner.get(sphere as usize).copied().unwrap_or(sphere)
    }

    #[inline]
    pub fn of_body(&self, k: usize) -> Range<u32> {
        if self.rigid { self.first[k]..self.first[k + 1] } else { k as u32..k as u32 + 1 }
    }

    #[inline(always)]
    pub fn member(&self, sphere: u32, body: usize) -> u32 {
        if self.rigid { sphere - self.first[body] } else { 0 }
    }

    /// Includes clump members.
    #[inline(always)]
    pub fn spheres<'a>(&'a self, block: &'a Block) -> &'a [Vec4] {
        if self.rigid { &self.spheres } else { &block.centre }
    }

    #[inline]
    pub fn spheres_of(&self, k: usize) -> &[Vec4] {
        &self.spheres[self.first[k] as usize..self.first[k + 1] as usize]
    }

    #[inline(always)]
    pub fn local_and_world(&mut self) -> (&[Vec4], &mut [Vec4]) {
        (&self.local, &mut self.spheres)
    }

    #[inline(always)]
    pub fn place_spheres(&mut self, k: usize, centre: &Vec4, orientation: &UnitQuaternion<f64>) {
        let (x, columns) = (V3::from_vec(&xyz(centre)), QuaternionLanes::of(orientation).columns());
        for s in self.first[k] as usize..self.first[k + 1] as usize {
            let local = &self.local[s];
            let p = placed(columns, x, V3::from_vec(&xyz(local)));
            self.spheres[s] = Vec4([p.x, p.y, p.z, local[3]]);
        }
    }
}

impl BlockBodies {
    pub fn bytes(&self) -> usize {
        let spheres = capacity_bytes(&self.owner)
            + capacity_bytes(&self.local)
            + capacity_bytes(&self.spheres)
            + capacity_bytes(&self.first);
        let bodies = capacity_bytes(&self.inertia) + capacity_bytes(&self.reach) + capacity_bytes(&self.kind);
        spheres
            + bodies
            + capacity_bytes(&self.fixed)
            + capacity_bytes(&self.solids)
            + capacity_bytes(&self.half)
    }
}
