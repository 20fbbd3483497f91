//! Both models of a coupled run and how they are joined.

use crate::scheme::Scheme;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::nonlinear::NewtonOptions;

/// The two models and how they are joined.
pub struct Model<'a> {
    /// The solid.
    pub solid: &'a fem::model::Model,
    /// The grains.
    pub grains: dem::Model,
    /// Steps of the grains per window, of the length that the run begins with; where steps follow the contacts
    /// ([`dem::stability`]) fewer, longer ones make up the same window.
    pub substeps: u32,
    /// Parts of equal length that a window of `substeps` is divided into, 1 unless the interface asks for shorter ones.
    pub division: u32,
    /// Order of the exchange.
    pub scheme: Scheme,
    /// Implicitness of the solid's step, ½–1.
    pub theta: f64,
    /// How a plastic solid finds the end of its step; not used for an elastic one.
    pub newton: NewtonOptions,
    /// Constant load on the solid (gravity) [N]. Shape `[3·nodes]`.
    pub dead_load: Vec<f64>,
    /// Displacement of the solid in the shape that the mesh file describes [m]. Shape `[3·nodes]`.
    pub reference: Vec<f64>,
}

impl Model<'_> {
    /// Length of a window [s].
    pub fn window(&self) -> f64 {
        self.grains.dt() * f64::from(self.substeps) / f64::from(self.division)
    }
}
