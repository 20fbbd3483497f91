use super::*;
use crate::shape::dilated::tables::rows;
use crate::shape::dilated::{Dilated, DilatedError};

/// Reference table confirmed by slices to 4e-16.
#[test]
fn disk_moments_match_table() {
    let table = include_str!("../../../tests/data/shapes/dilated_disks.csv");
    let mut compared = 0;
    for (big, row) in rows(table) {
        let big: f64 = big.parse().unwrap();
        if big == 0.0 {
            assert_eq!(Dilated::disk(big, row[0]), Err(DilatedError::Radius(0.0)));
            continue;
        }
        let own = Dilated::disk(big, row[0]).unwrap();
        let found = [own.volume, own.area, own.inertia[2], own.inertia[0]];
        for (found, exact) in found.iter().zip(&row[1..]) {
            assert!((found / exact - 1.0).abs() < 1e-13, "{big}: {found} for {exact}");
        }
        assert_eq!(own.inertia[0], own.inertia[1]);
        compared += 1;
    }
    assert!(compared >= 10, "{compared}");
}

#[test]
fn sizes_and_pictures() {
    let own = Dilated::disk(0.4, 0.1).unwrap();
    assert_eq!(own.extents(), [1.0, 1.0, 0.2]);
    assert_eq!(own.sieve_size(), 1.0);
    assert_eq!(own.bounding_radius(), 0.5);
    let (points, polygons) = own.outline();
    assert!(points.iter().all(|p| (offset_from_disk(0.4, p).norm() - 0.1).abs() < 1e-15));
    let mut volume = 0.0;
    for polygon in &polygons {
        let at = |k: usize| points[polygon[k] as usize];
        for k in 1..polygon.len() - 1 {
            volume += at(0).dot(&at(k).cross(&at(k + 1))) / 6.0;
        }
    }
    assert!(volume > 0.95 * own.volume && volume < own.volume, "{volume} {}", own.volume);
}
