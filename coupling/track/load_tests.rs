use super::*;

fn load(waveform: Waveform) -> CyclicLoad {
    CyclicLoad { waveform, cycles: 3, rest: 0.1, ramp: 0.2, seating: None, places: vec![0.0, 0.6, 1.2] }
}

fn wave(sine: bool) -> CyclicLoad {
    load(Waveform::Wave { sine, minimum: 5.0, maximum: 65.0, frequency: 10.0 })
}

/// Largest value of f and its position.
fn peak(f: impl Fn(f64) -> f64, from: f64, to: f64) -> [f64; 2] {
    let n = 200_000;
    let at = |i: i32| from + (to - from) * f64::from(i) / f64::from(n);
    (0..=n).map(|i| [f(at(i)), at(i)]).fold([f64::NEG_INFINITY; 2], |a, b| if b[0] > a[0] { b } else { a })
}

fn area(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let n = 200_000;
    let h = (to - from) / f64::from(n);
    (0..n).map(|i| h * f(from + (f64::from(i) + 0.5) * h)).sum()
}

#[test]
fn haversine_peaks_at_half_cycle() {
    let f = wave(false);
    assert_eq!(f.on(0, 0.05), 0.0);
    assert!((f.on(0, 0.2) - 2.5).abs() < 1e-12, "half way up the ramp to the minimum");
    assert!((f.on(0, 0.3) - 5.0).abs() < 1e-12);
    assert!((f.on(2, 0.35) - 65.0).abs() < 1e-9);
    assert!((f.end() - 0.6).abs() < 1e-12);
}

#[test]
fn sine_starts_at_mean() {
    let f = wave(true);
    assert!((f.on(0, 0.3) - 35.0).abs() < 1e-9);
    assert!((f.on(0, 0.325) - 65.0).abs() < 1e-9);
    assert!((f.on(0, 0.375) - 5.0).abs() < 1e-9);
}

/// Area: minimum · T + range · (rise/2 + hold + fall/2).
#[test]
fn ramp_hold_and_unload() {
    let ramp = |fall| Waveform::Ramp { minimum: 2.0, maximum: 10.0, rise: 0.2, hold: 0.3, fall };
    let f = load(ramp(Some(0.1)));
    assert!((f.period() - 0.6).abs() < 1e-15);
    assert!((f.on(1, 0.4) - 6.0).abs() < 1e-12 && f.on(1, 0.65) == 10.0);
    let found = area(|t| f.on(0, t), 0.3, 0.9);
    assert!((found - (2.0 * 0.6 + 8.0 * 0.45)).abs() < 1e-6, "{found}");
    assert!((f.on(0, 0.9) - 2.0).abs() < 1e-9 && (f.on(0, f.end() + 1.0) - 2.0).abs() < 1e-12, "unloaded");
    let stays = CyclicLoad { cycles: 1, ..load(ramp(None)) };
    assert_eq!(stays.on(0, 10.0), 10.0);
}

#[test]
fn measured_forces_run_along() {
    let points = vec![(0.0, 0.0), (0.1, 50.0), (0.2, -10.0), (0.3, 0.0)];
    let f = load(Waveform::Measured { points: points.clone(), speed: Some(12.0) });
    assert!((f.period() - 0.4).abs() < 1e-15);
    for cycle in 0..3 {
        let t = 0.3 + 0.4 * f64::from(cycle);
        assert!((f.on(0, t + 0.05) - 25.0).abs() < 1e-9);
        assert!((f.on(1, t + 0.1) - 25.0).abs() < 1e-9);
        assert!((f.on(2, t + 0.3) + 10.0).abs() < 1e-9, "a force that lifts");
    }
    let at_once = load(Waveform::Measured { points, speed: None });
    assert_eq!(at_once.on(0, 0.41), at_once.on(2, 0.41));
    assert!((at_once.period() - 0.3).abs() < 1e-15);
}

fn pass(spread: AxleSpread, axles: Vec<[f64; 2]>, speed: f64) -> CyclicLoad {
    let reach = spread.reach();
    let last = axles.last().unwrap()[0];
    load(Waveform::Pass(Pass {
        speed,
        axles,
        begin: -reach,
        distance: 1.2 + 2.0 * reach + last,
        spread,
        waves: Vec::new(),
    }))
}

