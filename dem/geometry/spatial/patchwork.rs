//! Wall patches (triangles, round patches) on rigid frames, for bodies with faces.

use super::bvh::{Aabb, Bvh};
use super::facet::Facet;
use super::round::Round;
use crate::base::Vec3;
use crate::base::error::Partner;
use nalgebra::UnitQuaternion;

#[derive(Clone, Debug)]
pub enum Form {
    Facet(Box<Facet>),
    Round(Round),
}

impl Form {
    pub fn bounds(&self) -> Aabb {
        match self {
            Form::Facet(it) => it.bounds(),
            Form::Round(it) => it.bounds(),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Patch {
    pub wall: u32,
    pub form: Form,
    /// Contact name.
    pub partner: Partner,
    /// Central point [m].
    pub middle: Vec3,
}

impl Patch {
    pub fn new(wall: u32, form: Form, partner: Partner) -> Patch {
        let (low, high) = form.bounds();
        let middle = (Vec3::from(low) + Vec3::from(high)) * 0.5;
        Patch { wall, form, partner, middle }
    }
}

/// Placed wall.
#[derive(Clone, Copy, Debug)]
pub struct WallView {
    /// Frame origin [m] and rotation.
    pub origin: Vec3,
    pub orientation: UnitQuaternion<f64>,
    /// Moment centre [m], velocity [m/s], angular velocity [rad/s].
    pub centre: Vec3,
    pub velocity: Vec3,
    pub spin: Vec3,
    pub material: u32,
    /// Inverse mass [1/kg]; zero if prescribed.
    pub inverse_mass: f64,
    /// Bodies pass through.
    pub open: bool,
    /// Servo-controlled.
    pub driven: bool,
    /// Scarred ground.
    pub scarred: bool,
}

/// Patch trees in wall frames; rigid motion never changes them.
#[derive(Clone, Debug, Default)]
pub struct Trees {
    each: Vec<Tree>,
}

#[derive(Clone, Debug)]
struct Tree {
    wall: u32,
    /// First patch.
    first: u32,
    boxes: Bvh,
}

impl Trees {
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

    /// Appends patches that may overlap world bounds; ascending.
    pub fn query(&self, walls: &[WallView], (low, high): Aabb, out: &mut Vec<u32>) {
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

#[derive(Clone, Copy, Debug)]
pub struct Walls<'a> {
    pub patches: &'a [Patch],
    pub walls: &'a [WallView],
}

#[cfg(test)]
#[path = "patchwork_tests.rs"]
mod tests;
