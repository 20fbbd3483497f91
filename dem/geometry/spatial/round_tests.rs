use super::*;
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

fn random() -> impl FnMut() -> f64 {
    let mut rng = Pcg64Mcg::new(17);
    move || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn frustum_against_sampling() {
    let mut unit = random();
    let mut parts = [0_usize; 3];
    for case in 0..400 {
        let axis = Vec3::new(unit() - 0.5, unit() - 0.5, unit() - 0.5).normalize();
        let base = Vec3::new(unit(), unit(), unit());
        let (height, radii) = match case % 4 {
            0 => (0.7, [0.4, 0.4]),
            1 => (0.6, [0.0, 0.5]),
            2 => (0.0, [0.2, 0.6]),
            _ => (unit(), [unit(), unit()]),
        };
        let patch = |far| Round::Frustum { base, axis, height, radii, far };
        let helper = axis.cross(&Vec3::new(0.3, 0.5, 0.8)).normalize();
        let other = axis.cross(&helper);
        let x = base + Vec3::new(unit() - 0.5, unit() - 0.5, unit() - 0.5) * 2.0;
        let (p, n, part) = patch(false).closest(&x);
        let mut nearest = f64::INFINITY;
        for i in 0..=40 {
            let t = f64::from(i) / 40.0;
            for j in 0..90 {
                let (sin, cos) = (f64::from(j) / 90.0 * TAU).sin_cos();
                let r = radii[0] + t * (radii[1] - radii[0]);
                let q = base + axis * (t * height) + (helper * cos + other * sin) * r;
                nearest = nearest.min((q - x).norm());
            }
        }
        let distance = (p - x).norm();
        assert!(distance <= nearest + 1e-12 && nearest - distance < 0.05, "{distance} {nearest}");
        assert!((n.norm() - 1.0).abs() < 1e-14);
        match part {
            Part::Inside => assert!(((x - p).cross(&n)).norm() < 1e-14, "{:e}", (x - p).cross(&n).norm()),
            Part::Rim(k) => {
                let z = (p - base).dot(&axis);
                assert!((z - if k == 0 { 0.0 } else { height }).abs() < 1e-14);
                assert!(((p - base - axis * z).norm() - radii[k]).abs() < 1e-14);
            }
            Part::Apex => assert!((p - base).norm() < 1e-14),
            Part::Hidden => panic!("the near side is always seen"),
        }
        parts[match part {
            Part::Inside => 0,
            Part::Rim(_) => 1,
            Part::Apex | Part::Hidden => 2,
        }] += 1;
        let (q, _, _) = patch(true).closest(&x);
        assert!((q - x).norm() >= distance - 1e-12, "the far side is not the nearer");
        let (lo, hi) = patch(false).bounds();
        assert!((0..3).all(|d| p[d] >= lo[d] - 1e-12 && p[d] <= hi[d] + 1e-12));
    }
    assert!(parts.iter().all(|&n| n > 5), "{parts:?}");
}

#[test]
fn far_side() {
    let cone =
        |far| Round::Frustum { base: Vec3::zeros(), axis: Vec3::z(), height: 1.0, radii: [0.0, 1.0], far };
    let x = Vec3::new(0.0, 0.0, 0.6);
    let (a, b) = (cone(false).closest(&x), cone(true).closest(&x));
    assert!(
        (a.0.xy() + b.0.xy()).norm() < 1e-15 && (a.0.z - 0.3).abs() < 1e-15 && (b.0.z - 0.3).abs() < 1e-15
    );
    assert_eq!(cone(true).closest(&Vec3::new(0.8, 0.0, 0.3)).2, Part::Hidden);
    let tube =
        |far| Round::Frustum { base: Vec3::zeros(), axis: Vec3::x(), height: 1.0, radii: [0.5; 2], far };
    assert_eq!(tube(true).closest(&Vec3::new(0.5, 0.7, 0.0)).2, Part::Hidden);
    let (p, n, _) = tube(true).closest(&Vec3::new(0.5, 0.2, 0.0));
    assert!((p - Vec3::new(0.5, -0.5, 0.0)).norm() < 1e-15 && (n + Vec3::y()).norm() < 1e-15);
}

#[test]
fn discs_spheres_and_what_turning_leaves() {
    let disc = Round::Disc { centre: Vec3::zeros(), axis: Vec3::z(), radius: 1.0 };
    assert_eq!(disc.closest(&Vec3::new(0.3, 0.4, 2.0)), (Vec3::new(0.3, 0.4, 0.0), Vec3::z(), Part::Inside));
    assert!((disc.closest(&Vec3::new(3.0, 4.0, 2.0)).0 - Vec3::new(0.6, 0.8, 0.0)).norm() < 1e-15);
    let ball = Round::Sphere { centre: Vec3::x(), radius: 2.0 };
    assert_eq!(ball.closest(&Vec3::new(2.0, 0.0, 0.0)).0, Vec3::new(3.0, 0.0, 0.0));
    assert_eq!(ball.closest(&Vec3::x()).0, Vec3::new(1.0, 0.0, 2.0));
    let tube = Round::Frustum { base: Vec3::x(), axis: Vec3::y(), height: 1.0, radii: [0.5; 2], far: false };
    assert!(tube.unmoved_by(&Vec3::new(1.0, 7.0, 0.0), &(Vec3::y() * 3.0)));
    assert!(!tube.unmoved_by(&Vec3::zeros(), &Vec3::y()) && !tube.unmoved_by(&Vec3::x(), &Vec3::x()));
    assert!(ball.unmoved_by(&Vec3::x(), &Vec3::z()) && !ball.unmoved_by(&Vec3::zeros(), &Vec3::z()));
}
