//! Sphere dropped 0.05 m on a nearly rigid block, Hertz contact.

use crate::support::*;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_dem::surface::NoSurface;
use trackbed_fem as fem;

const RADIUS: f64 = 0.05;
const DENSITY: f64 = 2650.0;
/// Contact deflection is 200 times the block's (20 GPa) under an element corner.
const YOUNG: f64 = 1e9;
const POISSON: f64 = 0.25;
const STEP: f64 = 4e-6;

fn sphere(restitution: f64, planes: Vec<dem::Plane>, surface: Option<usize>) -> dem::ModelInput {
    let stone = dem::Material {
        density: DENSITY,
        stiffness: f64::INFINITY,
        young: Some(YOUNG),
        poisson: POISSON,
        restitution,
        ..dem::Material::default()
    };
    dem::ModelInput {
        materials: vec![stone],
        shapes: vec![dem::Shape::Sphere { radius: RADIUS }],
        // At the surface with the speed of the fall.
        bodies: vec![dem::BodyInput {
            position: Vec3::new(0.37, 0.61, RADIUS),
            velocity: Vec3::new(0.0, 0.0, -speed()),
            ..Default::default()
        }],
        planes,
        surface_material: surface,
        time_step: dem::TimeStep::Fixed(STEP),
        ..Default::default()
    }
}

fn speed() -> f64 {
    (2.0_f64 * 9.81 * 0.05).sqrt()
}

#[derive(Debug)]
struct Bounce {
    restitution: f64,
    peak: f64,
    time: f64,
}

fn follow(mut step: impl FnMut() -> (f64, f64)) -> Bounce {
    let (mut peak, mut steps, mut last) = (0.0_f64, 0, 0.0);
    for k in 0..2000 {
        let (force, velocity) = step();
        peak = peak.max(force);
        last = velocity;
        if force > 0.0 {
            steps += 1;
        } else if k > 10 {
            break;
        }
    }
    Bounce { restitution: last / speed(), peak, time: f64::from(steps) * STEP }
}

fn on_the_block(restitution: f64) -> Bounce {
    let rayleigh = fem::Rayleigh::default();
    let solid = block([8, 8, 4], [1.0, 1.0, 0.5], 20e9, 0.3, 2000.0, Held::Base, rayleigh);
    let mut c = Coupled::new(&solid, sphere(restitution, Vec::new(), Some(0)), 1);
    follow(|| {
        c.step(&[]);
        (-c.work.mean_contact_force(STEP)[2], c.state.grains.velocity(0).z)
    })
}

fn on_a_rigid_plane(restitution: f64) -> Bounce {
    let plane = dem::Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0, velocity: Vec3::zeros() };
    let model = dem::Model::new(sphere(restitution, vec![plane], None)).expect("a valid model");
    let mut state = dem::State::new(&model);
    let mut work = dem::Work::new(&model, &state);
    follow(|| {
        let before = state.velocity(0).z;
        dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a step");
        let after = state.velocity(0).z;
        // Mass times acceleration less gravity; the threshold excludes rounding.
        let force = model.mass(0) * ((after - before) / STEP + 9.81);
        (if force > 1e-6 { force } else { 0.0 }, after)
    })
}

/// Restitution within 1 % of a rigid wall, elastic and damped; elastic peak force K^(2/5) (5/4 m v²)^(3/5)
/// and contact time 2.94 δ/v within 2 %.
#[test]
fn stiff_block_acts_as_rigid_wall() {
    for restitution in [1.0, 0.5] {
        let (block, wall) = (on_the_block(restitution), on_a_rigid_plane(restitution));
        println!(
            "e = {restitution}: block {:.4}, wall {:.4} ({:+.2} %); peak {:.1} and {:.1} N; time {:.1} and {:.1} us",
            block.restitution,
            wall.restitution,
            100.0 * (block.restitution / wall.restitution - 1.0),
            block.peak,
            wall.peak,
            1e6 * block.time,
            1e6 * wall.time
        );
        assert!((wall.restitution / restitution - 1.0).abs() < 0.01);
        assert!((block.restitution / wall.restitution - 1.0).abs() < 0.01);
        if restitution == 1.0 {
            let mass = DENSITY * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
            let modulus = YOUNG / (2.0 * (1.0 - POISSON * POISSON));
            let k = 4.0 / 3.0 * modulus * RADIUS.sqrt();
            let peak = k.powf(0.4) * (1.25 * mass * speed() * speed()).powf(0.6);
            let time = 2.94 * (peak / k).powf(2.0 / 3.0) / speed();
            println!(
                "Hertz: peak {peak:.1} N ({:+.2} %), time {:.1} us ({:+.2} %)",
                100.0 * (block.peak / peak - 1.0),
                1e6 * time,
                100.0 * (block.time / time - 1.0)
            );
            assert!((block.peak / peak - 1.0).abs() < 0.02);
            assert!((block.time / time - 1.0).abs() < 0.02);
        }
    }
}
