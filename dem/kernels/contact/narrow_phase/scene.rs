//! Positions of contact partners.

use crate::base::Vec3;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::block_slice::BlockSlice;
use crate::lanes::vec4::{Vec4, xyz};
use crate::law::scarring::Scar;
use crate::shape::Shape;
use crate::shape::dilated::Core;
use crate::shape::plane::{Plane, PlaneMotion};
use crate::spatial::bvh::{Aabb, Bvh};
use crate::spatial::patchwork::{Patch, Trees, WallView, Walls};
use crate::spatial::periodic::Periodic;
use crate::spatial::sheet::SheetFacet;
use nalgebra::UnitQuaternion;

/// Non-spherical body.
#[derive(Clone, Copy, Debug)]
pub struct PosedBody<'a> {
    pub centre: Vec3,
    /// Body frame to world.
    pub orientation: UnitQuaternion<f64>,
    pub shape: &'a Shape,
    /// Scale factor on lengths.
    pub scale: f64,
    pub core: &'a Core,
    /// Rounding radius, scaled [m].
    pub radius: f64,
}

impl PosedBody<'_> {
    /// Frame in unscaled lengths.
    #[inline(always)]
    pub fn pose(&self) -> Pose {
        Pose { centre: self.centre, orientation: self.orientation, scale: self.scale }
    }

    #[inline(always)]
    pub fn half(&self) -> Option<Vec3> {
        match self.shape {
            Shape::Box { .. } => Some(self.shape.half_sides(self.scale)),
            _ => None,
        }
    }

    #[inline(always)]
    pub fn dilated(&self) -> bool {
        self.radius > 0.0
    }

    /// Bounding radius [m].
    #[inline(always)]
    pub fn reach(&self) -> f64 {
        self.core.reach * self.scale + self.radius
    }

    pub fn bounds(&self) -> Aabb {
        let turn = self.orientation.to_rotation_matrix();
        let reach = turn.matrix().abs() * self.shape.bounding_half(self.scale);
        ((self.centre - reach).into(), (self.centre + reach).into())
    }
}

#[derive(Clone, Copy, Debug)]
pub struct PlaneView {
    /// Point on it [m].
    pub origin: Vec3,
    pub normal: Vec3,
    pub velocity: Vec3,
    pub material: u32,
    /// Whether bodies pass through.
    pub open: bool,
}

#[derive(Clone, Copy, Debug)]
pub struct PatchView<'a> {
    pub patch: &'a Patch,
    pub wall: &'a WallView,
    /// Patch to image [m].
    pub shift: Vec3,
}

impl PatchView<'_> {
    /// Frame of its wall.
    pub fn pose(&self) -> Pose {
        Pose { centre: self.wall.origin + self.shift, orientation: self.wall.orientation, scale: 1.0 }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub centre: Vec3,
    pub orientation: UnitQuaternion<f64>,
    pub scale: f64,
}

pub trait BodyAccess {
    fn block(&self, b: usize) -> &Block;

    /// Sphere centre and radius.
    fn sphere(&self, b: usize, i: u32) -> &Vec4;

    /// Body of a sphere.
    fn owner(&self, b: usize, i: u32) -> usize;

    fn placed(&self, b: usize, k: usize) -> PosedBody<'_>;

    fn plane(&self, k: usize) -> PlaneView;

    fn walls(&self) -> Walls<'_>;

    fn sheet(&self) -> SheetView<'_>;

    fn borders(&self) -> Option<&Periodic>;

    /// Scars by body; empty without scarred ground.
    fn scars(&self) -> &[Scar];
}

#[derive(Clone, Copy)]
pub struct SheetView<'a> {
    pub facets: &'a [SheetFacet],
    /// Material of the first triangles; start and material of the others.
    pub materials: (u32, Option<(u32, u32)>),
}

impl SheetView<'_> {
    #[inline(always)]
    pub fn material(&self, number: u32) -> u32 {
        match self.materials {
            (_, Some((first, other))) if number >= first => other,
            (own, _) => own,
        }
    }
}

/// Bodies in a step.
#[derive(Clone, Copy)]
pub struct Configuration<'a> {
    pub blocks: BlockSlice<'a, Block>,
    pub members: BlockSlice<'a, BlockBodies>,
    pub shapes: &'a [Shape],
    pub cores: &'a [Core],
    pub planes: (&'a [Plane], &'a [PlaneMotion]),
    pub walls: Walls<'a>,
    pub sheet: SheetView<'a>,
    pub periodic: Option<&'a Periodic>,
    pub scars: &'a [Scar],
}

