//! Face bonds: row of slabs against closed forms, flying pieces, errors.

use crate::bonds::near;
use crate::scene::{Random, Run, stone, weightless};
use trackbed_dem::bond::{
    Bond, BondDamping, BondInput, BreakMode, Criterion, Face, FaceBond, ParallelBond, ShearStrength,
};
use trackbed_dem::measure::bond_records as records;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{
    AppliedForce, BodyForce, BodyInput, LocalDamping, Model, ModelInput, Shape, TimeStep, Vec3, measure,
};

/// Slab width, thickness [m]; Young's modulus [Pa]; kₙ/kₛ; strength [Pa].
const W: f64 = 0.8;
const T: f64 = 0.5;
const YOUNG: f64 = 1e8;
const RATIO: f64 = 2.5;
const STRENGTH: f64 = 5e5;

fn ice() -> FaceBond {
    FaceBond {
        young: YOUNG,
        ratio: RATIO,
        tensile_strength: STRENGTH,
        shear_strength: ShearStrength::Constant(f64::INFINITY),
        criterion: Criterion::Stress,
        damping: BondDamping::None,
    }
}

fn slab(from: f64, to: f64, (gap, radius): (f64, f64), input: &mut ModelInput) {
    let half = [0.5 * (to - from) - gap - radius, 0.5 * W - radius, 0.5 * T - radius];
    let middle = Vec3::x() * (0.5 * (from + to));
    let corner = |k: usize| middle + Vec3::from_fn(|d, _| half[d] * if k >> d & 1 == 1 { 1.0 } else { -1.0 });
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    add(&corners, radius, input);
}

fn add(corners: &[Vec3], radius: f64, input: &mut ModelInput) {
    let (shape, position, orientation) = Dilated::new(corners, radius).expect("a convex body");
    let shape_number = input.shapes.len();
    input.shapes.push(Shape::Polyhedron(Box::new(shape)));
    input.bodies.push(BodyInput { shape: shape_number, position, orientation, ..BodyInput::default() });
}

fn row(kind: FaceBond) -> (ModelInput, Vec<f64>, Vec<f64>) {
    let lengths = [1.0, 0.7, 1.2, 0.6, 1.0, 0.9];
    let mut input = ModelInput { shapes: Vec::new(), ..weightless(stone()) };
    let (mut at, mut faces, mut centres) = (0.0, Vec::new(), Vec::new());
    for (k, length) in lengths.into_iter().enumerate() {
        slab(at, at + length, (0.01, 0.05), &mut input);
        input.bodies[k].fixed = [k == 0; 6];
        centres.push(at + 0.5 * length);
        at += length;
        if k + 1 < lengths.len() {
            faces.push(at);
        }
    }
    for (k, face) in faces.iter().enumerate() {
        let offset = (face - centres[k]) - (centres[k + 1] - face);
        let face = Some(Face { size: [W, T], offset });
        input.bonds.push(BondInput { face, ..BondInput::new(k, k + 1, 0) });
    }
    input.bond_kinds.push(Bond::Face(kind));
    input.time_step = TimeStep::Auto { fraction: 0.8 };
    input.damping = Some(LocalDamping { factor: 0.3 });
    (input, faces, centres)
}

/// Load P at the last centre: rotation M/(E I/l) and slip P/(E A/(r l)) per bond, a the face's lever arm, l
/// between centres: δ = Σ P a² l/(E I) + Σ P r l/(E A).
#[test]
fn slab_row_matches_beam_theory() {
    let (input, faces, centres) = row(FaceBond { tensile_strength: f64::INFINITY, ..ice() });
    let (tip, end) = (centres.len() - 1, centres[centres.len() - 1]);
    let mut run = Run::new(input);
    let (start, p) = (run.state.position(tip), 1000.0);
    for _ in 0..40_000 {
        let point = run.state.position(tip);
        run.step_under(&[AppliedForce { body: tip, force: -Vec3::z() * p, point }]);
    }
    assert!(measure::energies(&run.model, &run.state).kinetic() < 1e-9);
    let (area, second) = (W * T, W * T.powi(3) / 12.0);
    let expected: f64 = faces
        .iter()
        .zip(centres.windows(2))
        .map(|(face, pair)| {
            let l = pair[1] - pair[0];
            p * (end - face).powi(2) * l / (YOUNG * second) + p * RATIO * l / (YOUNG * area)
        })
        .sum();
    let sunk = start.z - run.state.position(tip).z;
    println!("slabs: {sunk:e} m, chain {expected:e} m");
    near(sunk, expected, 1e-4);
    let beam = p * (end - faces[0]).powi(3) / (3.0 * YOUNG * second);
    near(expected, beam, 0.5);
}

