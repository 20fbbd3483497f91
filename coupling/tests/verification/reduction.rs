//! A reduced solid in the coupled step against the full one.

use crate::support::*;
use std::sync::Arc;
use trackbed_coupling::step;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;
use trackbed_fem::reduction::{Reduced, Reduction};

const PULSE: f64 = 0.05;
const SETTLING: f64 = 0.3;

/// Two layers of 6 × 6 spheres and a sleeper, as in the cyclic problem.
fn bed() -> dem::ModelInput {
    let side = |at: f64, normal: Vec3| dem::Plane {
        point: Vec3::new(at, at, 0.0),
        normal,
        material: 0,
        velocity: Vec3::zeros(),
    };
    let mut random = Scatter::new(5);
    let mut bodies = vec![dem::BodyInput {
        shape: 1,
        position: Vec3::new(0.5, 0.5, 0.39),
        mass: Some(120.0),
        ..Default::default()
    }];
    bodies.extend((0..72).map(|k| {
        let at = [k % 6, k / 6 % 6, k / 36].map(|i| f64::from(i) * 0.164 + 0.09);
        let place = Vec3::from(at.map(|c| c + 0.001 * random.symmetric()));
        dem::BodyInput { position: place, ..Default::default() }
    }));
    let stone = dem::Material { tangential_damping_ratio: 0.5, ..material(2650.0, 2e5, 0.5, 0.3) };
    dem::ModelInput {
        materials: vec![stone],
        shapes: vec![dem::Shape::Sphere { radius: 0.08 }, dem::Shape::Box { half: [0.4, 0.15, 0.05] }],
        bodies,
        planes: vec![
            side(0.0, Vec3::x()),
            side(1.0, -Vec3::x()),
            side(0.0, Vec3::y()),
            side(1.0, -Vec3::y()),
        ],
        surface_material: Some(0),
        time_step: dem::TimeStep::Fixed(5e-5),
        ..Default::default()
    }
}

/// Largest settlement of the middle of the block and of the sleeper under a pulse of 5 kN after the settling, and the
/// error of the account of energy over the work of the load and of gravity on the way.
fn pulse(solid: &fem::Model, reduction: Option<Reduction>) -> (f64, f64, f64) {
    let mut c = Coupled::new(solid, bed(), 5);
    if let Some(reduction) = reduction {
        let reduced = Arc::new(Reduced::new(solid, c.work.surface.faces(), reduction).expect("a reduction"));
        println!("{reduction:?}: {}", reduced.estimate());
        c.work.reduce(&c.model, reduced).expect("the same solid");
        assert!(c.work.reduction().is_some());
    }
    let node = solid
        .mesh()
        .coordinates
        .iter()
        .position(|x| (x[0] - 0.5).abs() + (x[1] - 0.5).abs() + x[2].abs() < 1e-9)
        .expect("a node in the middle of the top");
    let start = step::stored(&c.model, &c.state);
    let (mut ground, mut sleeper, mut rest) = (0.0_f64, 0.0_f64, 0.0);
    while c.state.solid.time < SETTLING + PULSE {
        let time = c.state.solid.time;
        let on = if time < SETTLING {
            rest = c.state.grains.position(0).z;
            0.0
        } else {
            5000.0 * (std::f64::consts::PI * (time - SETTLING) / PULSE).sin()
        };
        c.step(&[(0, [0.0, 0.0, -on])]);
        if time >= SETTLING {
            ground = ground.max(-c.state.solid.u[3 * node + 2]);
            sleeper = sleeper.max(rest - c.state.grains.position(0).z);
        }
    }
    let (now, spent) = (step::stored(&c.model, &c.state), step::spent(&c.state));
    let error = now.total() - start.total() + spent.dissipated() - spent.work();
    (ground, sleeper, error.abs() / (start.grains_gravity - now.grains_gravity + spent.work()))
}

/// A bed and a sleeper under a pulse. Condensed to the surface with 20 modes, the block settles as the full one within 1 %; with 60
/// modes and pressures on the faces within 10 %, as a point force on a corner of an element, of which the
/// estimate says that two thirds of the local deflection are lost, is met by grains anywhere. The account of energy closes
/// as with the full solid.
#[test]
fn a_reduced_block_settles_as_the_full_one() {
    let solid = block_b(4, Held::Base, fem::Rayleigh { alpha_m: 20.0, beta_k: 2e-4 });
    let full = pulse(&solid, None);
    println!("full: ground {:.4e} m, sleeper {:.4e} m, energy {:.1e}", full.0, full.1, full.2);
    for (reduction, ground, sleeper) in
        [(Reduction::Surface { modes: 20 }, 0.01, 0.01), (Reduction::Modes { modes: 60 }, 0.1, 0.1)]
    {
        let few = pulse(&solid, Some(reduction));
        println!(
            "{reduction:?}: ground {:.4e} m ({:+.2} %), sleeper {:.4e} m ({:+.2} %), energy {:.1e}",
            few.0,
            100.0 * (few.0 / full.0 - 1.0),
            few.1,
            100.0 * (few.1 / full.1 - 1.0),
            few.2
        );
        assert!((few.0 / full.0 - 1.0).abs() < ground && (few.1 / full.1 - 1.0).abs() < sleeper);
        assert!(few.2 < 0.01 && full.2 < 0.01);
    }
}
