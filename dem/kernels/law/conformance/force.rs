//! Force, restitution, symmetry, contact history.

use super::{GLASS, MASS, Path, RADIUS, law, plain};
use crate::base::Vec3;
use crate::law::material::Material;
use crate::law::{ContactGeometry, ContactLaw, History, NO_CONTACT};
use nalgebra::Rotation3;

fn touch(overlap: f64) -> ContactGeometry {
    ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap, radius: RADIUS }
}

pub fn no_force_at_zero_overlap<L: ContactLaw>(material: &Material) {
    let law = plain::<L>(material, 0.5);
    let still = Vec3::zeros();
    for rate in [NO_CONTACT, law.initial_state(0.0)] {
        let mut history = History { rate, ..History::NONE };
        let f = law.evaluate_one(1.0 / MASS, &touch(0.0), &still, &still, &mut history, 1e-5);
        assert_eq!(f.force.norm(), 0.0, "{f:?}");
        assert_eq!((f.dashpot, f.friction), (0.0, 0.0));
        assert!(history.spring.norm() == 0.0 && history.rate.is_finite());
    }
    let nothing = (0.0, 0.0);
    assert_eq!(law.stored(0.0, RADIUS, &History::NONE), nothing);
    assert_eq!(law.springs(0.0, RADIUS, &History::NONE).0, 0.0);
}

/// Central impact: prescribed restitution to 0.5 % at any speed.
pub fn restitution_at_any_speed<L: ContactLaw>(material: &Material) {
    for wanted in [0.2, 0.5, 0.8, 1.0] {
        let law = plain::<L>(material, wanted);
        for speed in [0.01, 0.1, 1.0] {
            let (mut low, mut high) = (0.0, RADIUS);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let stored =
                    law.stored(middle, RADIUS, &History { rate: law.initial_state(0.0), ..History::NONE }).0;
                *if stored > 0.5 * MASS * speed * speed { &mut high } else { &mut low } = middle;
            }
            let dt = 0.005 * (MASS / law.stiffness(low, RADIUS)).sqrt();
            let (mut d, mut v) = (0.37 * speed * dt, speed);
            let mut history = History::NONE;
            while d > 0.0 {
                let velocity = Vec3::new(0.0, 0.0, -v);
                let f = law.evaluate_one(1.0 / MASS, &touch(d), &velocity, &Vec3::zeros(), &mut history, dt);
                v -= f.force.z / MASS * dt;
                d += v * dt;
                if f.normal == 0.0 && v < 0.0 {
                    break;
                }
            }
            let found = -v / speed;
            let kept = if wanted == 1.0 { kept(material, speed) } else { wanted };
            if wanted < 1.0 && material.corner_strength.is_finite() {
                assert!(found < wanted * (1.0 + 5e-3), "at most {wanted} at {speed} m/s, found {found}");
            } else {
                assert!((found / kept - 1.0).abs() < 5e-3, "wanted {kept} at {speed} m/s, found {found}");
            }
        }
    }
}

/// Restitution of a crushing impact: energy stored at the largest tip radius over initial energy.
fn kept(m: &Material, speed: f64) -> f64 {
    let Some(young) = m.young.filter(|_| m.corner_strength.is_finite()) else { return 1.0 };
    let modulus = 0.5 * young / (1.0 - m.poisson * m.poisson);
    let h = (0.5 * std::f64::consts::PI * m.corner_strength / modulus).powi(2);
    let k = (1.0 - m.corner_angle.sin()) / m.corner_angle.sin();
    let c = 4.0 / 3.0 * modulus * h.powf(1.5);
    let (before, first) = (0.5 * MASS * speed * speed, 0.4 * c * h * RADIUS.powi(3));
    if before <= first {
        return 1.0;
    }
    let cube = RADIUS.powi(3) + 3.0 * (before - first) / (c * (h + k));
    (0.4 * c * h * cube / before).sqrt()
}

pub fn partners_are_alike<L: ContactLaw>(material: &Material) {
    let law = law::<L>(material);
    let unlike = Material { restitution: 0.9, friction: 0.1, ..*material };
    let (one, two) = ([unlike, *material], [*material, unlike]);
    let mixed = |m: &[Material; 2], i, j| L::mix(&crate::law::material::Pair::of(m, &[], i, j));
    let spring = |l: &L| l.springs(1e-4, RADIUS, &History::NONE);
    assert_eq!(spring(&mixed(&one, 0, 1)), spring(&mixed(&one, 1, 0)));
    assert_eq!(mixed(&one, 0, 1).damping_ratio(), mixed(&two, 0, 1).damping_ratio());
    let (mut a, mut b) = (History::NONE, History::NONE);
    let path = Path { steps: 400, ..Path::USUAL };
    for m in path.moments() {
        let (force, geometry) = (m.evaluate(&law, &mut a, path.dt()), m.geometry);
        let turned = ContactGeometry { normal: -geometry.normal, ..geometry };
        let other = law.evaluate_one(1.0 / MASS, &turned, &-m.velocity, &-m.spin, &mut b, path.dt());
        assert_eq!(other.force, -force.force);
        assert_eq!(other.moment, -force.moment);
        assert_eq!((other.normal, other.dashpot), (force.normal, force.dashpot));
        assert_eq!(a.turned(), b);
    }
}

