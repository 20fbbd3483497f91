use super::*;

#[track_caller]
fn close(found: f64, expected: f64, limit: f64) {
    assert!((found - expected).abs() <= limit * expected.abs(), "{found}, expected {expected}");
}

/// Twelve loads [kN].
const LOADS: [f64; 12] = [231.0, 77.0, 142.0, 90.0, 52.0, 219.0, 67.0, 204.0, 206.0, 217.0, 237.0, 80.0];

#[test]
fn fraction_above_matches_sine() {
    let times: Vec<f64> = (0..=20_000).map(|k| 0.001 * f64::from(k)).collect();
    let values: Vec<f64> = times.iter().map(|t| libm::sin(2.0 * std::f64::consts::PI * t / 5.0)).collect();
    for level in [-0.5, 0.0, 0.5, 0.9] {
        let expected = (0.5 * std::f64::consts::PI - libm::asin(level)) / std::f64::consts::PI;
        close(fraction_above(&times, &values, level), expected, 1e-5);
        // Four periods; at −0.5 the history starts above.
        assert_eq!(events(&times, &values, level, 0.0).len(), if level < 0.0 { 5 } else { 4 });
    }
    assert_eq!(fraction_above(&times, &values, 1.0), 0.0);
    assert_eq!(fraction_above(&[1.0], &[2.0], 1.0), 0.0);
}

#[test]
fn fraction_above_is_linear_between_rows() {
    // Rows of unequal intervals: up within 2 s, down within 8 s.
    close(fraction_above(&[0.0, 2.0, 10.0], &[0.0, 4.0, 0.0], 1.0), 0.75, 1e-12);
    close(fraction_above(&[0.0, 2.0, 3.0], &[0.0, 0.0, 5.0], 0.0), 1.0 / 3.0, 1e-12);
}

#[test]
fn separation_joins_events() {
    let times: Vec<f64> = (0..10).map(f64::from).collect();
    let values = [0.0, 2.0, 0.0, 3.0, 2.5, 0.0, 0.0, 4.0, 0.0, 0.0];
    let peaks = |separation: f64| -> Vec<(f64, f64)> {
        events(&times, &values, 1.0, separation).iter().map(|e| (e.time, e.peak)).collect()
    };
    assert_eq!(peaks(0.0), [(1.0, 2.0), (3.0, 3.0), (7.0, 4.0)]);
    assert_eq!(peaks(2.0), [(3.0, 3.0), (7.0, 4.0)]);
    assert_eq!(peaks(3.0), [(7.0, 4.0)]);
}

/// scipy 1.x: `gumbel_r.fit`, `weibull_min.fit(x - 40, floc=0)`, refined to 1e-12; `isf`, `kstest`.
#[test]
fn fits_match_scipy() {
    let gumbel = Fit::of(Law::Gumbel, 0.0, &LOADS).unwrap();
    close(gumbel.location, 116.311_476_58, 1e-8);
    close(gumbel.scale, 62.868_944_4, 1e-8);
    close(gumbel.distance, 0.280_448_235, 1e-7);
    close(gumbel.quantile(0.1, 0.9).value, 257.789_693_48, 1e-8);
    close(gumbel.quantile(0.01, 0.9).value, 405.517_999_45, 1e-8);
    // Here the empirical distribution is above the fitted one.
    let other = Fit::of(Law::Gumbel, 0.0, &[1.0, 1.1, 1.2, 1.3, 5.0, 9.0]).unwrap();
    close(other.distance, 0.403_277_1, 1e-6);
    let weibull = Fit::of(Law::Weibull, 40.0, &LOADS).unwrap();
    close(weibull.shape, 1.499_484, 1e-6);
    close(weibull.scale, 123.326_72, 1e-6);
    close(weibull.distance, 0.284_169, 1e-5);
    close(weibull.quantile(0.1, 0.9).value, 255.088_59, 1e-6);
    close(weibull.quantile(0.01, 0.9).value, 381.486_1, 1e-6);
}

