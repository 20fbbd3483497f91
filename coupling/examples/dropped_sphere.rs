//! Sphere dropped on an elastic block, with the energy balance.

use std::error::Error;
use trackbed_coupling::energy_balance::EnergyBalance;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::step;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_fem as fem;

fn main() -> Result<(), Box<dyn Error>> {
    // 1 × 1 × 0.5 m of stiff soil, clamped base, top at 0.5 m.
    let mesh = fem::Mesh::block([4, 4, 2], [1.0, 1.0, 0.5]);
    let base = (0..mesh.node_count() as u32).filter(|&n| mesh.coordinates[n as usize][2] == 0.0);
    let constraints =
        base.flat_map(|node| [0, 1, 2].map(|d| fem::Constraint { node, direction: d, value: 0.0 }));
    let soil = fem::Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };
    let solid = fem::Model::new(fem::ModelInput {
        constraints: constraints.collect(),
        materials: [(1, soil.into())].into(),
        mesh,
        ..Default::default()
    })?;
    // Granite sphere of 5 cm at 1 m/s, just before contact.
    let grains = dem::Model::new(dem::ModelInput {
        materials: vec![dem::Material {
            density: 2650.0,
            stiffness: 1e6,
            restitution: 0.9,
            ..Default::default()
        }],
        shapes: vec![dem::Shape::Sphere { radius: 0.05 }],
        bodies: vec![dem::BodyInput {
            position: dem::Vec3::new(0.5, 0.5, 0.55),
            velocity: dem::Vec3::new(0.0, 0.0, -1.0),
            ..Default::default()
        }],
        surface_material: Some(0),
        time_step: dem::TimeStep::Fixed(2e-5),
        ..Default::default()
    })?;
    let surface = SolidSurface::new(solid.mesh(), SolidSurface::facing(solid.mesh(), [0.0, 0.0, 1.0], 0.3));
    let zeros = vec![0.0; solid.dof_count()];
    let state = step::State::new(fem::State::new(&solid), dem::State::new(&grains));
    let (scheme, newton) = (Scheme::Predicted, Default::default());
    let model = step::Model {
        solid: &solid,
        grains,
        substeps: 5,
        division: 1,
        scheme,
        theta: 0.5,
        newton,
        dead_load: zeros.clone(),
        reference: zeros,
    };
    let (mut state, mut work) = (state.clone(), step::Work::new(&model, &state, surface)?);
    let start = step::stored_energy(&model, &state);
    while state.grains.time < 0.02 {
        step::step(&model, &mut state, &mut work, |_, _, _| {}, |_, _| {})?;
    }
    let balance = EnergyBalance {
        start,
        now: step::stored_energy(&model, &state),
        spent: step::work_and_dissipation(&state),
        ..EnergyBalance::default()
    };
    let speed = state.grains.velocity(0).z;
    println!("rebound at {speed:.3} m/s, error of the energy {:.1e} J of 0.69 J", balance.error());
    assert!(speed > 0.3 && speed < 0.9, "it bounces, and leaves energy in the block");
    assert!(balance.error().abs() < 1e-3);
    Ok(())
}
