//! Change test before a cycle jump: whether the last cycles follow one law.
//!
//! Settlements over ln N are fitted by one line and, for every split, by two. A change is a split that explains
//! more than chance (largest Wald statistic over all splits, D. W. K. Andrews, Econometrica 61, 1993, with the
//! correlation of successive residuals). A step beyond the tolerance forbids the jump; a change of slope, as of
//! a curved law, limits it so that its effect stays within the tolerance.

use super::cycles::{Cycle, CycleRecorder};

/// Smallest part of the cycles on either side of a split.
const TRIM: f64 = 0.15;
/// Fewest cycles on either side.
const FEWEST: usize = 5;
/// Wald statistic of two changed coefficients, exceeded by chance in 1 % of cases.
const CRITICAL: f64 = 16.0;
/// Largest correlation of successive residuals.
const CORRELATED: f64 = 0.99;
/// Relative change of the mean resilient deflection that matters: voids, loss of support.
const DEFLECTION: f64 = 0.2;

/// Change among the last cycles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// No jump.
    Break(&'static str),
    /// No jump with a longer ln(1 + ΔN/N).
    Turn(f64),
}

/// Returns the change of the cycles from `from` on, if any; `matters`: error of the settlement [m], `event`: what
/// happened in the stretch.
pub fn of(cycles: &CycleRecorder, from: f64, matters: f64, event: Option<&'static str>) -> Option<Change> {
    if let Some(event) = event {
        return Some(Change::Break(event));
    }
    let settlements: Vec<[f64; 2]> =
        cycles.measured.iter().filter(|c| c[0] >= from).map(|c| [libm::log(c[0]), c[1]]).collect();
    let change = settlement_change(&settlements, matters);
    if matches!(change, Some(Change::Break(_))) {
        return change;
    }
    let done = &cycles.done;
    // A row is a simulated cycle; earlier ones still seat the sleeper.
    let recent = &done[done.len() - (settlements.len() / 2).min(done.len())..];
    match deflection_changes(recent) {
        true => Some(Change::Break("resilient deflection changed")),
        false => change,
    }
}

/// Line through points: intercept, slope, sum of squared residuals.
fn line(points: &[[f64; 2]]) -> [f64; 3] {
    let n = points.len() as f64;
    let [x, y] = [0, 1].map(|d| points.iter().map(|p| p[d]).sum::<f64>() / n);
    let sxx: f64 = points.iter().map(|p| (p[0] - x).powi(2)).sum();
    let sxy: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    let slope = if sxx > 0.0 { sxy / sxx } else { 0.0 };
    let rest = points.iter().map(|p| (p[1] - y - slope * (p[0] - x)).powi(2)).sum();
    [y - slope * x, slope, rest]
}

fn settlement_change(points: &[[f64; 2]], matters: f64) -> Option<Change> {
    let count = points.len();
    let least = FEWEST.max((TRIM * count as f64) as usize);
    if count < 2 * least + 1 {
        return None;
    }
    let whole = line(points);
    let parts = |k: usize| (k, [line(&points[..k]), line(&points[k..])]);
    let splits = (least..=count - least).map(parts);
    let rest = |parts: &[[f64; 3]; 2]| parts[0][2] + parts[1][2];
    let (k, [before, after]) = splits.min_by(|a, b| rest(&a.1).total_cmp(&rest(&b.1)))?;
    let left = before[2] + after[2];
    let residual = |i: usize| {
        let [a, b, _] = if i < k { before } else { after };
        points[i][1] - a - b * points[i][0]
    };
    let products: f64 = (1..count).map(|i| residual(i) * residual(i - 1)).sum();
    let correlation = if left > 0.0 { (products / left).clamp(0.0, CORRELATED) } else { 0.0 };
    let scale = left / (count - 4) as f64 * (1.0 + correlation) / (1.0 - correlation);
    if whole[2] - left <= CRITICAL * scale {
        return None;
    }
    let at = 0.5 * (points[k - 1][0] + points[k][0]);
    let step = (after[0] - before[0]) + (after[1] - before[1]) * at;
    match step.abs() > matters {
        true => Some(Change::Break("settlement stepped")),
        false => Some(Change::Turn(matters / (after[1] - before[1]).abs())),
    }
}

