//! Drag against closed forms, with energy and momentum balances.

use crate::scene::{Run, pile, sphere, stone, weightless};
use trackbed_dem::{BodyForce, ModelInput, Shape, TimeStep, Vec3, Wind, measure};

const AIR: f64 = 1.2;

/// Seven distant spheres of three sizes: an incomplete group of four.
fn apart(wind: Wind, dt: f64) -> ModelInput {
    let mut input = weightless(stone());
    input.bodies = (0..7)
        .map(|k| {
            let mut body = sphere(Vec3::new(f64::from(k), 0.0, 0.0), Vec3::zeros());
            body.scale = 1.0 + 0.5 * f64::from(k % 3);
            body
        })
        .collect();
    input.body_forces = vec![BodyForce::Wind(wind)];
    input.time_step = TimeStep::FixedAboveLimit(dt);
    input
}

/// v = v∞ tanh(g t/v∞), v∞² = 8 r g ρₛ/(3 C ρ). First order in the step.
#[test]
fn falls_as_the_closed_form_says() {
    let wind = Wind { velocity: Vec3::zeros(), density: AIR, drag: 0.8 };
    let mut errors = Vec::new();
    for dt in [2e-4, 1e-4] {
        let mut input = apart(wind, dt);
        input.gravity = Vec3::new(0.0, 0.0, -9.81);
        let mut run = Run::new(input);
        while run.state.time < 1.5 {
            run.step();
        }
        let mut worst = 0.0_f64;
        for b in 0..7 {
            let r = 0.01 * run.model.scale(b);
            let end = (8.0 * r * 9.81 * 2600.0 / (3.0 * 0.8 * AIR)).sqrt();
            // Velocities are half a step old.
            let t = run.state.time - 0.5 * dt;
            let exact = end * (9.81 * t / end).tanh();
            worst = worst.max((-run.state.velocity(b).z / exact - 1.0).abs());
        }
        println!("dt {dt}: off by {worst:.2e}");
        errors.push(worst);
    }
    assert!(errors[1] < 5e-5 && (1.8..2.2).contains(&(errors[0] / errors[1])), "{errors:?}");
}

#[test]
fn wind_takes_stones_along() {
    let velocity = Vec3::new(12.0, -9.0, 20.0);
    let (dt, drag) = (1e-4, 1.1);
    let mut run = Run::new(apart(Wind { velocity, density: AIR, drag }, dt));
    while run.state.time < 2.0 {
        run.step();
    }
    for b in 0..7 {
        let k = 3.0 * drag * AIR / (8.0 * 0.01 * run.model.scale(b) * 2600.0) * velocity.norm();
        let t = run.state.time - 0.5 * dt;
        let exact = velocity * (k * t / (1.0 + k * t));
        let found = run.state.velocity(b);
        assert!((found - exact).norm() < 1e-4 * exact.norm(), "{b}: {found} for {exact}");
    }
}

#[test]
fn accounts_close_with_drag() {
    let mut input = pile(4, false);
    input.body_forces =
        vec![BodyForce::Wind(Wind { velocity: Vec3::new(40.0, 5.0, 0.0), density: 30.0, drag: 1.0 })];
    input.time_step = TimeStep::Auto { fraction: 0.1 };
    let mut run = Run::new(input);
    let left = |run: &Run| {
        let balance = &run.state.balance;
        measure::energies(&run.model, &run.state).total() + balance.dissipated() - balance.work()
    };
    let (start, momentum) = (left(&run), measure::momentum(&run.model, &run.state));
    while run.state.time < 0.1 {
        run.step();
    }
    let work = run.state.balance.work_body_forces;
    let (error, after) = (left(&run) - start, measure::momentum(&run.model, &run.state));
    println!("work {work:.4} J, error {error:.2e} J");
    assert!(work > 0.1 && error.abs() < 2e-4 * work, "{work} {error}");
    let given = run.state.balance.impulse();
    let gap = after.linear - momentum.linear - given.linear;
    let turn = after.angular - momentum.angular - given.angular;
    let scale = run.state.balance.body_forces.linear.norm();
    assert!(
        scale > 0.01 && gap.norm() < 1e-11 * scale && turn.norm() < 1e-11 * scale,
        "{gap} {turn} {scale}"
    );
}

/// First step from rest: ½ ρ C π r² U² with the volume-equivalent radius.
#[test]
fn clump_drag_uses_equivalent_radius() {
    let mut input = pile(3, false);
    let wind = Wind { velocity: Vec3::new(10.0, 0.0, 0.0), density: AIR, drag: 1.0 };
    input.body_forces = vec![BodyForce::Wind(wind)];
    input.bodies.iter_mut().for_each(|b| b.velocity = Vec3::zeros());
    input.planes.clear();
    input.triangles.clear();
    let mut run = Run::new(input);
    let dt = run.state.dt();
    run.step();
    let clumps = (0..run.model.body_count()).filter(|&b| matches!(run.model.shape(b), Shape::Clump(_)));
    let mut seen = 0;
    for b in clumps {
        let r = (0.75 / std::f64::consts::PI * run.model.volume(b)).cbrt();
        let force = 0.5 * AIR * std::f64::consts::PI * r * r * 100.0;
        let found = run.state.velocity(b).x * run.model.mass(b) / dt;
        assert!((found / force - 1.0).abs() < 1e-9, "{found} for {force}");
        seen += 1;
    }
    assert!(seen > 0);
}
