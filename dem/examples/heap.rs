//! Deposits a thousand spheres in a box and prints the energy balance.
//!
//! `cargo run --release -p trackbed-dem --example heap`

use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BodyInput, Material, Model, ModelInput, Plane, Shape, State, Vec3, Work, measure, step};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stone =
        Material { density: 2600.0, stiffness: 1e5, friction: 0.5, restitution: 0.4, ..Material::default() };
    let wall = |point: [f64; 3], normal: [f64; 3]| Plane {
        point: point.into(),
        normal: normal.into(),
        material: 0,
        velocity: Vec3::zeros(),
    };
    let planes = vec![
        wall([0.0; 3], [0.0, 0.0, 1.0]),
        wall([0.0; 3], [1.0, 0.0, 0.0]),
        wall([0.0; 3], [0.0, 1.0, 0.0]),
        wall([0.22, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        wall([0.0, 0.22, 0.0], [0.0, -1.0, 0.0]),
    ];
    let place = |k: usize| Vec3::new((k % 10) as f64, (k / 10 % 10) as f64, (k / 100) as f64) * 0.0215;
    let body = |k: usize| BodyInput {
        position: place(k) + Vec3::repeat(0.012) + Vec3::new(1e-4 * (k % 7) as f64, 0.0, 0.0),
        ..BodyInput::default()
    };
    let model = Model::new(ModelInput {
        materials: vec![stone],
        shapes: vec![Shape::Sphere { radius: 0.01 }],
        bodies: (0..1000).map(body).collect(),
        planes,
        ..ModelInput::default()
    })?;
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let start = measure::energies(&model, &state).total();
    while state.time < 0.3 {
        step(&model, &mut state, &mut work, &NoSurface, &[])?;
    }
    let now = measure::energies(&model, &state);
    let error = now.total() - start + state.balance.dissipated() - state.balance.work();
    println!("{:.3} J dissipated, {:.2e} J kinetic", state.balance.dissipated(), now.kinetic());
    println!("coordination number {:.2}", measure::coordination(&model, &state));
    println!("energy balance closes to {:.1e} of what was dissipated", error / state.balance.dissipated());
    assert!(error.abs() < 0.01 * state.balance.dissipated());
    Ok(())
}
