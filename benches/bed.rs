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
#[path = "common/watch.rs"]
mod watch;

use nalgebra::{Quaternion, UnitQuaternion};
use std::path::{Path, PathBuf};
use trackbed_dem::bond::{Bond, BondDamping, BondInput, Criterion, DirectBond};
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    BodyInput, Material, Model, ModelInput, Partner, Plane, Shape, State, TimeStep, TriangleSurface, Vec3,
    Work, measure,
};
use watch::Watch;

/// Width of the box of the blocks [m].
const WIDTH: f64 = 0.222;

/// Share of a block that its rounding takes.
const ROUNDING: f64 = 0.06;

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

/// The bonded block: bonds of a beam of E = 1 GPa, radius and half length 1 cm; its lower layer is held, the upper moves.
fn block() -> ModelInput {
    let mut input = ModelInput {
        materials: vec![Material { stiffness: 1e6, ..grains::stone() }],
        shapes: vec![Shape::Sphere { radius: 1.0 }],
        gravity: Vec3::zeros(),
        time_step: TimeStep::Fixed(2e-6),
        ..ModelInput::default()
    };
    for row in grains::table("s3_particles.csv.gz") {
        let gripped = row[4] > 0.0;
        input.bodies.push(BodyInput {
            position: Vec3::new(row[0], row[1], row[2]),
            scale: row[3],
            velocity: if row[4] > 1.0 { Vec3::new(0.0, 0.0, -0.1) } else { Vec3::zeros() },
            fixed: [gripped; 6],
            ..BodyInput::default()
        });
    }
    input.bond_kinds.push(Bond::Direct(DirectBond {
        stiffness: [1.5708e7, 6.2832e6, 392.7, 314.16],
        strength: [62.83, 125.66, 0.15708, 0.31416],
        criterion: Criterion::Sum,
        damping: BondDamping::Coefficients([80.0, 80.0, 0.004, 0.004]),
        contact: false,
    }));
    let bond = |row: &Vec<f64>| BondInput::new(row[0] as usize - 1, row[1] as usize - 1, 0);
    input.bonds = grains::table("s3_bonds.csv.gz").iter().map(bond).collect();
    input
}

/// Convex blocks of 5 cm that have settled: cores of 0.94 of their size, rounded by the rest.
fn blocks() -> ModelInput {
    let mut input = ModelInput {
        materials: vec![Material { stiffness: 1e6, ..grains::stone() }],
        time_step: TimeStep::Fixed(1.5e-6),
        planes: boxes::walls(WIDTH),
        ..ModelInput::default()
    };
    input.planes.push(Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
        material: 0,
        velocity: Vec3::zeros(),
    });
    for rows in grains::table("s4_blocks.csv.gz").chunk_by(|a, b| a[0] == b[0]) {
        let corners: Vec<Vec3> = rows.iter().map(|r| Vec3::new(r[8], r[9], r[10])).collect();
        let radius = corners.iter().map(|c| c.norm()).sum::<f64>() / corners.len() as f64;
        let inner: Vec<Vec3> = corners.iter().map(|c| c * (1.0 - ROUNDING)).collect();
        let (block, centre, turn) = Dilated::new(&inner, ROUNDING * radius).expect("a convex block");
        let r = &rows[0];
        let own = UnitQuaternion::from_quaternion(Quaternion::new(r[4], r[5], r[6], r[7]));
        let shape = input.shapes.len();
        input.shapes.push(Shape::Polyhedron(Box::new(block)));
        let position = Vec3::new(r[1], r[2], r[3]) + own * centre;
        input.bodies.push(BodyInput { shape, position, orientation: own * turn, ..BodyInput::default() });
    }
    input
}

/// The model of a scene with its packing.
fn input(scene: &str, packing: Option<PathBuf>) -> ModelInput {
    if scene == "s3" {
        return block();
    }
    if scene == "s4" {
        return blocks();
    }
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/data");
    let standard = if scene == "s2" { "s2_1k.csv" } else { "s1_10k.csv" };
    let file = packing.unwrap_or_else(|| data.join(standard));
    let width = width(&file);
    let mut input = ModelInput {
        materials: vec![grains::stone()],
        time_step: TimeStep::Fixed(2e-5),
        planes: boxes::walls(width),
        ..ModelInput::default()
    };
    let rows = grains::read(&file);
    match scene {
        "s1" | "s1hertz" | "s1sleeper" | "s5" => {
            input.shapes.push(Shape::Sphere { radius: 1.0 });
            input.bodies = grains::spheres(&rows);
        }
        "s2" => {
            let (shape, bodies) = boxes::clumps(&rows);
            input.shapes.push(shape);
            input.bodies = bodies;
        }
        _ => panic!("{scene}: unknown scene"),
    }
    if scene == "s1sleeper" {
        input.shapes.push(Shape::Box { half: [0.15, 1.3, 0.1] });
        let position = Vec3::new(0.2, 0.2, 2.0);
        input.bodies.push(BodyInput { shape: 1, position, fixed: [true; 6], ..BodyInput::default() });
    }
    if scene == "s1hertz" {
        input.materials[0] = elastic::elastic();
    }
    if scene == "s5" {
        input.triangles.push(floor(width, 71));
    } else {
        let floor = Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0, velocity: Vec3::zeros() };
        input.planes.push(floor);
    }
    input
}

/// A floor of 2 n² triangles over x, y in [0, width].
fn floor(width: f64, n: u32) -> TriangleSurface {
    let at = |k: u32| width * f64::from(k) / f64::from(n);
    let vertex = |k: u32| Vec3::new(at(k % (n + 1)), at(k / (n + 1)), 0.0);
    let square = |k: u32| {
        let a = k % n + (n + 1) * (k / n);
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    TriangleSurface {
        vertices: (0..(n + 1) * (n + 1)).map(vertex).collect(),
        triangles: (0..n * n).flat_map(square).collect(),
        ..TriangleSurface::default()
    }
}

/// The width of the box in a packing's comments [m].
fn width(file: &Path) -> f64 {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let comments = text.lines().filter(|l| l.starts_with('#')).flat_map(str::split_whitespace);
    let width = comments.skip_while(|word| *word != "W").nth(1).and_then(|word| word.parse().ok());
    width.unwrap_or_else(|| panic!("{}: no width `W ...` in its comments", file.display()))
}

fn main() {
    let a = arguments();
    let input = input(&a.scene, a.packing);
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
