//! Conical damage against YADE and closed forms.

use super::*;
use crate::base::Vec3;
use crate::law::constants::Constants;
use crate::law::material::Material;
use crate::law::table::ConicalLaw;
use crate::law::{ContactGeometry, ContactLaw, History};

const GRANITE: Material = Material {
    young: Some(1e10),
    poisson: 0.2,
    corner_strength: 6e7,
    corner_angle: 85.0 * PI / 180.0,
    restitution: 1.0,
    ..Material::RIGID
};

fn law(a: &Material, b: &Material) -> ConicalDamage {
    ConicalDamage::mix(&Pair { a, b, exception: None }, 0.0)
}

/// YADE's check (`checkHertzExtended.py`, after Suhr & Six 2017): overlap, force and tip radius of a 0.1 m
/// sphere on a plane and on an equal sphere.
#[test]
fn figures_of_another_program() {
    let law = law(&GRANITE, &GRANITE);
    for (radius, overlap, force, grown) in
        [(0.1, 5.61227e-5, 459.1828, 0.1056368), (0.05, 7.43693e-5, 168.4617, 0.0639842)]
    {
        let (tip, elastic) = law.state(overlap, radius, radius);
        assert!((tip / grown - 1.0).abs() < 1e-5, "{tip} against {grown}");
        let found = law.force(overlap, radius, radius);
        assert!((found / force - 1.0).abs() < 1e-5, "{found} against {force}");
        let pressure = 2.0 * law.modulus / PI * (elastic / tip).sqrt();
        assert!((pressure / 6e7 - 1.0).abs() < 1e-5, "{pressure}");
        let (rise, n) = (1e-6 * overlap, 4000);
        let slope = (law.force(overlap + rise, radius, radius) - law.force(overlap - rise, radius, radius))
            / (2.0 * rise);
        assert!((law.loading(overlap, radius).1 / slope - 1.0).abs() < 1e-6);
        let at = |k: f64| law.force(overlap * k / f64::from(n), radius, radius);
        let work: f64 = (0..n).map(|k| at(f64::from(k) + 0.5)).sum::<f64>() * overlap / f64::from(n);
        let crushed = law.work * (tip.powi(3) - radius.powi(3));
        let gap = work - crushed - law.stored(overlap, radius, radius);
        assert!(gap.abs() < 1e-5 * work && crushed > 0.1 * work, "{gap:e} of {work:e}, {crushed:e}");
    }
}

#[test]
fn what_has_crushed_stays() {
    let law = law(&GRANITE, &GRANITE);
    let (radius, deep) = (0.1, 2e-4);
    let tip = law.state(deep, radius, radius).0;
    let left = (tip - radius) * law.slope;
    assert!(
        left > 0.5 * deep && law.force(left, radius, tip) == 0.0 && law.force(1.01 * left, radius, tip) > 0.0
    );
    let elastic = 4.0 / 3.0 * law.modulus * tip.sqrt() * (0.5 * (deep - left)).powf(1.5);
    assert!((law.force(0.5 * (deep + left), radius, tip) / elastic - 1.0).abs() < 1e-12);
    let whole = self::law(
        &Material { corner_strength: f64::INFINITY, ..GRANITE },
        &Material { corner_strength: f64::INFINITY, ..GRANITE },
    );
    assert_eq!(whole.state(deep, radius, radius), (radius, deep));
}

#[test]
fn overlaps_of_the_start_have_crushed() {
    let law = law(&GRANITE, &GRANITE);
    let (radius, deep) = (0.1, 2e-4);
    assert!(
        law.force(deep, radius, NO_CONTACT).abs() < 1e-9
            && law.stored(deep, radius, NO_CONTACT).abs() < 1e-15
    );
    let touch = |overlap, approach, remembered| {
        let fresh = remembered == NO_CONTACT;
        let touch =
            NormalInput { inverse_mass: 1.0, radius, overlap, approach, remembered, fresh, step: 1e-6 };
        <ConicalDamage as NormalLaw>::respond(&law.splat::<f64>(), &touch)
    };
    let there = touch(deep, 0.1, NO_CONTACT);
    assert!(
        (there.remembered / (radius + (deep - 1e-7) / law.slope) - 1.0).abs() < 1e-12 && there.elastic < 2.0,
        "{there:?}"
    );
    let now = touch(1e-7, 0.1, NO_CONTACT);
    assert!(
        now.remembered == radius && now.lost == 0.0 && now.elastic == law.force(1e-7, radius, radius),
        "{now:?}"
    );
}

#[test]
fn nothing_is_held_without_pressure() {
    let law = ConicalLaw::mix(&Pair { a: &GRANITE, b: &GRANITE, exception: None });
    let (mut history, still, dt) =
        (History { rate: law.initial_state(0.0), ..History::NONE }, Vec3::zeros(), 1e-5);
    let mut go = |overlap: f64, velocity: Vec3| {
        let touch = ContactGeometry { point: still, normal: Vec3::z(), overlap, radius: 0.1 };
        let f = law.evaluate_one(1.0, &touch, &velocity, &still, &mut history, dt);
        (f, history.spring.norm())
    };
    go(2e-4, still);
    let slide = Vec3::new(0.1, 0.0, 0.0);
    for _ in 0..10 {
        let (force, spring) = go(1e-4, slide);
        assert!(force.force.norm() == 0.0 && spring <= 0.1 * dt * (1.0 + 1e-12), "{force:?} {spring:e}");
    }
    let again = Vec3::new(0.0, 0.0, -1e-4 / dt);
    let (force, _) = go(2e-4, again);
    assert!(force.normal > 1.0 && force.force.x.abs() < 1e-9 * force.normal, "{force:?}");
}

#[test]
fn partners_without_corners() {
    let plate = Material { corner_strength: f64::INFINITY, corner_angle: 0.5 * PI, ..GRANITE };
    assert_eq!(law(&plate, &GRANITE), law(&GRANITE, &GRANITE));
    let rubber = Material { young: Some(5e7), ..plate };
    let soft = law(&rubber, &GRANITE);
    assert_eq!(soft.state(1e-3, 0.1, 0.1), (0.1, 1e-3));
    assert_eq!(soft.state(1e-3, 0.1, NO_CONTACT), (0.1, 1e-3), "and what overlaps at the start is elastic");
    assert!(greatest_strength(soft.modulus, GRANITE.corner_angle) < GRANITE.corner_strength);
}

#[test]
fn expected_overlaps() {
    let law = law(&GRANITE, &GRANITE);
    let (density, speed, radius) = (2650.0, 3.0, 0.05_f64);
    let expected = law.expected_overlap(&Expected { density, speed, gravity: 0.0, height: 0.0 }) * radius;
    let energy = 0.5 * 4.0 / 3.0 * PI * radius.powi(3) * density * speed * speed;
    let n = 20_000;
    let work: f64 = (0..n)
        .map(|k| law.force(expected * (f64::from(k) + 0.5) / f64::from(n), radius, radius))
        .sum::<f64>()
        * expected
        / f64::from(n);
    assert!((work / energy - 1.0).abs() < 0.01, "{work} against {energy}");
    let rest = law.expected_overlap(&Expected { density, speed: 0.0, gravity: 9.81, height: 20.0 }) * radius;
    let weight = 4.0 * radius * radius * density * 9.81 * 20.0;
    assert!((law.force(rest, radius, radius) / weight - 1.0).abs() < 1e-9);
}
