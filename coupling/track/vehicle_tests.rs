use super::*;
use std::f64::consts::TAU;

/// Passenger vehicle of the Manchester benchmarks (Iwnicki 1998) without dampers.
fn input() -> VehicleInput {
    VehicleInput {
        body: [32e3, 1.97e6],
        bogie: [2615.0, 1476.0],
        wheelset: 1813.0,
        primary: [2.4e6, 0.0],
        secondary: [860e3, 0.0],
        wheelbase: 2.56,
        bogie_spacing: 19.0,
        gravity: 9.81,
    }
}

/// Wheelsets too heavy to move.
fn on_fixed_wheels() -> VehicleInput {
    VehicleInput { wheelset: 1e15, gravity: 0.0, ..input() }
}

#[test]
fn axles_carry_the_weight() {
    assert!((input().axle_load() - 44_482.0 * 9.81 / 4.0).abs() < 1e-6);
}

/// Error of a mode after its period in 2,000 steps, relative to its amplitude.
fn error_after_a_period(omega: f64, shape: &[(usize, f64)]) -> f64 {
    let dt = TAU / omega / 2000.0;
    let vehicle = Vehicle::new(&on_fixed_wheels(), dt).unwrap();
    let mut state = VehicleState::default();
    shape.iter().for_each(|&(k, u)| state.u[k] = u);
    let begin = state.u;
    // Consistent accelerations.
    state.a = -(vehicle.stiffness * state.u).component_div(&vehicle.mass);
    for _ in 0..2000 {
        vehicle.step(&mut state, [0.0; AXLES]);
    }
    ((state.u - begin).norm() + state.v.norm() / omega) / begin.norm()
}

/// Roots of two masses in a row: upper m on spring k, lower n on k and spring l to the ground.
fn modes([m, k]: [f64; 2], [n, l]: [f64; 2]) -> [(f64, f64); 2] {
    let (a, b, c) = (m * n, m * (k + l) + n * k, k * l);
    [-1.0, 1.0].map(|sign: f64| {
        let square = (b + sign * (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
        // Displacement of the lower mass for 1 of the upper.
        (square.sqrt(), 1.0 - m * square / k)
    })
}

#[test]
fn modes_have_closed_form_frequencies() {
    let i = input();
    let mut frequencies = Vec::new();
    for (omega, lower) in modes([i.body[0], 2.0 * i.secondary[0]], [2.0 * i.bogie[0], 4.0 * i.primary[0]]) {
        frequencies.push(omega / TAU);
        let error = error_after_a_period(omega, &[(0, 1e-3), (2, 1e-3 * lower), (4, 1e-3 * lower)]);
        assert!(error < 1e-5, "bounce {omega}: {error}");
    }
    // Body pitch by the ends of a lever of half the bogie spacing.
    let half = 0.5 * i.bogie_spacing;
    let inertia = i.body[1] / (half * half);
    for (omega, lower) in modes([inertia, 2.0 * i.secondary[0]], [2.0 * i.bogie[0], 4.0 * i.primary[0]]) {
        frequencies.push(omega / TAU);
        let error = error_after_a_period(omega, &[(1, 1e-3 / half), (2, 1e-3 * lower), (4, -1e-3 * lower)]);
        assert!(error < 1e-5, "pitch {omega}: {error}");
    }
    let omega = (i.primary[0] * i.wheelbase * i.wheelbase / (2.0 * i.bogie[1])).sqrt();
    frequencies.push(omega / TAU);
    assert!(error_after_a_period(omega, &[(3, 1e-3)]) < 1e-5);
    assert!(error_after_a_period(0.999 * omega, &[(3, 1e-3)]) > 1e-3, "the test sees 0.1 %");
    println!("bounce, pitch of body and bogies, bogie pitch: {frequencies:.2?} Hz");
    assert!((1.0..1.2).contains(&frequencies[0]), "{frequencies:?}");
}

#[test]
fn energy_balances_without_dampers() {
    let vehicle = Vehicle::new(&input(), 2e-3).unwrap();
    let mut state = VehicleState::default();
    let force = |n: usize| std::array::from_fn(|k| 109e3 * (1.0 + 0.3 * ((n * (k + 2)) as f64 * 0.1).sin()));
    let (mut work, mut before) = (0.0, [vehicle.axle_load(); AXLES]);
    for n in 1..500 {
        let (old, forces) = (state, force(n));
        vehicle.step(&mut state, forces);
        for k in 0..AXLES {
            let mean = 0.5 * (before[k] + forces[k]) - vehicle.axle_load();
            work += mean * (state.wheelset(k) - old.wheelset(k));
        }
        before = forces;
        assert!((vehicle.energy(&state) - work).abs() < 1e-9 * work.abs().max(1.0), "{n}");
    }
    assert!(work > 10.0, "{work}");
}
