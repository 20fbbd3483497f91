//! What a model is made of, as given by its user. [`crate::model::Model`] is the checked and resolved form.

use crate::Vec3;
use crate::bond::{Bond, BondInput};
use crate::law::material::{Material, PairOverride};
use crate::shape::Shape;
use crate::wall::WallInput;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// One body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyInput {
    /// Shape (index).
    pub shape: usize,
    /// Factor on all lengths of the shape [-].
    pub scale: f64,
    /// Material (index).
    pub material: usize,
    /// Group number, carried to the output.
    pub part: u32,
    /// Centre of mass at the start [m].
    pub position: Vec3,
    /// Turns the shape's frame into the world's.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity at the start [m/s].
    pub velocity: Vec3,
    /// Angular velocity at the start, in world axes [rad/s].
    pub spin: Vec3,
    /// Motions that keep their starting velocity whatever the forces: x, y, z, and turning about x, y, z (world axes).
    pub fixed: [bool; 6],
    /// Mass instead of density × volume [kg]; the inertia scales along.
    pub mass: Option<f64>,
    /// Whether the body is not there at the start: it waits until [`crate::flow::exchange`] puts it in.
    #[serde(default)]
    pub absent: bool,
}

impl Default for BodyInput {
    /// Shape 0 of material 0, unscaled, at rest at the origin, free.
    fn default() -> BodyInput {
        BodyInput {
            shape: 0,
            scale: 1.0,
            material: 0,
            part: 0,
            position: Vec3::zeros(),
            orientation: UnitQuaternion::identity(),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            fixed: [false; 6],
            mass: None,
            absent: false,
        }
    }
}

/// An infinite plane; grains live on the side its normal points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane [m].
    pub point: Vec3,
    /// Normal, towards the grains; any length but zero.
    pub normal: Vec3,
    /// Material (index).
    pub material: usize,
    /// Velocity at the start [m/s]; also tangential, as of a belt. [`crate::state::State::set_plane_velocity`] changes it.
    pub velocity: Vec3,
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
    /// Velocity at the start [m/s]. [`crate::state::State::set_wall_velocity`] changes it.
    pub velocity: Vec3,
}

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum TimeStep {
    /// This fraction, in (0, 1], of the stability limit (see [`crate::timestep`]); 0.1 to 0.2 suits most scenes.
    Auto {
        /// Fraction of the limit [-].
        fraction: f64,
    },
    /// This many seconds, refused when above the limit.
    Fixed(f64),
    /// This many seconds, whatever the limit.
    FixedAboveLimit(f64),
}

/// Damping proportional to the unbalanced force (Cundall & Strack 1979, sec. 2.4, as used in later codes):
/// each component of the total force, gravity included, is reduced by this fraction when it accelerates the
/// body and increased when it slows it; torques alike. Not physical: for deposition only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LocalDamping {
    /// Fraction in [0, 1).
    pub factor: f64,
}

/// A force on a body for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppliedForce {
    /// Body (index).
    pub body: usize,
    /// Force [N].
    pub force: Vec3,
    /// Point of the world where it acts [m].
    pub point: Vec3,
}

/// Everything a model is made of.
#[derive(Clone, Debug)]
pub struct ModelInput {
    /// Materials.
    pub materials: Vec<Material>,
    /// Pairs of materials with values of their own.
    pub contacts: Vec<PairOverride>,
    /// Shapes.
    pub shapes: Vec<Shape>,
    /// Bodies.
    pub bodies: Vec<BodyInput>,
    /// Planes.
    pub planes: Vec<Plane>,
    /// Triangle surfaces.
    pub triangles: Vec<TriangleSurface>,
    /// Walls of other shapes, and triangle surfaces that turn, swing, are driven by a force or are bodies.
    pub walls: Vec<WallInput>,
    /// Material (index) of the external surface, when the scene has one.
    pub surface_material: Option<usize>,
    /// Part of the external surface that is of another material: its first patch, from which on all others follow, and
    /// the material (index).
    pub other_surface: Option<(u32, usize)>,
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
    /// Time step.
    pub time_step: TimeStep,
    /// Largest speed at which two bodies are expected to meet [m/s]: sets the overlap at which contacts after Hertz are
    /// taken for the limit of the time step; the estimate of [`crate::timestep`] when `None`.
    pub impact_speed: Option<f64>,
    /// Distance beyond touch up to which neighbours are listed [m]; 0.2 of the mean sphere radius when `None`.
    pub skin: Option<f64>,
    /// Local damping, for deposition only.
    pub damping: Option<LocalDamping>,
    /// Kinds of bonds.
    pub bond_kinds: Vec<Bond>,
    /// Bonds between spheres, unstrained at the start.
    pub bonds: Vec<BondInput>,
    /// Lower and upper border [m] along x, y and z where the scene repeats itself; `None` along axes where it does not.
    pub periodic: [Option<[f64; 2]>; 3],
}

impl Default for ModelInput {
    /// Nothing at all, gravity 9.81 m/s² downward (−z), time step 0.1 of the limit.
    fn default() -> ModelInput {
        ModelInput {
            materials: Vec::new(),
            contacts: Vec::new(),
            shapes: Vec::new(),
            bodies: Vec::new(),
            planes: Vec::new(),
            triangles: Vec::new(),
            walls: Vec::new(),
            surface_material: None,
            other_surface: None,
            gravity: Vec3::new(0.0, 0.0, -9.81),
            time_step: TimeStep::Auto { fraction: 0.1 },
            impact_speed: None,
            skin: None,
            damping: None,
            bond_kinds: Vec::new(),
            bonds: Vec::new(),
            periodic: [None; 3],
        }
    }
}

impl ModelInput {
    /// All walls of patches: triangle surfaces, then walls.
    pub(crate) fn all_walls(&self) -> impl Iterator<Item = WallInput> {
        self.triangles.iter().map(WallInput::of_triangles).chain(self.walls.iter().cloned())
    }
}
