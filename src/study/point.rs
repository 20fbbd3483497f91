//! Cases as points of the parameters, with results.

use serde::{Deserialize, Serialize};

/// Name and unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Unit, or empty.
    pub unit: String,
}

impl Column {
    /// Returns name and unit.
    pub fn head(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// Case with results.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Label.
    pub case: String,
    /// Parameter values; none for a separate reference.
    pub values: Vec<Option<f64>>,
    /// Planned runs.
    pub runs: usize,
    /// Completed runs.
    pub done: usize,
    /// Mean, standard deviation and standard error over seeds by quantity.
    pub results: Vec<[Option<f64>; 3]>,
    /// √(mean of squared deviations over tolerances).
    pub misfit: Option<f64>,
}

impl Point {
    /// Returns the parameter values; none of a separate reference.
    pub fn complete(&self) -> Option<Vec<f64>> {
        self.values.iter().copied().collect()
    }
}