impl BodyAccess for Configuration<'_> {
    #[inline(always)]
    fn block(&self, b: usize) -> &Block {
        &self.blocks[b]
    }

    #[inline(always)]
    fn sphere(&self, b: usize, i: u32) -> &Vec4 {
        &self.members[b].spheres(&self.blocks[b])[i as usize]
    }

    #[inline(always)]
    fn owner(&self, b: usize, i: u32) -> usize {
        self.members[b].body(i) as usize
    }

    #[inline(always)]
    fn placed(&self, b: usize, k: usize) -> PosedBody<'_> {
        let (block, (shape, scale)) = (&self.blocks[b], self.members[b].solids[k]);
        PosedBody {
            centre: xyz(&block.centre[k]),
            orientation: block.rotation[k].orientation,
            shape: &self.shapes[shape as usize],
            scale,
            core: &self.cores[shape as usize],
            radius: self.shapes[shape as usize].rounding(scale),
        }
    }

    #[inline(always)]
    fn plane(&self, k: usize) -> PlaneView {
        let (plane, motion) = (&self.planes.0[k], &self.planes.1[k]);
        PlaneView {
            origin: plane.point + motion.offset,
            normal: plane.normal,
            velocity: motion.velocity,
            material: plane.material as u32,
            open: motion.open,
        }
    }

    #[inline(always)]
    fn walls(&self) -> Walls<'_> {
        self.walls
    }

    #[inline(always)]
    fn sheet(&self) -> SheetView<'_> {
        self.sheet
    }

    #[inline(always)]
    fn borders(&self) -> Option<&Periodic> {
        self.periodic
    }

    #[inline(always)]
    fn scars(&self) -> &[Scar] {
        self.scars
    }
}

pub struct Search<'a> {
    pub now: Configuration<'a>,
    pub planes: usize,
    /// Block and place, ascending.
    pub solids: Vec<[u32; 2]>,
    tree: Bvh,
    patches: &'a Trees,
    facets: Bvh,
    /// Image shifts [m].
    images: Vec<Vec3>,
}

impl<'a> Search<'a> {
    pub fn new(now: Configuration<'a>, patches: &'a Trees) -> Search<'a> {
        let mut solids = Vec::new();
        for (b, (block, members)) in now.blocks.list.iter().zip(now.members.list).enumerate() {
            if members.solid() {
                solids.extend((0..block.bodies.len() as u32).map(|k| [b as u32, k]));
            }
        }
        let bounds: Vec<Aabb> =
            solids.iter().map(|&[b, k]| now.placed(b as usize, k as usize).bounds()).collect();
        let facets = Bvh::new(&now.sheet.facets.iter().map(SheetFacet::bounds).collect::<Vec<_>>());
        let images = now.periodic.map_or_else(Vec::new, Periodic::around);
        Search { now, planes: now.planes.0.len(), solids, tree: Bvh::new(&bounds), patches, facets, images }
    }

    /// Results of `query` over all images, ascending.
    fn near(&self, (low, high): Aabb, row: &mut Vec<u32>, query: impl Fn(Aabb, &mut Vec<u32>)) {
        row.clear();
        if self.images.is_empty() {
            return query((low, high), row);
        }
        for way in &self.images {
            let moved = |x: [f64; 3]| std::array::from_fn(|d| x[d] - way[d]);
            query((moved(low), moved(high)), row);
        }
        row.sort_unstable();
        row.dedup();
    }

    /// Visits wall patches possibly within bounds, ascending.
    pub fn patches_near(&self, bounds: Aabb, row: &mut Vec<u32>, f: impl FnMut(u32)) {
        self.near(bounds, row, |bounds, row| self.patches.query(self.now.walls.walls, bounds, row));
        row.iter().copied().for_each(f);
    }

    /// Visits surface triangles possibly within bounds, ascending.
    pub fn facets_near(&self, bounds: Aabb, row: &mut Vec<u32>, f: impl FnMut(u32)) {
        self.near(bounds, row, |(low, high), row| self.facets.query(low, high, row));
        row.iter().copied().for_each(f);
    }

    /// Visits block and place of bodies possibly within bounds, ascending.
    pub fn solids_near(&self, bounds: Aabb, row: &mut Vec<u32>, mut f: impl FnMut(u32, u32)) {
        self.near(bounds, row, |(low, high), row| self.tree.query(low, high, row));
        for &k in row.iter() {
            let [b, place] = self.solids[k as usize];
            f(b, place);
        }
    }
}
