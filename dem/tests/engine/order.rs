//! Order of accuracy in time, and long free flight.

use crate::scene::{Run, clump, plane, stone, weightless};
use trackbed_dem::{BodyInput, Material, Shape, TimeStep, Vec3, measure};

/// Sphere oscillating on a plane: z = z₀ + A e^(−ζωt) sin(ω_d t). The half-step-old dashpot velocity acts
/// like a mass reduced by 1 − g, g = C'dt/2m; `delayed` compares with that mass.
fn swing_error(restitution: f64, steps: usize, delayed: bool) -> f64 {
    let material = Material { restitution, ..stone() };
    let mut input = weightless(material);
    let mass = 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
    let omega = (1e5_f64 / mass).sqrt();
    let end = 10.0 / omega;
    input.gravity = Vec3::new(0.0, 0.0, -1000.0);
    input.time_step = TimeStep::FixedAboveLimit(end / steps as f64);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let rest = 0.01 - mass * 1000.0 / 1e5;
    input.bodies.push(BodyInput { position: Vec3::new(0.0, 0.0, rest), ..BodyInput::default() });
    let mut run = Run::new(input);
    let zeta = trackbed_dem::law::restitution::damping_ratio(restitution);
    let lag = zeta * omega * run.model.dt();
    let share = lag / (1.0 + lag).sqrt();
    let omega = if delayed { omega / (1.0 - share).sqrt() } else { omega };
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let v0 = 5e-5 * omega;
    let before = v0 * (1.0 + zeta * omega * run.model.dt());
    run.state.set_velocity(&run.model, 0, Vec3::new(0.0, 0.0, before), Vec3::zeros());
    run.steps(steps);
    let t = run.state.time;
    let exact = rest + v0 / damped * (-zeta * omega * t).exp() * (damped * t).sin();
    (run.state.position(0).z - exact).abs() / (v0 / omega)
}

#[test]
fn second_order_without_damping() {
    let errors = [200, 400, 800].map(|n| swing_error(1.0, n, false));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "{errors:?}");
    }
}

#[test]
fn second_order_with_dashpot() {
    let errors = [400, 800, 1600].map(|n| swing_error(0.7, n, true));
    println!("with the smaller mass {errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 1.8, "{errors:?}");
    }
    let phases = [400, 800, 1600].map(|n| swing_error(0.7, n, false));
    println!("with the mass itself {phases:?}");
    for (n, error) in [400.0, 800.0, 1600.0].into_iter().zip(phases) {
        assert!(error < 1.5 * 0.122 * 10.0 / n, "{phases:?}");
    }
}

/// 10⁶ steps.
#[test]
fn free_tumbling_keeps_energy_and_momentum() {
    for shape in [Shape::Clump(clump()), Shape::Box { half: [0.1, 0.05, 0.02] }] {
        let mut input = weightless(stone());
        input.time_step = TimeStep::Fixed(1e-5);
        input.shapes = vec![shape];
        input.bodies.push(BodyInput { spin: Vec3::new(0.3, 30.0, 0.5), ..BodyInput::default() });
        let mut run = Run::new(input);
        let energy = |run: &Run| measure::energies(&run.model, &run.state).kinetic_rotation;
        let (e0, l0) = (energy(&run), measure::momentum(&run.model, &run.state).angular);
        run.steps(1_000_000);
        let drift = (energy(&run) / e0 - 1.0).abs();
        let l = measure::momentum(&run.model, &run.state).angular;
        assert!(drift < 1e-12, "energy {drift:e}");
        assert!((l - l0).norm() < 1e-14 * l0.norm());
    }
}

#[test]
fn elastic_bouncing_keeps_its_energy() {
    let mut input = weightless(Material { restitution: 1.0, friction: 0.0, ..stone() });
    input.gravity = Vec3::new(0.0, 0.0, -9.81);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.bodies.push(BodyInput { position: Vec3::new(0.0, 0.0, 0.03), ..BodyInput::default() });
    let mut run = Run::new(input);
    let energy = |run: &Run| measure::energies(&run.model, &run.state).total();
    let floor = 0.01 * 9.81 * run.model.mass(0);
    let start = energy(&run) - floor;
    let mut worst = 0.0_f64;
    for _ in 0..300_000 {
        run.step();
        worst = worst.max((energy(&run) - floor - start).abs() / start);
    }
    assert!(worst < 2e-3, "{worst:e}");
    let end = (energy(&run) - floor - start).abs() / start;
    assert!(end < 1e-3, "{end:e}");
}
