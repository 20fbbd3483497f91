//! Frictionless sphere on a curved top with normal jumps between elements.

use crate::support::*;
use trackbed_coupling::step;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;
use trackbed_fem::Mesh;

const FORCE: f64 = 100.0;
const SPEED: f64 = 0.5;

/// Strip of 1/8 m elements, top at z = 0.02 sin 2πx.
fn waves() -> fem::Model {
    let size = [1.0, 0.25, 0.5];
    let mut mesh = Mesh::block([8, 2, 4], size);
    for x in &mut mesh.coordinates {
        x[2] -= size[2];
        if x[2] > -1e-9 {
            x[2] = 0.02 * (std::f64::consts::TAU * x[0]).sin();
        }
    }
    model(mesh, size, 20e6, 0.3, 2000.0, Held::Base, fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 })
}

#[test]
fn curved_traverse_conserves_energy() {
    let solid = waves();
    for y in [0.125, 0.0625] {
        let radius = 0.05;
        let mut c = Coupled::new(
            &solid,
            dem::ModelInput {
                materials: vec![material(2650.0, 2e5, 0.0, 0.5)],
                shapes: vec![dem::Shape::Sphere { radius }],
                bodies: vec![dem::BodyInput {
                    position: Vec3::new(0.25, y, 0.02 + radius - FORCE / 2e5),
                    velocity: Vec3::new(SPEED, 0.0, 0.0),
                    fixed: [true, true, false, true, true, true],
                    ..Default::default()
                }],
                gravity: Vec3::zeros(),
                surface_material: Some(0),
                time_step: dem::TimeStep::Fixed(5e-5),
                ..Default::default()
            },
            5,
        );
        let mut start = None;
        while c.state.grains.position(0).x < 0.73 {
            c.step(&[(0, [0.0, 0.0, -FORCE])]);
            assert_eq!(c.work.grains.surface_contacts().len(), 1, "one contact, at borders too");
            if start.is_none() && c.state.grains.position(0).x >= 0.27 {
                start = Some((step::work_and_dissipation(&c.state), step::stored_energy(&c.model, &c.state)));
            }
        }
        let (spent0, stored0) = start.expect("the traverse has begun");
        let (spent, stored) = (step::work_and_dissipation(&c.state), step::stored_energy(&c.model, &c.state));
        let (pushed, held) = (spent.applied_work - spent0.applied_work, spent.wall_work - spent0.wall_work);
        let kept = stored.total() - stored0.total();
        let lost = pushed + held - kept;
        let booked = spent.dissipated() - spent0.dissipated();
        println!(
            "y = {y}: {pushed:.4} J from the force, {held:.4} J at the guide, stored {kept:.1e} J, lost {lost:.2e} J = {:.3} %, \
             of it booked as dissipated {booked:.2e} J",
            100.0 * lost / pushed
        );
        assert!(pushed > 3.8 && (lost / pushed).abs() < 0.01);
        assert!(((pushed + held) / pushed).abs() < 0.01);
    }
}
