//! Bounce heights of a sphere on a plane.
//!
//! `cargo run --release -p trackbed-dem --example bouncing_sphere`

use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BodyInput, Material, Model, ModelInput, Plane, Shape, State, Vec3, Work, step};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let restitution = 0.8;
    let ball = Material { density: 2500.0, stiffness: 1e6, restitution, ..Material::default() };
    let floor = Material { restitution: 1.0, ..Material::RIGID };
    let (radius, drop) = (0.01, 0.5);
    let position = Vec3::new(0.0, 0.0, radius + drop);
    let model = Model::new(ModelInput {
        materials: vec![ball, floor],
        shapes: vec![Shape::Sphere { radius }],
        bodies: vec![BodyInput { position, ..BodyInput::default() }],
        planes: vec![Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 1, velocity: Vec3::zeros() }],
        ..ModelInput::default()
    })?;
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let (mut rising, mut expected) = (false, drop);
    for bounce in 1..=3 {
        let top = loop {
            step(&model, &mut state, &mut work, &NoSurface, &[])?;
            let speed = state.velocity(0).z;
            if rising && speed < 0.0 {
                rising = false;
                break state.position(0).z - radius;
            }
            rising |= speed > 0.0;
        };
        expected *= restitution * restitution;
        println!("bounce {bounce}: {top:.4} m, expected {expected:.4} m");
        assert!((top - expected).abs() < 0.01 * expected, "{top} {expected}");
    }
    Ok(())
}
