//! Speed of a settled bed of like clumps (x, y, z, quaternion w, x, y, z per line) in a box open at the top.
//!
//! `cargo run --release --example s2 -- BED.csv CLUMP.csv [STEPS]`; the header's ` W ` is the width of the box, and
//! CLUMP.csv holds x, y, z, r of each sphere in the principal frame.

use nalgebra::{Quaternion, UnitQuaternion};
use std::time::Instant;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    BodyInput, Material, Model, ModelInput, Plane, Shape, State, TimeStep, Vec3, Work, measure,
};

fn rows(path: &str) -> std::io::Result<(String, Vec<Vec<f64>>)> {
    let text = std::fs::read_to_string(path)?;
    let parse = |l: &str| l.split(',').filter_map(|v| v.trim().parse().ok()).collect::<Vec<f64>>();
    let rows = text.lines().map(parse).filter(|r| r.len() >= 4).collect();
    Ok((text, rows))
}

type Outcome = Result<(), Box<dyn std::error::Error + Send + Sync>>;

fn main() -> Outcome {
    // Inside the pool from the start: no hand-over per step.
    rayon::ThreadPoolBuilder::new().build()?.install(run)
}

fn run() -> Outcome {
    let mut args = std::env::args().skip(1);
    let bed = args.next().ok_or("name a CSV file of clumps")?;
    let shape = args.next().ok_or("name a CSV file of the clump's spheres")?;
    let steps: u32 = args.next().map_or(Ok(1000), |s| s.parse())?;
    let (text, bed) = rows(&bed)?;
    let width: f64 = text
        .lines()
        .find_map(|l| l.split(" W ").nth(1))
        .and_then(|s| s.split_whitespace().next()?.parse().ok())
        .ok_or("the header holds no width W")?;
    let spheres: Vec<_> = rows(&shape)?.1.iter().map(|r| ([r[0], r[1], r[2]], r[3])).collect();
    let clump = Clump::from_spheres(&spheres)?;
    println!("volume {:.5e} m3, inertia per density {:?}", clump.volume, clump.inertia);

    let stone = Material {
        density: 2600.0,
        stiffness: 1e5,
        tangential_ratio: 2.0 / 7.0,
        tangential_damping_ratio: 0.0,
        friction: 0.5,
        restitution: 0.5,
    };
    let mut input = ModelInput {
        materials: vec![stone],
        time_step: TimeStep::Fixed(2e-5),
        shapes: vec![Shape::Clump(clump)],
        ..ModelInput::default()
    };
    for row in &bed {
        if let [x, y, z, w, i, j, k] = row[..] {
            input.bodies.push(BodyInput {
                position: Vec3::new(x, y, z),
                orientation: UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k)),
                ..BodyInput::default()
            });
        }
    }
    for (point, normal) in [
        (Vec3::zeros(), Vec3::z()),
        (Vec3::zeros(), Vec3::x()),
        (Vec3::zeros(), Vec3::y()),
        (Vec3::repeat(width), -Vec3::x()),
        (Vec3::repeat(width), -Vec3::y()),
    ] {
        input.planes.push(Plane { point, normal, material: 0, velocity: Vec3::zeros() });
    }
    let model = Model::new(input)?;
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    for _ in 0..500 {
        trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[])?;
    }
    let before = work.rebuilds();
    let start = Instant::now();
    for _ in 0..steps {
        trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[])?;
    }
    let seconds = start.elapsed().as_secs_f64();
    let after = work.rebuilds();
    let e = measure::energies(&model, &state);
    println!(
        "{} clumps, {steps} steps: {:.3} M clump-steps/s, coordination {:.4}, kinetic {:.4e} J + {:.4e} J, \
         {} searches, {} near lists, limit {:.2e} s",
        model.body_count(),
        model.body_count() as f64 * f64::from(steps) / seconds / 1e6,
        measure::coordination(&model, &state),
        e.kinetic_translation,
        e.kinetic_rotation,
        after.0 - before.0,
        after.1 - before.1,
        model.dt_limit().dt,
    );
    Ok(())
}
