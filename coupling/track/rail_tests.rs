use super::*;
use crate::influence::Winkler;
use std::f64::consts::PI;

/// 60 kg rail on pads and a bed, one sleeper modelled among 40.
pub fn input() -> RailInput {
    RailInput {
        elements: 4,
        spacing: 0.6,
        bending: 6.4e6,
        mass: 60.0,
        pad: [120e6, 40e3],
        gravity: 0.0,
        sleepers: 1,
        beyond: 20,
        sleeper_mass: 160.0,
        foundation: [40e6, 60e3],
    }
}

/// Tends to a continuous foundation with decreasing spacing.
#[test]
fn discrete_pads_tend_to_winklers_foundation() {
    let mut errors = Vec::new();
    for refine in [1, 2, 4] {
        let per = 1.0 / f64::from(refine);
        let rail = RailInput {
            spacing: 0.6 * per,
            pad: [120e6 * per, 0.0],
            foundation: [40e6 * per, 0.0],
            beyond: 20 * refine as usize,
            ..input()
        };
        let series = 30e6 * per;
        let formula = Winkler::new(6.4e6, series, rail.spacing);
        let wheels = [Wheel { at: 0.0, force: 70e3 }];
        let found = Rail::new(rail, 1e-4).unwrap().static_seats([wheels.to_vec()].into_iter()).unwrap()[0][0];
        errors.push(found / (70e3 * formula.share(0.0)) - 1.0);
    }
    println!("seat force on discrete sleepers over Winkler's, spacings 0.6, 0.3, 0.15 m: {errors:?}");
    assert!(errors[0].abs() < 0.01, "{errors:?}");
    assert!(errors[1].abs() < 0.5 * errors[0].abs() && errors[2].abs() < 0.5 * errors[1].abs(), "{errors:?}");
}

#[test]
fn sleepers_carry_the_wheel_together() {
    let rail = Rail::new(RailInput { sleepers: 9, beyond: 16, ..input() }, 1e-4).unwrap();
    for at in [2.4, 2.47, 2.7] {
        let seats = &rail.static_seats([vec![Wheel { at, force: 100.0 }]].into_iter()).unwrap()[0];
        let formula = Winkler::new(6.4e6, 30e6, 0.6);
        let beyond: f64 = (-16..25)
            .filter(|k| !(0..9).contains(k))
            .map(|k| 100.0 * formula.share(0.6 * f64::from(k) - at))
            .sum();
        assert!((seats.iter().sum::<f64>() + beyond - 100.0).abs() < 0.3, "{seats:?} {beyond}");
    }
}

#[test]
fn energy_balances_while_wheel_rolls() {
    let rail = Rail::new(RailInput { sleepers: 3, beyond: 6, gravity: 9.81, ..input() }, 5e-5).unwrap();
    let mut state = rail.laid();
    let mut scratch = RailScratch::default();
    let mut reference_energy = 0.0_f64;
    for n in 1..=4000 {
        let t = f64::from(n) * 5e-5;
        let wheels = [Wheel { at: -3.6 + 40.0 * t, force: 70e3 }, Wheel { at: -6.1 + 40.0 * t, force: 70e3 }];
        let lifts = [0.0, 2e-3 * (t / 0.05).min(1.0), 0.0];
        let seats = (0..3).map(|k| -1e-3 * (30.0 * t + f64::from(k)).sin() * (1.0 - (-t / 0.01).exp()));
        rail.step(&mut state, seats, &lifts, &wheels, (t / 0.05).min(1.0), &mut scratch);
        let e = state.energy();
        reference_energy = reference_energy.max(e.wheels.abs()).max(e.elastic);
        assert!(e.error().abs() < 1e-9 * reference_energy, "step {n}: {} of {reference_energy}", e.error());
        assert!(e.beyond >= 0.0);
    }
    assert!(reference_energy > 10.0 && state.energy().pads > 1.0, "{reference_energy} {:?}", state.energy());
}

#[test]
fn sudden_wheel_tends_to_static_force() {
    let rail = Rail::new(RailInput { beyond: 12, ..input() }, 1e-4).unwrap();
    let wheels = [Wheel { at: 0.0, force: 70e3 }];
    let mut state = rail.laid();
    let mut scratch = RailScratch::default();
    let mut seat = [0.0, 0.0];
    let (mass, bed) = (160.0, [40e6, 60e3]);
    let mut peak = 0.0_f64;
    for _ in 0..20_000 {
        // Sleeper by leapfrog on its own bed.
        let push = -state.force(0) - bed[0] * seat[0] - bed[1] * seat[1];
        seat[1] += 1e-4 * push / mass;
        seat[0] += 1e-4 * seat[1];
        rail.step(&mut state, std::iter::once(seat[0]), &[0.0], &wheels, 0.0, &mut scratch);
        peak = peak.max(state.force(0));
    }
    let expected = rail.static_seats([wheels.to_vec()].into_iter()).unwrap()[0][0];
    assert!((state.force(0) / expected - 1.0).abs() < 1e-5, "{} {expected}", state.force(0));
    assert!(peak > 1.2 * expected && peak < 2.0 * expected, "{peak} {expected}");
}

