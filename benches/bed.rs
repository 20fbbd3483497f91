//! One bed for `dem_peers.py`.
//!
//! `cargo bench --bench bed -- --scene s1 --packing FILE --threads 1 --relax 300 --steps 1000`; default: a
//! short `s1`. Output `key=value`: body-steps per second of CPU and wall time; coordination (both bodies
//! count); `bytes` of resident memory per sphere, within a few per cent (`memory` bench: exact).
//!
//! | scene | model |
//! |---|---|
//! | `s1` | spheres in a box, K = 1e5 N/m, tangential 2/7, restitution 0.5, friction 0.5, step 2e-5 s |
//! | `s1hertz` | `s1` with Hertz–Mindlin: E = 5e7 Pa, ν = 0.25 |
//! | `s1sleeper` | `s1` with a sleeper above, without contact |
//! | `s2` | clumps of `benches/data/s2_clump.csv`, as `s1` |
//! | `s3` | 6,331 spheres, 19,480 bonds, compressed at 0.1 m/s, step 2e-6 s |
//! | `s4` | 125 convex blocks, mean 26 corners, dilated by 6 %: K = 1e6 N/m, step 1.5e-6 s |
//! | `s5` | `s1` on 2 × 71 × 71 triangles |
//!
//! FILE: columns x, y, z, r (`s2`: x, y, z, quaternion), box width as comment `W 0.42`.

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

use std::path::PathBuf;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{Model, Partner, State, Work, measure};
use watch::Watch;

struct Arguments {
    scene: String,
    packing: Option<PathBuf>,
    threads: usize,
    relax: u32,
    steps: u32,
}

fn arguments() -> Arguments {
    let mut found = Arguments { scene: "s1".into(), packing: None, threads: 1, relax: 300, steps: 500 };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_else(|| panic!("{word} needs a value"));
        let number = |text: String| text.parse::<u32>().unwrap_or_else(|e| panic!("{text}: {e}"));
        match word.as_str() {
            "--scene" => found.scene = value(),
            "--packing" => found.packing = Some(value().into()),
            "--threads" => found.threads = number(value()) as usize,
            "--relax" => found.relax = number(value()),
            "--steps" => found.steps = number(value()),
            "--bench" => {} // from cargo
            _ => panic!("{word}: unknown argument"),
        }
    }
    found
}

/// Resident memory [B]; zero if unknown.
fn resident() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    text.split(' ').nth(1).and_then(|pages| pages.parse::<f64>().ok()).unwrap_or(0.0) * 4096.0
}

fn main() {
    let a = arguments();
    let input = scenes::input(&a.scene, a.packing);
    let before = resident();
    let model = Model::new(input).expect("the bed is a model");
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let pool = watch::pool(a.threads);
    let advance = |state: &mut State, work: &mut Work, steps: u32| {
        pool.install(|| {
            for _ in 0..steps {
                trackbed_dem::step(&model, state, work, &NoSurface, &[]).expect("a good step");
            }
        });
    };
    advance(&mut state, &mut work, a.relax);
    let before_run = work.rebuilds();
    let mut watch = Watch::default();
    watch.time(|| advance(&mut state, &mut work, a.steps));
    let used = resident() - before;
    let after = work.rebuilds();
    let count = model.body_count() as f64;
    let done = count * f64::from(a.steps);
    let energies = measure::energies(&model, &state);
    let pairs = measure::contacts(&model, &state).iter().filter(|c| matches!(c.b, Partner::Body(_))).count();
    println!(
        "scene={} bodies={count} threads={} steps={} wall={:.4} cpu={:.4} rate={:.5e} wall_rate={:.5e} coordination={:.4} \
         translation={:.4e} rotation={:.4e} searches={} near_lists={} bytes={:.0}",
        a.scene,
        a.threads,
        a.steps,
        watch.wall,
        watch.cpu,
        done / watch.cpu,
        done / watch.wall,
        2.0 * pairs as f64 / count,
        energies.kinetic_translation,
        energies.kinetic_rotation,
        after.0 - before_run.0,
        after.1 - before_run.1,
        used / model.sphere_count().max(1) as f64,
    );
}
