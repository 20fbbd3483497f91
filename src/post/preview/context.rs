//! What objects are made from.

use trackbed_input::model::Job;
use trackbed_input::scene::{Document, Scene};

/// Scene with the bounds of the objects so far.
pub struct Context<'a> {
    pub document: &'a Document,
    pub scene: &'a Scene,
    pub job: &'a Job,
    pub bounds: [[f64; 3]; 2],
}

impl Context<'_> {
    /// Diagonal [m].
    pub fn size(&self) -> f64 {
        let [low, high] = self.bounds;
        (0..3).map(|k| (high[k] - low[k]).powi(2)).sum::<f64>().sqrt()
    }
}