/// Variances 1.1087, 0.6079 and covariance 0.2570 of location and scale, times scale² / n (Kotz and Nadarajah 2000).
#[test]
fn confidence_matches_published_variances() {
    let fit = Fit::of(Law::Gumbel, 0.0, &LOADS).unwrap();
    let y = -libm::log(-libm::log(0.99));
    let variance = 1.1087 + 2.0 * 0.2570 * y + 0.6079 * y * y;
    let half = 1.959_964 * fit.scale * (variance / 12.0).sqrt();
    let found = fit.quantile(0.01, 0.95);
    close(found.high - found.value, half, 1e-4);
    close(found.value - found.low, half, 1e-4);
}

#[test]
fn quantile_inverts_exceedance() {
    for (law, origin) in [(Law::Gumbel, 0.0), (Law::Weibull, 40.0)] {
        let fit = Fit::of(law, origin, &LOADS).unwrap();
        for p in [0.5, 0.1, 1e-3, 1e-6] {
            let found = fit.quantile(p, 0.9);
            close(fit.exceedance(found.value), p, 1e-9);
            assert!(found.low < found.value && found.value < found.high);
        }
    }
    let weibull = Fit::of(Law::Weibull, 40.0, &LOADS).unwrap();
    assert_eq!(weibull.exceedance(39.0), 1.0);
}

/// Uniform numbers of a linear congruence (Knuth, MMIX).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    ((*state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
}

/// The interval of 90 % contains the true quantile in 90 % of samples.
#[test]
fn intervals_cover_known_quantile() {
    let mut state = 5;
    for law in [Law::Gumbel, Law::Weibull] {
        let (count, samples) = (60, 2000);
        let mut covered = 0;
        for _ in 0..samples {
            let draw = |u: f64| match law {
                Law::Gumbel => 100.0 - 20.0 * libm::log(-libm::log(u)),
                Law::Weibull => 30.0 + 50.0 * libm::pow(-libm::log(u), 1.0 / 1.5),
            };
            let values: Vec<f64> = (0..count).map(|_| draw(uniform(&mut state))).collect();
            let found = Fit::of(law, 30.0, &values).unwrap().quantile(0.02, 0.9);
            let truth = match law {
                Law::Gumbel => 100.0 - 20.0 * libm::log(-libm::log(0.98)),
                Law::Weibull => 30.0 + 50.0 * libm::pow(-libm::log(0.02), 1.0 / 1.5),
            };
            covered += i32::from(found.low <= truth && truth <= found.high);
        }
        let rate = f64::from(covered) / f64::from(samples);
        println!("{law:?}: {rate} of 90 % intervals of {count} values contain the quantile");
        assert!((rate - 0.9).abs() < 0.03, "{law:?}: {rate}");
    }
}

#[test]
fn rejects_small_or_equal_samples() {
    assert_eq!(Fit::of(Law::Gumbel, 0.0, &LOADS[..4]), None);
    assert_eq!(Fit::of(Law::Gumbel, 0.0, &[3.0; 6]), None);
    assert_eq!(Fit::of(Law::Weibull, 77.0, &LOADS), None);
}

/// Events that the ends of the history cut off have no known peak.
#[test]
fn events_at_the_ends_are_not_whole() {
    let times: Vec<f64> = (0..9).map(f64::from).collect();
    let values = [3.0, 1.0, 0.0, 4.0, 0.0, 5.0, 0.0, 2.0, 6.0];
    let all = events(&times, &values, 1.5, 0.0);
    let peaks = |events: &[Event]| events.iter().map(|e| e.peak).collect::<Vec<_>>();
    assert_eq!(peaks(&all), [3.0, 4.0, 5.0, 6.0]);
    assert_eq!(peaks(&whole(all, &values, 1.5)), [4.0, 5.0]);
    assert!(whole(events(&times[..2], &[2.0, 2.0], 1.5, 0.0), &[2.0, 2.0], 1.5).is_empty());
}
