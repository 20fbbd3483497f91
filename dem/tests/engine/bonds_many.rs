//! Many bonds: balances, threads, restarts, breakage.

use crate::bonds::cement;
use crate::scene::{Random, Run, plane, rigid, sphere, stone, weightless};
use trackbed_dem::bond::{
    Bond, BondDamping, BondInput, BreakMode, Criterion, DirectBond, ParallelBond, ShearStrength, within_gap,
};
use trackbed_dem::measure::{bond_records as records, force_on, fragments};
use trackbed_dem::{BodyInput, ModelInput, TimeStep, Vec3, Work, measure};

/// Cube of n³ spheres of radius 1 cm, bonded along the axes.
pub fn cube(input: &mut ModelInput, n: usize, pitch: f64) {
    for k in 0..n * n * n {
        let cell = Vec3::new((k % n) as f64, (k / n % n) as f64, (k / n / n) as f64);
        input.bodies.push(sphere(cell * pitch, Vec3::zeros()));
    }
    join(input, 0.001);
}

fn join(input: &mut ModelInput, gap: f64) {
    let spheres: Vec<_> = input.bodies.iter().map(|b| (b.position, 0.01)).collect();
    let pairs = within_gap(&spheres, gap, |_, _| true);
    input.bonds.extend(pairs.iter().map(|&[a, b]| BondInput::new(a, b, 0)));
}

/// Irregular, so that no two bonds break simultaneously by symmetry.
pub fn falling(n: usize, kind: ParallelBond, speed: f64) -> ModelInput {
    let mut input = weightless(stone());
    input.materials.push(rigid(stone()));
    cube(&mut input, n, 0.0198);
    let mut random = Random::new(5);
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, 0.3, 0.2);
    let centre = Vec3::repeat(0.0099 * (n - 1) as f64);
    let w = Vec3::new(3.0, -2.0, 4.0);
    for b in &mut input.bodies {
        let x = turn * (b.position - centre);
        b.position = x + random.vector() * 1e-4;
        b.velocity = -Vec3::z() * speed + w.cross(&x);
        b.spin = w;
    }
    let low = input.bodies.iter().map(|b| b.position.z).fold(f64::INFINITY, f64::min);
    input.planes.push(trackbed_dem::Plane { material: 1, ..plane(Vec3::z() * (low - 0.0101), Vec3::z()) });
    input.bond_kinds.push(Bond::Parallel(kind));
    input.gravity = Vec3::new(0.0, 0.0, -9.81);
    input.time_step = TimeStep::Auto { fraction: 0.2 };
    input
}

#[test]
fn energy_balance_through_impact_and_breaking() {
    let error = |fraction: f64, damping: BondDamping, criterion| {
        let kind = ParallelBond { damping, criterion, ..cement() };
        let mut run =
            Run::new(ModelInput { time_step: TimeStep::Auto { fraction }, ..falling(6, kind, 1.0) });
        let energy = |run: &Run| {
            measure::energies(&run.model, &run.state).total() - run.state.balance.work()
                + run.state.balance.dissipated()
        };
        let momentum = |run: &Run| {
            let (m, i) = (measure::momentum(&run.model, &run.state), run.state.balance.impulse());
            (m.linear - i.linear, m.angular - i.angular)
        };
        let (e0, m0) = (energy(&run), momentum(&run));
        let kinetic = measure::energies(&run.model, &run.state).kinetic();
        let mut worst = 0.0_f64;
        while run.state.time < 0.012 {
            run.step();
            if run.state.steps.is_multiple_of(20) {
                worst = worst.max((energy(&run) - e0).abs() / kinetic);
            }
        }
        let m1 = momentum(&run);
        assert!((m1.0 - m0.0).norm() < 1e-11, "{}", (m1.0 - m0.0).norm());
        assert!((m1.1 - m0.1).norm() < 1e-11, "{}", (m1.1 - m0.1).norm());
        let l = &run.state.balance;
        let (tension, shear) = run.state.broken_bonds();
        println!(
            "impact at {fraction} of the limit: error {worst:e} of the kinetic energy; bonds {:.4}, breaks {:.4}, contacts \
             {:.4}; broken {tension} + {shear} of {}",
            l.dissipated_bonds / kinetic,
            l.released_by_breaks / kinetic,
            (l.dissipated_dashpot + l.dissipated_friction) / kinetic,
            run.model.bond_count()
        );
        assert!(tension + shear > 20 && l.released_by_breaks > 1e-3 * kinetic);
        assert_eq!(run.state.bond_count() as u64 + tension + shear, run.model.bond_count() as u64);
        if damping != BondDamping::None {
            assert!(l.dissipated_bonds > 0.003 * kinetic);
        }
        worst
    };
    assert!(error(0.2, BondDamping::None, Criterion::Stress) < 2e-3);
    assert!(error(0.2, BondDamping::Fraction(0.2), Criterion::Sum) < 2e-3);
}

