//! Grains from `benches/data`, what they are made of, and the walls around them.

use std::path::Path;
use trackbed_dem::{Material, Plane, Vec3};

/// The numbers of a table, without its comments and its line of names.
pub fn table(name: &str) -> Vec<Vec<f64>> {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/data").join(name))
}

/// The numbers of a table of the user's, plain or compressed (`.gz`).
pub fn read(path: &Path) -> Vec<Vec<f64>> {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut text = String::new();
    if path.extension().is_some_and(|e| e == "gz") {
        let mut decoder = flate2::read::GzDecoder::new(bytes.as_slice());
        std::io::Read::read_to_string(&mut decoder, &mut text).expect("a compressed table");
    } else {
        text = String::from_utf8(bytes).expect("a table of text");
    }
    let row = |line: &str| line.split(',').map(|v| v.parse().ok()).collect::<Option<Vec<f64>>>();
    text.lines().filter(|l| !l.starts_with('#')).skip(1).map(|l| row(l).expect("a row of numbers")).collect()
}

/// The grains of the peers' scenes: K = 1e5 N/m for a pair, and for a wall of the same material.
pub fn stone() -> Material {
    Material {
        density: 2600.0,
        stiffness: 1e5,
        tangential_ratio: 2.0 / 7.0,
        tangential_damping_ratio: 0.0,
        friction: 0.5,
        restitution: 0.5,
        ..Material::default()
    }
}

/// The grains of the peers' Hertz scene: E = 5e7 Pa, ν = 0.25.
#[allow(dead_code)] // Not every benchmark uses every material.
pub fn elastic() -> Material {
    Material { stiffness: f64::INFINITY, young: Some(5e7), poisson: 0.25, ..stone() }
}

/// Four walls around x, y in [0, width].
pub fn walls(width: f64) -> Vec<Plane> {
    let wall = |point, normal| Plane { point, normal, material: 0, velocity: Vec3::zeros() };
    let far = Vec3::repeat(width);
    vec![
        wall(Vec3::zeros(), Vec3::x()),
        wall(Vec3::zeros(), Vec3::y()),
        wall(far, -Vec3::x()),
        wall(far, -Vec3::y()),
    ]
}

/// The bed of 1,000 clumps of ten spheres in a box 0.4 m wide: its shape and bodies.
pub fn clumps() -> (trackbed_dem::Shape, Vec<trackbed_dem::BodyInput>) {
    clumps_at(&table("s2_1k.csv"))
}

/// Clumps of ten spheres, one for each row of centre and quaternion.
pub fn clumps_at(rows: &[Vec<f64>]) -> (trackbed_dem::Shape, Vec<trackbed_dem::BodyInput>) {
    let spheres: Vec<_> = table("s2_clump.csv").iter().map(|s| ([s[0], s[1], s[2]], s[3])).collect();
    let clump = trackbed_dem::shape::clump::Clump::from_spheres(&spheres).expect("the spheres make a clump");
    let body = |row: &Vec<f64>| trackbed_dem::BodyInput {
        position: Vec3::new(row[0], row[1], row[2]),
        orientation: nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(
            row[3], row[4], row[5], row[6],
        )),
        ..Default::default()
    };
    (trackbed_dem::Shape::Clump(clump), rows.iter().map(body).collect())
}

/// A body of the unit sphere for each row x, y, z, r of a table.
pub fn spheres(name: &str) -> Vec<trackbed_dem::BodyInput> {
    let body = |row: &Vec<f64>| trackbed_dem::BodyInput {
        position: Vec3::new(row[0], row[1], row[2]),
        scale: row[3],
        ..Default::default()
    };
    table(name).iter().map(body).collect()
}
