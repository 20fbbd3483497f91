//! Energy and momentum balances of whole scenes.

use crate::scene::{Random, Run, pile, plane, sphere, stone, weightless};
use trackbed_dem::balance_terms::Impulse;
use trackbed_dem::{AppliedForce, BodyInput, LocalDamping, Material, Shape, TimeStep, Vec3, measure};

fn energy_left(run: &Run) -> f64 {
    let balance = &run.state.balance;
    measure::energies(&run.model, &run.state).total() + balance.dissipated() - balance.work()
}

fn gap(run: &Run, before: &Impulse) -> (f64, f64) {
    let after = measure::momentum(&run.model, &run.state);
    let given = run.state.balance.impulse();
    let scale = run.state.balance.gravity.linear.norm().max(1e-12);
    let angular = run.state.balance.gravity.angular.norm().max(1e-12);
    (
        (after.linear - before.linear - given.linear).norm() / scale,
        (after.angular - before.angular - given.angular).norm() / angular,
    )
}

#[test]
fn ledger_of_a_settling_pile_closes() {
    let mut closure = Vec::new();
    for fraction in [0.4, 0.1] {
        let mut input = pile(4, false);
        input.time_step = TimeStep::Auto { fraction };
        let mut run = Run::new(input);
        let start = energy_left(&run);
        let momentum = measure::momentum(&run.model, &run.state);
        let mut worst = 0.0_f64;
        while run.state.time < 0.25 {
            run.step();
            if run.state.steps.is_multiple_of(50) {
                worst = worst.max((energy_left(&run) - start).abs());
            }
        }
        let lost = run.state.balance.dissipated();
        assert!(lost > 0.2, "the pile must have settled, {lost}");
        let (linear, angular) = gap(&run, &momentum);
        assert!(linear < 1e-11 && angular < 1e-11, "{linear:e} {angular:e}");
        println!(
            "fraction {fraction}: dissipated {lost:.4} J, energy not accounted for {:.2e} of it",
            worst / lost
        );
        closure.push(worst / lost);
    }
    assert!(closure[0] < 1e-3 && closure[1] < 2e-5, "{closure:?}");
    assert!(closure[0] > 4.0 * closure[1], "{closure:?}");
}

#[test]
fn ledger_with_every_source_closes() {
    let mut input = pile(4, true);
    let block = input.bodies.len() - 1;
    input.planes[1].velocity = Vec3::new(0.03, 0.01, 0.0);
    input.triangles[0].velocity = Vec3::new(0.0, 0.0, 0.02);
    input.damping = Some(LocalDamping { factor: 0.1 });
    input.bodies[7].fixed = [true, false, false, false, true, false];
    input.bodies[8].fixed = [true; 6];
    input.bodies[8].velocity = Vec3::new(0.0, 0.05, 0.0);
    input.bodies[11].fixed[5] = true;
    input.time_step = TimeStep::Auto { fraction: 0.1 };
    let mut run = Run::new(input);
    let start = energy_left(&run);
    let momentum = measure::momentum(&run.model, &run.state);
    while run.state.time < 0.15 {
        let push = AppliedForce {
            body: block,
            force: Vec3::new(1.0, 0.0, -5.0),
            point: run.state.position(block) + Vec3::new(0.03, 0.0, 0.0),
        };
        run.step_under(&[push]);
    }
    let l = run.state.balance;
    for entry in
        [l.work_applied, l.work_walls, l.work_constraints, l.dissipated_local_damping, l.dissipated_friction]
    {
        assert!(entry.abs() > 1e-5, "{l:?}");
    }
    let (linear, angular) = gap(&run, &momentum);
    assert!(linear < 1e-11 && angular < 1e-11, "{linear:e} {angular:e}");
    let open = (energy_left(&run) - start).abs() / l.dissipated();
    println!("every source: not accounted for {open:.2e}");
    assert!(open < 2e-5, "{open:e}");
    assert_eq!(run.state.velocity(8), Vec3::new(0.0, 0.05, 0.0));
}

