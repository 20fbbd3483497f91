//! Bonds against closed forms: single bond, cantilever, objectivity.

use crate::scene::{Run, plane, rigid, sphere, stone, weightless};
use std::f64::consts::PI;
use trackbed_dem::bond::{
    Bond, BondDamping, BondInput, BreakMode, ContactPoint, Criterion, ParallelBond, ParallelStiffness,
    ShearStrength,
};
use trackbed_dem::measure::bond_records as records;
use trackbed_dem::{AppliedForce, BodyInput, LocalDamping, ModelInput, TimeStep, Vec3, measure};

/// Radius of the spheres [m].
const R: f64 = 0.01;

/// E = 1 GPa, strengths 0.2 and 0.4 MPa.
pub fn cement() -> ParallelBond {
    ParallelBond {
        radius_factor: 1.0,
        stiffness: ParallelStiffness::Modulus { young: 1e9, ratio: 2.5 },
        tensile_strength: 2e5,
        shear_strength: ShearStrength::Constant(4e5),
        moment_factor: 1.0,
        criterion: Criterion::Stress,
        damping: BondDamping::None,
        contact: false,
    }
}

fn section(r: f64) -> (f64, f64, f64) {
    (PI * r * r, PI * r.powi(4) / 4.0, PI * r.powi(4) / 2.0)
}

/// Drives a sphere against a fixed one along a skew direction until the bond breaks.
fn drive(
    kind: Bond,
    motion: impl Fn(Vec3, Vec3) -> (Vec3, Vec3, Vec3),
) -> (trackbed_dem::measure::BondRecord, BreakMode) {
    let n = Vec3::new(0.48, -0.6, 0.64);
    let t = n.cross(&Vec3::x()).normalize();
    let (velocity, spin, counter) = motion(n, t);
    let mut input = weightless(stone());
    let held = BodyInput { fixed: [true; 6], ..BodyInput::default() };
    input.bodies.push(BodyInput { position: n * 2.0 * R, velocity, spin, ..held.clone() });
    input.bodies.push(BodyInput { spin: counter, ..held });
    input.bond_kinds.push(kind);
    input.bonds.push(BondInput::new(0, 1, 0));
    input.time_step = TimeStep::Fixed(1e-6);
    let mut run = Run::new(input);
    let mut last = None;
    for _ in 0..200_000 {
        let now = records(&run.model, &run.state);
        if now.is_empty() {
            let breaks = run.state.take_breaks();
            assert_eq!((breaks.len(), breaks[0].bodies), (1, [0, 1]));
            return (last.expect("a record"), breaks[0].mode);
        }
        last = Some(now[0]);
        run.step();
    }
    panic!("the bond holds");
}

pub fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "found {found}, expected {expected}");
}

/// About 4000 steps to the break.
#[test]
fn single_bond_breaks_in_each_mode() {
    let (a, i, j) = section(R);
    let kind = || Bond::Parallel(cement());
    let zero = Vec3::zeros();
    // Strain at break 2e-4: 4e-6 m.
    let (r, mode) = drive(kind(), |n, _| (n * 1e-3, zero, zero));
    near(r.tension, 2e5 * a, 1e-3);
    assert_eq!(mode, BreakMode::Tension);
    let (r, mode) = drive(kind(), |_, t| (t * 5e-3, zero, zero));
    near(r.shear.norm(), 4e5 * a, 1e-3);
    assert_eq!(mode, BreakMode::Shear);
    // M R/I = 0.2 MPa.
    let (r, mode) = drive(kind(), |_, t| (zero, t * 0.05, t * -0.05));
    near(r.bending, 2e5 * i / R, 1e-3);
    assert!(r.shear.norm() < 1e-9 * r.bending / R);
    assert_eq!(mode, BreakMode::Tension);
    let (r, mode) = drive(kind(), |n, _| (zero, n * 0.5, zero));
    near(r.twisting, 4e5 * j / R, 1e-3);
    assert_eq!(mode, BreakMode::Shear);
}

