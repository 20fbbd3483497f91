//! The law driven by prescribed motion.

use super::*;
use crate::base::Vec3;
use crate::law::{ContactForce, ContactGeometry};

const GLASS: Material = Material {
    density: 2500.0,
    friction: 1e3,
    restitution: 1.0,
    young: Some(6e7),
    poisson: 0.25,
    ..Material::RIGID
};
const RADIUS: f64 = 0.005;

#[test]
fn moduli_of_like_pairs_and_of_rigid_partners() {
    let like = Hertz::mix(&GLASS, &GLASS, None);
    let shear = 6e7 / 2.5;
    assert!((like.modulus - 6e7 / (2.0 * 0.9375)).abs() < 1e-6);
    assert!((like.shear - shear / (2.0 * 1.75)).abs() < 1e-6);
    let wall = Hertz::mix(&GLASS, &Material::RIGID, None);
    assert!((wall.modulus / like.modulus - 2.0).abs() < 1e-12);
    assert!((wall.shear / like.shear - 2.0).abs() < 1e-12);
    // Mindlin: tangential over normal stiffness 2(1 − ν)/(2 − ν).
    assert!((like.tangential_ratio() - 2.0 * 0.75 / 1.75).abs() < 1e-12);
    assert_eq!(Hertz::mix(&Material::RIGID, &Material::RIGID, None).tangential_ratio(), 0.0);
}

/// A contact whose overlap and tangential displacement are led along a path.
struct Led {
    law: Hertz,
    history: History,
    at: (f64, f64),
    last: ContactForce,
    work: f64,
    booked: f64,
}

impl Led {
    fn new(law: Hertz) -> Led {
        let history = History { rate: 0.0, ..History::NONE };
        Led { law, history, at: (0.0, 0.0), last: ContactForce::default(), work: 0.0, booked: 0.0 }
    }

    /// Goes to overlap `d` and displacement `s` on a straight line.
    fn go(&mut self, d: f64, s: f64) {
        let (n, dt) = (4000, 1e-3);
        let (from_d, from_s) = self.at;
        let rate = ((d - from_d) / (f64::from(n) * dt), (s - from_s) / (f64::from(n) * dt));
        for k in 1..=n {
            let part = f64::from(k) / f64::from(n);
            let overlap = from_d + (d - from_d) * part;
            let g = ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap, radius: RADIUS };
            let velocity = Vec3::new(rate.1, 0.0, -rate.0);
            let f = self.law.evaluate_one(0.1, &g, &velocity, &Vec3::zeros(), &mut self.history, dt);
            // Work that the path does on the contact, by the trapezoidal rule.
            self.work -= 0.5 * (f.force + self.last.force).dot(&velocity) * dt;
            self.booked += f.friction + f.dashpot;
            self.last = f;
        }
        self.at = (d, s);
    }

    fn stored(&self) -> f64 {
        let (normal, tangential) = self.law.stored(self.at.0, RADIUS, &self.history);
        normal + tangential
    }
}

#[test]
fn force_and_stiffness_of_hertz_and_mindlin() {
    let law = Hertz::mix(&GLASS, &GLASS, None);
    let mut led = Led::new(law);
    let d = 2e-5;
    led.go(d, 0.0);
    let normal = 4.0 / 3.0 * law.modulus * RADIUS.sqrt() * d.powf(1.5);
    assert!((led.last.normal / normal - 1.0).abs() < 1e-12);
    led.go(d, 1e-6);
    let tangential = 8.0 * law.shear * (RADIUS * d).sqrt() * 1e-6;
    assert!((led.last.force.x / -tangential - 1.0).abs() < 1e-9, "{}", led.last.force.x / tangential);
    assert!((led.law.stiffness(d, RADIUS) * d / normal - 1.5).abs() < 1e-12);
}

/// Cycles of pressing and shearing in both orders (Elata & Berryman 1996): what the path puts in is stored or booked,
/// and no cycle gives energy away.
#[test]
fn cycles_of_load_and_shear_create_no_energy() {
    let (high, low, s) = (2e-5, 5e-6, 2e-6);
    let cycles = [
        [(high, 0.0), (high, s), (low, s), (low, 0.0), (high, 0.0)],
        [(low, 0.0), (low, s), (high, s), (high, 0.0), (low, 0.0)],
    ];
    for (k, cycle) in cycles.iter().enumerate() {
        let mut led = Led::new(Hertz::mix(&GLASS, &GLASS, None));
        led.go(cycle[0].0, cycle[0].1);
        for turn in 0..3 {
            let (work, booked, stored) = (led.work, led.booked, led.stored());
            let mut most = 0.0_f64;
            for &(d, s) in &cycle[1..] {
                led.go(d, s);
                most = most.max(led.history.spring.norm());
            }
            let (work, booked) = (led.work - work, led.booked - booked);
            let gap = work - booked - (led.stored() - stored);
            assert!(booked > 0.0, "cycle {k}, {turn}: {booked:e}");
            assert!(gap.abs() < 2e-3 * booked, "cycle {k}, {turn}: {gap:e} of {booked:e}");
        }
    }
}

/// The damping that the closed form gives, against an integration of m d̈ = −max(0, F) in steps far below the time of
/// contact; at two speeds.
#[test]
fn damping_gives_the_restitution_at_any_speed() {
    for e in [0.1, 0.5, 0.9] {
        let law = Hertz::mix(&Material { restitution: e, ..GLASS }, &GLASS, None);
        for speed in [0.01, 1.0] {
            let mass = 0.002;
            let force = |d: f64, v: f64| {
                let tangent = law.stiffness(d, RADIUS);
                2.0 / 3.0 * tangent * d + DASHPOT * law.damping_ratio * (tangent * mass).sqrt() * v
            };
            let time = (mass * mass / (RADIUS * law.modulus.powi(2) * speed)).powf(0.2);
            let h = 1e-5 * time;
            // Midpoint rule; the start lies inside, where the dashpot's root is smooth.
            let (mut d, mut v) = (speed * h, speed);
            loop {
                let (dm, vm) = (d + 0.5 * h * v, v - 0.5 * h / mass * force(d, v));
                if dm <= 0.0 || force(dm, vm) <= 0.0 {
                    break;
                }
                d += h * vm;
                v -= h / mass * force(dm, vm);
            }
            assert!((-v / speed / e - 1.0).abs() < 2e-3, "asked {e} at {speed} m/s, got {}", -v / speed);
        }
    }
}
