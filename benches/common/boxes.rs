//! Walls and clumps.

use crate::grains;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::{BodyInput, Plane, Shape, Vec3};

/// Walls around x, y in [0, width].
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

/// Ten-sphere clumps from rows of centre and quaternion.
pub fn clumps(rows: &[Vec<f64>]) -> (Shape, Vec<BodyInput>) {
    let spheres: Vec<_> = grains::table("s2_clump.csv").iter().map(|s| ([s[0], s[1], s[2]], s[3])).collect();
    let clump = Clump::from_spheres(&spheres).expect("the spheres make a clump");
    let body = |row: &Vec<f64>| BodyInput {
        position: Vec3::new(row[0], row[1], row[2]),
        orientation: nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(
            row[3], row[4], row[5], row[6],
        )),
        ..BodyInput::default()
    };
    (Shape::Clump(clump), rows.iter().map(body).collect())
}
