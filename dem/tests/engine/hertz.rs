//! Hertz–Mindlin contact against closed forms.

use crate::scene::{Run, pile, plane, sphere, stone, weightless};
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BodyInput, Material, PairOverride, Shape, TimeStep, Vec3, find_contacts, measure};

/// [`stone`] with elastic moduli.
pub fn elastic() -> Material {
    Material { stiffness: f64::INFINITY, young: Some(5e7), poisson: 0.25, ..stone() }
}

/// E* of two equal materials.
fn modulus() -> f64 {
    5e7 / (2.0 * (1.0 - 0.0625))
}

fn mass(radius: f64) -> f64 {
    2600.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}

fn impact(restitution: f64, speed: f64, on_plane: bool, gap: f64) -> Run {
    let mut input = weightless(Material { restitution, ..elastic() });
    input.impact_speed = Some(speed);
    if on_plane {
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01 + gap), Vec3::new(0.0, 0.0, -speed)));
    } else {
        input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.03 + gap), Vec3::new(0.0, 0.0, -speed)));
        input.bodies.push(BodyInput { scale: 2.0, ..BodyInput::default() });
    }
    Run::new(input)
}

fn through(run: &mut Run) -> f64 {
    let touching = |run: &Run| !measure::contacts(&run.model, &run.state).is_empty();
    while !touching(run) {
        run.step();
    }
    let start = run.state.time;
    while touching(run) {
        run.step();
        assert!(run.state.steps < 200_000, "the bodies never part");
    }
    run.state.time - start
}

#[test]
fn force_of_resting_overlap() {
    for (on_plane, radius) in [(true, 0.01), (false, 0.02 / 3.0)] {
        let d = 1e-4;
        let mut run = impact(0.5, 0.0, on_plane, -d);
        find_contacts(&run.model, &mut run.state, &mut run.work, &NoSurface).expect("contacts");
        let contacts = measure::contacts(&run.model, &run.state);
        let expected = 4.0 / 3.0 * modulus() * f64::sqrt(radius) * d.powf(1.5);
        assert!((contacts[0].normal_force / expected - 1.0).abs() < 1e-10);
        let stored = measure::energies(&run.model, &run.state).elastic_normal;
        let energy = 8.0 / 15.0 * modulus() * f64::sqrt(radius) * d.powf(2.5);
        assert!((stored / energy - 1.0).abs() < 1e-10);
    }
}

/// Johnson, Contact Mechanics (1985), eq. 11.24: T = 2.87 (m*²/(R* E*² v))^(1/5).
#[test]
fn time_of_an_elastic_impact() {
    for speed in [0.01, 1.0] {
        let mut run = impact(1.0, speed, false, 1e-5);
        let found = through(&mut run);
        let (a, b) = (mass(0.01), mass(0.02));
        let m = a * b / (a + b);
        let expected = 2.8682 * (m * m / (0.02 / 3.0 * modulus().powi(2) * speed)).powf(0.2);
        // One step at either end.
        let tolerance = 2.0 * run.model.dt() / expected;
        assert!((found / expected - 1.0).abs() < tolerance && tolerance < 0.1, "{found} {expected}");
        let rebound = run.state.velocity(0).z - run.state.velocity(1).z;
        assert!((rebound / speed - 1.0).abs() < 1e-3, "{rebound}");
    }
}

#[test]
fn restitution_does_not_depend_on_speed() {
    for e in [0.2, 0.5, 0.8, 0.95] {
        for speed in [0.01, 0.3, 10.0] {
            for (on_plane, gap) in [(true, 1e-5), (false, 1.37e-5), (false, 2.11e-5)] {
                let mut run = impact(e, speed, on_plane, gap);
                through(&mut run);
                let partner = if on_plane { 0.0 } else { run.state.velocity(1).z };
                let found = (run.state.velocity(0).z - partner) / speed;
                assert!((found / e - 1.0).abs() < 5e-3, "asked {e} at {speed} m/s, got {found}");
            }
        }
    }
}

/// Sliding: speed falls by μ(1 + e)v, angular velocity grows by 5/2 of it over r (Maw, Barber & Fawcett, Wear
/// 38, 1976, beyond their limit of sticking).
#[test]
fn oblique_impacts_slide_or_stick() {
    let (e, mu, v) = (0.8, 0.3, 1.0);
    for (tangential, slides) in [(3.0, true), (0.2, false)] {
        let mut input = weightless(Material { restitution: e, friction: mu, ..elastic() });
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01001), Vec3::new(tangential, 0.0, -v)));
        let mut run = Run::new(input);
        through(&mut run);
        let lost = tangential - run.state.velocity(0).x;
        let full = mu * (1.0 + e) * v;
        let spin = run.state.spin(0).y * 0.01;
        // Lever arm: radius less overlap.
        assert!((spin / (2.5 * lost) - 1.0).abs() < 0.05, "{spin} {lost}");
        if slides {
            assert!((lost / full - 1.0).abs() < 5e-3, "{lost} against {full}");
        } else {
            assert!(lost < 0.5 * full && lost > 0.0, "{lost} against {full}");
        }
    }
}