#[test]
fn ringing_cube_energy_is_second_order() {
    let error = |fraction: f64, damping| {
        let kind = ParallelBond {
            tensile_strength: f64::INFINITY,
            shear_strength: ShearStrength::Constant(f64::INFINITY),
            damping,
            ..cement()
        };
        let mut input = weightless(stone());
        cube(&mut input, 4, 0.02);
        let mut random = Random::new(3);
        for b in &mut input.bodies {
            let shake = random.vector() * 0.05 + Vec3::new(b.position.y, -b.position.x, b.position.z) * 0.3;
            (b.velocity, b.spin) = (shake, random.vector() * 5.0);
        }
        input.bond_kinds.push(Bond::Parallel(kind));
        input.time_step = TimeStep::Auto { fraction };
        let mut run = Run::new(input);
        let energy =
            |run: &Run| measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated();
        // The first step starts the leapfrog.
        run.step();
        let e0 = energy(&run);
        let (mut worst, kinetic) = (0.0_f64, measure::energies(&run.model, &run.state).kinetic());
        while run.state.time < 0.004 {
            run.step();
            worst = worst.max((energy(&run) - e0).abs() / kinetic);
        }
        if damping != BondDamping::None {
            assert!(run.state.balance.dissipated_bonds > 0.2 * kinetic);
        }
        worst
    };
    for damping in [BondDamping::None, BondDamping::Fraction(0.1)] {
        let errors = [0.2, 0.1, 0.05].map(|f| error(f, damping));
        println!("ringing cube, {damping:?}: errors {errors:?}");
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((1.7..2.4).contains(&order), "order {order} with {damping:?}");
        }
        assert!(errors[1] < 5e-3);
    }
}

/// To rounding.
#[test]
fn flying_cluster_keeps_its_momenta() {
    let mut input = falling(5, cement(), 1.0);
    input.planes.clear();
    input.gravity = Vec3::zeros();
    let Bond::Parallel(kind) = &mut input.bond_kinds[0] else { unreachable!() };
    kind.damping = BondDamping::Fraction(0.05);
    for b in &mut input.bodies {
        b.velocity += Vec3::new(0.4 * (b.position.x * 300.0).sin(), 0.0, 0.3);
    }
    let mut run = Run::new(input);
    let before = measure::momentum(&run.model, &run.state);
    run.steps(5200);
    let after = measure::momentum(&run.model, &run.state);
    let linear = (after.linear - before.linear).norm() / before.linear.norm();
    let angular = (after.angular - before.angular).norm() / before.angular.norm();
    println!("flying cluster: momentum changes by {linear:e}, angular momentum by {angular:e}");
    assert!(linear < 1e-12 && angular < 1e-12);
    assert!(run.state.balance.dissipated_bonds > 0.0 && run.state.bond_count() > 0);
}

fn bits(run: &mut Run) -> Vec<u64> {
    let mut out = Vec::new();
    for b in 0..run.model.body_count() {
        let v = [run.state.position(b), run.state.velocity(b), run.state.spin(b)];
        out.extend(v.iter().flat_map(|v| v.iter()).map(|x| x.to_bits()));
    }
    let l = &run.state.balance;
    out.extend([l.dissipated_dashpot, l.dissipated_bonds, l.released_by_breaks].map(f64::to_bits));
    for b in run.state.take_breaks() {
        out.extend([b.time.to_bits(), u64::from(b.bond), b.energy.to_bits()]);
    }
    out.extend(fragments(&run.model, &run.state).of.iter().map(|f| u64::from(*f)));
    out
}

pub fn crash() -> ModelInput {
    let kind = ParallelBond { damping: BondDamping::Fraction(0.1), ..cement() };
    ModelInput { time_step: TimeStep::Auto { fraction: 0.8 }, ..falling(14, kind, 3.0) }
}

