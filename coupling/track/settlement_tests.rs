use super::*;

/// Cycles 1 to 400 with 1 % noise, linear congruential generator (Knuth).
fn noisy(law: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    let mut seed = 12345_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let size = 0.02 * law(400.0);
    (1..=400).map(|n| [f64::from(n), law(f64::from(n)) + size * random()]).collect()
}

fn fitted(curve: &[[f64; 2]], law: &str) -> Fit {
    fits(curve, 40e3).into_iter().find(|f| f.law == law).unwrap_or_else(|| panic!("no fit of {law}"))
}

#[track_caller]
fn near(fit: &Fit, name: &str, expected: f64, share: f64) {
    let found = fit.parameter(name).unwrap();
    assert!(
        (found - expected).abs() <= share * expected.abs(),
        "{}: {name} = {found}, not {expected}",
        fit.law
    );
}

#[test]
fn parameters_of_curves_are_recovered() {
    let curve = noisy(|n| 0.005 * (1.0 + 0.3 * n.log10()));
    let fit = fitted(&curve, "Alva-Hurtado & Selig");
    near(&fit, "s1", 0.005, 0.01);
    near(&fit, "C", 0.3, 0.03);
    // Standard deviation of uniform noise: 0.02 s / sqrt 12.
    let deviation = 0.02 * curve[399][1] / 12.0_f64.sqrt();
    assert!((fit.rms_error / deviation - 1.0).abs() < 0.1, "{} against {deviation}", fit.rms_error);
    assert!(fit.r2 > 0.98 && fit.r2 < 0.999, "{}", fit.r2);
    assert_eq!((fit.range, fit.points), ([10.0, 400.0], 391));
    let hettler = fitted(&curve, "Hettler");
    near(&hettler, "C", 0.3 / std::f64::consts::LN_10, 0.03);
    near(&hettler, "r [mm/kN^1.6]", 5.0 / 40.0_f64.powf(1.6), 0.01);

    let fit = fitted(&noisy(|n| 0.004 * n.powf(0.17)), "power");
    near(&fit, "a", 0.004, 0.01);
    near(&fit, "b", 0.17, 0.01);

    let fit = fitted(&noisy(|n| 0.006 * (1.0 - (-n / 40.0).exp()) + 1e-5 * n), "Sato");
    near(&fit, "gamma", 0.006, 0.02);
    near(&fit, "alpha", 1.0 / 40.0, 0.05);
    near(&fit, "beta", 1e-5, 0.03);

    let fit = fitted(&noisy(|n| 0.002 * n.powf(0.2) + 4e-6 * n), "Shenton");
    near(&fit, "a", 0.002, 0.01);
    near(&fit, "b", 4e-6, 0.03);

    let fit = fitted(&noisy(|n| 0.004 + 3e-6 * n), "Guérin, Dahlberg");
    near(&fit, "a", 0.004, 0.02);
    near(&fit, "b", 3e-6, 0.1);
    assert_eq!(fit.range, [252.0, 400.0]);

    let late: Vec<[f64; 2]> =
        (1..=60).map(|k| f64::from(k * 500)).map(|n| [n, 0.004 + 1e-3 * (n.log10() - 2.4).powi(2)]).collect();
    let fit = fitted(&late, "Thom & Oakley");
    near(&fit, "s0", 0.004, 1e-9);
    near(&fit, "c", 1e-3, 1e-9);
    assert_eq!(fit.range, [500.0, 30000.0]);
    assert!(
        fits(&noisy(|n| 0.004 * n.powf(0.17))[..240], 40e3)
            .iter()
            .all(|f| f.range[1] < 252.0 && f.law != "Thom & Oakley" && f.law != "Guérin, Dahlberg")
    );

    let fit = fitted(&noisy(|n| 0.003 * (1.0 + 0.2 * n.log10())), "ORE D71");
    near(&fit, "s1", 0.003, 0.002);

    let fit = fitted(&noisy(|n| 0.003 * (1.0 + 0.4 * n.log10() + 0.15 * n.log10().powi(2))), "Indraratna");
    near(&fit, "s1", 0.003, 0.1);
    near(&fit, "a", 0.4, 0.4);
    near(&fit, "b", 0.3, 0.15);
}

