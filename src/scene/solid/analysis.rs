//! How the solid is solved, as written in a scene.

use crate::scene::units::{Density, Frequency, Length, Quantity, Rate, Stress, Time};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[solid.dynamics]`: Newmark's method, or that of Hilber, Hughes and Taylor, for a solid that runs alone.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// Newmark α (β elsewhere); default 0.25.
    pub alpha: Option<f64>,
    /// Newmark δ (γ elsewhere); default 0.5.
    pub delta: Option<f64>,
    /// α of Hilber, Hughes and Taylor, −1/3 to 0, in place of `alpha` and `delta`.
    pub hht_alpha: Option<f64>,
    /// Accept α and δ that are not unconditionally stable; default false.
    #[serde(default)]
    pub accept_conditional_stability: bool,
}

/// `solid.rayleigh`: Rayleigh damping, by its coefficients or by a damping ratio at two frequencies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Coefficient of the mass [1/s].
    pub alpha_m: Option<Quantity<Rate>>,
    /// Coefficient of the stiffness [s].
    pub beta_k: Option<Quantity<Time>>,
    /// Damping ratio at both `frequencies`, 0–1.
    pub damping_ratio: Option<f64>,
    /// The two frequencies [Hz].
    pub frequencies: Option<[Quantity<Frequency>; 2]>,
}

/// `[solid.reduction]`: an elastic solid under grains is stepped in the span of a few shapes.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reduction {
    /// What it is reduced to.
    pub kind: ReductionKind,
    /// Natural modes; default 0 beside `surface`, 60 of `modes`.
    pub modes: Option<usize>,
}

/// What a solid is reduced to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReductionKind {
    /// The dofs of the contact surface.
    Surface,
    /// The slowest natural modes, with static corrections for pressures on the contact surface.
    Modes,
}

/// `[solid.quasi_static]`: equilibrium at every step of a pseudo-time, in which loads and supports vary.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuasiStatic {
    /// Smallest part of `time.solid_step` that is tried before the run gives up; default 1/1024.
    pub smallest_step: Option<f64>,
    /// Newton iterations above which the next step is made shorter; default 40.
    pub target_iterations: Option<u32>,
}

/// `[solid.initial_stress]`: stress that the solid has before the run.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialStress {
    /// How it is found.
    pub method: InitialStressMethod,
    /// Horizontal over vertical stress, of `k0`; a material's own `k0` comes first.
    pub k0: Option<f64>,
    /// Height of level ground's surface [m], of `k0`; default the top of the mesh.
    pub surface: Option<Quantity<Length>>,
    /// Layers of different density, of `k0`, in place of `surface`: [[height of the top, density], …] from the top down.
    pub layers: Option<Vec<(Quantity<Length>, Quantity<Density>)>>,
    /// Stress xx, yy, zz, xy, yz, zx [Pa], of `uniform`.
    pub stress: Option<[Quantity<Stress>; 6]>,
    /// Steps in which equilibrium is sought; default 10.
    pub steps: Option<u32>,
    /// Whether the loads at time 0 take part in the equilibrium and act from then on; default false.
    #[serde(default)]
    pub loads: bool,
}

/// How the initial stress is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InitialStressMethod {
    /// Weight of the ground above, times K₀ sideways; then brought into equilibrium.
    K0,
    /// Gravity turned on in steps.
    Gravity,
    /// The same stress everywhere; then brought into equilibrium.
    Uniform,
}

/// `[solid.strength_reduction]`: the factor by which cohesion and tan φ can be divided before the solid fails.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrengthReduction {
    /// First factor tried; default 1.
    pub start: Option<f64>,
    /// Width of the bracket that ends the search; default 0.02.
    pub tolerance: Option<f64>,
    /// Factors beyond it, or below its reciprocal, are not tried; default 16.
    pub largest: Option<f64>,
}

/// `[solid.newton]`: how equilibrium is found in a plastic solid.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Newton {
    /// Which matrix the iteration takes; default `full`.
    pub variant: Option<NewtonVariant>,
    /// Whether steps of the iteration are shortened where the energy asks for it; default true.
    pub line_search: Option<bool>,
    /// Residual force over the largest force at which equilibrium counts as found; default 1e-4 (quasi-static), 1e-3 (strength reduction)
    /// or 1e-6.
    pub tolerance: Option<f64>,
    /// Iterations at most; default 50 (full), 60 (modified) or 400 (initial stiffness).
    pub max_iterations: Option<u32>,
    /// How unsymmetric equations are solved; default `auto`.
    pub solver: Option<LinearSolver>,
}

/// `[solid.equations]`: how the equations of an elastic solid are solved.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Equations {
    /// Method; default `auto`.
    #[serde(default)]
    pub method: EquationMethod,
    /// Residual at which an iteration ends, over the right-hand side; default 1e-8.
    pub tolerance: Option<f64>,
    /// Whether the factor of MUMPS lies in files; default false.
    pub out_of_core: Option<bool>,
}

/// How the equations of an elastic solid are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EquationMethod {
    /// What is faster by the number of nodes and the kind of mass.
    #[default]
    Auto,
    /// Cholesky factor.
    Direct,
    /// Conjugate gradients.
    Iterative,
    /// Factor by the library MUMPS, in programs that are built with it.
    Mumps,
}

/// Which matrix the iteration takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NewtonVariant {
    /// The consistent tangent, new in every iteration.
    Full,
    /// The tangent of the start of the step.
    Modified,
    /// The elastic matrix, factored once.
    InitialStiffness,
}

/// How unsymmetric equations are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LinearSolver {
    /// `direct` for small systems, `krylov` for large ones.
    Auto,
    /// LU factorization.
    Direct,
    /// GMRES on a kept factor.
    Krylov,
}
