//! Tests of sensitivities.

use super::super::design::latin_hypercube;
use super::*;
use approx::assert_relative_eq;

fn factor(name: &str, range: [f64; 2], log: bool) -> Factor {
    Factor { name: name.into(), range, log, ..Factor::default() }
}

fn point(values: &[f64], result: f64) -> Point {
    let values = values.iter().map(|v| Some(*v)).collect();
    Point { values, results: vec![[Some(result), None, None]], ..Point::default() }
}

#[test]
fn sampled_effects_follow_regression() {
    let factors = [factor("a", [0.0, 2.0], false), factor("b", [1.0, 100.0], true)];
    let points: Vec<Point> = latin_hypercube(12, 2, 1)
        .iter()
        .map(|u| {
            let (a, b) = (2.0 * u[0], libm::pow(100.0, u[1]));
            point(&[a, b], 7.0 + 3.0 * a - 5.0 * libm::log10(b))
        })
        .collect();
    let found = sensitivity(&factors, None, &points, 0);
    // Middle: a = 1, b = 10.
    assert_relative_eq!(found.centre.unwrap(), 5.0, max_relative = 1e-9);
    let ends = found.ends(0, &factors[0]).unwrap();
    assert_relative_eq!(ends[0][1], 2.0, max_relative = 1e-9);
    assert_relative_eq!(ends[1][1], 8.0, max_relative = 1e-9);
    assert_relative_eq!(found.effect(1, &factors[1]).unwrap(), -10.0, max_relative = 1e-9);
    assert_relative_eq!(found.regression.unwrap().r_squared, 1.0, max_relative = 1e-9);
}

#[test]
fn listed_effects_are_level_means() {
    let factors = [factor("a", [1.0, 3.0], false), factor("b", [1.0, 2.0], false)];
    let grid: Vec<Point> = [[1.0, 1.0], [1.0, 2.0], [3.0, 1.0], [3.0, 2.0]]
        .iter()
        .map(|v| point(v, v[0] * v[0] + 10.0 * v[1]))
        .collect();
    let found = sensitivity(&factors, Some(Combine::Grid), &grid, 0);
    assert_eq!(found.responses[0], [[1.0, 16.0], [3.0, 24.0]]);
    assert_eq!((found.effect(0, &factors[0]), found.effect(1, &factors[1])), (Some(8.0), Some(10.0)));
    assert_eq!(found.centre, Some(20.0));
    // The base case is the first; the last case varies both parameters.
    let found = sensitivity(&factors, Some(Combine::OneAtATime), &grid, 0);
    assert_eq!(found.responses[0], [[1.0, 11.0], [3.0, 19.0]]);
    assert_eq!((found.centre, found.rank_correlations[0]), (Some(11.0), None));
    let found = sensitivity(&factors, Some(Combine::List), &grid, 0);
    assert_eq!((found.effect(0, &factors[0]), found.centre), (None, None));
}

#[test]
fn categories_have_extreme_results() {
    let categories = ["x", "y", "z"].map(String::from).to_vec();
    let factors = [Factor { categories, range: [1.0, 3.0], ..Factor::default() }];
    let points = [point(&[1.0], 5.0), point(&[2.0], 9.0), point(&[3.0], 4.0)];
    let found = sensitivity(&factors, Some(Combine::Grid), &points, 0);
    assert_eq!(found.ends(0, &factors[0]), Some([[3.0, 4.0], [2.0, 9.0]]));
    assert!(found.regression.is_none() && found.rank_correlations[0].is_none());
}

/// y = 3 a, plus 1 or 5 by category.
#[test]
fn samples_at_each_category() {
    let kinds = Factor {
        name: "kind".into(),
        range: [1.0, 2.0],
        categories: ["x", "y"].map(String::from).to_vec(),
        ..Factor::default()
    };
    let factors = [factor("a", [0.0, 2.0], false), kinds];
    let samples = latin_hypercube(6, 1, 1);
    let each = [(1.0, 1.0), (2.0, 5.0)].into_iter().flat_map(|case| samples.iter().map(move |u| (case, u)));
    let points: Vec<Point> =
        each.map(|((kind, offset), u)| point(&[2.0 * u[0], kind], 6.0 * u[0] + offset)).collect();
    let found = sensitivity(&factors, None, &points, 0);
    assert_relative_eq!(found.effect(0, &factors[0]).unwrap(), 6.0, max_relative = 1e-9);
    assert_relative_eq!(found.effect(1, &factors[1]).unwrap(), 4.0, max_relative = 1e-9);
    assert_relative_eq!(found.centre.unwrap(), 6.0, max_relative = 1e-9);
    let fit = found.regression.unwrap();
    assert_eq!((fit.coefficients.len(), fit.slopes[1]), (2, 0.0));
}

#[test]
fn incomplete_points_are_left_out() {
    let factors = [factor("a", [0.0, 3.0], false)];
    let mut points: Vec<Point> = (0..4).map(|k| point(&[f64::from(k)], f64::from(2 * k))).collect();
    points
        .insert(0, Point { values: vec![None], results: vec![[Some(1e9), None, None]], ..Point::default() });
    points.push(Point { values: vec![Some(9.0)], results: vec![[None; 3]], ..Point::default() });
    let found = sensitivity(&factors, None, &points, 0);
    assert_relative_eq!(found.regression.unwrap().slopes[0], 2.0, max_relative = 1e-12);
    assert_relative_eq!(found.rank_correlations[0].unwrap(), 1.0, max_relative = 1e-12);
}
