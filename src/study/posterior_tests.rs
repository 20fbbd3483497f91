use super::*;
use trackbed_dem::random::Random;

fn factor(name: &str) -> Factor {
    Factor { name: name.into(), range: [0.0, 2.0], ..Factor::default() }
}

/// Uniform noise of standard deviation 0.2 on q = 2 x; p = x + y.
fn study() -> (Vec<Factor>, Vec<Point>, Vec<Column>) {
    let of = |(k, u): (usize, Vec<f64>)| {
        let (x, y) = (2.0 * u[0], 2.0 * u[1]);
        let noise = 0.2 * 12.0_f64.sqrt() * (Random::new(3, k as u64).uniform() - 0.5);
        let results = vec![[Some(2.0 * x + noise), None, None], [Some(x + y), None, None]];
        Point { values: vec![Some(x), Some(y)], results, ..Point::default() }
    };
    let points = sobol(80, 2, Some(7)).into_iter().enumerate().map(of).collect();
    let column = |name: &str| Column { name: name.into(), unit: String::new() };
    (vec![factor("x"), factor("y")], points, vec![column("q"), column("p")])
}

#[test]
fn linear_model_has_normal_posterior() {
    let (factors, points, results) = study();
    let target = Target { quantity: 0, value: 2.4, tolerance: 0.12 };
    let posterior = Posterior::of(&factors, &points, &results, &[target]).unwrap();
    let [x, y] = posterior.parameters.as_slice() else { panic!("two parameters") };
    // Mean 2.4/2, standard deviation √(0.12² + 0.2²)/2 = 0.117.
    let deviation = 0.12_f64.hypot(0.2) / 2.0;
    assert!((x.median - 1.2).abs() < 0.05, "{x:?}");
    for (found, z) in x.band.iter().zip([-1.645, 1.645]) {
        assert!((found - (1.2 + z * deviation)).abs() < 0.06, "{x:?}");
    }
    assert!((x.deviation - deviation / (2.0 / 12.0_f64.sqrt())).abs() < 0.03, "{x:?}");
    assert!(!x.is_undetermined() && y.is_undetermined(), "{y:?}");
    assert!((y.deviation - 1.0).abs() < 0.03, "{y:?}");
    // p = x + y keeps the uniform band of y: 1.2 + 0.1 to 1.2 + 1.9.
    let p = &posterior.predictions[1];
    assert!((p.band[0] - 1.3).abs() < 0.1 && (p.band[1] - 3.1).abs() < 0.1, "{p:?}");
    assert!(p.prior[1] > 3.3 && p.explained > 0.99, "{p:?}");
    assert_eq!(posterior.notes()[0], "not determined by the targets: y");
}

#[test]
fn narrow_target_is_approached() {
    let (factors, mut points, results) = study();
    for (k, point) in points.iter_mut().enumerate() {
        let x = point.values[0].unwrap();
        // Without noise.
        point.results[0] = [Some(2.0 * x), None, None];
        point.case = format!("{k}");
    }
    let target = Target { quantity: 0, value: 1.0, tolerance: 1e-3 };
    let posterior = Posterior::of(&factors, &points, &results, &[target]).unwrap();
    let x = &posterior.parameters[0];
    assert!((x.median - 0.5).abs() < 0.005, "{x:?}");
    assert!(posterior.effective > 50.0, "{}", posterior.effective);
}

#[test]
fn correlated_parameters_are_reported() {
    let (factors, points, results) = study();
    let target = Target { quantity: 1, value: 2.0, tolerance: 0.1 };
    let posterior = Posterior::of(&factors, &points, &results, &[target]).unwrap();
    let [(a, b, r)] = posterior.correlations.as_slice() else { panic!("one pair") };
    assert!(a == "x" && b == "y" && *r < -0.9, "{r}");
    // Random seeds are no parameters.
    let mut seeded = factors.clone();
    seeded[1].random = true;
    let one = Posterior::of(&seeded, &points, &results, &[target_of_q()]).unwrap();
    assert_eq!(one.parameters.len(), 1);
    let few = Posterior::of(&factors, &points[..4], &results, &[target_of_q()]).unwrap_err();
    assert_eq!(few, "q is constant, or has fewer than 6 values");
}

fn target_of_q() -> Target {
    Target { quantity: 0, value: 2.4, tolerance: 0.12 }
}

#[test]
fn sign_and_size_of_target_do_not_matter() {
    let (factors, mut points, results) = study();
    // q = 1/(x + 0.1) is wide and positive, hence fitted by its logarithm.
    for point in &mut points {
        let x = point.values[0].unwrap();
        point.results[0] = [Some(1.0 / (x + 0.1)), None, None];
    }
    let of = |value: f64, sign: f64| {
        let mut points = points.clone();
        points.iter_mut().for_each(|p| p.results[0][0] = p.results[0][0].map(|q| sign * q));
        let target = Target { quantity: 0, value: sign * value, tolerance: 1.0 };
        Posterior::of(&factors, &points, &results, &[target]).unwrap().parameters[0].clone()
    };
    for value in [2.0, 0.0] {
        // Quantiles of exp(−(value − 1/(x + 0.1))²/2) on 0 to 2.
        let density = |x: f64| (-0.5 * (value - 1.0 / (x + 0.1)).powi(2)).exp();
        let grid: Vec<f64> = (0..20_000).map(|k| (k as f64 + 0.5) * 1e-4).collect();
        let weights: Vec<f64> = grid.iter().map(|x| density(*x)).collect();
        for (found, share) in [of(value, 1.0), of(value, -1.0)].iter().flat_map(|m| m.band.iter().zip(BAND)) {
            let expected = quantile(&grid, &weights, share);
            assert!((found - expected).abs() < 0.05, "{value}: {found} for {expected}");
        }
    }
}

#[test]
fn target_out_of_reach_determines_nothing() {
    let (factors, points, results) = study();
    let target = Target { quantity: 0, value: 9.0, tolerance: 0.1 };
    let posterior = Posterior::of(&factors, &points, &results, &[target]).unwrap();
    assert!(!posterior.is_reliable(), "{:?}", posterior.missed);
    let notes = posterior.notes();
    assert!(notes[0].starts_with("target of q not reached within the ranges: "), "{notes:?}");
    assert!(!notes.iter().any(|n| n.contains("determined by the targets")), "{notes:?}");
}
