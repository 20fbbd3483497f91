use super::*;

#[test]
fn caps_of_a_ball() {
    let r = 0.3;
    for level in [-0.29, -0.1, 0.0, 0.12, 0.31] {
        let steps = 200_000;
        let top: f64 = f64::min(level, r);
        let dz = (top + r) / f64::from(steps);
        let (mut volume, mut moment, mut side) = (0.0, 0.0, 0.0);
        for k in 0..steps {
            let z = -r + (f64::from(k) + 0.5) * dz;
            let section = r * r - z * z;
            volume += PI * section * dz;
            moment += PI * section * z * dz;
            side += 2.0 * section.sqrt() * dz;
        }
        let found = ball(r, level, &Vec3::x());
        assert!((found.volume / volume - 1.0).abs() < 1e-8, "{level}");
        assert!((found.arm.z - moment / volume).abs() < 1e-8 * r, "{level}");
        assert!((found.seen / side - 1.0).abs() < 1e-6, "{level}");
    }
    assert_eq!(ball(r, -0.3, &Vec3::x()).volume, 0.0);
}

#[test]
fn clumps_are_their_balls() {
    let (r, far) = (0.1, 0.5);
    let whole = 2.0 * 4.0 / 3.0 * PI * r * r * r;
    let two = || [Vec3::x() * far, Vec3::x() * -far].into_iter().map(|at| (at, r));
    let half = clump(two(), whole, libm::cbrt(2.0) * r, 0.0);
    assert!((half.volume / whole - 0.5).abs() < 1e-15 && half.arm.x.abs() < 1e-15);
    let uneven = [(Vec3::x() * 0.3, 0.2), (Vec3::x() * -0.2, 0.1)];
    assert!(clump(uneven.into_iter(), 0.03, 0.2, 1.0).arm.norm() < 1e-15);
}
