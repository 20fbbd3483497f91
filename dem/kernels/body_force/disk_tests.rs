use super::*;
use crate::tables::rows;
use nalgebra::UnitQuaternion;

/// Table checked to 4e-8 by slicing in another direction.
#[test]
fn disks_are_cut_exactly() {
    let table = rows(include_str!("../../tests/data/water/disks.csv"));
    assert_eq!(table.len(), 16);
    let mut worst = [0.0_f64; 2];
    for (_, row) in table {
        let [big, r, tilt, z, volume, x, down] = [0, 1, 2, 3, 4, 5, 6].map(|k| row[k]);
        let q = UnitQuaternion::from_axis_angle(&Vec3::y_axis(), tilt);
        let up = q.inverse_transform_vector(&Vec3::z());
        let wet = below([big, r], &up, -z, &Vec3::x());
        let arm = q * wet.arm;
        worst[0] = worst[0].max((wet.volume - volume).abs());
        worst[1] = worst[1].max((arm - Vec3::new(x, 0.0, down - z)).norm());
    }
    println!("volume off by {:.1e} m³, centre by {:.1e} m", worst[0], worst[1]);
    // Digits of the table: volume nine, centre eight.
    assert!(worst[0] < 1e-8 && worst[1] < 1e-7, "{worst:?}");
}

#[test]
fn parts_add_up() {
    let (big, r) = (0.7, 0.12);
    let own = crate::shape::dilated::Dilated::disk(big, r).unwrap();
    let mut random = crate::base::random::Random::new(2, 1);
    for k in 0..200 {
        let up = random.orientation() * Vec3::z();
        let up = if k == 0 { Vec3::z() } else { up };
        let along = random.orientation() * Vec3::z();
        let level = (2.0 * random.uniform() - 1.0) * (big * libm::hypot(up.x, up.y) + r);
        let one = below([big, r], &up, level, &along);
        let two = below([big, r], &-up, -level, &along);
        assert!((one.volume + two.volume - own.volume).abs() < 1e-9 * own.volume, "{up} {level}");
        assert!((one.area + two.area - own.area).abs() < 1e-6 * own.area);
        assert!((one.arm * one.volume + two.arm * two.volume).norm() < 1e-9);
        let whole = below([big, r], &up, 10.0, &along);
        let tilt = along.z.abs();
        let around: f64 = (0..2000)
            .map(|k| {
                let (s, c) = libm::sincos(TAU * f64::from(k) / 2000.0);
                libm::hypot(s, c * tilt)
            })
            .sum::<f64>()
            * big
            * TAU
            / 2000.0;
        let shadow = PI * big * big * tilt + r * around + PI * r * r;
        assert!((whole.seen / shadow - 1.0).abs() < 4e-3, "{} {shadow}", whole.seen);
    }
}
