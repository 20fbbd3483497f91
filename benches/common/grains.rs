//! Grains and materials.

use std::path::Path;
use trackbed_dem::{BodyInput, Material, Vec3};

/// Numbers of a table in `benches/data`.
pub fn table(name: &str) -> Vec<Vec<f64>> {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/data").join(name))
}

/// Numbers of a table, plain or `.gz`.
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

/// K = 1e5 N/m for pairs and walls.
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

/// Unit-sphere bodies from rows x, y, z, r.
pub fn spheres(rows: &[Vec<f64>]) -> Vec<BodyInput> {
    let body = |row: &Vec<f64>| BodyInput {
        position: Vec3::new(row[0], row[1], row[2]),
        scale: row[3],
        ..BodyInput::default()
    };
    rows.iter().map(body).collect()
}
