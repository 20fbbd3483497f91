//! Sieve sizes of bodies, by the definition that filling uses: the diameter of a sphere, the intermediate extent of a
//! clump. The curve follows from [`achieved_passing`](crate::insert::gradation::achieved_passing).

use crate::engine::model::Model;
use crate::shape::Shape;

/// Sieve size [m] and mass [kg] of the bodies that `counted` names by number; boxes are no stones and left out.
pub fn stones(model: &Model, counted: impl Fn(usize) -> bool) -> Vec<(f64, f64)> {
    // The size of a shape at scale 1 is found once: sorting extents per body would cost more than the rest.
    let unit: Vec<Option<f64>> = model.shapes.iter().map(size_of).collect();
    (0..model.body_count())
        .filter(|&b| counted(b))
        .filter_map(|b| unit[model.body(b).shape].map(|size| (size * model.scale(b), model.mass(b))))
        .collect()
}

/// Sieve size of a shape at scale 1 [m]; none for a box.
pub fn size_of(shape: &Shape) -> Option<f64> {
    match shape {
        Shape::Sphere { radius } => Some(2.0 * radius),
        Shape::Clump(clump) => Some(clump.sieve_size()),
        Shape::Polyhedron(it) => Some(it.sieve_size()),
        Shape::Box { .. } => None,
    }
}
