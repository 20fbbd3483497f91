//! Laws under prescribed motion.

use super::*;
use crate::base::Vec3;
use crate::law::ContactGeometry;
use crate::law::material::Material;
use crate::law::table::{HertzLaw, LinearLaw};

fn pair<'a>(a: &'a Material, b: &'a Material) -> Pair<'a> {
    Pair { a, b, exception: None }
}

const GLASS: Material = Material {
    density: 2500.0,
    friction: 1e3,
    restitution: 1.0,
    young: Some(6e7),
    poisson: 0.25,
    ..Material::RIGID
};
const RADIUS: f64 = 0.005;
const SOFT: Material = Material::SOFT;

#[test]
fn moduli_against_equal_and_rigid_partner() {
    let like = HertzLaw::mix(&pair(&GLASS, &GLASS));
    let shear = 6e7 / 2.5;
    assert!((like.normal.modulus - 6e7 / (2.0 * 0.9375)).abs() < 1e-6);
    assert!((like.tangential.shear - shear / (2.0 * 1.75)).abs() < 1e-6);
    let wall = HertzLaw::mix(&pair(&GLASS, &Material::RIGID));
    assert!((wall.normal.modulus / like.normal.modulus - 2.0).abs() < 1e-12);
    assert!((wall.tangential.shear / like.tangential.shear - 2.0).abs() < 1e-12);
    assert!((like.tangential_ratio() - 2.0 * 0.75 / 1.75).abs() < 1e-12);
    assert_eq!(HertzLaw::mix(&pair(&Material::RIGID, &Material::RIGID)).tangential_ratio(), 0.0);
}

#[test]
fn hertz_mindlin_force_and_stiffness() {
    let law = HertzLaw::mix(&pair(&GLASS, &GLASS));
    let (d, dt) = (2e-5, 1e-4);
    let mut h = History { rate: 0.0, ..History::NONE };
    let velocity = Vec3::new(0.01, 0.0, 0.0);
    let f = law.evaluate_one(10.0, &touch(d), &velocity, &Vec3::zeros(), &mut h, dt);
    let normal = 4.0 / 3.0 * law.normal.modulus * RADIUS.sqrt() * d.powf(1.5);
    assert!((f.normal / normal - 1.0).abs() < 1e-12);
    let tangential = 8.0 * law.tangential.shear * (RADIUS * d).sqrt() * 1e-6;
    assert!((f.force.x / -tangential - 1.0).abs() < 1e-9, "{}", f.force.x / tangential);
    assert!((law.stiffness(d, RADIUS) * d / normal - 1.5).abs() < 1e-12);
}

#[test]
fn damping_gives_restitution() {
    for e in [0.1, 0.5, 0.9] {
        let law = HertzLaw::mix(&pair(&Material { restitution: e, ..GLASS }, &GLASS));
        for speed in [0.01, 1.0] {
            let mass = 0.002;
            let force = |d: f64, v: f64| {
                let tangent = law.stiffness(d, RADIUS);
                let dashpot = 2.0 * (5.0_f64 / 6.0).sqrt() * law.damping_ratio();
                2.0 / 3.0 * tangent * d + dashpot * (tangent * mass).sqrt() * v
            };
            let time = (mass * mass / (RADIUS * law.normal.modulus.powi(2) * speed)).powf(0.2);
            let h = 1e-5 * time;
            // Midpoint rule; starts where the dashpot's root is smooth.
            let (mut d, mut v) = (speed * h, speed);
            loop {
                let (dm, vm) = (d + 0.5 * h * v, v - 0.5 * h / mass * force(d, v));
                if dm <= 0.0 || force(dm, vm) <= 0.0 {
                    break;
                }
                d += h * vm;
                v -= h / mass * force(dm, vm);
            }
            assert!((-v / speed / e - 1.0).abs() < 2e-3, "wanted {e} at {speed} m/s, got {}", -v / speed);
        }
    }
}

fn touch(overlap: f64) -> ContactGeometry {
    ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap, radius: RADIUS }
}

#[test]
fn stiffness_against_equal_and_rigid_partner() {
    let wall = Material { stiffness: f64::INFINITY, ..SOFT };
    assert_eq!(LinearLaw::mix(&pair(&SOFT, &SOFT)).normal.stiffness, 1e5);
    assert_eq!(LinearLaw::mix(&pair(&SOFT, &wall)).normal.stiffness, 2e5);
    assert!(LinearLaw::mix(&pair(&wall, &wall)).normal.stiffness.is_infinite());
}

#[test]
fn coulomb_limit_shortens_spring() {
    let law = LinearLaw::mix(&pair(&SOFT, &SOFT));
    for k in 0..8 {
        let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
        let velocity = Vec3::new(angle.cos(), angle.sin(), 0.0);
        let mut h = History { rate: 0.0, ..History::NONE };
        let mut force = Vec3::zeros();
        for _ in 0..100 {
            force = law.evaluate_one(10.0, &touch(1e-4), &velocity, &Vec3::zeros(), &mut h, 1e-4).force;
        }
        let friction = Vec3::new(force.x, force.y, 0.0);
        assert!((friction + velocity * 5.0).norm() < 1e-12, "{friction}");
        assert!((h.spring * law.tangential.stiffness + friction).norm() < 1e-12);
    }
}

#[test]
fn spring_rotates_with_constant_length() {
    let law = LinearLaw::mix(&pair(&SOFT, &SOFT));
    let mut h = History { spring: Vec3::new(1e-6, 0.0, 0.0), rate: 0.0, ..History::NONE };
    for k in 0..=100 {
        let a = f64::from(k) * 0.01;
        let normal = Vec3::new(-a.sin(), 0.0, a.cos());
        law.evaluate_one(
            10.0,
            &ContactGeometry { normal, ..touch(1e-4) },
            &Vec3::zeros(),
            &Vec3::zeros(),
            &mut h,
            1e-4,
        );
    }
    let expected = Vec3::new(1.0_f64.cos(), 0.0, 1.0_f64.sin()) * 1e-6;
    assert!((h.spring - expected).norm() < 1e-18, "{}", h.spring);
}
