//! What a model is made of, as given by its user. [`crate::engine::model::Model`] is the checked and resolved form.

use crate::base::Vec3;
use crate::bodies::input::BodyInput;
use crate::body_force::BodyForce;
use crate::bond::{Bond, BondInput};
use crate::law::material::{Material, PairOverride};
use crate::shape::Shape;
use crate::shape::plane::Plane;
use crate::spatial::sheet::SurfaceMesh;
use crate::wall::{TriangleSurface, WallInput};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// How the time step is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum TimeStep {
    /// This fraction, in (0, 1], of the stability limit (see [`crate::engine::timestep`]); 0.1 to 0.2 suits most scenes.
    Auto {
        /// Fraction of the limit [-].
        fraction: f64,
    },
    /// This share, in (0, 1], of what the contacts of each moment allow (see [`crate::stability`]), which whoever advances
    /// the state has to ask for ([`crate::stability::divide`]); until then as `Auto`.
    Measured {
        /// Share of the limit [-].
        share: f64,
        /// Longest step for reasons that the grains do not know of, such as springs on bodies from outside [s].
        longest: f64,
        /// Whether the restitution of single collisions matters, which takes short steps as long as few contacts last.
        collisions: bool,
    },
    /// This many seconds, refused when above the limit.
    Fixed(f64),
    /// This many seconds, whatever the limit.
    FixedAboveLimit(f64),
}

/// Distance beyond touch up to which neighbours are listed. A wide one is searched for less often and lists more pairs that
/// do not touch; it changes no bit of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SearchSkin {
    /// This share of the mean radius of all spheres [-].
    Share(f64),
    /// This distance [m].
    Distance(f64),
}

impl Default for SearchSkin {
    /// A fifth of the mean radius.
    fn default() -> SearchSkin {
        SearchSkin::Share(0.2)
    }
}

/// Largest share of what the contacts allow, for stiffnesses with local damping.
const DAMPED: f64 = 0.95;

impl TimeStep {
    /// Share of what the contacts allow that is usually taken.
    pub const SHARE: f64 = 0.8;

    /// The same under local damping: a force against the motion acts with 1 + α of it, as a stiffer contact would. A step of 0.8 of the
    /// limit with α = 0.8 kept light grains below a boulder in motion for ever.
    pub(crate) fn damped(self, damping: Option<LocalDamping>) -> TimeStep {
        let most = DAMPED / (1.0 + damping.map_or(0.0, |d| d.factor)).sqrt();
        match self {
            TimeStep::Measured { share, longest, collisions } => {
                TimeStep::Measured { share: share.min(most), longest, collisions }
            }
            other => other,
        }
    }
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
    /// The external surface as triangles, which dilated polyhedra need beside one.
    pub surface_mesh: Option<Arc<SurfaceMesh>>,
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
    /// Body forces beside gravity.
    pub body_forces: Vec<BodyForce>,
    /// Time step.
    pub time_step: TimeStep,
    /// Largest speed at which two bodies are expected to meet [m/s]: sets the overlap at which contacts after Hertz are
    /// taken for the limit of the time step; the estimate of [`crate::engine::timestep`] when `None`.
    pub impact_speed: Option<f64>,
    /// Distance beyond touch up to which neighbours are listed.
    pub skin: SearchSkin,
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
            surface_mesh: None,
            gravity: Vec3::new(0.0, 0.0, -9.81),
            body_forces: Vec::new(),
            time_step: TimeStep::Auto { fraction: 0.1 },
            impact_speed: None,
            skin: SearchSkin::default(),
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