/// Pulses A exp(−(vt/ℓ)²): peak A, area A √π ℓ/v, delay 0.6/v.
#[test]
fn gaussian_pulses() {
    let f = pass(AxleSpread::Gauss(0.7), vec![[0.0, 40.0], [7.5, 40.0]], 20.0);
    let first = 0.3 + 2.1 / 20.0;
    for k in 0..3 {
        let [force, at] = peak(|t| f.on(k, t), first - 0.05, first + 0.2);
        assert!((force - 40.0).abs() < 1e-6 && (at - first - 0.03 * k as f64).abs() < 1e-4, "{force} {at}");
        let both = area(|t| f.on(k, t), 0.3, 0.3 + f.period());
        assert!((both / (2.0 * 40.0 * PI.sqrt() * 0.7 / 20.0) - 1.0).abs() < 1e-4, "{both}");
    }
}

/// M-shaped if β times half the wheelbase exceeds about 1.2.
#[test]
fn a_bogie_is_m_shaped() {
    let w = Winkler::new(6.4e6, 40e6, 0.6);
    let (p, v, base) = (70e3, 50.0, 2.5);
    let f = pass(AxleSpread::Winkler(w), vec![[0.0, p], [base, p]], v);
    let both = area(|t| f.on(1, t), 0.3, 0.3 + f.period());
    assert!((both / (2.0 * p * 0.6 / v) - 1.0).abs() < 1e-3, "{both}");
    let over = 0.3 + (w.reach() + 0.6) / v;
    let [first, at] = peak(|t| f.on(1, t), over - 0.01, over + 0.01);
    let [second, then] = peak(|t| f.on(1, t), over + base / v - 0.01, over + base / v + 0.01);
    let middle = f.on(1, over + 0.5 * base / v);
    let alone = p * w.share(0.0);
    assert!((first / (alone + p * w.share(base)) - 1.0).abs() < 5e-3, "{first} {alone}");
    assert!((first - second).abs() < 1e-3 && (then - at - base / v).abs() < 2e-3, "{at} {then}");
    assert!(
        (middle - 2.0 * p * w.share(0.5 * base)).abs() < 1e-6 && middle < 0.9 * first,
        "{middle} {first}"
    );
}

#[test]
fn an_uneven_rail_swings_the_load() {
    let (v, wave) = (200.0 / 3.6, TAU / 10.0 * 200.0 / 3.6);
    let mut f = pass(AxleSpread::Beam { ends: [-12.0, 13.2], taper: 1.2 }, vec![[0.0, 140e3]], v);
    let Waveform::Pass(p) = &mut f.waveform else { panic!() };
    (p.begin, p.distance) = (-12.0, 25.2);
    p.waves = vec![[750.0 * 3.5e-3 * wave * wave, 10.0]];
    assert!((p.waves[0][0] - 3198.5).abs() < 1.0, "{:?}", p.waves);
    let mut wheels = Vec::new();
    for (x, sine) in [(2.5, 1.0), (5.0, 0.0), (7.5, -1.0)] {
        f.wheels(0.3 + (x + 12.0) / v, 2, &mut wheels);
        assert!((wheels[0].at - x).abs() < 1e-9);
        assert!((wheels[0].force - 70e3 - 0.5 * 3198.5 * sine).abs() < 1.0, "{wheels:?}");
    }
    // Ramp over the first 1.2 m; no wheels before and after the pass.
    f.wheels(0.3 + 0.6 / v, 1, &mut wheels);
    assert!((wheels[0].force / 70e3 - 1.0).abs() < 0.06, "{wheels:?}");
    f.wheels(0.2, 1, &mut wheels);
    assert!(wheels.is_empty());
    f.wheels(f.end() + 1e-6, 1, &mut wheels);
    assert!(wheels.is_empty());
}

#[test]
fn peak_of_a_cycle_is_found() {
    for (sine, at) in [(true, 0.025), (false, 0.05)] {
        assert!((wave(sine).peak_in_cycle(1) - at).abs() < 1e-12);
    }
    let f = load(Waveform::Ramp { minimum: 0.0, maximum: 10.0, rise: 0.3, hold: 0.2, fall: Some(0.5) });
    assert!((f.peak_in_cycle(0) - 0.3).abs() < 1e-3);
    let measured = Waveform::Measured { points: vec![(0.0, 0.0), (0.4, 9.0), (1.0, 0.0)], speed: Some(6.0) };
    assert!((load(measured).peak_in_cycle(2) - 0.6).abs() < 1e-3);
}