#[test]
fn breakage_is_independent_of_threads() {
    let run_in = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut run = Run::new(crash());
            assert!(run.model.sphere_count() > 2500);
            let momentum = |run: &Run| {
                let (m, i) = (measure::momentum(&run.model, &run.state), run.state.balance.impulse());
                (m.linear - i.linear, m.angular - i.angular)
            };
            let before = momentum(&run);
            run.steps(700);
            let after = momentum(&run);
            assert!((after.0 - before.0).norm() < 1e-10 && (after.1 - before.1).norm() < 1e-10);
            let (searches, lists) = run.work.rebuilds();
            let (tension, shear) = run.state.broken_bonds();
            println!("crash: {tension} + {shear} broken, {searches} searches, {lists} lists");
            assert!(
                searches > 2 && lists > 5 && tension > 50 && shear > 2,
                "{searches} {lists} {tension} {shear}"
            );
            bits(&mut run)
        })
    };
    let one = run_in(1);
    for threads in [2, 3, 7] {
        assert!(one == run_in(threads), "{threads} threads differ from one");
    }
}

#[test]
fn restart_changes_nothing() {
    let mut run = Run::new(falling(6, cement(), 2.0));
    run.steps(1777);
    assert!(run.state.broken_bonds().0 > 10);
    let state = run.state.clone();
    let work = Work::new(&run.model, &state);
    let mut again = Run { model: run.model.clone(), state, work };
    run.steps(4000);
    again.steps(4000);
    assert!(bits(&mut run) == bits(&mut again), "the restart shows");
}

#[test]
fn skin_changes_nothing() {
    let run_with = |skin: f64| {
        let mut run = Run::new(ModelInput {
            skin: trackbed_dem::SearchSkin::Distance(skin),
            ..falling(6, cement(), 2.0)
        });
        run.steps(4000);
        (bits(&mut run), run.work.rebuilds())
    };
    let (a, rebuilds_a) = run_with(0.0003);
    let (b, rebuilds_b) = run_with(0.003);
    assert!(rebuilds_a.0 > rebuilds_b.0, "{rebuilds_a:?} {rebuilds_b:?}");
    assert!(a == b, "the skin shows");
}

#[test]
fn contact_takes_over_without_creating_energy() {
    // Contact over bond stiffness.
    for (ratio, expected) in [(100.0, 1.0), (0.01, 0.1)] {
        let k = 1e6;
        let material =
            trackbed_dem::Material { stiffness: ratio * k, friction: 0.0, restitution: 1.0, ..stone() };
        let mut input = weightless(material);
        let held = BodyInput { fixed: [true; 6], ..BodyInput::default() };
        // Overlap when bonded: 0.4 mm.
        input.bodies.push(BodyInput {
            position: Vec3::z() * 0.0196,
            velocity: Vec3::new(0.05, 0.0, -0.02),
            ..held.clone()
        });
        input.bodies.push(BodyInput { velocity: Vec3::zeros(), ..held });
        // Only one is fixed: a contact needs mass.
        input.bodies[1].fixed = [true, true, false, true, true, true];
        input.bond_kinds.push(Bond::Direct(DirectBond {
            stiffness: [k, k, 0.0, 0.0],
            strength: [f64::INFINITY, 20.0, f64::INFINITY, f64::INFINITY],
            criterion: Criterion::Stress,
            damping: BondDamping::None,
            contact: false,
        }));
        input.bodies[1].mass = Some(1e6);
        input.bonds.push(BondInput::new(0, 1, 0));
        input.time_step = TimeStep::FixedAboveLimit(1e-7);
        let mut run = Run::new(input);
        let mut pressure = 0.0;
        let mut stored = 0.0;
        while run.state.bond_count() == 1 {
            assert!(measure::contacts(&run.model, &run.state).is_empty(), "no contact beside the bond");
            pressure = -records(&run.model, &run.state)[0].tension;
            stored = measure::energies(&run.model, &run.state).elastic_bonds;
            run.step();
        }
        let event = run.state.take_breaks()[0];
        assert_eq!(event.mode, BreakMode::Shear);
        let contact = measure::contacts(&run.model, &run.state)[0];
        println!("contact / bond stiffness {ratio}: pressure {pressure} N, then {} N", contact.normal_force);
        assert!(pressure > 5.0);
        let elastic = 0.5 * ratio * k * contact.overlap * contact.overlap;
        assert!((ratio * k * contact.overlap / pressure - expected).abs() < 0.01 * expected.max(ratio * 0.1));
        assert!(elastic <= 0.5 * pressure * pressure / k * 1.02);
        assert!((event.energy + elastic - stored).abs() < 0.01 * stored && event.energy > 0.0);
        assert_eq!(event.energy, run.state.balance.released_by_breaks);
    }
}

