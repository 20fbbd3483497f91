//! Scenes of `bed.rs`.

use crate::{boxes, elastic, grains};
use nalgebra::{Quaternion, UnitQuaternion};
use std::path::{Path, PathBuf};
use trackbed_dem::bond::{Bond, BondDamping, BondInput, Criterion, DirectBond};
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{BodyInput, Material, ModelInput, Plane, Shape, TimeStep, TriangleSurface, Vec3};

/// Box width of the blocks [m].
const WIDTH: f64 = 0.222;

/// Rounding, as a fraction of block size.
const ROUNDING: f64 = 0.06;

/// Bonded block: beam of E = 1 GPa, radius and half length 1 cm; lower layer fixed, upper moving.
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

/// Convex 5 cm blocks at rest: cores of 0.94, dilated.
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

/// Model of a scene.
pub fn input(scene: &str, packing: Option<PathBuf>) -> ModelInput {
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

/// Floor of 2 n² triangles, x, y in [0, width].
pub fn floor(width: f64, n: u32) -> TriangleSurface {
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

/// Box width in the comments [m].
fn width(file: &Path) -> f64 {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let comments = text.lines().filter(|l| l.starts_with('#')).flat_map(str::split_whitespace);
    let width = comments.skip_while(|word| *word != "W").nth(1).and_then(|word| word.parse().ok());
    width.unwrap_or_else(|| panic!("{}: no width `W ...` in its comments", file.display()))
}
