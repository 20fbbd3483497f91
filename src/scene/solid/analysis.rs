//! Scene tables of the FEM analysis.

use crate::units::{Density, Frequency, Length, Quantity, Rate, Stress, Time};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[solid.dynamics]`: Newmark's method, or that of Hilber, Hughes and Taylor, for a solid that runs alone.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// Newmark's β; default 0.25.
    pub beta: Option<f64>,
    /// Newmark's γ; default 0.5.
    pub gamma: Option<f64>,
    /// α of Hilber–Hughes–Taylor, instead of Newmark's; default none; −1/3 – 0.
    pub hht_alpha: Option<f64>,
    /// Whether conditionally stable constants are accepted; default false.
    #[serde(default)]
    pub accept_conditional_stability: bool,
}

/// `solid.rayleigh`: Rayleigh damping, by its coefficients or by a damping ratio at two frequencies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Mass coefficient α [1/s]; default 0; ≥ 0.
    pub alpha_m: Option<Quantity<Rate>>,
    /// Stiffness coefficient β [s]; default 0; ≥ 0.
    pub beta_k: Option<Quantity<Time>>,
    /// Damping ratio; or `alpha_m`, `beta_k`; ≥ 0, < 1.
    pub damping_ratio: Option<f64>,
    /// Two rising frequencies [Hz]; > 0; with `damping_ratio`.
    pub frequencies: Option<[Quantity<Frequency>; 2]>,
}

/// `[solid.reduction]`: an elastic solid under grains is stepped in the span of a few shapes.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reduction {
    /// Basis of the model.
    pub kind: ReductionKind,
    /// Natural modes; default 60; ≤ 2000 with static shapes, ≤ half the dofs.
    pub modes: Option<usize>,
}

/// What a solid is reduced to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReductionKind {
    /// Dofs of the surface near grains, exact for slow loads, and slowest modes.
    Surface,
    /// Slowest modes with static corrections.
    Modes,
}

/// `[solid.quasi_static]`: equilibrium at every step of a pseudo-time, in which loads and supports vary.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuasiStatic {
    /// Fraction of `solid_step` at which the run stops; default 1/1024; 1e-9 – 1.
    pub smallest_step: Option<f64>,
    /// Iterations above which the next step is shorter; default 40; 2–1000.
    pub target_iterations: Option<u32>,
}

/// `[solid.initial_stress]`: stress that the solid has before the run.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialStress {
    /// Method.
    pub method: InitialStressMethod,
    /// Horizontal over vertical stress without material `k0`; ≥ 0; with `"k0"`.
    pub k0: Option<f64>,
    /// Surface of ground of one density [m]; default mesh top; with `"k0"`.
    pub surface: Option<Quantity<Length>>,
    /// Layers `[[top, density], …]` downwards, needed for different densities [m, kg/m³]; or `surface`; with `"k0"`.
    pub layers: Option<Vec<(Quantity<Length>, Quantity<Density>)>>,
    /// Stress `[xx, yy, zz, xy, yz, zx]`, tension positive [Pa]; with `"uniform"`.
    pub stress: Option<[Quantity<Stress>; 6]>,
    /// Steps to equilibrium; default 10; 1–10,000.
    pub steps: Option<u32>,
    /// Whether loads at time 0 take part and stay; default false; not under grains.
    #[serde(default)]
    pub loads: bool,
}

/// How the initial stress is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InitialStressMethod {
    /// Weight above, times K₀ sideways.
    K0,
    /// In steps.
    Gravity,
    /// Everywhere equal.
    Uniform,
}

/// `[solid.strength_reduction]`: the factor by which cohesion and tan φ can be divided before the solid fails.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrengthReduction {
    /// First trial factor; default 1; 0.001–1000.
    pub start: Option<f64>,
    /// Width of the final bracket; default 0.02; 0.0001–10.
    pub tolerance: Option<f64>,
    /// Largest trial factor, and reciprocal of the smallest; default 16; > `start`, ≤ 10,000.
    pub largest: Option<f64>,
}

/// `[solid.newton]`: how equilibrium is found in a plastic solid.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Newton {
    /// Matrix of the iteration; default `"full"`.
    pub variant: Option<NewtonVariant>,
    /// Whether a line search shortens iterations; default true.
    pub line_search: Option<bool>,
    /// Residual over largest force; default 1e-5 quasi-static, 1e-3 strength reduction, else 1e-6; 1e-12 – 0.01.
    pub tolerance: Option<f64>,
    /// Largest number of iterations; default 50 full, 60 modified, 400 initial, 100 strength reduction; 1–10,000.
    pub max_iterations: Option<u32>,
    /// Solver of unsymmetric equations (dilation below friction); default `"auto"`.
    pub solver: Option<LinearSolver>,
}

/// `[solid.equations]`: how the equations of an elastic solid are solved.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Equations {
    /// Solver; default `"auto"`.
    #[serde(default)]
    pub method: EquationMethod,
    /// Preconditioned residual over right-hand side; default 1e-8; 1e-13 – 1e-4.
    pub tolerance: Option<f64>,
    /// Whether the factor lies on disk, in `TMPDIR` (`/tmp`); default false; with `"mumps"`.
    pub out_of_core: Option<bool>,
}

/// How the equations of an elastic solid are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EquationMethod {
    /// Iterative from 25,000 nodes (static), 100,000 (steps, lumped mass), else direct.
    #[default]
    Auto,
    /// Sparse Cholesky factor.
    Direct,
    /// Conjugate gradients.
    Iterative,
    /// Factor by an optional library.
    Mumps,
}

/// Which matrix the iteration takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NewtonVariant {
    /// Consistent tangent.
    Full,
    /// Tangent of the step's start.
    Modified,
    /// Elastic matrix.
    InitialStiffness,
}

/// How unsymmetric equations are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LinearSolver {
    /// By size.
    Auto,
    /// LU.
    Direct,
    /// GMRES on a kept factor.
    Krylov,
}
