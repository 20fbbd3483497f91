//! Implicit finite elements for ballasted track: statics and dynamics, elastic and elastoplastic
//! ([`nonlinear`]).
//!
//! A [`model::Model`] is immutable; a [`state::State`] is sufficient for a restart. SI units. Nodal vectors
//! have the index `3 * node + direction`.
//!
//! ```
//! use trackbed_fem::{Constraint, Elastic, Mesh, Model, ModelInput, Quadrature, Rayleigh, loads, statics};
//!
//! // A column of two cubic metres on a fixed base, pressed by 10 kPa from above.
//! let mesh = Mesh::block([1, 1, 2], [1.0, 1.0, 2.0]);
//! let constraints = (0..mesh.node_count() as u32)
//!     .filter(|&n| mesh.coordinates[n as usize][2] == 0.0)
//!     .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
//!     .collect();
//! let model = Model::new(ModelInput {
//!     mesh,
//!     materials: [(1, Elastic { young: 20e6, poisson: 0.0, density: 2000.0 }.into())].into(),
//!     quadrature: Quadrature::Gauss3,
//!     constraints,
//!     gravity: [0.0, 0.0, -9.81],
//!     rayleigh: Rayleigh::default(),
//!     ..Default::default()
//! })?;
//! let mut load = vec![0.0; model.dof_count()];
//! loads::face_pressure(model.mesh(), &model.mesh().face(1, 5), 10e3, &mut load);
//! let solution = statics::solve(&model, &load)?;
//! let top = model.mesh().node_count() - 1;
//! assert!((solution.u[3 * top + 2] + 10e3 * 2.0 / 20e6).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod assembly;
pub mod assumed;
pub mod boundary;
pub mod connectivity;
pub mod damping;
pub mod element;
pub mod element_test;
pub mod energy;
pub mod equations;
pub mod error;
pub mod integrator;
pub mod iterative;
pub mod kinematics;
pub mod loads;
pub mod mass;
pub mod material;
pub mod mesh;
pub mod mesh_order;
pub mod modal;
pub mod model;
pub mod newmark;
pub mod nonlinear;
pub mod reduction;
pub mod samples;
pub mod small_strain_check;
pub mod solver;
pub mod state;
pub mod statics;
pub mod stress;
pub mod structured_mesh;
pub mod supports;
pub mod surface_mass;
pub mod theta;

pub use assumed::{AssumedStrain, Dilatation};
pub use boundary::BoundaryLayer;
pub use connectivity::Connectivity;
pub use damping::Rayleigh;
pub use element::quadrature::Quadrature;
pub use element::{ElementKind, FaceShape};
pub use equations::method::{Method, Methods, MumpsMethod, Regime};
pub use error::{ModelError, SolveError};
pub use integrator::{Loading, StepReport, TimeIntegrator};
pub use mass::Mass;
pub use material::elastic::Elastic;
pub use material::{
    Cone, ConstitutiveLaw, DruckerPrager, Hardening, Law, LinearElastic, Material, MohrCoulomb, Point,
    PointState, Points, Response, ReturnError, ReturnRegion, StateValue,
};
pub use mesh::{Constraint, Face, Mesh};
pub use model::{Model, ModelInput};
pub use state::{State, StepAudit};