#[test]
fn broken_pair_separates_and_meets_again() {
    let mut input = weightless(trackbed_dem::Material { restitution: 1.0, ..stone() });
    input.bodies.push(sphere(Vec3::zeros(), Vec3::zeros()));
    input.bodies.push(sphere(Vec3::z() * 0.019, Vec3::z() * 0.5));
    input.bond_kinds.push(Bond::Parallel(cement()));
    input.bonds.push(BondInput::new(0, 1, 0));
    let mut run = Run::new(input);
    while run.state.bond_count() == 1 {
        run.step();
    }
    let energy =
        |run: &Run| measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated();
    let start = energy(&run);
    let gap = |run: &Run| (run.state.position(1) - run.state.position(0)).norm() - 0.02;
    while gap(&run) < 0.002 {
        assert!(measure::contacts(&run.model, &run.state).is_empty());
        run.step();
    }
    for b in 0..2 {
        let v = run.state.velocity(b);
        run.state.set_velocity(&run.model, b, -v, Vec3::zeros());
    }
    let mut deepest = 0.0_f64;
    while gap(&run) < 0.003 {
        run.step();
        deepest = deepest.max(-gap(&run));
        if gap(&run) < 0.0 {
            assert_eq!(measure::contacts(&run.model, &run.state).len(), 1, "an ordinary contact");
        }
    }
    assert!(deepest > 1e-5, "{deepest:e}");
    assert!((energy(&run) - start).abs() < 1e-3 * start);
}

#[test]
fn contact_beside_the_bond() {
    let mut input = weightless(stone());
    input.bodies.push(sphere(Vec3::zeros(), Vec3::zeros()));
    input.bodies.push(sphere(Vec3::z() * 0.0199, Vec3::zeros()));
    input.bond_kinds.push(Bond::Parallel(ParallelBond { contact: true, ..cement() }));
    input.bonds.push(BondInput::new(0, 1, 0));
    let mut run = Run::new(input);
    run.step();
    assert!((measure::contacts(&run.model, &run.state)[0].normal_force - 1e5 * 1e-4).abs() < 0.5);
}

#[test]
fn force_on_a_grip() {
    let mut input = weightless(stone());
    for k in 0..4 {
        let mut b = sphere(Vec3::z() * (0.02 * f64::from(k)), Vec3::zeros());
        b.fixed = [k == 0 || k == 3; 6];
        b.velocity = if k == 3 { Vec3::z() * 1e-4 } else { Vec3::zeros() };
        input.bodies.push(b);
    }
    join(&mut input, 0.001);
    input.bond_kinds.push(Bond::Parallel(ParallelBond { damping: BondDamping::Fraction(0.3), ..cement() }));
    let mut run = Run::new(input);
    while run.state.time < 0.01 {
        run.step();
    }
    // Three springs EA/l in series.
    let stretch = run.state.position(3).z - 0.06;
    let expected = 1e9 * std::f64::consts::PI * 1e-4 / 0.06 * stretch;
    let top = force_on(&run.model, &run.state, |b| b == 3);
    assert!((top.z / -expected - 1.0).abs() < 0.01, "{top} {expected}");
    let l = &run.state.balance;
    let held = measure::energies(&run.model, &run.state).elastic_bonds;
    assert!(
        (l.work_constraints - held - l.dissipated_bonds).abs() < 0.01 * held,
        "{} {held}",
        l.work_constraints
    );
}

#[test]
fn fragments_follow_smallest_body() {
    let mut input = weightless(stone());
    for x in [0.0, 1.0, 0.02, 1.02, 5.0, 0.04] {
        input.bodies.push(sphere(Vec3::x() * x, Vec3::zeros()));
    }
    join(&mut input, 0.001);
    input.bond_kinds.push(Bond::Parallel(cement()));
    let run = Run::new(input);
    let f = fragments(&run.model, &run.state);
    assert_eq!(f.of, [0, 1, 0, 1, 2, 0]);
    assert_eq!(f.sizes, [3, 2, 1]);
}
