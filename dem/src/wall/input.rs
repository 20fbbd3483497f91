//! Walls as given by the user.

use super::Servo;
use crate::base::Vec3;
use crate::law::scarring::Scarring;

/// A wall made of patches.
#[derive(Clone, Debug, PartialEq)]
pub struct WallInput {
    /// Its shape at the start.
    pub shape: WallShape,
    /// Material (index).
    pub material: usize,
    /// Prescribed motion.
    pub motion: Motion,
    /// Drive that holds a force, in place of a prescribed velocity.
    pub servo: Option<Servo>,
    /// Makes a wall other than a plane a body that moves by the forces on it, in place of a prescribed motion.
    pub body: Option<RigidBody>,
    /// Makes triangles that stand still ground that dilated polyhedra and disks scar.
    pub scarring: Option<Scarring>,
}

/// Shape of a wall.
#[derive(Clone, Debug, PartialEq)]
pub enum WallShape {
    /// Triangles, touched from both sides.
    Triangles {
        /// Vertices [m].
        vertices: Vec<Vec3>,
        /// Vertex indices of each triangle; their order carries no meaning.
        triangles: Vec<[u32; 3]>,
    },
    /// An infinite plane; grains are on the side that its normal points to.
    Plane {
        /// A point of it [m].
        point: Vec3,
        /// Normal, any length but zero.
        normal: Vec3,
    },
    /// Side of a frustum of a cone, touched from inside and outside: a cylinder when the radii are equal, a flat ring
    /// when the height is zero.
    Frustum {
        /// Middle of the end with the first radius [m].
        base: Vec3,
        /// Direction from the first end to the second, any length but zero.
        axis: Vec3,
        /// Distance of the ends [m].
        height: f64,
        /// Radii of the ends [m]; one of them may be zero.
        radii: [f64; 2],
        /// Whether a disc closes each end.
        caps: [bool; 2],
    },
    /// A sphere, touched from inside and outside.
    Sphere {
        /// Centre [m].
        centre: Vec3,
        /// Radius [m].
        radius: f64,
    },
}

/// Prescribed motion: steady translation, steady turning about a point that goes along, and an oscillation on top.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Velocity [m/s]. [`crate::State::set_wall_velocity`] changes it.
    pub velocity: Vec3,
    /// Angular velocity [rad/s].
    pub angular_velocity: Vec3,
    /// Point that the wall turns about, at the start [m]; default: the shape's own point (the middle of the vertices'
    /// bounds, the plane's point, the middle of the first end, the centre).
    pub centre: Option<Vec3>,
    /// Oscillation.
    pub oscillation: Option<Oscillation>,
}

/// Displacement a [sin(2πft + φ) − sin φ].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// Amplitude a, with its direction [m].
    pub amplitude: Vec3,
    /// Frequency f [Hz].
    pub frequency: f64,
    /// Phase φ [rad].
    pub phase: f64,
}

impl Oscillation {
    /// Displacement at a time [m].
    pub fn at(&self, time: f64) -> Vec3 {
        let turn = std::f64::consts::TAU * self.frequency * time;
        self.amplitude * (libm::sin(turn + self.phase) - libm::sin(self.phase))
    }
}

/// What makes a wall a rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass at the start [m]; default: that of the solid which the triangles enclose, or the middle of a round shape.
    pub centre: Option<Vec3>,
    /// Tensor of inertia about the centre, world axes at the start, in the order xx, yy, zz, xy, yz, zx [kg m²]; default:
    /// that of the solid which the triangles enclose. A round shape without it does not turn.
    pub inertia: Option<[f64; 6]>,
    /// Velocity of the centre at the start [m/s].
    pub velocity: Vec3,
    /// Angular velocity at the start, world axes [rad/s].
    pub spin: Vec3,
    /// Motions that keep their starting velocity: x, y, z, and turning about x, y, z (world axes).
    pub fixed: [bool; 6],
    /// Springs and dashpots between the centre of mass and where it started.
    pub mount: Option<Mount>,
    /// Radius that its corners and edges are rounded with where triangles touch other walls, within the surface given [m]; default: a fiftieth of
    /// the smallest side of its bounds, or less where that is too large for its surface.
    pub rounding: Option<f64>,
}

/// Linear springs and dashpots along the axes of the world, at rest at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// Stiffness along x, y, z [N/m]; zero where nothing holds.
    pub stiffness: Vec3,
    /// Damping along x, y, z [N s/m].
    pub damping: Vec3,
}

impl WallInput {
    /// A wall at rest.
    pub fn fixed(shape: WallShape, material: usize) -> WallInput {
        WallInput { shape, material, motion: Motion::default(), servo: None, body: None, scarring: None }
    }

    /// A triangle surface that keeps its velocity.
    pub(crate) fn of_triangles(t: &TriangleSurface) -> WallInput {
        let shape = WallShape::Triangles { vertices: t.vertices.clone(), triangles: t.triangles.clone() };
        let motion = Motion { velocity: t.velocity, ..Motion::default() };
        WallInput { motion, ..WallInput::fixed(shape, t.material) }
    }

    /// Whether it leaves its place.
    pub fn moves(&self) -> bool {
        let motion = &self.motion;
        let still = motion.velocity == Vec3::zeros() && motion.angular_velocity == Vec3::zeros();
        !still || motion.oscillation.is_some() || self.servo.is_some() || self.body.is_some()
    }

    /// The same wall standing still where it starts.
    pub fn at_rest(&self) -> WallInput {
        WallInput { scarring: self.scarring, ..WallInput::fixed(self.shape.clone(), self.material) }
    }
}

impl WallShape {
    /// A point amid it [m].
    pub(crate) fn middle(&self) -> Vec3 {
        match self {
            WallShape::Frustum { base, axis, height, .. } => base + axis.normalize() * (0.5 * height),
            _ => self.own_centre(),
        }
    }

    /// The point that a motion turns about unless stated otherwise [m].
    pub fn own_centre(&self) -> Vec3 {
        match self {
            WallShape::Triangles { vertices, triangles } => {
                let mut bounds = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
                for &v in triangles.iter().flatten() {
                    bounds = (bounds.0.inf(&vertices[v as usize]), bounds.1.sup(&vertices[v as usize]));
                }
                if triangles.is_empty() { Vec3::zeros() } else { (bounds.0 + bounds.1) * 0.5 }
            }
            WallShape::Plane { point, .. } => *point,
            WallShape::Frustum { base, .. } => *base,
            WallShape::Sphere { centre, .. } => *centre,
        }
    }
}

/// A surface of triangles, touched from both sides.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleSurface {
    /// Vertices at the start [m]. Triangles that share an edge must share its vertices' indices.
    pub vertices: Vec<Vec3>,
    /// Vertex indices of each triangle; their order carries no meaning.
    pub triangles: Vec<[u32; 3]>,
    /// Material (index).
    pub material: usize,
    /// Velocity at the start [m/s]. [`crate::engine::state::State::set_wall_velocity`] changes it.
    pub velocity: Vec3,
}
