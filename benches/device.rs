//! CPU against CUDA: rates and bitwise equality.
//!
//! `cargo bench --bench device -- --scene s1 --tiles 1,3,10 --steps 2000`. Scenes of `bed.rs`, tiled n × n,
//! deposited on the CPU, then continued on both. Exit code 1 if positions, velocities or energies differ.
//! `--device-only` skips the CPU; `--change FROM TO` edits the kernel source.

#[path = "common/boxes.rs"]
mod boxes;
#[path = "common/elastic.rs"]
mod elastic;
#[path = "common/grains.rs"]
mod grains;
#[path = "common/scenes.rs"]
mod scenes;
#[path = "common/watch.rs"]
mod watch;

use std::process::ExitCode;
use std::time::Instant;
use trackbed_dem::device::{Cuda, Device, kernels, source};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BackEnd, Model, ModelInput, State, TimeStep, Vec3, Work, measure};
use watch::Watch;

struct Arguments {
    scene: String,
    tiles: Vec<usize>,
    threads: usize,
    relax: u32,
    steps: u32,
    processor: bool,
    changes: Vec<[String; 2]>,
}

fn arguments() -> Arguments {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    let mut found = Arguments {
        scene: "s1".into(),
        tiles: vec![1],
        threads,
        relax: 300,
        steps: 500,
        processor: true,
        changes: Vec::new(),
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        let number = |text: &str| text.parse::<u32>().unwrap_or_else(|e| panic!("{text}: {e}"));
        match word.as_str() {
            "--scene" => found.scene = value(),
            "--tiles" => found.tiles = value().split(',').map(|n| number(n) as usize).collect(),
            "--threads" => found.threads = number(&value()) as usize,
            "--relax" => found.relax = number(&value()),
            "--steps" => found.steps = number(&value()),
            "--device-only" => found.processor = false,
            "--change" => found.changes.push([value(), value()]),
            "--bench" => {} // from cargo
            _ => panic!("{word}: unknown argument"),
        }
    }
    found
}

/// Scene tiled `n` × `n`.
fn tiled(scene: &str, n: usize) -> ModelInput {
    let one = scenes::input(scene, None);
    // Gripped blocks are separate; beds of spheres alternate with mirror images, so that seams act like
    // walls.
    let (width, mirrored) = match scene {
        "s3" => (0.5, false),
        "s2" => (0.4, false),
        _ => (0.42, true),
    };
    let place = |x: f64, k: usize| k as f64 * width + if mirrored && k % 2 == 1 { width - x } else { x };
    let mut all = ModelInput { bodies: Vec::new(), bonds: Vec::new(), ..one.clone() };
    for k in 0..n * n {
        let first = all.bodies.len();
        for body in &one.bodies {
            let at = body.position;
            let position = Vec3::new(place(at.x, k % n), place(at.y, k / n), at.z);
            all.bodies.push(trackbed_dem::BodyInput { position, ..body.clone() });
        }
        for bond in &one.bonds {
            all.bonds.push(trackbed_dem::bond::BondInput { a: bond.a + first, b: bond.b + first, ..*bond });
        }
    }
    if scene != "s3" {
        let floor = all.planes.split_off(4.min(all.planes.len()));
        all.planes = boxes::walls(width * n as f64);
        all.planes.extend(floor);
        all.time_step = TimeStep::Fixed(2e-5);
    }
    if scene == "s5" {
        all.triangles = vec![scenes::floor(width * n as f64, 71 * n as u32)];
    }
    all
}

fn same(model: &Model, a: &State, b: &State) -> bool {
    let motion = |s: &State, k: usize| {
        [s.position(k), s.velocity(k), s.spin(k)].map(|v| [v.x, v.y, v.z].map(f64::to_bits))
    };
    (0..model.body_count()).all(|k| motion(a, k) == motion(b, k))
        && a.balance == b.balance
        && format!("{:?}", measure::energies(model, a)) == format!("{:?}", measure::energies(model, b))
}

/// Steps on both; whether all bits agree.
fn compare(a: &Arguments, n: usize) -> bool {
    let begin = Instant::now();
    let model = Model::new(tiled(&a.scene, n)).expect("the bed is a model");
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let pool = watch::pool(a.threads);
    let by_processor = |state: &mut State, work: &mut Work, steps: u32| {
        let start = Instant::now();
        pool.install(|| {
            (0..steps)
                .for_each(|_| trackbed_dem::step(&model, state, work, &NoSurface, &[]).expect("a good step"));
        });
        start.elapsed().as_secs_f64()
    };
    by_processor(&mut state, &mut work, a.relax);
    let built = begin.elapsed().as_secs_f64();
    let start = Instant::now();
    let text = source(&model).expect("a model for a device");
    let text = a.changes.iter().fold(text, |text, [from, to]| text.replace(from, to));
    let cuda = Cuda::new(&text, kernels(&model)).expect("a device");
    let name = cuda.name.replace(' ', "_");
    let compiled = start.elapsed().as_secs_f64();
    let mut ours = state.clone();
    let mut device = Device::new(cuda, &model, &ours).expect("memory on the device");
    let mut watch = Watch::default();
    watch.time(|| {
        (0..a.steps).for_each(|_| device.step(&model, &mut ours, &NoSurface, &[]).expect("a good step"));
    });
    let Watch { wall, cpu } = watch;
    let start = Instant::now();
    device.download(&model, &mut ours).expect("a device that responds");
    let downloaded = start.elapsed().as_secs_f64();
    let done = model.body_count() as f64 * f64::from(a.steps);
    print!(
        "scene={} bodies={} device={name} steps={} built={built:.1} compiled={compiled:.2} wall={wall:.4} cpu={cpu:.4} us_a_step={:.1} rate={:.4e} \
         lists={} download={downloaded:.4}",
        a.scene,
        model.body_count(),
        a.steps,
        1e6 * wall / f64::from(a.steps),
        done / wall,
        device.rebuilds().1,
    );
    if !a.processor {
        println!();
        return true;
    }
    let wall = by_processor(&mut state, &mut work, a.steps);
    let same = same(&model, &ours, &state);
    println!(" threads={} processor={:.4e} same_bits={same}", a.threads, done / wall);
    same
}

fn main() -> ExitCode {
    let a = arguments();
    if let Some(what) = Cuda::missing() {
        println!("not run: {what}");
        return ExitCode::SUCCESS;
    }
    let same = a.tiles.iter().map(|&n| compare(&a, n)).fold(true, |all, one| all & one);
    if same { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
