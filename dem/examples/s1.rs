//! Speed of a settled bed of spheres (x, y, z, r per line) in a box open at the top.
//!
//! `cargo run --release --example s1 -- BED.csv [STEPS]`; the header's `W` is the width of the box.

use std::time::Instant;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    BodyInput, Material, Model, ModelInput, Plane, Shape, State, TimeStep, Vec3, Work, measure,
};

type Outcome = Result<(), Box<dyn std::error::Error + Send + Sync>>;

fn main() -> Outcome {
    // Inside the pool from the start: no hand-over per step.
    rayon::ThreadPoolBuilder::new().build()?.install(run)
}

fn run() -> Outcome {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or("name a CSV file of x, y, z, r")?;
    let steps: u32 = args.next().map_or(Ok(1000), |s| s.parse())?;
    let text = std::fs::read_to_string(&path)?;
    let width: f64 = text
        .lines()
        .find_map(|l| l.split(" W ").nth(1))
        .and_then(|s| s.trim().split(|c: char| !c.is_ascii_digit() && c != '.').next()?.parse().ok())
        .ok_or("the header holds no width W")?;

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
        shapes: vec![Shape::Sphere { radius: 1.0 }],
        ..ModelInput::default()
    };
    for line in text.lines() {
        let row: Vec<f64> = line.split(',').filter_map(|v| v.trim().parse().ok()).collect();
        if let [x, y, z, r] = row[..] {
            input.bodies.push(BodyInput { scale: r, position: Vec3::new(x, y, z), ..BodyInput::default() });
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
    for _ in 0..300 {
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
        "{} spheres, {steps} steps: {:.2} M sphere-steps/s, coordination {:.4}, kinetic {:.4e} J + {:.4e} J, \
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
