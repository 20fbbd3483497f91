use super::*;
use crate::tables::{corners, rows};
use nalgebra::{Quaternion, UnitQuaternion};

fn wet(skin: &Skin, row: &[f64]) -> (f64, Vec3) {
    let q = UnitQuaternion::new_unchecked(Quaternion::new(row[0], row[1], row[2], row[3]));
    let up = q.inverse_transform_vector(&Vec3::z());
    let found = skin.below(&up, -row[6], &Vec3::x(), &mut Vec::new());
    let (volume, moment) = skin.whole;
    let arm = found.arm + moment / volume;
    (found.volume, Vec3::new(row[4], row[5], row[6]) + q * arm)
}

#[test]
fn sharp_bodies_are_cut_exactly() {
    let shapes = rows(include_str!("../../tests/data/water/corners.csv"));
    let table = rows(include_str!("../../tests/data/water/cores.csv"));
    assert_eq!(table.len(), 100);
    for (body, row) in &table {
        let skin = Skin::new(&Core::new(&corners(&shapes, body)).unwrap(), 0.0);
        let (volume, centre) = wet(&skin, row);
        assert!((volume - row[7]).abs() < 1e-12, "{body}: {volume} for {}", row[7]);
        for d in 0..3 {
            assert!(
                (centre[d] - row[8 + d]).abs() * row[7].min(1.0) < 1e-12,
                "{body}: {centre} for {:?}",
                &row[8..]
            );
        }
    }
}

/// Error of an edge cut at the waterplane; plainly offset faces: 0.0023 (mean), 0.023 (largest).
#[test]
fn dilated_bodies_are_cut_accurately() {
    let shapes = rows(include_str!("../../tests/data/water/corners.csv"));
    let table = rows(include_str!("../../tests/data/water/dilated.csv"));
    assert_eq!(table.len(), 100);
    let (mut worst, mut sum, mut off) = (0.0_f64, 0.0, 0.0_f64);
    for (body, row) in &table {
        let core = Core::new(&corners(&shapes, body)).unwrap();
        let (skin, exact) =
            (Skin::new(&core, row[0]), crate::shape::dilated::Dilated::moments_of(&core, row[0]));
        assert!(
            (skin.whole.0 / exact.volume - 1.0).abs() < 1e-9,
            "{body}: {} {}",
            skin.whole.0,
            exact.volume
        );
        let (volume, centre) = wet(&skin, &row[1..]);
        let error = (volume - row[8]).abs() / exact.volume;
        (worst, sum) = (worst.max(error), sum + error);
        let size = libm::cbrt(exact.volume);
        let aside = (centre - Vec3::new(row[9], row[10], row[11])).norm() * row[8] / (size * exact.volume);
        off = off.max(aside);
    }
    println!("volume off by {worst:.1e}, in the mean {:.1e}; moment by {off:.1e}", sum / 100.0);
    assert!(worst < 3e-4 && sum < 100.0 * 5e-5 && off < 3e-4);
}

#[test]
fn cube_has_projected_areas() {
    let cube: Vec<Vec3> = (0..8)
        .map(|k| Vec3::new(f64::from(k & 1) - 0.5, f64::from(k >> 1 & 1) - 0.5, f64::from(k >> 2) - 0.5))
        .collect();
    let skin = Skin::new(&Core::new(&cube).unwrap(), 0.0);
    let see = |along: Vec3| skin.below(&Vec3::z(), 0.0, &along.normalize(), &mut Vec::new());
    let corner = Vec3::new(1.0, 1.0, 0.0);
    assert!((see(Vec3::x()).seen - 0.5).abs() < 1e-15);
    assert!((see(corner).seen - 0.5 * 2_f64.sqrt()).abs() < 1e-15);
    assert!((see(Vec3::z()).seen - 1.0).abs() < 1e-15);
    assert!((see(corner).area - 3.0).abs() < 1e-15);
}
