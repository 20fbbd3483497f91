//! Times steps of a bed of spheres on several ranks (threads).
//!
//! cargo run --release -p trackbed-dem --example ranks -- RANKS NX NY NZ [STEPS]

use std::time::Instant;
use trackbed_dem::ranks::{Ranks, local, serve};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BackEnd, BodyInput, Material, Model, ModelInput, Plane, Shape, State, TimeStep, Vec3};

/// 1 cm spheres in contact on a cubic lattice, with individual velocities.
fn bed(counts: [usize; 3]) -> ModelInput {
    let stone = Material {
        density: 2600.0,
        stiffness: 1e5,
        tangential_ratio: 0.5,
        friction: 0.5,
        restitution: 0.5,
        ..Material::default()
    };
    let pitch = 0.0199;
    let [nx, ny, nz] = counts;
    let far = Vec3::new(nx as f64, ny as f64, nz as f64) * pitch;
    let walls = [Vec3::x(), Vec3::y(), Vec3::z()].into_iter().flat_map(|n| [(Vec3::zeros(), n), (far, -n)]);
    let planes = walls.map(|(point, normal)| Plane { point, normal, material: 0, velocity: Vec3::zeros() });
    let body = |k: usize| {
        let cell = Vec3::new((k % nx) as f64, (k / nx % ny) as f64, (k / nx / ny) as f64);
        let x = k as f64;
        let velocity = Vec3::new((1.7 * x).sin(), (2.9 * x).cos(), (0.7 * x).sin()) * 0.2;
        BodyInput { position: (cell + Vec3::repeat(0.5)) * pitch, velocity, ..BodyInput::default() }
    };
    ModelInput {
        materials: vec![stone],
        shapes: vec![Shape::Sphere { radius: 0.01 }],
        planes: planes.collect(),
        bodies: (0..nx * ny * nz).map(body).collect(),
        time_step: TimeStep::Auto { fraction: 0.2 },
        ..ModelInput::default()
    }
}

fn main() {
    let numbers: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let [size, nx, ny, nz, ref rest @ ..] = numbers[..] else {
        println!("RANKS SPHERES_ALONG_X SPHERES_ALONG_Y SPHERES_ALONG_Z [STEPS]");
        return;
    };
    let steps = rest.first().copied().unwrap_or(200);
    let model = Model::new(bed([nx, ny, nz])).expect("a good input");
    let mut state = State::new(&model);
    let mut links = local(size);
    let first = links.remove(0);
    std::thread::scope(|scope| {
        for link in links {
            let model = &model;
            scope.spawn(move || alone(|| serve(link, |_| Ok(model.clone())).expect("the first rank")));
        }
        alone(|| {
            let mut ranks = Ranks::new(first, &model, &state, &[]).expect("ranks");
            let advance = |ranks: &mut Ranks<_>, state: &mut State| {
                ranks.step(&model, state, &NoSurface, &[]).expect("a good step");
            };
            // Warm-up of the lists.
            (0..50).for_each(|_| advance(&mut ranks, &mut state));
            let begun = Instant::now();
            (0..steps).for_each(|_| advance(&mut ranks, &mut state));
            let step = begun.elapsed().as_secs_f64() / steps as f64;
            let download = Instant::now();
            ranks.download(&model, &mut state).expect("ranks that respond");
            let download = download.elapsed().as_secs_f64();
            let (count, total) = (model.body_count(), steps as u64 + 50);
            let each = step * 1e6 / count as f64;
            println!(
                "{size} ranks, {count} spheres: {:.2} ms a step, {each:.3} us a sphere and step",
                1e3 * step
            );
            println!(
                "{} ghosts in all; a download {:.1} ms; {:?} searches, near lists",
                ranks.traffic().ghosts,
                1e3 * download,
                ranks.rebuilds()
            );
            ranks.traffic().lines(total).iter().for_each(|line| println!("  {line}"));
        });
    });
}

/// Single-threaded.
fn alone(work: impl FnOnce() + Send) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    pool.install(work);
}
