//! Timoshenko's sphere on a simply supported steel beam.

use crate::support::*;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;
use trackbed_fem::{Constraint, Mesh};

const LENGTH: f64 = 0.1535;
const SIDE: f64 = 0.01;
const YOUNG: f64 = 215.7e9;
const POISSON: f64 = 0.289;
const DENSITY: f64 = 7960.0;
const SPEED: f64 = 0.01;

/// Hex20 beam supported at mid-height of both ends; top at z = 0.
fn beam(elements: usize) -> fem::Model {
    let mut mesh = Mesh::block([elements, 2, 2], [LENGTH, SIDE, SIDE]);
    let mut constraints = Vec::new();
    for (n, x) in mesh.coordinates.iter_mut().enumerate() {
        x[2] -= SIDE;
        let mut hold = |direction| constraints.push(Constraint { node: n as u32, direction, value: 0.0 });
        let left = x[0].abs() < 1e-9;
        if (x[2] + 0.5 * SIDE).abs() < 1e-9 && (left || (x[0] - LENGTH).abs() < 1e-9) {
            hold(2);
            if (x[1] - 0.5 * SIDE).abs() < 1e-9 {
                hold(1);
            }
            if left {
                hold(0);
            }
        }
    }
    fem::Model::new(fem::ModelInput {
        mesh,
        materials: [(1, fem::Elastic { young: YOUNG, poisson: POISSON, density: DENSITY }.into())].into(),
        quadrature: fem::Quadrature::Gauss3,
        constraints,
        ..Default::default()
    })
    .expect("a valid beam")
}

/// Reference (Hertz contact and 60 modes of a Bernoulli beam, converged): peak force 4.967 N at 72.8 µs,
/// contact time 156.8 µs, rebound −3.029 mm/s, largest deflection 1.125 µm at 323.9 µs. Tolerances for 60 × 2
/// × 2 elements: 3 %, 3 %, 8 %, 3 %.
#[test]
fn timoshenkos_sphere_on_a_beam() {
    let solid = beam(60);
    let radius = 0.01;
    let steel = dem::Material {
        density: DENSITY,
        stiffness: f64::INFINITY,
        young: Some(YOUNG),
        poisson: POISSON,
        ..dem::Material::default()
    };
    let dt = 4e-7;
    let mut c = Coupled::new(
        &solid,
        dem::ModelInput {
            materials: vec![steel],
            shapes: vec![dem::Shape::Sphere { radius }],
            bodies: vec![dem::BodyInput {
                position: Vec3::new(0.5 * LENGTH, 0.5 * SIDE, radius),
                velocity: Vec3::new(0.0, 0.0, -SPEED),
                ..Default::default()
            }],
            gravity: Vec3::zeros(),
            surface_material: Some(0),
            time_step: dem::TimeStep::Fixed(dt),
            ..Default::default()
        },
        1,
    );
    assert!((c.model.grains.mass(0) - 0.033_343).abs() < 1e-6);
    let middle = solid
        .mesh()
        .coordinates
        .iter()
        .position(|x| {
            (x[0] - 0.5 * LENGTH).abs() + (x[1] - 0.5 * SIDE).abs() + (x[2] + 0.5 * SIDE).abs() < 1e-9
        })
        .expect("a node in the middle");
    let (mut peak, mut deflection, mut ends, mut touching) = ((0.0, 0.0), (0.0, 0.0), Vec::new(), false);
    for k in 1..=1000 {
        c.step(&[]);
        let time = f64::from(k) * dt;
        let force = -c.work.mean_contact_force(dt)[2];
        if force > peak.0 {
            peak = (force, time - 0.5 * dt);
        }
        if touching && force == 0.0 {
            ends.push(time - 0.5 * dt);
        }
        touching = force > 0.0;
        let down = -c.state.solid.u[3 * middle + 2];
        if down > deflection.0 {
            deflection = (down, time);
        }
    }
    let rebound = c.state.grains.velocity(0).z;
    println!(
        "peak {:.4} N at {:.1} us, contact ends at {:?} us, sphere after {:.4} mm/s, deflection {:.4} um at {:.1} us",
        peak.0,
        1e6 * peak.1,
        ends.iter().map(|t| (1e7 * t).round() / 10.0).collect::<Vec<_>>(),
        -1e3 * rebound,
        1e6 * deflection.0,
        1e6 * deflection.1
    );
    assert_eq!(ends.len(), 1, "one contact");
    assert!((peak.0 / 4.967 - 1.0).abs() < 0.03);
    assert!((ends[0] / 156.8e-6 - 1.0).abs() < 0.03);
    assert!((rebound / 3.029e-3 - 1.0).abs() < 0.08);
    assert!((deflection.0 / 1.125e-6 - 1.0).abs() < 0.03);
}
