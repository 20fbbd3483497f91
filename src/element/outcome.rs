//! Results of a test.

use super::check::Check;
use super::file::Kind;
use super::point::{Figures, State};

/// Test of one material, with results.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Test.
    pub test: String,
    /// Material.
    pub material: String,
    /// Kind.
    pub kind: Kind,
    /// Name of the table.
    pub file: String,
    /// States, from the initial state.
    pub states: Vec<State>,
    /// Figures.
    pub figures: Figures,
    /// Checks.
    pub checks: Vec<Check>,
}

impl Outcome {
    /// Test and material, for display.
    pub fn label(&self) -> String {
        format!("{}, {}", self.test, self.material)
    }
}
