//! Walls as bodies with faces and edges see them: triangles and round patches, in frames that move as rigid wholes.

use super::bvh::Aabb;
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
}

impl WallNow {
    /// Bounds of a patch in the world [m].
    pub fn bounds(&self, patch: &Patch) -> Aabb {
        let (low, high) = patch.form.bounds();
        let (low, high) = (Vec3::from(low), Vec3::from(high));
        let turn = self.orientation.to_rotation_matrix();
        let (middle, half) = ((low + high) * 0.5, turn.matrix().abs() * ((high - low) * 0.5));
        let middle = self.origin + turn * middle;
        ((middle - half).into(), (middle + half).into())
    }
}

/// All patches, wall by wall, and the walls where they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walls<'a> {
    pub patches: &'a [Patch],
    pub walls: &'a [WallNow],
}
