//! Wall input.

use super::Servo;
use super::shape::WallShape;
use crate::base::Vec3;
use crate::law::scarring::Scarring;

/// Wall of patches.
#[derive(Clone, Debug, PartialEq)]
pub struct WallInput {
    /// Initial shape.
    pub shape: WallShape,
    /// Material (index).
    pub material: usize,
    /// Prescribed motion.
    pub motion: Motion,
    /// Servo control instead of prescribed velocity.
    pub servo: Option<Servo>,
    /// Rigid body instead of prescribed motion.
    pub body: Option<RigidBody>,
    /// Scarred ground: fixed triangles penetrated by dilated polyhedra and disks.
    pub scarring: Option<Scarring>,
}

/// Prescribed motion: steady translation, steady rotation about a co-moving point, oscillation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Velocity [m/s]. [`crate::State::set_wall_velocity`] changes it.
    pub velocity: Vec3,
    /// Angular velocity [rad/s].
    pub angular_velocity: Vec3,
    /// Initial centre of rotation [m]; default: middle of the vertices' bounds, point, first end's centre, or
    /// sphere centre.
    pub centre: Option<Vec3>,
    /// Oscillation.
    pub oscillation: Option<Oscillation>,
}

/// Displacement a [sin(2πft + φ) − sin φ].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// Amplitude vector a [m].
    pub amplitude: Vec3,
    /// Frequency f [Hz].
    pub frequency: f64,
    /// Phase φ [rad].
    pub phase: f64,
}

impl Oscillation {
    /// Returns the displacement [m].
    pub fn at(&self, time: f64) -> Vec3 {
        let turn = std::f64::consts::TAU * self.frequency * time;
        self.amplitude * (libm::sin(turn + self.phase) - libm::sin(self.phase))
    }
}

/// Rigid-body properties.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Mass [kg].
    pub mass: f64,
    /// Initial centre of mass [m]; default: of the enclosed solid or round shape.
    pub centre: Option<Vec3>,
    /// Initial inertia tensor about the centre, world axes: xx, yy, zz, xy, yz, zx [kg m²]; default: enclosed
    /// solid, no rotation of a round shape.
    pub inertia: Option<[f64; 6]>,
    /// Initial centre velocity [m/s].
    pub velocity: Vec3,
    /// Initial angular velocity, world axes [rad/s].
    pub spin: Vec3,
    /// Motions at constant starting velocity: translation, rotation, world axes.
    pub fixed: [bool; 6],
    /// Spring–dashpot support at the initial position.
    pub mount: Option<Mount>,
    /// Rounding radius in wall–wall contacts [m]; default: 1/50 of the smallest side of the bounds, or less
    /// if the surface requires it.
    pub rounding: Option<f64>,
    /// Forces of the water ([`crate::Water`]) on closed triangles.
    pub water: Option<BodyWater>,
    /// Thrust and rudder, with `water`.
    pub propulsion: Option<Propulsion>,
}

/// Coefficients of water forces, along and about the initial world axes, which follow the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyWater {
    /// Form drag coefficients of the wet area projected along the flow [-].
    pub drag: Vec3,
    /// Skin drag coefficient of the wet surface [-].
    pub skin_drag: f64,
    /// Coefficients of the quadratic moments against rotation [-].
    pub drag_moment: Vec3,
    /// Added mass over displaced mass [-].
    pub added_mass: Vec3,
    /// Added inertia over inertia [-].
    pub added_inertia: Vec3,
    /// Linear damping over critical in heave, roll (about x), pitch (about y) [-].
    pub damping_ratio: Vec3,
}

/// Prescribed thrust and rudder angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Propulsion {
    /// Initial position of the propeller [m].
    pub point: Vec3,
    /// Initial direction of thrust.
    pub direction: Vec3,
    /// Thrust: times [s] and forces [N].
    pub thrust: Vec<[f64; 2]>,
    /// Propeller diameter [m], whose race meets the rudder; zero: no race.
    pub diameter: f64,
    /// Rudder.
    pub rudder: Option<Rudder>,
}

/// Rudder on a stock along the initial vertical.
#[derive(Clone, Debug, PartialEq)]
pub struct Rudder {
    /// Initial position of the centre of pressure [m].
    pub point: Vec3,
    /// Area [m²].
    pub area: f64,
    /// Aspect ratio Λ, squared height over area [-].
    pub aspect_ratio: f64,
    /// Times [s] and angles [rad], positive to port.
    pub angle: Vec<[f64; 2]>,
}

/// Linear springs and dashpots along world axes, initially unstretched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// Stiffness by axis [N/m]; zero: free.
    pub stiffness: Vec3,
    /// Damping by axis [N s/m].
    pub damping: Vec3,
}

impl WallInput {
    /// Wall at rest.
    pub fn fixed(shape: WallShape, material: usize) -> WallInput {
        WallInput { shape, material, motion: Motion::default(), servo: None, body: None, scarring: None }
    }

    pub(crate) fn of_triangles(t: &TriangleSurface) -> WallInput {
        let shape = WallShape::Triangles { vertices: t.vertices.clone(), triangles: t.triangles.clone() };
        let motion = Motion { velocity: t.velocity, ..Motion::default() };
        WallInput { motion, ..WallInput::fixed(shape, t.material) }
    }

    /// Whether the wall moves.
    pub fn moves(&self) -> bool {
        let motion = &self.motion;
        let still = motion.velocity == Vec3::zeros() && motion.angular_velocity == Vec3::zeros();
        !still || motion.oscillation.is_some() || self.servo.is_some() || self.body.is_some()
    }

    /// Returns the wall, at rest.
    pub fn at_rest(&self) -> WallInput {
        WallInput { scarring: self.scarring, ..WallInput::fixed(self.shape.clone(), self.material) }
    }
}

/// Two-sided triangle surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleSurface {
    /// Initial vertices [m]; triangles with a common edge must share its indices.
    pub vertices: Vec<Vec3>,
    /// Vertex indices, any order.
    pub triangles: Vec<[u32; 3]>,
    /// Material (index).
    pub material: usize,
    /// Initial velocity [m/s]. [`crate::engine::state::State::set_wall_velocity`] changes it.
    pub velocity: Vec3,
}