/// Beam on elastic foundation (Hetényi, Beams on Elastic Foundation, 1946), k = ρ g W, λ⁴ = k/4EI: end
/// settles by 2 P λ/k, largest moment P e^(−π/4) sin(π/4)/λ at π/4λ from the end.
#[test]
fn floating_strip_matches_elastic_foundation() {
    let (density, young, length, count) = (1025.0, 1e9, 0.5, 80);
    let water = crate::water::still(density);
    let strip = |strength: f64| {
        let mut material = stone();
        material.density = 915.0;
        let mut input =
            ModelInput { shapes: Vec::new(), gravity: Vec3::new(0.0, 0.0, -9.81), ..weightless(material) };
        for k in 0..count {
            slab(length * k as f64, length * (k + 1) as f64, (0.001, 0.02), &mut input);
            input.bodies[k].position.z = T * (0.5 - 915.0 / density);
        }
        let face = Some(Face { size: [W, T], offset: 0.0 });
        input.bonds = (1..count).map(|k| BondInput { face, ..BondInput::new(k - 1, k, 0) }).collect();
        input.bond_kinds.push(Bond::Face(FaceBond { young, tensile_strength: strength, ..ice() }));
        input.body_forces = vec![BodyForce::Water(water)];
        input.time_step = TimeStep::Auto { fraction: 0.8 };
        input.damping = Some(LocalDamping { factor: 0.3 });
        let mut run = Run::new(input);
        while run.state.time < 4.0 {
            run.step();
        }
        run
    };
    let second = W * T.powi(3) / 12.0;
    let k = density * 9.81 * W;
    let lambda = (k / (4.0 * young * second)).powf(0.25);
    let p = 500.0;
    let end = |run: &Run| run.state.position(0) - Vec3::x() * (0.5 * length);
    let mut run = strip(f64::INFINITY);
    let before = run.state.position(0).z;
    while run.state.time < 12.0 {
        let point = end(&run);
        run.step_under(&[AppliedForce { body: 0, force: -Vec3::z() * p, point }]);
    }
    let sunk = before - run.state.position(0).z;
    let at = lambda * 0.5 * length;
    let expected = 2.0 * p * lambda / k * (-at).exp() * at.cos();
    let moments: Vec<f64> = records(&run.model, &run.state).iter().map(|r| r.bending).collect();
    let largest = moments.iter().fold(0.0, |a: f64, b| a.max(*b));
    let moment = p / lambda * (-std::f64::consts::FRAC_PI_4).exp() * std::f64::consts::FRAC_PI_4.sin();
    println!("strip: sinks {sunk:e} m of {expected:e} m, moment {largest} of {moment} N m");
    near(sunk, expected, 0.02);
    near(largest, moment, 0.02);

    let strength = 5e4;
    let holds = strength * W * T * T / 6.0 / (moment / p);
    let mut run = strip(strength);
    assert_eq!(run.state.bond_count(), count - 1);
    loop {
        let load = holds * (run.state.time - 4.0) / 10.0;
        assert!(load < 1.2 * holds, "the strip holds");
        let point = end(&run);
        run.step_under(&[AppliedForce { body: 0, force: -Vec3::z() * load, point }]);
        if let Some(first) = run.state.take_breaks().first() {
            println!(
                "strip: breaks at {load} N {} m from its end, of {holds} N at {} m",
                first.place.x,
                0.785 / lambda
            );
            near(load, holds, 0.05);
            return near(first.place.x, std::f64::consts::FRAC_PI_4 / lambda, 0.25);
        }
    }
}

/// P = σ W T²/(6 a).
#[test]
fn the_row_breaks_at_its_root() {
    let (input, faces, centres) = row(ice());
    let (tip, end) = (centres.len() - 1, centres[centres.len() - 1]);
    let expected = STRENGTH * W * T * T / 6.0 / (end - faces[0]);
    let mut run = Run::new(input);
    let steps = 60_000;
    for k in 0..steps {
        let p = 1.1 * expected * f64::from(k) / f64::from(steps);
        let point = run.state.position(tip);
        run.step_under(&[AppliedForce { body: tip, force: -Vec3::z() * p, point }]);
        if let Some(first) = run.state.take_breaks().first() {
            println!("slabs: break at {p} N, predicted {expected} N");
            assert_eq!((first.bond, first.mode), (0, BreakMode::Tension));
            assert_eq!(run.state.bond_count(), faces.len() - 1);
            return near(p, expected, 0.02);
        }
    }
    panic!("the row holds");
}