/// Half the moment: twice the load. Half the radius: an eighth.
#[test]
fn moment_factor_and_radius() {
    let bend = |_: Vec3, t: Vec3| (Vec3::zeros(), t * 0.1, t * -0.1);
    let (_, i, _) = section(R);
    let (r, _) = drive(Bond::Parallel(ParallelBond { moment_factor: 0.5, ..cement() }), bend);
    near(r.bending, 2.0 * 2e5 * i / R, 2e-3);
    let (r, _) = drive(Bond::Parallel(ParallelBond { radius_factor: 0.5, ..cement() }), bend);
    near(r.bending, 2e5 * i / R / 8.0, 2e-3);
}

#[test]
fn shear_strength_grows_with_pressure() {
    let (a, _, _) = section(R);
    let shear_strength = ShearStrength::MohrCoulomb { cohesion: 4e5, friction: 0.7 };
    let kind = Bond::Parallel(ParallelBond { tensile_strength: f64::INFINITY, shear_strength, ..cement() });
    for normal in [-2e-4, 2e-4] {
        // Fixed ratio of compression (or tension) to shear.
        let (r, mode) = drive(kind.clone(), |n, t| (t * 5e-3 + n * normal, Vec3::zeros(), Vec3::zeros()));
        assert_eq!(mode, BreakMode::Shear);
        near(r.shear.norm(), 4e5 * a - 0.7 * r.tension, 1e-3);
        assert!(r.tension * normal > 0.0 && r.tension.abs() > 2.0);
    }
}

#[test]
fn criterion_by_sum() {
    let (a, _, _) = section(R);
    let kind = Bond::Parallel(ParallelBond { criterion: Criterion::Sum, ..cement() });
    let (r, _) = drive(kind, |n, t| (t * 2.5e-3 + n * 5e-4, Vec3::zeros(), Vec3::zeros()));
    let (tension, shear) = (r.tension / (2e5 * a), r.shear.norm() / (4e5 * a));
    near(tension + shear, 1.0, 1e-3);
    assert!(tension > 0.3 && shear > 0.3, "{tension} {shear}");
}

#[test]
fn contact_point_bond_has_no_moment() {
    let kind = || {
        Bond::ContactPoint(ContactPoint {
            normal: 1e7,
            shear: 4e6,
            tension_limit: 50.0,
            shear_limit: 30.0,
            damping: BondDamping::None,
            contact: false,
        })
    };
    let (r, mode) = drive(kind(), |n, _| (n * 1e-3, Vec3::zeros(), Vec3::zeros()));
    near(r.tension, 50.0, 1e-3);
    assert_eq!(mode, BreakMode::Tension);
    let (r, mode) = drive(kind(), |_, t| (t * 1e-3, Vec3::zeros(), Vec3::zeros()));
    near(r.shear.norm(), 30.0, 1e-3);
    assert_eq!(mode, BreakMode::Shear);
    let (r, _) = drive(kind(), |_, t| (Vec3::zeros(), t, Vec3::zeros()));
    assert_eq!((r.bending, r.twisting), (0.0, 0.0));
    near(r.shear.norm(), 30.0, 2e-3);
}

fn cantilever(bonds: usize, kind: ParallelBond) -> Run {
    let mut input = weightless(stone());
    for k in 0..=bonds {
        let mut body = sphere(Vec3::x() * (2.0 * R * k as f64), Vec3::zeros());
        body.fixed = [k == 0; 6];
        input.bodies.push(body);
        if k > 0 {
            input.bonds.push(BondInput::new(k - 1, k, 0));
        }
    }
    input.bond_kinds.push(Bond::Parallel(kind));
    input.time_step = TimeStep::Auto { fraction: 0.8 };
    input.damping = Some(LocalDamping { factor: 0.2 });
    Run::new(input)
}

