//! Sieve sizes of bodies: diameter of a sphere, intermediate extent of a clump. Curve:
//! [`achieved_passing`](crate::insert::gradation::achieved_passing).

use crate::engine::model::Model;
use crate::shape::Shape;

/// Sieve size [m] and mass [kg] of selected bodies, without boxes.
pub fn stones(model: &Model, counted: impl Fn(usize) -> bool) -> Vec<(f64, f64)> {
    // Once per shape: sorting extents dominates.
    let unit: Vec<Option<f64>> = model.shapes.iter().map(size_of).collect();
    (0..model.body_count())
        .filter(|&b| counted(b))
        .filter_map(|b| unit[model.body(b).shape].map(|size| (size * model.scale(b), model.mass(b))))
        .collect()
}

/// Sieve size of a shape at scale 1 [m]; `None` for a box.
pub fn size_of(shape: &Shape) -> Option<f64> {
    shape.query(|s| s.sieve_size())
}
