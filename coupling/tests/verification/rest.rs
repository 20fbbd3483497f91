//! Sphere at rest on block B.

use crate::support::*;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;

const RADIUS: f64 = 0.05;
const DENSITY: f64 = 2650.0;
const STIFFNESS: f64 = 1e5;

#[test]
fn sphere_rests_with_its_weight() {
    // The block corner is the lightest point and needs the shortest window.
    for (place, substeps) in [([0.50, 0.50], 5), ([0.37, 0.61], 5), ([0.06, 0.06], 5), ([0.0, 0.0], 1)] {
        // Damps the sphere on its spring, and the block near 58 Hz.
        let solid = block_b(8, Held::Base, fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 });
        let mut free_only_vertically = [true; 6];
        free_only_vertically[2] = false;
        let mut c = Coupled::new(
            &solid,
            dem::ModelInput {
                materials: vec![material(DENSITY, STIFFNESS, 0.0, 0.5)],
                shapes: vec![dem::Shape::Sphere { radius: RADIUS }],
                bodies: vec![dem::BodyInput {
                    position: Vec3::new(place[0], place[1], RADIUS),
                    fixed: free_only_vertically,
                    ..Default::default()
                }],
                surface_material: Some(0),
                time_step: dem::TimeStep::Fixed(4e-5),
                ..Default::default()
            },
            substeps,
        );
        let weight = 13.611_7;
        let exact = DENSITY * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3) * 9.81;
        assert!((exact - weight).abs() < 1e-4);
        for _ in 0..12_500 / substeps {
            c.step(&[]);
        }
        let contacts = c.work.grains.surface_contacts();
        assert_eq!(contacts.len(), 1, "one contact at {place:?}, edges and corners included");
        let force = -contacts[0].force[2];
        let audit = c.state.audit;
        let (load, _) = nodal_load(&solid, &c.work.surface, contacts);
        let reaction: f64 =
            fem::energy::reactions(&solid, &c.state.solid, &load).iter().skip(2).step_by(3).sum();
        let rest = fem::statics::solve(&solid, &load).unwrap();
        let deflection = deflection(&c.work.surface, &contacts[0], &rest.u);
        // The normal of the bent surface is not vertical.
        let centre = c.state.grains.position(0);
        let arm = centre - Vec3::from(contacts[0].point);
        let normal_force = force * arm.norm() / arm.z;
        let gap = centre.z - ((RADIUS - normal_force / STIFFNESS) * arm.z / arm.norm() + deflection);
        println!(
            "{place:?}: contact/weight - 1 = {:.1e}, base/weight - 1 = {:.1e}, force and moment errors {:.1e}, {:.1e}, \
             gap error {:.1e} of the deflection {:.3e} m",
            force / exact - 1.0,
            reaction / exact - 1.0,
            audit.force,
            audit.moment,
            gap / deflection,
            deflection,
        );
        assert!((force / exact - 1.0).abs() < 1e-6);
        assert!((reaction / exact - 1.0).abs() < 1e-6);
        assert!(audit.exchanges > 1000 && audit.force < 1e-12 && audit.moment < 1e-12, "{audit:?}");
        assert!((gap / deflection).abs() < 1e-6);
    }
}