#[test]
fn cantilever_deflects_as_a_beam() {
    let (n, load) = (10, Vec3::new(0.0, 0.3, -0.4));
    let cement =
        ParallelBond { tensile_strength: 1e9, shear_strength: ShearStrength::Constant(1e9), ..cement() };
    let mut run = cantilever(n, cement);
    let point = Vec3::x() * (2.0 * R * n as f64);
    for _ in 0..30_000 {
        run.step_under(&[AppliedForce { body: n, force: load, point }]);
    }
    assert!(measure::energies(&run.model, &run.state).kinetic() < 1e-10);
    let (a, i, _) = section(R);
    let (l, young, p) = (2.0 * R, 1e9, load.norm());
    let length = l * n as f64;
    let beam = p * length.powi(3) / (3.0 * young * i) + p * length / (young / 2.5 * a);
    let chain: f64 = (1..=n).map(|k| p * ((k as f64 - 0.5) * l).powi(2) * l / (young * i)).sum::<f64>()
        + n as f64 * p * 2.5 * l / (young * a);
    let tip = run.state.position(n) - point;
    let found = tip.dot(&load) / p;
    println!("cantilever: deflection {found:e} m, beam {beam:e} m, chain {chain:e} m");
    near(found, beam, 0.02);
    near(found, chain, 1e-3);
    assert!((tip - load * (found / p)).norm() < 1e-3 * found);
}

/// δ = Σ P (k − ½)² l²/(kₙI) + N P/(kₛA): Timoshenko's P L³/3EI + P L/kₛAl, less 1/(4N²) of the first term.
#[test]
fn cantilever_breaks_at_predicted_load() {
    let n = 10;
    let mut run = cantilever(n, cement());
    let (_, i, _) = section(R);
    let expected = 2e5 * i / R / ((n as f64 - 0.5) * 2.0 * R);
    let point = Vec3::x() * (2.0 * R * n as f64);
    let steps = 60_000;
    for k in 0..steps {
        let p = 1.1 * expected * f64::from(k) / f64::from(steps);
        run.step_under(&[AppliedForce { body: n, force: -Vec3::z() * p, point }]);
        let breaks = run.state.take_breaks();
        if let Some(first) = breaks.first() {
            println!("cantilever: breaks at {p} N, predicted {expected} N");
            assert_eq!((first.bond, first.mode), (0, BreakMode::Tension));
            return near(p, expected, 0.02);
        }
    }
    panic!("the beam holds");
}

#[test]
fn free_pair_rotates_without_shear() {
    let mut input = weightless(stone());
    let w = Vec3::new(20.0, -35.0, 50.0);
    for x in [Vec3::new(0.006, 0.0, 0.008), Vec3::new(-0.006, 0.0, -0.008)] {
        let velocity = Vec3::new(0.3, 0.1, -0.2) + w.cross(&x);
        input.bodies.push(BodyInput { spin: w, ..sphere(x, velocity) });
    }
    input.bond_kinds.push(Bond::Parallel(ParallelBond { tensile_strength: 1e9, ..cement() }));
    input.bonds.push(BondInput::new(0, 1, 0));
    input.time_step = TimeStep::Auto { fraction: 0.3 };
    let mut run = Run::new(input);
    let kinetic = measure::energies(&run.model, &run.state).kinetic();
    let mut worst = 0.0_f64;
    for _ in 0..100_000 {
        run.step();
        let r = records(&run.model, &run.state)[0];
        let k = 1e9 * PI * R * R / (2.0 * R);
        let energy = r.shear.norm_squared() / (2.0 * k / 2.5)
            + r.bending.powi(2) / (0.5 * k * R * R)
            + r.twisting.powi(2) / (0.4 * k * R * R);
        worst = worst.max(energy / kinetic);
    }
    let turned = w.norm() * run.state.time / std::f64::consts::TAU;
    println!("free pair: {turned} turns, shear, bending and twisting hold {worst:e} of the kinetic energy");
    // Residual: the stretching line of centres slows down.
    assert!(worst < 1e-6 && turned > 5.0);
}

#[test]
fn initial_motion_causes_no_slip() {
    let mut input = weightless(stone());
    input.bodies = vec![sphere(Vec3::x() * 0.02, Vec3::y() * 0.01), sphere(Vec3::zeros(), Vec3::zeros())];
    input.bond_kinds.push(Bond::Parallel(cement()));
    input.bonds.push(BondInput::new(0, 1, 0));
    let mut run = Run::new(input);
    assert_eq!(records(&run.model, &run.state)[0].shear, Vec3::zeros());
    run.step();
    let expected = 0.01 * run.model.dt() * 1e9 / 2.5 * PI * R * R / 0.02;
    near(records(&run.model, &run.state)[0].shear.norm(), expected, 1e-6);
}

