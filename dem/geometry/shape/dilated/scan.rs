//! Roots and negative ranges of a smooth function, bracketed by cells with one extremum each.

use arrayvec::ArrayVec;

pub type Places = ArrayVec<f64, 72>;

/// Most iterations per root.
const ROUNDS: usize = 60;

/// Bracket tolerance.
const PLACE: f64 = 1e-15;

/// Extremum tolerance; the value is second-order accurate.
const EXTREMUM: f64 = 1e-9;

/// Value and slope.
type Function<'a> = &'a dyn Fn(f64) -> [f64; 2];

/// Adds roots between ordered cell boundaries.
pub fn roots(points: impl IntoIterator<Item = f64>, f: Function<'_>, out: &mut Places) {
    let mut points = points.into_iter();
    let Some(mut from) = points.next() else { return };
    let mut before = f(from);
    for to in points {
        let after = f(to);
        let sign = if before[0] < 0.0 { -1.0 } else { 1.0 };
        if (before[0] < 0.0) != (after[0] < 0.0) {
            out.push(crossing([from, to], before[0] < 0.0, f));
        } else if sign * before[1] < 0.0 && sign * after[1] > 0.0 {
            // The extremum may cross zero.
            let (at, beyond) = extremum([from, to], [before[1], after[1]], sign, f);
            if beyond {
                out.push(crossing([from, at], before[0] < 0.0, f));
                out.push(crossing([at, to], before[0] >= 0.0, f));
            }
        }
        (from, before) = (to, after);
    }
}

/// Newton with bisection safeguard.
fn crossing([mut low, mut high]: [f64; 2], rising: bool, f: Function<'_>) -> f64 {
    let mut x = 0.5 * (low + high);
    for _ in 0..ROUNDS {
        let [y, slope] = f(x);
        if (y >= 0.0) == rising {
            high = x;
        } else {
            low = x;
        }
        let next = x - y / slope;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - x).abs() <= PLACE * (1.0 + x.abs()) {
            return next;
        }
        x = next;
    }
    x
}

/// Extremum in a bracket, from end slopes; stops at the first crossing of zero.
fn extremum(
    [mut low, mut high]: [f64; 2],
    [mut first, mut last]: [f64; 2],
    sign: f64,
    f: Function<'_>,
) -> (f64, bool) {
    let mut x = low;
    let mut side = 0;
    for _ in 0..ROUNDS {
        // Illinois method (Dowell & Jarratt, BIT 11, 1971).
        let next = low + (high - low) * (first / (first - last));
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let near = (next - x).abs() <= EXTREMUM * (1.0 + x.abs());
        x = next;
        let [y, slope] = f(x);
        if sign * y < 0.0 {
            return (x, true);
        }
        if near || high - low <= EXTREMUM {
            break;
        }
        if sign * slope < 0.0 {
            (low, first) = (x, slope);
            if side == -1 {
                last *= 0.5;
            }
            side = -1;
        } else {
            (high, last) = (x, slope);
            if side == 1 {
                first *= 0.5;
            }
            side = 1;
        }
    }
    (x, false)
}

/// Calls `put` with each range between ordered roots.
pub fn between(range: [f64; 2], places: &Places, mut put: impl FnMut([f64; 2])) {
    let mut from = range[0];
    for &to in places.iter().chain([&range[1]]) {
        if to > from {
            put([from, to]);
            from = to;
        }
    }
}

/// Calls `put` with each range of negative values.
pub fn below(
    points: impl IntoIterator<Item = f64>,
    range: [f64; 2],
    f: Function<'_>,
    mut put: impl FnMut([f64; 2]),
) {
    let mut places = Places::new();
    roots(points, f, &mut places);
    between(range, &places, |[from, to]| {
        if f(0.5 * (from + to))[0] < 0.0 {
            put([from, to]);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_of_cosines() {
        for periods in 1..=8 {
            let n = periods as f64;
            let f = |x: f64| [libm::cos(n * x) + 0.3, -n * libm::sin(n * x)];
            let mut found = Places::new();
            roots((0..=32).map(|k| k as f64 * std::f64::consts::TAU / 32.0), &f, &mut found);
            assert_eq!(found.len(), 2 * periods);
            assert!(found.iter().all(|x| f(*x)[0].abs() < 1e-13), "{found:?}");
            assert!(found.windows(2).all(|w| w[0] < w[1]));
        }
        let depth = 1e-12;
        let f = |x: f64| [(x - 0.3) * (x - 0.3) - depth, 2.0 * (x - 0.3)];
        let mut parts = Vec::new();
        below([0.0, 1.0], [0.0, 1.0], &f, |part| parts.push(part));
        assert_eq!(parts.len(), 1);
        assert!((parts[0][1] - parts[0][0] - 2e-6).abs() < 1e-12, "{parts:?}");
    }
}
