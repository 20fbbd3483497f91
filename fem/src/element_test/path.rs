//! Strain and stress paths, and states along them.

use crate::material::PointState;

/// Prescribed quantity of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Strain.
    Strain,
    /// Stress.
    Stress,
}

/// Linear change of the prescribed components.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Prescribed quantity of each component.
    pub controls: [Control; 6],
    /// Values at the end: strain [-] since the start, or stress [Pa].
    pub target: [f64; 6],
    /// Number of equal steps.
    pub steps: usize,
}

/// State after a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Strain since the start [-].
    pub strain: [f64; 6],
    /// Stress and history.
    pub state: PointState,
    /// State values of the law.
    pub values: Vec<f64>,
    /// Plastic work since the start [J/m³].
    pub plastic_work: f64,
}