#[test]
fn rejects_inputs_without_bond() {
    let base = || {
        let mut input = weightless(stone());
        input.bodies = vec![sphere(Vec3::zeros(), Vec3::zeros()), sphere(Vec3::x() * 0.02, Vec3::zeros())];
        input.bond_kinds.push(Bond::Parallel(cement()));
        input.bonds.push(BondInput::new(0, 1, 0));
        input.planes.push(plane(-Vec3::z(), Vec3::z()));
        input.materials.push(rigid(stone()));
        input
    };
    let refused = |change: fn(&mut ModelInput), part: &str| {
        let mut input = base();
        change(&mut input);
        let error = trackbed_dem::Model::new(input).expect_err(part).to_string();
        assert!(error.contains(part), "{error}");
    };
    assert!(trackbed_dem::Model::new(base()).is_ok());
    refused(|i| i.bonds[0].b = 7, "bond 0: there is no body 7");
    refused(|i| i.bonds[0].b = 0, "joins body 0 with itself");
    refused(|i| i.bonds[0].kind = 1, "no kind of bond 1");
    refused(|i| i.bonds.push(BondInput::new(1, 0, 0)), "bond 1: bodies 1 and 0 have another bond");
    refused(|i| i.bonds[0].shear = 0.0, "factors");
    refused(|i| i.bodies[1].position = Vec3::zeros(), "same centre");
    refused(|i| i.shapes[0] = trackbed_dem::Shape::Box { half: [0.01; 3] }, "body 0 is not a single sphere");
    let kind = |change: fn(&mut ParallelBond), part: &str| {
        let mut input = base();
        let mut bond = cement();
        change(&mut bond);
        input.bond_kinds[0] = Bond::Parallel(bond);
        let error = trackbed_dem::Model::new(input).expect_err(part).to_string();
        assert!(error.contains("bond kind 0") && error.contains(part), "{error}");
    };
    kind(|b| b.radius_factor = -1.0, "radius factor is -1");
    kind(|b| b.tensile_strength = 0.0, "tensile strength is 0");
    kind(|b| b.moment_factor = 1.5, "moment factor is 1.5");
    kind(|b| b.damping = BondDamping::Fraction(-0.1), "fraction of critical damping is -0.1");
    kind(|b| b.stiffness = ParallelStiffness::Modulus { young: 1e9, ratio: 0.0 }, "stiffness ratio is 0");
}

#[test]
fn step_limit_of_a_bonded_cube() {
    let cube = |time_step| {
        let mut input = weightless(stone());
        crate::bonds_many::cube(&mut input, 5, 0.0199);
        for b in &mut input.bodies {
            b.velocity = Vec3::new(b.position.x.sin(), 7.0 * b.position.z, b.position.y) * 0.01;
        }
        input.bond_kinds.push(Bond::Parallel(ParallelBond {
            tensile_strength: f64::INFINITY,
            shear_strength: ShearStrength::Constant(f64::INFINITY),
            ..cement()
        }));
        input.time_step = time_step;
        input
    };
    let limit = trackbed_dem::Model::new(cube(TimeStep::Auto { fraction: 1.0 })).unwrap().dt();
    let error = trackbed_dem::Model::new(cube(TimeStep::Fixed(1.001 * limit))).unwrap_err().to_string();
    assert!(error.contains("held by its bonds"), "{error}");
    let ring = |dt: f64, steps: usize| {
        let mut run = Run::new(cube(TimeStep::FixedAboveLimit(dt)));
        let start = measure::energies(&run.model, &run.state).total();
        for _ in 0..steps {
            if trackbed_dem::step(
                &run.model,
                &mut run.state,
                &mut run.work,
                &trackbed_dem::surface::NoSurface,
                &[],
            )
            .is_err()
            {
                return f64::INFINITY;
            }
        }
        measure::energies(&run.model, &run.state).total() / start
    };
    let quiet = ring(0.9 * limit, 20_000);
    let loud = ring(2.0 * limit, 2_000);
    println!("step limit {limit:e} s: energy after 0.9 of it {quiet}, after twice {loud:e}");
    assert!((quiet - 1.0).abs() < 0.3 && loud > 1e3, "{quiet} {loud}");
}
