//! Verification of the finite elements against exact solutions and tables of other programs.
//!
//! Tables: `tests/data/fem` of the workspace and `tests/data/plasticity_fe`, origin in each `case.json`.

mod absorbing;
mod aggregation;
mod cavity;
mod collapse_common;
mod collapse_footing;
mod collapse_slope;
mod common;
mod companion_cases;
mod companion_orders;
mod companions;
mod conformance;
mod convergence;
mod determinism;
mod dynamics;
mod element;
mod examples;
mod hht;
mod integrators;
mod iterative;
mod locking;
mod mixed;
mod modal;
mod modified_cam_clay;
mod mumps;
mod patch;
mod plastic_common;
mod plastic_cylinder;
mod plastic_dynamics;
mod plastic_element;
mod plastic_footing;
mod plastic_ground;
mod plastic_iteration;
mod plastic_sphere;
mod plasticity_point;
mod prescribed;
mod static_cases;
mod support;
mod user_material;
mod window;