fn deflection_changes(rows: &[Cycle]) -> bool {
    let (early, late) = rows.split_at(rows.len() / 2);
    let mean = |rows: &[Cycle]| rows.iter().map(|c| c.resilient_deflection).sum::<f64>() / rows.len() as f64;
    let [early, late] = [mean(early), mean(late)];
    (late - early).abs() > DEFLECTION * early.abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Settlement in millimetres, with noise of ± `noise`.
    fn points(count: usize, noise: f64, at: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let mut seed = 7_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 23) - 1.0
        };
        let from = count / 4;
        (from..=count).map(|n| n as f64).map(|n| [libm::log(n), at(n) + noise * random()]).collect()
    }

    /// Longest jump, ln(1 + ΔN/N); none after a step.
    fn longest(points: &[[f64; 2]], matters: f64) -> Option<f64> {
        match settlement_change(points, matters) {
            None => Some(f64::INFINITY),
            Some(Change::Turn(span)) => Some(span),
            Some(Change::Break(_)) => None,
        }
    }

    #[test]
    fn curved_laws_limit_jumps() {
        let laws: [fn(f64) -> f64; 3] = [
            |n| 1.0 + 0.3 * libm::log(n),
            |n| libm::pow(n, 0.2),
            |n| 0.8 * (1.0 - libm::exp(-0.01 * n)) + 0.002 * n,
        ];
        // d²s/d(ln N)² of the power is 0.04 s; the halves of the window differ by about ln 2.
        let spans = [f64::INFINITY, 0.02 / (0.04 * std::f64::consts::LN_2), 0.09];
        for (law, expected) in laws.into_iter().zip(spans) {
            let points = points(100, 0.0, law);
            let span = longest(&points, 0.02 * law(100.0)).unwrap();
            // A logarithm has no turn but rounding.
            assert!(
                span.min(1e3) / expected.min(1e3) - 1.0 < 0.3
                    && expected.min(1e3) / span.min(1e3) - 1.0 < 0.3,
                "{span}, not {expected}"
            );
        }
        let noisy = points(100, 0.05, laws[1]);
        assert_eq!(longest(&noisy, 0.05), Some(f64::INFINITY));
    }

    #[test]
    fn steps_forbid_and_slopes_limit_jumps() {
        let base = |n: f64| 1.0 + 0.3 * libm::log(n);
        let step = |n: f64| base(n) + if n > 60.0 { 0.12 } else { 0.0 };
        let turn = |n: f64| base(n) + 0.5 * libm::log((n / 60.0).max(1.0));
        let matters = 0.02 * base(100.0);
        for noise in [0.0, 0.01] {
            assert_eq!(longest(&points(100, noise, step), matters), None, "noise {noise}");
            let span = longest(&points(100, noise, turn), matters).unwrap();
            assert!((span / (matters / 0.5) - 1.0).abs() < 0.2, "{span}, noise {noise}");
        }
        // Within the scatter.
        assert_eq!(longest(&points(100, 0.3, step), matters), Some(f64::INFINITY));
        let little = |n: f64| base(n) + if n > 60.0 { 0.02 } else { 0.0 };
        assert!(longest(&points(100, 0.0, little), matters).is_some());
    }

    #[test]
    fn deflection_of_a_growing_void_is_a_change() {
        let rows = |late: f64| -> Vec<Cycle> {
            let of = |k: usize| Cycle {
                resilient_deflection: if k < 20 { 5e-4 } else { late },
                ..Cycle::default()
            };
            (0..40).map(of).collect()
        };
        assert!(deflection_changes(&rows(7e-4)));
        assert!(deflection_changes(&rows(3.5e-4)));
        assert!(!deflection_changes(&rows(5.4e-4)));
    }
}
