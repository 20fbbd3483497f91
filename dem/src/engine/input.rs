//! User input of a model; checked form: [`crate::engine::model::Model`].

use crate::base::Vec3;
use crate::base::names::Names;
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

/// Choice of the time step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum TimeStep {
    /// Fraction, in (0, 1], of the stability limit ([`crate::engine::timestep`]); typically 0.1–0.2.
    Auto {
        /// Fraction [-].
        fraction: f64,
    },
    /// Fraction, in (0, 1], of the critical step of current contacts ([`crate::stability`]); `Auto` unless
    /// the caller uses [`crate::stability::divide`].
    Measured {
        /// Fraction [-].
        share: f64,
        /// Upper bound, e.g. from external springs on bodies [s].
        longest: f64,
        /// Resolve the restitution of single collisions while few contacts last.
        collisions: bool,
    },
    /// Step [s]; must not exceed the limit.
    Fixed(f64),
    /// Step [s], not checked.
    FixedAboveLimit(f64),
}

/// Search skin (Verlet distance); does not change results.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SearchSkin {
    /// Fraction of the mean radius [-].
    Share(f64),
    /// Distance [m].
    Distance(f64),
}

impl Default for SearchSkin {
    fn default() -> SearchSkin {
        SearchSkin::Share(0.2)
    }
}

impl SearchSkin {
    /// Returns the skin [m] for a mean radius [m].
    pub(crate) fn distance(self, mean: f64) -> f64 {
        match self {
            SearchSkin::Share(share) => share * mean,
            SearchSkin::Distance(distance) => distance,
        }
    }
}

/// Bound for stiffnesses with local damping.
const DAMPED: f64 = 0.95;

impl TimeStep {
    /// Default fraction of the critical step.
    pub const SHARE: f64 = 0.8;

    /// Local damping scales decelerating forces by 1 + α, like a stiffer contact.
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

/// Damping proportional to the unbalanced force (Cundall & Strack 1979, sec. 2.4). For deposition only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LocalDamping {
    /// Fraction in [0, 1).
    pub factor: f64,
}

/// Force on a body for one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppliedForce {
    /// Body (index).
    pub body: usize,
    /// Force [N].
    pub force: Vec3,
    /// Point of application [m].
    pub point: Vec3,
}

/// Model input.
#[derive(Clone, Debug)]
pub struct ModelInput {
    /// Names in messages.
    pub names: Names,
    /// Materials.
    pub materials: Vec<Material>,
    /// Values of material pairs.
    pub contacts: Vec<PairOverride>,
    /// Shapes.
    pub shapes: Vec<Shape>,
    /// Bodies.
    pub bodies: Vec<BodyInput>,
    /// Planes.
    pub planes: Vec<Plane>,
    /// Triangle surfaces.
    pub triangles: Vec<TriangleSurface>,
    /// Other walls, and triangle surfaces that rotate, oscillate, are servo-controlled or rigid bodies.
    pub walls: Vec<WallInput>,
    /// Material index of the external surface.
    pub surface_material: Option<usize>,
    /// First patch and material index of a second external surface.
    pub other_surface: Option<(u32, usize)>,
    /// Triangulated external surface, for dilated polyhedra.
    pub surface_mesh: Option<Arc<SurfaceMesh>>,
    /// Gravity [m/s²].
    pub gravity: Vec3,
    /// Other body forces.
    pub body_forces: Vec<BodyForce>,
    /// Time step.
    pub time_step: TimeStep,
    /// Largest expected impact speed [m/s], for Hertz stiffness in the time step limit. `None`: estimated
    /// ([`crate::engine::timestep`]).
    pub impact_speed: Option<f64>,
    /// Search skin.
    pub skin: SearchSkin,
    /// Local damping.
    pub damping: Option<LocalDamping>,
    /// Bond types.
    pub bond_kinds: Vec<Bond>,
    /// Bonds, initially unstrained.
    pub bonds: Vec<BondInput>,
    /// Lower and upper periodic boundary [m] along x, y, z.
    pub periodic: [Option<[f64; 2]>; 3],
}

impl Default for ModelInput {
    /// Empty, gravity 9.81 m/s² along −z.
    fn default() -> ModelInput {
        ModelInput {
            names: Names::default(),
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
    pub(crate) fn all_walls(&self) -> impl Iterator<Item = WallInput> {
        self.triangles.iter().map(WallInput::of_triangles).chain(self.walls.iter().cloned())
    }
}
