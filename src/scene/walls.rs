//! Scene tables of walls.

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
    /// Shape.
    pub kind: WallKind,
    /// Name in `history.csv`; default `wall<number>`, from 0.
    pub name: Option<String>,
    /// Name of a `[[material]]`.
    pub material: String,
    /// Point of the plane [m]; with `"plane"`.
    pub point: Option<[Quantity<Length>; 3]>,
    /// Normal towards grains; with `"plane"`.
    pub normal: Option<[f64; 3]>,
    /// Vertices `[[x, y, z], …]` [m]; with `"triangles"`.
    pub vertices: Option<Vec<[Quantity<Length>; 3]>>,
    /// Vertex indices `[[a, b, c], …]`, from 0; with `"triangles"`.
    pub triangles: Option<Vec<[u32; 3]>>,
    /// File of a surface, terrain or mesh; with `"mesh"`.
    #[schemars(extend("format" = "path"))]
    pub file: Option<PathBuf>,
    /// Factor on file lengths; default 1; > 0; with `"mesh"`.
    pub scale: Option<f64>,
    /// Shift after scaling [m]; default none; with `"mesh"`.
    pub translation: Option<[Quantity<Length>; 3]>,
    /// Middle of the first end, or of the sphere [m]; with `"cylinder"`, `"cone"`, `"sphere"`.
    pub base: Option<[Quantity<Length>; 3]>,
    /// Direction to the second end; default up; with `"cylinder"`, `"cone"`.
    pub axis: Option<[f64; 3]>,
    /// Distance of the ends [m]; > 0 (`"cone"` ≥ 0); with `"cylinder"`, `"cone"`.
    pub height: Option<Quantity<Length>>,
    /// Radius [m]; > 0; with `"cylinder"`, `"sphere"`.
    pub radius: Option<Quantity<Length>>,
    /// Radii of both ends [m]; ≥ 0; with `"cone"`.
    pub radii: Option<[Quantity<Length>; 2]>,
    /// Whether discs close the ends; default `[false, false]`; with `"cylinder"`, `"cone"`.
    pub caps: Option<[bool; 2]>,
    /// Velocity [m/s]; default at rest.
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Angular velocity, of planes along the normal [rad/s]; default none.
    pub angular_velocity: Option<[Quantity<Spin>; 3]>,
    /// Centre of rotation at the start [m]; default `point`, `base`, middle of vertices; with `angular_velocity`.
    pub centre: Option<[Quantity<Length>; 3]>,
    /// Displacement a (sin(2πft + φ) − sin φ); default none.
    pub oscillation: Option<Oscillation>,
    /// Servo-controlled force; default none; not with motions, `body`.
    pub servo: Option<Servo>,
    /// Rigid body; default none; not with motions, `servo`, `"plane"`.
    pub body: Option<Body>,
    /// Ground that grains penetrate; default none; with `"triangles"`, `"mesh"`; not with motions, `servo`, `body`.
    pub scarring: Option<Scarring>,
    /// Whether force, moment, displacement go to `history.csv`; default false.
    #[serde(default)]
    pub record: bool,
}

/// Kind of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WallKind {
    /// Infinite, one-sided (others two-sided).
    Plane,
    /// Cylinder.
    Cylinder,
    /// Cone.
    Cone,
    /// Sphere.
    Sphere,
    /// Triangles.
    Triangles,
    /// From a file.
    Mesh,
}

/// Sine in time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Oscillation {
    /// Amplitude a [m]; > 0.
    pub amplitude: Quantity<Length>,
    /// Direction.
    pub direction: [f64; 3],
    /// Frequency f [Hz]; > 0.
    pub frequency: Quantity<Frequency>,
    /// Phase φ [rad]; default 0.
    pub phase: Option<Quantity<Angle>>,
}

/// Drive that holds a force.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Servo {
    /// Direction of pressing; default plane normal.
    pub direction: Option<[f64; 3]>,
    /// Target force [N]; or `pressure`.
    pub force: Option<Quantity<Force>>,
    /// Target pressure [Pa]; or `force`.
    pub pressure: Option<Quantity<Stress>>,
    /// Area of `pressure` [m²]; > 0; with `pressure`.
    pub area: Option<f64>,
    /// Factors on the force `[[time, factor], …]`, linear between [s]; default 1; or `pulses`.
    pub history: Option<Vec<(Quantity<Time>, f64)>>,
    /// Haversine factors from 1 to `peak`; or `history`.
    pub pulses: Option<Pulses>,
    /// Largest speed, rising by a tenth per step [m/s]; > 0.
    pub max_speed: Quantity<Velocity>,
    /// Gain, smaller against oscillation; default 0.5; > 0, ≤ 1.
    pub gain: Option<f64>,
    /// Constant speed after a time, in place of the force.
    pub displacement_control: Option<DisplacementControl>,
}

/// Displacement control of a servo wall: the platen of a compression test after confinement.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DisplacementControl {
    /// Start [s]; ≥ 0.
    pub from: Quantity<Time>,
    /// Speed along the direction of pressing [m/s].
    pub speed: Quantity<Velocity>,
}