/// Rigid rail on springs: ω = √(k/(m s)); Newmark lengthens the period by (ωΔt)²/12 (Bathe 1996, section
/// 9.4).
#[test]
fn rail_on_springs_matches_frequency() {
    let stiff = RailInput {
        pad: [30e6, 0.0],
        sleeper_mass: 1e-9,
        foundation: [1e16, 0.0],
        beyond: 10,
        sleepers: 1,
        bending: 6.4e12,
        gravity: 9.81,
        ..input()
    };
    // Stiff rail of 20 bays on 21 pads.
    let (mass, k): (f64, f64) = (60.0 * 0.6 * 20.0, 21.0 * 30e6);
    let period = 2.0 * PI * (mass / k).sqrt();
    let dt = period / 40.0;
    let rail = Rail::new(stiff, dt).unwrap();
    let mut state = rail.laid();
    let mut scratch = RailScratch::default();
    let weight = mass * 9.81 / k;
    let mut crossings = Vec::new();
    let mut before = 0.0;
    for n in 1..=400 {
        rail.step(&mut state, std::iter::once(0.0), &[0.0], &[], 1.0, &mut scratch);
        let x = state.deflection(&rail, 0) + weight;
        if before > 0.0 && x <= 0.0 {
            crossings.push((f64::from(n) - x / (x - before)) * dt);
        }
        before = x;
    }
    let found = (crossings[8] - crossings[0]) / 8.0;
    let expected = period * (1.0 + (2.0 * PI / 40.0_f64).powi(2) / 12.0);
    assert!((found / expected - 1.0).abs() < 2e-4, "{found} {expected}");
}

/// m g s per sleeper.
#[test]
fn sleepers_support_rail_weight() {
    let rail = Rail::new(RailInput { sleepers: 3, beyond: 40, gravity: 9.81, ..input() }, 1e-4).unwrap();
    let seats = &rail.static_seats([Vec::new()].into_iter()).unwrap()[0];
    let expected = 60.0 * 9.81 * 0.6;
    assert!(seats.iter().all(|f| (f / expected - 1.0).abs() < 1e-9), "{seats:?} {expected}");
}

/// Immovable rail, seat displacement ½ a t²: force C a t + k a t²/2 to rounding.
#[test]
fn dashpots_use_final_seat_velocity() {
    let rail = Rail::new(RailInput { mass: 1e15, pad: [1e6, 40e3], ..input() }, 1e-4).unwrap();
    let mut state = rail.laid();
    let mut scratch = RailScratch::default();
    for n in 1..=50 {
        let t = 1e-4 * f64::from(n);
        rail.step(&mut state, std::iter::once(t * t), &[0.0], &[], 0.0, &mut scratch);
        let expected = 40e3 * 2.0 * t + 1e6 * t * t;
        // The first two steps lack earlier motion.
        assert!(
            n < 3 || (state.force(0) / expected - 1.0).abs() < 1e-9,
            "{n}: {} {expected}",
            state.force(0)
        );
    }
}

/// Limp rail on stiff pads, sudden wheel over an outside sleeper: P/k after a quarter period, twice that
/// after a half.
#[test]
fn outside_sleeper_matches_frequency() {
    let limp = RailInput {
        bending: 1e-3,
        mass: 1e-3,
        elements: 1,
        pad: [1e12, 0.0],
        foundation: [40e6, 0.0],
        ..input()
    };
    let period = 2.0 * PI * (160.0_f64 / 40e6).sqrt();
    let rail = Rail::new(limp, period / 4000.0).unwrap();
    let mut state = rail.laid();
    let mut scratch = RailScratch::default();
    let still = 1000.0 / 40e6;
    for n in 1..=2000 {
        rail.step(
            &mut state,
            std::iter::once(0.0),
            &[0.0],
            &[Wheel { at: 1.2, force: 1000.0 }],
            0.0,
            &mut scratch,
        );
        if n == 1000 || n == 2000 {
            let down = -state.line(&rail).find(|p| (p[0] - 1.2).abs() < 1e-9).unwrap()[1];
            let expected = still * f64::from(n) / 1000.0;
            assert!((down / expected - 1.0).abs() < 2e-3, "{down} {expected}");
        }
    }
}

/// A sleeper over a void hangs on the rail. Its seat rises by the gap less the stretch of the pad and the deflection of a beam on an elastic
/// foundation (Zimmermann 1888) without the support in its middle: c = c₀/(1 − s c₀), c₀ = λ/(2k), k = s/spacing.
#[test]
fn hanging_sleeper_is_carried_by_the_rail() {
    let (dt, gap, weight) = (5e-5, 2e-4, 1600.0);
    let rail = Rail::new(input(), dt).unwrap();
    let (mut state, mut scratch) = (rail.laid(), RailScratch::default());
    let (mut rise, mut speed, mut largest) = (0.0, 0.0, 0.0_f64);
    for n in 1..=20_000 {
        let share = (f64::from(n) * dt / 0.05).min(1.0);
        rail.step(&mut state, std::iter::once(rise), &[share * gap], &[], 0.0, &mut scratch);
        let force = -state.force(0) - share * weight;
        speed = (speed + dt * force / (weight / 9.81)) * (1.0 - 20.0 * dt);
        rise += dt * speed;
        largest = largest.max(state.energy().wheels.abs());
        assert!(state.energy().error().abs() < 1e-9 * largest, "step {n}: {:?}", state.energy());
    }
    let (series, stiffness) = (30e6, 30e6 / 0.6);
    let continuous = (stiffness / (4.0 * 6.4e6_f64)).powf(0.25) / (2.0 * stiffness);
    let expected = gap - weight * (1.0 / 120e6 + continuous / (1.0 - series * continuous));
    println!("rises by {rise:.4e} m, expected {expected:.4e} m of {gap:.1e} m");
    assert!(((gap - rise) / (gap - expected) - 1.0).abs() < 0.02);
}
