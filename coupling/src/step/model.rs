//! Models of a coupled run.

use crate::scheme::Scheme;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::nonlinear::NewtonOptions;

/// Coupled models.
pub struct Model<'a> {
    /// Solid.
    pub solid: &'a fem::model::Model,
    /// Grains.
    pub grains: dem::Model,
    /// DEM sub-steps per window at the initial step.
    pub substeps: u32,
    /// Divisions of a window of `substeps`; above 1 only for interface stability.
    pub division: u32,
    /// Coupling scheme.
    pub scheme: Scheme,
    /// Implicitness θ, ½–1.
    pub theta: f64,
    /// Newton options of a plastic solid.
    pub newton: NewtonOptions,
    /// Constant load (gravity) [N]. Shape `[3·nodes]`.
    pub dead_load: Vec<f64>,
    /// Displacement of the meshed shape [m]. Shape `[3·nodes]`.
    pub reference: Vec<f64>,
}

impl Model<'_> {
    /// Window length [s].
    pub fn window(&self) -> f64 {
        self.grains.dt() * f64::from(self.substeps) / f64::from(self.division)
    }
}
