//! Samples of quantities: means, scatter, distances.

/// Sample of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Sample {
    /// Number.
    Number(f64),
    /// Points (x, y), x ascending, linear between.
    Curve(Vec<[f64; 2]>),
}

impl Sample {
    /// Creates a curve; the last point per abscissa counts.
    pub fn curve(mut points: Vec<[f64; 2]>) -> Sample {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut kept: Vec<[f64; 2]> = Vec::with_capacity(points.len());
        for point in points {
            match kept.last_mut() {
                Some(last) if last[0] == point[0] => *last = point,
                _ => kept.push(point),
            }
        }
        Sample::Curve(kept)
    }

    /// Returns the number, or the RMS of the curve.
    pub fn size(&self) -> f64 {
        match self {
            Sample::Number(value) => value.abs(),
            Sample::Curve(points) => root_mean_square(points),
        }
    }

    /// Returns the signed number, or the RMS of a curve.
    pub fn shown(&self) -> f64 {
        match self {
            Sample::Number(value) => *value,
            Sample::Curve(_) => self.size(),
        }
    }
}

/// Returns the size of the difference, and of `b` in the same range; none without common abscissa.
pub fn difference(a: &Sample, b: &Sample) -> Option<(f64, f64)> {
    match (a, b) {
        (Sample::Number(a), Sample::Number(b)) => Some(((a - b).abs(), b.abs())),
        (Sample::Curve(a), Sample::Curve(b)) => {
            let at = common_abscissae(&[a, b])?;
            let between = |x: &f64| Some([*x, value_at(a, *x)? - value_at(b, *x)?]);
            let deviation: Vec<[f64; 2]> = at.iter().filter_map(between).collect();
            let second: Vec<[f64; 2]> = at.iter().filter_map(|x| Some([*x, value_at(b, *x)?])).collect();
            Some((root_mean_square(&deviation), root_mean_square(&second)))
        }
        _ => None,
    }
}

/// Returns the mean; none without samples or common abscissa.
pub fn mean(samples: &[Sample]) -> Option<Sample> {
    let count = samples.len() as f64;
    match samples {
        [] => None,
        [only] => Some(only.clone()),
        [Sample::Number(_), ..] => {
            let number = |s: &Sample| if let Sample::Number(v) = s { Some(*v) } else { None };
            let values: Option<Vec<f64>> = samples.iter().map(number).collect();
            Some(Sample::Number(values?.iter().sum::<f64>() / count))
        }
        [Sample::Curve(_), ..] => {
            let curves: Vec<&[[f64; 2]]> = samples.iter().map(points).collect::<Option<_>>()?;
            let at = common_abscissae(&curves)?;
            let sum = |x: f64| curves.iter().map(|c| value_at(c, x)).sum::<Option<f64>>();
            Some(Sample::Curve(at.iter().filter_map(|&x| Some([x, sum(x)? / count])).collect()))
        }
    }
}

fn points(sample: &Sample) -> Option<&[[f64; 2]]> {
    if let Sample::Curve(points) = sample { Some(points) } else { None }
}

/// Returns the standard deviation (n − 1); none for one sample.
pub fn deviation(samples: &[Sample], mean: &Sample) -> Option<f64> {
    if samples.len() < 2 {
        return None;
    }
    let squares = samples.iter().map(|s| difference(s, mean).map(|(d, _)| d * d));
    Some((squares.sum::<Option<f64>>()? / (samples.len() - 1) as f64).sqrt())
}

fn common_abscissae(curves: &[&[[f64; 2]]]) -> Option<Vec<f64>> {
    let mut low = f64::NEG_INFINITY;
    let mut high = f64::INFINITY;
    for curve in curves {
        low = low.max(curve.first()?[0]);
        high = high.min(curve.last()?[0]);
    }
    let mut all: Vec<f64> =
        curves.iter().flat_map(|c| c.iter().map(|p| p[0])).filter(|x| (low..=high).contains(x)).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    (low <= high).then_some(all)
}

/// Returns the value at `x`, linear between points; none outside.
pub fn value_at(curve: &[[f64; 2]], x: f64) -> Option<f64> {
    let behind = curve.partition_point(|p| p[0] < x);
    let after = curve.get(behind)?;
    if after[0] == x {
        return Some(after[1]);
    }
    let before = curve.get(behind.checked_sub(1)?)?;
    let share = (x - before[0]) / (after[0] - before[0]);
    Some(before[1] + share * (after[1] - before[1]))
}

/// √(∫ y² dx / length), exact if piecewise linear.
fn root_mean_square(points: &[[f64; 2]]) -> f64 {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return 0.0 };
    if last[0] <= first[0] {
        return last[1].abs();
    }
    // Squared line: parabola.
    let piece = |w: &[[f64; 2]]| {
        let (a, b) = (w[0][1], w[1][1]);
        (w[1][0] - w[0][0]) * (a * a + a * b + b * b) / 3.0
    };
    (points.windows(2).map(piece).sum::<f64>() / (last[0] - first[0])).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn curve_norms_match_integrals() {
        // y = x on [0, 1] has RMS 1/√3 for any points.
        let line = |n: u32| Sample::curve((0..=n).map(|k| [f64::from(k) / f64::from(n); 2]).collect());
        assert_relative_eq!(line(1).size(), 3.0_f64.sqrt().recip(), max_relative = 1e-14);
        assert_relative_eq!(line(7).size(), 3.0_f64.sqrt().recip(), max_relative = 1e-14);
        let (d, size) = difference(&line(7), &line(5)).unwrap();
        assert!(d < 1e-15 && (size - line(5).size()).abs() < 1e-15);
        // From 0.5: ∫ x² from 1/2 to 1 is 7/24.
        let zero = Sample::curve(vec![[0.5, 0.0], [3.0, 0.0]]);
        assert_relative_eq!(
            difference(&line(3), &zero).unwrap().0,
            (7.0 / 12.0_f64).sqrt(),
            max_relative = 1e-14
        );
        assert_eq!(difference(&line(3), &Sample::curve(vec![[2.0, 1.0]])), None);
        assert_eq!(difference(&line(3), &Sample::Number(1.0)), None);
        assert_eq!(difference(&line(3), &Sample::curve(vec![[0.5, 0.25]])), Some((0.25, 0.25)));
    }

    #[test]
    fn mean_and_deviation() {
        let numbers = [1.0, 2.0, 6.0].map(Sample::Number);
        let middle = mean(&numbers).unwrap();
        assert_eq!(middle, Sample::Number(3.0));
        assert_relative_eq!(deviation(&numbers, &middle).unwrap(), 7.0_f64.sqrt(), max_relative = 1e-14);
        assert_eq!(deviation(&numbers[..1], &middle), None);
        // The same numbers as constant curves.
        let curves = [
            Sample::curve(vec![[0.0, 1.0], [4.0, 1.0]]),
            Sample::curve(vec![[1.0, 2.0], [2.0, 2.0], [5.0, 2.0]]),
            Sample::curve(vec![[-1.0, 6.0], [3.0, 6.0]]),
        ];
        let middle = mean(&curves).unwrap();
        assert_eq!(middle, Sample::curve(vec![[1.0, 3.0], [2.0, 3.0], [3.0, 3.0]]));
        assert_relative_eq!(deviation(&curves, &middle).unwrap(), 7.0_f64.sqrt(), max_relative = 1e-14);
        assert_eq!(
            Sample::curve(vec![[1.0, 2.0], [0.0, 1.0], [1.0, 5.0]]),
            Sample::Curve(vec![[0.0, 1.0], [1.0, 5.0]])
        );
    }
}