pub fn rotation_of_everything_rotates_the_force<L: ContactLaw>(material: &Material) {
    let law = law::<L>(material);
    let path = Path { steps: 400, ..Path::USUAL };
    let q = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let (mut a, mut b) = (History::NONE, History::NONE);
    let mut largest = 0.0_f64;
    for m in path.moments() {
        let force = m.evaluate(&law, &mut a, path.dt());
        let turned = ContactGeometry { normal: q * m.geometry.normal, ..m.geometry };
        let (velocity, spin) = (q * m.velocity, q * m.spin);
        let other = law.evaluate_one(1.0 / MASS, &turned, &velocity, &spin, &mut b, path.dt());
        largest = largest.max(force.force.norm());
        assert!((other.force - q * force.force).norm() < 1e-9 * largest);
        assert!((other.moment - q * force.moment).norm() < 1e-9 * largest * RADIUS);
        assert!((b.spring - q * a.spring).norm() < 1e-9 * path.depth);
    }
    assert!(largest > 0.0);
}

/// Closed-form friction limit at normal force [N].
fn limit(m: &Material, normal: f64) -> f64 {
    let crushes = m.corner_strength.is_finite();
    let square = RADIUS * RADIUS * if crushes { std::f64::consts::PI } else { 1.0 };
    let added = m.asperity_friction / (1.0 + normal / (m.asperity_pressure * square));
    (m.friction + if added.is_nan() { 0.0 } else { added }) * normal
}

pub fn friction_below_its_limit<L: ContactLaw>(material: &Material) {
    let law = law::<L>(material);
    let (mut sliding, mut sticking) = (0, 0);
    for step_size in [5.0, 50.0] {
        let path = Path { step_size, ..Path::USUAL };
        let mut history = History::NONE;
        for m in path.moments() {
            let f = m.evaluate(&law, &mut history, path.dt());
            let tangential = f.force - m.geometry.normal * f.normal;
            let limit = limit(material, f.normal);
            assert!(f.normal >= 0.0 && tangential.norm() <= limit * (1.0 + 1e-9) + 1e-300);
            *if tangential.norm() > limit * (1.0 - 1e-9) { &mut sliding } else { &mut sticking } += 1;
        }
    }
    assert!(sliding > 100 && sticking > 100, "{sliding} sliding, {sticking} sticking");
}

pub fn stiffness_equals_force_gradient<L: ContactLaw>(material: &Material) {
    let law = plain::<L>(material, 0.5);
    let still = Vec3::zeros();
    for d in [1e-6, 3e-5, 2e-4] {
        let evaluated = |d: f64| {
            let mut history = History { rate: law.initial_state(0.0), ..History::NONE };
            law.evaluate_one(1.0 / MASS, &touch(d), &still, &still, &mut history, 1e-6).normal
        };
        let (force, stiffness) = law.loading(d, RADIUS);
        assert!((evaluated(d) / force - 1.0).abs() < 1e-12, "{} against {force}", evaluated(d));
        let initial_state = History { rate: law.initial_state(0.0), ..History::NONE };
        assert!((law.springs(d, RADIUS, &initial_state).0 / force - 1.0).abs() < 1e-12);
        let slope = (evaluated(1.001 * d) - evaluated(0.999 * d)) / (0.002 * d);
        assert!((slope / stiffness - 1.0).abs() < 1e-6, "{slope} against {stiffness} at {d}");
        assert!(law.stiffness(d, RADIUS) >= stiffness);
    }
    assert!(law.tangential_ratio() > 0.0 && law.tangential_ratio() < 2.0);
    let own = ["walton_braun", "conical_damage", "contact_law with D"].contains(&law.names()[0]);
    assert_eq!(
        law.initial_state(1.0),
        if own { 0.0 } else { 1.0 },
        "the approach speed is remembered but for a number of its own"
    );
    assert!(!law.sources().is_empty() && GLASS.young.is_some());
}

pub fn memory_survives_a_checkpoint<L: ContactLaw>(material: &Material) {
    let law = law::<L>(material);
    let path = Path { steps: 400, ..Path::USUAL };
    let (mut a, mut b) = (History::NONE, History::NONE);
    let mut full = 0;
    for (k, m) in path.moments().enumerate() {
        if k % 50 == 7 {
            full += usize::from(b.spring.norm() > 0.0 && [0, 1, 3].iter().all(|&t| b.turn[t] != 0.0));
            let bytes = postcard::to_stdvec(&b).unwrap();
            b = postcard::from_bytes(&bytes).unwrap();
        }
        assert_eq!(m.evaluate(&law, &mut a, path.dt()), m.evaluate(&law, &mut b, path.dt()));
    }
    assert_eq!(a, b);
    assert!(full > 3, "springs of every kind in {full} checkpoints");
}