#[test]
fn true_law_has_smallest_residual() {
    let curve = noisy(|n| 0.004 * n.powf(0.35));
    let best = fits(&curve, 1.0).into_iter().min_by(|a, b| a.rms_error.total_cmp(&b.rms_error)).unwrap();
    // Three parameters may follow noise slightly better than two.
    assert!(best.rms_error > 0.97 * fitted(&curve, "power").rms_error, "{best:?}");
    assert!(fitted(&curve, "ORE D71").rms_error > 5.0 * fitted(&curve, "power").rms_error);
}

#[test]
fn insufficient_data_gives_no_fit() {
    let curve = |n: u32, s: f64| (1..=n).map(|k| [f64::from(k), s]).collect::<Vec<_>>();
    assert!(fits(&[], 1.0).is_empty());
    assert!(fits(&curve(18, 1.0), 1.0).is_empty(), "nine cycles from the tenth on");
    assert!(fits(&curve(100, 0.003), 1.0).is_empty(), "a sleeper that does not move");
    assert!(fits(&curve(100, 0.0), 1.0).is_empty());
    let growing: Vec<[f64; 2]> = (1..=19).map(|k| [f64::from(k), 1e-3 * f64::from(k)]).collect();
    for fit in fits(&growing, 1e3) {
        assert!(fit.r2.is_finite() && fit.rms_error.is_finite(), "{fit:?}");
        assert!(fit.parameters.iter().all(|p| p.1.is_finite()), "{fit:?}");
    }
    // A straight line is no exponential.
    assert!(!fits(&growing, 1e3).iter().any(|f| f.law == "Sato" && f.r2 < 0.999));
    assert!(slope(&growing[..2], 1.0).is_none());
}

/// One parameter, white noise: σ/√Σ(1 + 0.2 log N)².
#[test]
fn standard_errors_match_linear_regression() {
    let curve = noisy(|n| 0.003 * (1.0 + 0.2 * n.log10()));
    let fit = fitted(&curve, "ORE D71");
    let squares: f64 = (10..=400).map(|n| (1.0 + 0.2 * f64::from(n).log10()).powi(2)).sum();
    let expected = fit.rms_error * (391.0_f64 / 390.0).sqrt() / squares.sqrt();
    let found = fit.standard_errors[0];
    assert!(found >= expected * 0.999 && found < 1.3 * expected, "{found:e} {expected:e}");
    assert!((fit.parameter("s1").unwrap() - 0.003).abs() < 4.0 * found);
}

#[test]
fn correlated_residuals_widen_errors() {
    let wave = |n: f64| 1e-4 * (n / 60.0 * std::f64::consts::TAU).sin();
    let curve: Vec<[f64; 2]> =
        (1..=400).map(f64::from).map(|n| [n, 0.003 * (1.0 + 0.2 * n.log10()) + wave(n)]).collect();
    let fit = fitted(&curve, "ORE D71");
    let squares: f64 = (10..=400).map(|n| (1.0 + 0.2 * f64::from(n).log10()).powi(2)).sum();
    let white = fit.rms_error / squares.sqrt();
    assert!(fit.standard_errors[0] > 5.0 * white, "{:e} {white:e}", fit.standard_errors[0]);
}

#[test]
fn short_runs_are_fitted() {
    let curve: Vec<[f64; 2]> =
        [0.9, 1.0, 1.17, 1.28, 1.39].iter().enumerate().map(|(k, s)| [k as f64 + 1.0, 1e-3 * s]).collect();
    let found = fits(&curve, 40e3);
    assert!(found.iter().any(|f| f.law == "power") && !found.iter().any(|f| f.law == "Sato"), "{found:?}");
    for fit in &found {
        assert_eq!((fit.range, fit.points), ([2.0, 5.0], 4), "{}", fit.law);
        assert_eq!(fit.standard_errors.len(), fit.parameters.len(), "{}", fit.law);
    }
    assert!(fits(&curve[..3], 40e3).is_empty(), "two cycles from the second on");
}

#[test]
fn slope_matches_logarithm() {
    let curve: Vec<[f64; 2]> =
        (1..=100).map(f64::from).map(|n| [n, if n < 20.0 { 7.0 } else { 2.0 + 0.5 * n.ln() }]).collect();
    let found = slope(&curve, 20.0).unwrap();
    assert!((found.slope - 0.5).abs() < 1e-12 && found.error < 1e-12, "{found:?}");
    assert!(slope(&curve, 10.0).unwrap().error > 1e-3);
}