#[test]
fn ledger_of_a_settling_pile_closes() {
    let mut closure = Vec::new();
    for fraction in [0.4, 0.1] {
        let mut input = pile(4, false);
        let moduli = Material { rolling_friction: 0.1, twisting_friction: 0.05, ..elastic() };
        input.materials = vec![moduli, Material { young: None, ..moduli }];
        input.time_step = TimeStep::Auto { fraction };
        let mut run = Run::new(input);
        let energy = |run: &Run| {
            measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
                - run.state.balance.work()
        };
        let start = energy(&run);
        let momentum = measure::momentum(&run.model, &run.state);
        let mut worst = 0.0_f64;
        while run.state.time < 0.2 {
            run.step();
            if run.state.steps.is_multiple_of(50) {
                worst = worst.max((energy(&run) - start).abs());
            }
        }
        let (lost, given) = (run.state.balance.dissipated(), run.state.balance.impulse());
        assert!(lost > 0.2, "the pile must have settled, {lost}");
        let after = measure::momentum(&run.model, &run.state);
        let gap = (after.angular - momentum.angular - given.angular).norm() / given.angular.norm().max(1.0);
        assert!(gap < 1e-11, "{gap:e}");
        println!("fraction {fraction}: dissipated {lost:.4} J, {:.2e} of it not accounted for", worst / lost);
        closure.push(worst / lost);
    }
    assert!(closure[0] < 5e-3 && closure[1] < 5e-4 && closure[0] > 2.0 * closure[1], "{closure:?}");
}

#[test]
fn unequal_laws_need_pair_law() {
    let mut input = weightless(elastic());
    input.materials.push(stone());
    let error = trackbed_dem::Model::new(input.clone()).expect_err("two laws").to_string();
    assert!(error.contains("\"hertz\"") && error.contains("\"linear\""), "{error}");
    let normal = trackbed_dem::law::table::normal_named("linear");
    let stiffness = Some(1e5);
    input.contacts.push(PairOverride { a: 0, b: 1, normal, stiffness, ..PairOverride::default() });
    trackbed_dem::Model::new(input).expect("a law for every pair");
}

#[test]
fn radii_are_those_of_contacts() {
    let model = |shapes: Vec<Shape>| {
        let mut input = weightless(elastic());
        input.impact_speed = Some(1.0);
        input.time_step = TimeStep::Measured { share: 0.8, longest: f64::INFINITY, collisions: true };
        input.shapes = shapes;
        input.bodies = (0..input.shapes.len())
            .map(|k| BodyInput {
                shape: k,
                position: Vec3::new(9.0 * k as f64, 0.0, 0.0),
                ..BodyInput::default()
            })
            .collect();
        trackbed_dem::Model::new(input).expect("a good input")
    };
    let longest = |shapes: Vec<Shape>| model(shapes).longest(false);
    let stone = Shape::Sphere { radius: 0.01 };
    let sleeper = Shape::Box { half: [1.3, 0.14, 0.1] };
    assert_eq!(longest(vec![stone.clone(), sleeper.clone()]), longest(vec![stone.clone()]));
    let (with, alone) = (model(vec![stone.clone(), sleeper]), model(vec![stone]));
    assert_eq!(with.dt_limit().body, 1, "so many stones fit under the sleeper that it decides");
    assert_eq!(with.dt_limit().stiffness, alone.dt_limit().stiffness);
    let row: Vec<_> = (0..9).map(|k| ([0.015 * k as f64, 0.0, 0.0], 0.01)).collect();
    let clump = Clump::from_spheres(&row).expect("a clump");
    let mass = 2600.0 * clump.volume;
    let found = longest(vec![Shape::Clump(clump)]);
    let d = (1.25 * std::f64::consts::PI * 2600.0 / modulus()).powf(0.4) * 0.01;
    let stiffness = 2.0 * modulus() * (0.01 * d).sqrt();
    assert!((found / (0.2 * (0.5 * mass / stiffness).sqrt()) - 1.0).abs() < 1e-9, "{found:e}");
}

#[test]
fn step_follows_the_expected_overlap() {
    let dt = |speed: f64| impact(0.5, speed, true, 1e-5).model.dt();
    // d ~ v^(4/5), limit ~ d^(-1/4): 16 times the speed, step smaller by 16^(1/5).
    assert!((dt(1.0) / dt(16.0) / 16.0_f64.powf(0.2) - 1.0).abs() < 1e-9);
}
