//! Walls as bodies with faces and edges see them: triangles and round patches, in frames that move as rigid wholes.

use super::bvh::{Aabb, Bvh};
use super::facet::Facet;
use super::round::Round;
use crate::base::Vec3;
use crate::base::error::Partner;
use nalgebra::UnitQuaternion;

/// What a patch is.
#[derive(Clone, Debug)]
pub(crate) enum Form {
    Facet(Box<Facet>),
    Round(Round),
}

impl Form {
    /// Bounds in the frame of its wall.
    pub fn bounds(&self) -> Aabb {
        match self {
            Form::Facet(it) => it.bounds(),
            Form::Round(it) => it.bounds(),
        }
    }
}

/// A patch of a wall.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub wall: u32,
    pub form: Form,
    /// The patch as a contact names it.
    pub partner: Partner,
    /// A point amid it, in the frame of its wall [m].
    pub middle: Vec3,
}

impl Patch {
    /// A patch of a wall.
    pub fn new(wall: u32, form: Form, partner: Partner) -> Patch {
        let (low, high) = form.bounds();
        let middle = (Vec3::from(low) + Vec3::from(high)) * 0.5;
        Patch { wall, form, partner, middle }
    }
}

/// A wall where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallNow {
    /// Where the origin of its frame is [m], and how that is turned.
    pub origin: Vec3,
    pub orientation: UnitQuaternion<f64>,
    /// The point that its moments refer to [m], its velocity [m/s], and its angular velocity [rad/s].
    pub centre: Vec3,
    pub velocity: Vec3,
    pub spin: Vec3,
    pub material: u32,
    /// One over its mass [1/kg]; zero where its motion is prescribed.
    pub inverse_mass: f64,
    /// Whether bodies pass through.
    pub open: bool,
    /// Whether forces set its speed.
    pub driven: bool,
    /// Whether it is ground that bodies scar.
    pub scarred: bool,
}

/// Trees of the patches of each wall in its own frame. Walls move as rigid wholes: the trees never change.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trees {
    each: Vec<Tree>,
}

/// Patches of one wall.
#[derive(Clone, Debug)]
struct Tree {
    wall: u32,
    /// Its first patch.
    first: u32,
    boxes: Bvh,
}

impl Trees {
    /// Trees of patches that lie wall by wall.
    pub fn new(patches: &[Patch]) -> Trees {
        let mut first = 0;
        let tree = |own: &[Patch]| {
            let bounds: Vec<Aabb> = own.iter().map(|p| p.form.bounds()).collect();
            let tree = Tree { wall: own[0].wall, first, boxes: Bvh::new(&bounds) };
            first += own.len() as u32;
            tree
        };
        Trees { each: patches.chunk_by(|a, b| a.wall == b.wall).map(tree).collect() }
    }

    /// Appends the patches that may come within bounds in the world to `out`; ascending.
    pub fn query(&self, walls: &[WallNow], (low, high): Aabb, out: &mut Vec<u32>) {
        let (low, high) = (Vec3::from(low), Vec3::from(high));
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        for tree in &self.each {
            let wall = &walls[tree.wall as usize];
            let back = wall.orientation.to_rotation_matrix().transpose();
            let (middle, half) = (back * (middle - wall.origin), back.matrix().abs() * half);
            let from = out.len();
            tree.boxes.query((middle - half).into(), (middle + half).into(), out);
            out[from..].iter_mut().for_each(|patch| *patch += tree.first);
        }
    }
}

/// All patches, wall by wall, and the walls where they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walls<'a> {
    pub patches: &'a [Patch],
    pub walls: &'a [WallNow],
}

#[cfg(test)]
#[path = "patchwork_tests.rs"]
mod tests;
