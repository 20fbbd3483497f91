//! Models shared by unit tests.

use crate::base::Vec3;
use crate::engine::input::{ModelInput, TimeStep};
use crate::law::material::Material;
use crate::shape::Shape;
use crate::shape::clump::Clump;
use crate::shape::plane::Plane;

/// Soft frictional material.
pub(crate) const SOFT: Material = Material::SOFT;

/// Dumbbells (shape 0), spheres (1) and a box (2) at half the critical time step.
pub(crate) fn dumbbells(material: Material, half: [f64; 3]) -> ModelInput {
    let dumbbell = Clump::from_spheres(&[([0.0; 3], 0.01), ([0.01, 0.0, 0.0], 0.009)]).unwrap();
    ModelInput {
        materials: vec![material],
        time_step: TimeStep::Auto { fraction: 0.5 },
        shapes: vec![Shape::Clump(dumbbell), Shape::Sphere { radius: 0.011 }, Shape::Box { half }],
        ..ModelInput::default()
    }
}

pub(crate) fn shaft(side: f64, axes: &[Vec3]) -> Vec<Plane> {
    let wall = |point, normal| Plane { point, normal, material: 0, velocity: Vec3::zeros() };
    let walls = axes.iter().flat_map(|&d| [wall(Vec3::zeros(), d), wall(d * side, -d)]);
    walls.chain([wall(Vec3::zeros(), Vec3::z())]).collect()
}

/// Velocities that differ by body, downwards on average.
pub(crate) fn push(k: usize) -> Vec3 {
    Vec3::new((k as f64 * 1.7).sin(), (k as f64 * 2.9).cos(), -1.0)
}