/// Haversines on top of the force of a servo: force · (1 + (peak − 1) (1 − cos 2πf(t − start))/2).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pulses {
    /// Largest factor; ≥ 0.
    pub peak: f64,
    /// Frequency [Hz]; > 0.
    pub frequency: Quantity<Frequency>,
    /// Number of pulses; 1–1,000,000.
    pub count: u32,
    /// Time of the first [s]; default 0; ≥ 0.
    pub start: Option<Quantity<Time>>,
}

/// Rigid body that a wall is.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Mass [kg]; > 0.
    pub mass: Quantity<Mass>,
    /// Centre of mass [m]; default of the enclosed volume.
    pub centre: Option<[Quantity<Length>; 3]>,
    /// Inertia about the centre `[xx, yy, zz, xy, yz, zx]` [kg m²]; default of the enclosed volume, no rotation if round.
    pub inertia: Option<[f64; 6]>,
    /// Initial velocity [m/s]; default at rest.
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Initial angular velocity [rad/s]; default none.
    pub spin: Option<[Quantity<Spin>; 3]>,
    /// Motions at constant velocity; default none.
    #[serde(default)]
    pub hold: Vec<HeldMotion>,
    /// Spring–dashpot support; default none.
    pub mount: Option<Mount>,
    /// Water forces; default none; with closed triangles, `[water]`.
    pub water: Option<BodyWater>,
    /// Thrust and rudder; default none; with `water`.
    pub propulsion: Option<Propulsion>,
    /// Corner and edge radius against walls [m]; default smallest side/50 or less; > 0; with triangles.
    pub rounding: Option<Quantity<Length>>,
}

/// Water on a body of triangles: lift, wave forces, drag, added mass. Axes are x, y, z at the start and turn with the body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyWater {
    /// Form drag along x, y, z; default `water.drag`; 0–100.
    pub drag: Option<[f64; 3]>,
    /// Skin drag; default `water.skin_drag`; 0–100.
    pub skin_drag: Option<f64>,
    /// Moment coefficients; default `water.drag_moment`; 0–100.
    pub drag_moment: Option<[f64; 3]>,
    /// Added over displaced mass; default `water.added_mass`; 0–100.
    pub added_mass: Option<[f64; 3]>,
    /// Added over own inertia; default 0; 0–100.
    pub added_inertia: Option<[f64; 3]>,
    /// Damping over critical: heave, about x, y; default 0; 0–10.
    pub damping_ratio: Option<[f64; 3]>,
}

/// Prescribed thrust, and a rudder.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Propulsion {
    /// Thrust [N]; none above water.
    pub thrust: Quantity<Force>,
    /// Propeller at the start [m].
    pub point: [Quantity<Length>; 3],
    /// Direction at the start; default `[1, 0, 0]`.
    pub direction: Option<[f64; 3]>,
    /// Factors `[[time, factor], …]`, linear between [s]; default 1.
    pub history: Option<Vec<(Quantity<Time>, f64)>>,
    /// Propeller diameter, for its race [m]; default none; > 0; with `rudder`.
    pub diameter: Option<Quantity<Length>>,
    /// Rudder; default none; not with vertical `direction`.
    pub rudder: Option<Rudder>,
}

/// Rudder with the normal force of Fujii & Tuda (1961), without stall.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rudder {
    /// Area [m²]; > 0.
    pub area: f64,
    /// Position at the start [m].
    pub point: [Quantity<Length>; 3],
    /// Squared height over area; default 1.5; > 0.
    pub aspect_ratio: Option<f64>,
    /// Angles to port `[[time, angle], …]`, linear between [s, rad]; −π/2 to π/2.
    pub history: Vec<(Quantity<Time>, Quantity<Angle>)>,
}

/// Springs and dashpots that hold a body, along x, y, z. Each is given by its constants or by what the body's mass makes of them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mount {
    /// Stiffness along x, y, z, 0 along held axes [N/m]; or `frequency`; ≥ 0.
    pub stiffness: Option<[Quantity<Stiffness>; 3]>,
    /// Frequencies f of stiffness m (2πf)² [Hz]; or `stiffness`; ≥ 0.
    pub frequency: Option<[Quantity<Frequency>; 3]>,
    /// Damping along x, y, z [N s/m]; default 0; ≥ 0.
    pub damping: Option<[Quantity<Dashpot>; 3]>,
    /// Ratios ζ of damping 2ζ √(k m); or `damping`; ≥ 0.
    pub damping_ratio: Option<[f64; 3]>,
}

/// Ground that polyhedra and disks scar: soil over hard ground.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scarring {
    /// Mechanical strength of the soil [Pa]; > 0.
    pub strength: Quantity<Stress>,
    /// Soil drag coefficient; default 2.5; ≥ 0.
    pub drag: Option<f64>,
    /// Soil density [kg/m³]; default 1700; ≥ 0.
    pub density: Option<Quantity<Density>>,
    /// Initial and final friction; default `[0.55, 2]`; ≥ 0, rising.
    pub friction: Option<[f64; 2]>,
    /// Growth of friction with sliding distance [1/m]; default 3; ≥ 0.
    pub growth: Option<f64>,
    /// Decay of that distance without contact [1/s]; default 185; ≥ 0.
    pub decay: Option<f64>,
}
