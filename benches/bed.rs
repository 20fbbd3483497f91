//! One bed, one number of threads, so many steps: the program that `dem_peers.py` runs by turns with other programs.
//!
//! `cargo bench --bench bed -- --scene s1 --packing FILE --threads 1 --relax 300 --steps 1000`; without arguments a short
//! run of `s1`. Prints one line of `key=value`: rates are body-steps per second of processor time and of wall time;
//! coordination counts contacts between bodies, each for both;
//! `bytes` is the resident memory that model, state and scratch take after the run, per sphere (a few per cent of
//! noise; `cargo bench --bench memory` counts exactly).
//!
//! | scene | what |
//! |---|---|
//! | `s1` | spheres in a box, linear contacts: K = 1e5 N/m, tangential 2/7 of it, restitution 0.5, friction 0.5, step 2e-5 s |
//! | `s1hertz` | as `s1`, contacts after Hertz and Mindlin: E = 5e7 Pa, ν = 0.25 |
//! | `s1sleeper` | as `s1`, with a sleeper that hangs above the bed and touches nothing |
//! | `s2` | clumps of `benches/data/s2_clump.csv`, same parameters |
//! | `s3` | a block of 6,331 spheres with 19,480 bonds, pressed at 0.1 m/s between grips, step 2e-6 s |
//! | `s4` | 125 convex blocks of 26 corners in the mean that lie in a box, dilated by 6 % of their radius: K = 1e6 N/m, step 1.5e-6 s |
//! | `s5` | as `s1`, on a floor of 2 × 71 × 71 triangles in place of the plane |
//!
//! FILE has columns x, y, z, r (`s2`: x, y, z and a quaternion) and the width of the box as `W 0.42` in its comments.

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
            "--bench" => {} // cargo's own
            _ => panic!("{word}: unknown argument"),
        }
    }
    found
}

/// Resident memory of this program [B]; zero where the system does not tell.
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
