//! Walls as written in a scene.

use super::track::HeldMotion;
use super::units::{
    Angle, Dashpot, Density, Force, Frequency, Length, Mass, Quantity, Spin, Stiffness, Stress, Time,
    Velocity,
};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// `[[walls]]`: a plane, a round shape, or triangles.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Kind of wall.
    pub kind: WallKind,
    /// Name for the history and for reports; default `wall<number>`, counted from 0.
    pub name: Option<String>,
    /// Name of its material.
    pub material: String,
    /// A point of a `plane` [m].
    pub point: Option<[Quantity<Length>; 3]>,
    /// Normal of a `plane`, towards the grains.
    pub normal: Option<[f64; 3]>,
    /// Vertices of `triangles` [m].
    pub vertices: Option<Vec<[Quantity<Length>; 3]>>,
    /// Vertex numbers of `triangles`, counted from 0.
    pub triangles: Option<Vec<[u32; 3]>>,
    /// Surface file of a `mesh`.
    pub file: Option<PathBuf>,
    /// Factor on the lengths of a `mesh`; default 1.
    pub scale: Option<f64>,
    /// Shift of a `mesh`, after scaling [m]; default none.
    pub translation: Option<[Quantity<Length>; 3]>,
    /// Middle of the first end of a `cylinder` or `cone`, middle of a `sphere` [m].
    pub base: Option<[Quantity<Length>; 3]>,
    /// Direction from the first end to the second; default up (0, 0, 1).
    pub axis: Option<[f64; 3]>,
    /// Distance of the ends [m], 0 or more: 0 makes a `cone` a flat ring.
    pub height: Option<Quantity<Length>>,
    /// Radius of a `cylinder` or `sphere` [m].
    pub radius: Option<Quantity<Length>>,
    /// Radii of the two ends of a `cone` [m].
    pub radii: Option<[Quantity<Length>; 2]>,
    /// Whether discs close the two ends; default neither.
    pub caps: Option<[bool; 2]>,
    /// Constant velocity [m/s]; default at rest.
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Constant angular velocity [rad/s]; default none.
    pub angular_velocity: Option<[Quantity<Spin>; 3]>,
    /// Point that the wall turns about, at the start; it goes along with the velocity [m].
    pub centre: Option<[Quantity<Length>; 3]>,
    /// Oscillation on top of the velocity.
    pub oscillation: Option<Oscillation>,
    /// Drive by a force.
    pub servo: Option<Servo>,
    /// Makes a wall other than a plane a rigid body.
    pub body: Option<Body>,
    /// Makes `triangles` or a `mesh` ground that rocks scar.
    pub scarring: Option<Scarring>,
    /// Write the force of the grains on the wall, its moment and the wall's displacement to `history.csv`.
    #[serde(default)]
    pub record: bool,
}

/// Kind of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WallKind {
    /// Infinite plane, one-sided.
    Plane,
    /// Side of a cylinder, touched from inside and outside.
    Cylinder,
    /// Side of a frustum of a cone, touched from inside and outside.
    Cone,
    /// Sphere, touched from inside and outside.
    Sphere,
    /// Triangles, two-sided.
    Triangles,
    /// Triangles from a file, two-sided.
    Mesh,
}

/// Sine in time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Oscillation {
    /// Amplitude [m].
    pub amplitude: Quantity<Length>,
    /// Direction, any length but zero.
    pub direction: [f64; 3],
    /// Frequency [Hz].
    pub frequency: Quantity<Frequency>,
    /// Phase at the start [rad]; default 0.
    pub phase: Option<Quantity<Angle>>,
}

/// Drive that holds a force.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// Direction in which the wall presses; default the normal of a plane.
    pub direction: Option<[f64; 3]>,
    /// Force to hold [N].
    pub force: Option<Quantity<Force>>,
    /// Pressure to hold, in place of a force [Pa].
    pub pressure: Option<Quantity<Stress>>,
    /// Area that the pressure acts on [m²].
    pub area: Option<f64>,
    /// Factor on the force against time: [[time, factor], …], straight in between; default 1 at all times.
    pub history: Option<Vec<(Quantity<Time>, f64)>>,
    /// Pulses on top of the force, in place of `history`.
    pub pulses: Option<Pulses>,
    /// Greatest speed [m/s].
    pub max_speed: Quantity<Velocity>,
    /// Gain, above 0 and at most 1; default 0.5.
    pub gain: Option<f64>,
}

/// Haversines on top of the force of a servo: force · (1 + (peak − 1) (1 − cos 2πf(t − start))/2).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pulses {
    /// Largest factor on the force, 0 or more.
    pub peak: f64,
    /// Pulses in a second [Hz].
    pub frequency: Quantity<Frequency>,
    /// Number of pulses.
    pub count: u32,
    /// When the first begins [s]; default 0.
    pub start: Option<Quantity<Time>>,
}

/// Rigid body that a wall is.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Mass [kg].
    pub mass: Quantity<Mass>,
    /// Centre of mass [m]; default that of the enclosed solid, or the middle of a round shape.
    pub centre: Option<[Quantity<Length>; 3]>,
    /// Inertia about the centre in world axes, xx, yy, zz, xy, yz, zx [kg m²]; default that of the enclosed solid; a round
    /// shape without it does not turn.
    pub inertia: Option<[f64; 6]>,
    /// Velocity at the start [m/s].
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Angular velocity at the start [rad/s].
    pub spin: Option<[Quantity<Spin>; 3]>,
    /// Motions that keep their starting velocity.
    #[serde(default)]
    pub hold: Vec<HeldMotion>,
    /// Springs and dashpots to where its centre of mass started; default none.
    pub mount: Option<Mount>,
    /// Radius that corners and edges of triangles are rounded with where they touch other walls [m]; default a fiftieth of the smallest side
    /// of the bounds.
    pub rounding: Option<Quantity<Length>>,
}

/// Springs and dashpots that hold a body, along x, y, z. Each is given by its constants or by what the body's mass makes of them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mount {
    /// Stiffnesses [N/m]; 0 where nothing holds.
    pub stiffness: Option<[Quantity<Stiffness>; 3]>,
    /// Natural frequencies of the body on the springs [Hz], in place of `stiffness`.
    pub frequency: Option<[Quantity<Frequency>; 3]>,
    /// Dampings [N s/m]; default none.
    pub damping: Option<[Quantity<Dashpot>; 3]>,
    /// Shares of critical damping, in place of `damping`.
    pub damping_ratio: Option<[f64; 3]>,
}

/// Ground that polyhedra and disks scar: soil over hard ground.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scarring {
    /// Mechanical strength of the soil [Pa].
    pub strength: Quantity<Stress>,
    /// Drag coefficient of the soil; default 2.5.
    pub drag: Option<f64>,
    /// Density of the soil [kg/m³]; default 1700.
    pub density: Option<Quantity<Density>>,
    /// Friction coefficient at first and after a long slide; default 0.55 and 2.
    pub friction: Option<[f64; 2]>,
    /// How fast friction grows with the way that a rock slides [1/m]; default 3.
    pub growth: Option<f64>,
    /// How fast that way is forgotten after the contact [1/s]; default 185.
    pub decay: Option<f64>,
}