/// T = τ J/b, with J and b of the section.
#[test]
fn a_twisted_bond_breaks_in_shear() {
    let tau = 3e5;
    let shear_strength = ShearStrength::Constant(tau);
    let (mut input, ..) = row(FaceBond { tensile_strength: f64::INFINITY, shear_strength, ..ice() });
    input.bodies.truncate(2);
    input.bonds.truncate(1);
    input.bodies[1].fixed = [true; 6];
    input.bodies[1].spin = Vec3::x() * 0.05;
    input.time_step = TimeStep::Fixed(1e-6);
    let mut run = Run::new(input);
    let mut last = 0.0;
    while let [now] = records(&run.model, &run.state)[..] {
        last = now.twisting;
        run.step();
    }
    let slender = T / W;
    let j = W * T.powi(3) * (1.0 / 3.0 - 0.21 * slender * (1.0 - slender.powi(4) / 12.0));
    near(last, tau * j / T, 1e-3);
    assert_eq!(run.state.take_breaks()[0].mode, BreakMode::Shear);
}

#[test]
fn flying_bonded_bodies_conserve_energy() {
    let mut random = Random::new(5);
    let mut input = ModelInput { shapes: Vec::new(), ..weightless(stone()) };
    for x in [-0.5, 0.5] {
        let corners: Vec<Vec3> = (0..12)
            .map(|_| Vec3::x() * x + random.vector().normalize().component_mul(&Vec3::new(0.35, 0.4, 0.2)))
            .collect();
        add(&corners, 0.03, &mut input);
    }
    let w = Vec3::new(2.0, -3.5, 5.0);
    for (body, push) in input.bodies.iter_mut().zip([0.02, -0.02]) {
        body.velocity = Vec3::new(0.3, 0.1, -0.2) + w.cross(&body.position) + Vec3::new(push, push, -push);
        body.spin = w + Vec3::new(-0.05, 0.02, 0.03) * push.signum();
    }
    input.bond_kinds.push(Bond::Face(FaceBond { tensile_strength: f64::INFINITY, ..ice() }));
    let face = Some(Face { size: [0.4, 0.3], offset: 0.05 });
    input.bonds.push(BondInput { face, ..BondInput::new(0, 1, 0) });
    input.time_step = TimeStep::Auto { fraction: 0.1 };
    let mut run = Run::new(input);
    let state = |run: &Run| {
        let e = measure::energies(&run.model, &run.state);
        (e.total(), e.elastic_bonds, measure::momentum(&run.model, &run.state))
    };
    for _ in 0..10 {
        run.step();
    }
    let (energy, _, momentum) = state(&run);
    let (mut worst, mut held, mut drift) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..40_000 {
        run.step();
        let (now, bonds, m) = state(&run);
        worst = worst.max((now / energy - 1.0).abs());
        held = held.max(bonds / energy);
        drift = drift.max((m.angular - momentum.angular).norm() / momentum.angular.norm());
    }
    let turned = w.norm() * run.state.time / std::f64::consts::TAU;
    println!(
        "bonded bodies: {turned} turns, energy off by {worst:e}, up to {held:e} in the bond, angular momentum by {drift:e}"
    );
    assert!(worst < 1e-4 && held > 1e-5 && drift < 1e-6 && turned > 1.0);
}

#[test]
fn what_makes_no_face_is_refused() {
    let refused = |change: &dyn Fn(&mut ModelInput), expected: &str| {
        let (mut input, ..) = row(ice());
        change(&mut input);
        let error = Model::new(input).expect_err("refused").to_string();
        assert!(error.contains(expected), "{error}");
    };
    refused(&|i| i.bonds[1].face = None, "bond 1: its face must have a size above 0");
    refused(
        &|i| i.bonds[1].face.as_mut().unwrap().size[1] = 0.0,
        "bond 1: its face must have a size above 0",
    );
    refused(&|i| i.bonds[1].face.as_mut().unwrap().offset = 2.0, "lie between the centres");
    refused(&|i| i.bond_kinds[0] = Bond::Face(FaceBond { young: 0.0, ..ice() }), "Young's modulus");
    let cement = Bond::Parallel(ParallelBond { contact: true, ..crate::bonds::cement() });
    refused(&|i| i.bond_kinds[0] = cement.clone(), "body 0 is not a single sphere");
}
