//! Exactness of integration rules against closed-form monomial integrals.

use super::*;
use crate::element::checks::monomials;

fn factorial(n: i32) -> f64 {
    (1..=n).map(f64::from).product()
}

fn line(i: i32) -> f64 {
    if i % 2 == 1 { 0.0 } else { 2.0 / f64::from(i + 1) }
}

fn triangle([i, j, _]: [i32; 3]) -> f64 {
    factorial(i) * factorial(j) / factorial(i + j + 2)
}

fn tet([i, j, k]: [i32; 3]) -> f64 {
    factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3)
}

fn wedge(powers: [i32; 3]) -> f64 {
    triangle(powers) * line(powers[2])
}

fn pyramid([i, j, k]: [i32; 3]) -> f64 {
    line(i) * line(j) * factorial(k) * factorial(i + j + 2) / factorial(i + j + k + 3)
}

fn error(rule: &[VolumePoint], exact: fn([i32; 3]) -> f64, powers: [i32; 3]) -> f64 {
    let [i, j, k] = powers;
    let sum: f64 = rule.iter().map(|(x, w)| w * x[0].powi(i) * x[1].powi(j) * x[2].powi(k)).sum();
    (sum - exact(powers)).abs()
}

/// Exact to 1e-14 up to `limit`, wrong for the next degree; positive weights.
fn assert_degree(
    name: &str,
    rule: &[VolumePoint],
    exact: fn([i32; 3]) -> f64,
    degree: fn([i32; 3]) -> i32,
    limit: i32,
) {
    assert!(rule.iter().all(|&(_, w)| w > 0.0), "{name}: weights");
    let mut beyond: f64 = 0.0;
    for powers in monomials(14).into_iter().filter(|p| p.iter().all(|&n| n <= 7)) {
        let error = error(rule, exact, powers);
        if degree(powers) <= limit {
            assert!(error < 1e-14, "{name} {powers:?}: {error:e}");
        } else if degree(powers) == limit + 1 {
            beyond = beyond.max(error);
        }
    }
    assert!(beyond > 1e-6, "{name}: exact beyond degree {limit} ({beyond:e})");
}

fn lift<const P: usize>(rule: &[FacePoint; P]) -> [VolumePoint; P] {
    rule.map(|(x, w)| ([x[0], x[1], 0.0], w))
}

#[test]
fn face_rules_are_exact_to_degree() {
    let total: fn([i32; 3]) -> i32 = |[i, j, k]| if k > 0 { i32::MAX } else { i + j };
    assert_degree("triangle 3", &lift(&TRIANGLE3), triangle, total, 2);
    assert_degree("triangle 6", &lift(&TRIANGLE6), triangle, total, 4);
    assert_degree("triangle 7", &lift(&TRIANGLE7), triangle, total, 5);
    let per_axis: fn([i32; 3]) -> i32 = |[i, j, k]| if k > 0 { i32::MAX } else { i.max(j) };
    assert_degree("face 2×2", &lift(&FACE2), |[i, j, _]| line(i) * line(j), per_axis, 3);
    for rule in [TRIANGLE3.as_slice(), &TRIANGLE6, &TRIANGLE7] {
        assert!(rule.iter().all(|(x, _)| x[0] > 0.0 && x[1] > 0.0 && x[0] + x[1] < 1.0));
    }
}

#[test]
fn tetrahedron_rules_integrate_their_degree_exactly() {
    let total: fn([i32; 3]) -> i32 = |p| p.iter().sum();
    assert_degree("tet 1", &TET1, tet, total, 1);
    assert_degree("tet 4", &TET4, tet, total, 2);
    assert_degree("tet 14", &TET14, tet, total, 5);
    assert_degree("tet 24", &TET24, tet, total, 6);
    for rule in [TET1.as_slice(), &TET4, &TET14, &TET24] {
        assert!(rule.iter().all(|(x, _)| x.iter().all(|&c| c > 0.0) && x.iter().sum::<f64>() < 1.0));
    }
}

#[test]
fn wedge_rules_integrate_their_degree_exactly() {
    let rules: [(&str, &[VolumePoint], i32, i32); 3] =
        [("wedge 6", &WEDGE6, 2, 3), ("wedge 9", &WEDGE9, 2, 5), ("wedge 21", &WEDGE21, 5, 5)];
    for (name, rule, across, along) in rules {
        assert!(rule.iter().all(|&(_, w)| w > 0.0), "{name}: weights");
        let (mut beyond_across, mut beyond_along): (f64, f64) = (0.0, 0.0);
        for powers in monomials(14).into_iter().filter(|p| p[0] + p[1] <= across + 1 && p[2] <= along + 1) {
            let error = error(rule, wedge, powers);
            match (powers[0] + powers[1] <= across, powers[2] <= along) {
                (true, true) => assert!(error < 1e-14, "{name} {powers:?}: {error:e}"),
                (false, true) => beyond_across = beyond_across.max(error),
                (true, false) => beyond_along = beyond_along.max(error),
                _ => {}
            }
        }
        assert!(beyond_across > 1e-5 && beyond_along > 1e-3, "{name}: {beyond_across:e} {beyond_along:e}");
    }
}

#[test]
fn pyramid_rules_integrate_their_degree_exactly() {
    let total: fn([i32; 3]) -> i32 = |p| p.iter().sum();
    assert_degree("pyramid 8", &PYRAMID8, pyramid, total, 3);
    assert_degree("pyramid 18", &PYRAMID18, pyramid, total, 3);
    assert_degree("pyramid 27", &PYRAMID27, pyramid, total, 5);
    for rule in [PYRAMID8.as_slice(), &PYRAMID18, &PYRAMID27] {
        assert!(rule.iter().all(|(x, _)| x[2] > 0.0 && x[0].abs().max(x[1].abs()) < 1.0 - x[2]));
    }
}