/// Sphere between two planes: mean stress −F 2r/V.
#[test]
fn squeezed_sphere_has_its_stress() {
    let mut input = weightless(Material { tangential_damping_ratio: 1.0, restitution: 0.2, ..stone() });
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.planes.push(plane(Vec3::new(0.0, 0.0, 0.0198), -Vec3::z()));
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.00995), Vec3::zeros()));
    let mut run = Run::new(input);
    run.steps(4000);
    let contacts = measure::contacts(&run.model, &run.state);
    assert_eq!(contacts.len(), 2);
    for c in &contacts {
        assert!((c.normal_force - 10.0).abs() < 1e-6, "{c:?}");
    }
    let volume = run.model.volume(0);
    let stress = measure::mean_stress(&run.model, &run.state)[0];
    assert!((stress[2] + 10.0 * 0.0198 / volume).abs() < 1e-6 * stress[2].abs(), "{stress:?}");
    assert!(stress[0].abs() + stress[3].abs() < 1e-9 * stress[2].abs());
    assert_eq!(measure::coordination(&run.model, &run.state), 2.0);
    assert!(measure::contact_forces(&run.model, &run.state)[0].norm() < 1e-6);
}

#[test]
fn block_rests_on_spheres() {
    let mut input = weightless(Material { tangential_damping_ratio: 1.0, restitution: 0.2, ..stone() });
    input.gravity = Vec3::new(0.0, 0.0, -9.81);
    input.shapes.push(Shape::Box { half: [0.06, 0.05, 0.02] });
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    for (x, y) in [(-0.04, -0.03), (0.04, -0.03), (0.04, 0.03), (-0.04, 0.03)] {
        input.bodies.push(sphere(Vec3::new(x, y, 0.01), Vec3::zeros()));
    }
    input.bodies.push(BodyInput { shape: 1, position: Vec3::new(0.0, 0.0, 0.04), ..BodyInput::default() });
    let mut run = Run::new(input);
    while run.state.time < 0.4 {
        run.step();
    }
    let weight = run.model.mass(4) * 9.81;
    let whole = weight + 4.0 * run.model.mass(0) * 9.81;
    let contacts = measure::contacts(&run.model, &run.state);
    let on_block: f64 =
        contacts.iter().filter(|c| c.b == trackbed_dem::Partner::Body(4)).map(|c| c.normal_force).sum();
    let on_floor: f64 =
        contacts.iter().filter(|c| c.b == trackbed_dem::Partner::Plane(0)).map(|c| c.normal_force).sum();
    assert_eq!(contacts.len(), 8);
    assert!(
        (on_block / weight - 1.0).abs() < 1e-5 && (on_floor / whole - 1.0).abs() < 1e-5,
        "{on_block} {on_floor}"
    );
}

#[test]
fn pile_settles_just_below_the_limit() {
    let mut input = pile(4, true);
    input.time_step = TimeStep::Auto { fraction: 0.9 };
    let mut run = Run::new(input);
    let start = energy_left(&run);
    while run.state.time < 1.0 {
        run.step();
    }
    let e = measure::energies(&run.model, &run.state);
    let lost = run.state.balance.dissipated();
    println!(
        "0.9 of the limit: kinetic {:.2e} J, lost {lost:.3} J, open {:.2e}",
        e.kinetic(),
        energy_left(&run) - start
    );
    assert!(e.kinetic() < 1e-4 * lost, "{e:?}");
    assert!((energy_left(&run) - start).abs() < 1e-2 * lost);
}

#[test]
fn unequal_spheres_conserve_angular_momentum() {
    let mut random = Random::new(17);
    let mut input = weightless(Material { restitution: 0.8, ..stone() });
    for k in 0..2744_usize {
        let cell = Vec3::new((k % 14) as f64, (k / 14 % 14) as f64, (k / 196) as f64) - Vec3::repeat(6.5);
        let scale = if (k + k / 14 + k / 196).is_multiple_of(2) { 1.0 } else { 0.4 };
        let velocity = random.vector() * 0.5 - cell * 0.1;
        let spin = random.vector() * 50.0;
        input.bodies.push(BodyInput { scale, spin, ..sphere(cell * 0.0165, velocity) });
    }
    let mut run = Run::new(input);
    let before = measure::momentum(&run.model, &run.state).angular;
    let turning = |run: &Run| -> f64 {
        (0..run.model.body_count()).map(|b| run.model.inertia(b).x * run.state.spin(b).norm()).sum()
    };
    let scale = turning(&run);
    run.steps(1000);
    assert!(run.state.balance.dissipated_friction > 5e-5, "{:e}", run.state.balance.dissipated_friction);
    let gap = (measure::momentum(&run.model, &run.state).angular - before).norm() / scale;
    println!("angular momentum to {gap:.1e} of the sum of the spins'");
    assert!(gap < 1e-12, "{gap:e}");
}
