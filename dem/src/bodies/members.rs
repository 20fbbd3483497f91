//! Constants of the bodies of a block in block order, and the spheres that they are made of.

use super::block::Block;
use super::table::{Bodies, Kind, for_members};
use crate::base::Vec3;
use crate::base::held::held;
use crate::lanes::V3;
use crate::lanes::record::{Record, xyz};
use crate::lanes::turn::{Turn, placed};
use crate::shape::Shape;
use nalgebra::UnitQuaternion;
use std::ops::Range;

/// Constants of a block's bodies, and its spheres where they are. A block of single spheres keeps next to nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Members {
    /// Whether any body is no single sphere: spheres and bodies then have numbers of their own.
    pub rigid: bool,
    /// Whether all bodies are made of spheres.
    pub round: bool,
    pub mass_sum: f64,
    /// The material of all bodies, where there is only one.
    pub material: Option<u32>,
    /// Kind of each body; this and what follows is empty in blocks of single spheres.
    pub kind: Vec<Kind>,
    pub inertia: Vec<Vec3>,
    /// Bounding radius of each body that is not a single sphere; zero for those.
    pub reach: Vec<f64>,
    /// Bits 0–2 translation, 3–5 rotation; empty where all motions are free.
    pub fixed: Vec<u8>,
    /// Shape (index) and scale of each body, and half sides of a box about its centre that holds it; only in blocks of
    /// bodies that are not made of spheres.
    pub solids: Vec<(u32, f64)>,
    pub half: Vec<Vec3>,
    /// First sphere of each body, and one past the last.
    pub first: Vec<u32>,
    /// Number of spheres.
    pub count: usize,
    /// Place of the body of each sphere, its centre in the body frame and radius, and the same in the world.
    pub owner: Vec<u32>,
    pub local: Vec<Record>,
    spheres: Vec<Record>,
}

/// What all are equal to, if they are.
pub(crate) fn common<T: Copy + PartialEq>(mut all: impl Iterator<Item = T>) -> Option<T> {
    let first = all.next()?;
    all.all(|x| x == first).then_some(first)
}

impl Members {
    /// Number of spheres in bodies of several.
    pub fn in_clumps(&self) -> usize {
        let counts = self.first.windows(2).map(|w| (w[1] - w[0]) as usize);
        counts.filter(|count| *count > 1).sum()
    }

    /// Lays the constants out in the block's present order, and places the spheres.
    pub fn arrange(&mut self, table: &Bodies, shapes: &[Shape], block: &Block) {
        *self = Members::default();
        let bodies = &block.bodies;
        self.rigid = bodies.iter().any(|&b| table.kind(b as usize) != Kind::Sphere);
        self.round = bodies.iter().all(|&b| table.kind(b as usize) != Kind::Solid);
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
                self.reach.push(if b.kind == Kind::Sphere { 0.0 } else { b.radius });
                if !self.round {
                    self.solids.push((b.shape as u32, b.scale));
                    self.half.push(shapes[b.shape].bounding_half(b.scale));
                }
                for_members(&shapes[b.shape], b.scale, |c, r| {
                    self.owner.push(k as u32);
                    self.local.push(Record([c.x, c.y, c.z, r]));
                });
            }
        }
        self.count = if self.rigid { self.owner.len() } else { bodies.len() };
        if self.fixed.iter().all(|&f| f == 0) {
            self.fixed = Vec::new();
        }
        if self.rigid {
            self.first.push(self.owner.len() as u32);
            self.spheres.resize(self.local.len(), Record::default());
            for k in 0..bodies.len() {
                self.place_spheres(k, &block.centre[k], &block.rotation[k].orientation);
            }
        }
    }

    /// Whether the block is one of bodies that are not made of spheres.
    pub fn solid(&self) -> bool {
        self.kind.first() == Some(&Kind::Solid)
    }

    /// Whether all bodies are made of spheres and none has a fixed motion.
    pub fn plain(&self) -> bool {
        self.round && self.fixed.is_empty()
    }

    /// Whether the bodies k to k + 3 are made of spheres and have no fixed motion.
    #[inline(always)]
    pub fn all_free(&self, k: usize) -> bool {
        self.round && (self.fixed.is_empty() || self.fixed[k..k + 4] == [0; 4])
    }

    /// The body of a sphere.
    #[inline(always)]
    pub fn body(&self, sphere: u32) -> u32 {
        self.owner.get(sphere as usize).copied().unwrap_or(sphere)
    }

    /// The spheres of a body.
    pub fn of_body(&self, k: usize) -> Range<u32> {
        if self.rigid { self.first[k]..self.first[k + 1] } else { k as u32..k as u32 + 1 }
    }

    /// Number of a sphere within its body.
    #[inline(always)]
    pub fn member(&self, sphere: u32, body: usize) -> u32 {
        if self.rigid { sphere - self.first[body] } else { 0 }
    }

    /// Centre and radius of each sphere, of clumps too.
    #[inline(always)]
    pub fn spheres<'a>(&'a self, block: &'a Block) -> &'a [Record] {
        if self.rigid { &self.spheres } else { &block.centre }
    }

    /// Centre and radius of each sphere of a clump.
    pub fn spheres_of(&self, k: usize) -> &[Record] {
        &self.spheres[self.first[k] as usize..self.first[k + 1] as usize]
    }

    /// Where the spheres of clumps are kept.
    #[inline(always)]
    pub fn local_and_world(&mut self) -> (&[Record], &mut [Record]) {
        (&self.local, &mut self.spheres)
    }

    /// Puts the spheres of a body where its centre and orientation say.
    #[inline(always)]
    pub fn place_spheres(&mut self, k: usize, centre: &Record, orientation: &UnitQuaternion<f64>) {
        let (x, columns) = (V3::from_vec(&xyz(centre)), Turn::of(orientation).columns());
        for s in self.first[k] as usize..self.first[k + 1] as usize {
            let local = &self.local[s];
            let p = placed(columns, x, V3::from_vec(&xyz(local)));
            self.spheres[s] = Record([p.x, p.y, p.z, local[3]]);
        }
    }
}

impl Members {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let spheres = held(&self.owner) + held(&self.local) + held(&self.spheres) + held(&self.first);
        let bodies = held(&self.inertia) + held(&self.reach) + held(&self.kind);
        spheres + bodies + held(&self.fixed) + held(&self.solids) + held(&self.half)
    }
}
