//! Lanczos method for the largest eigenvalue of a symmetric positive semidefinite operator.

use super::operator::Operator;

/// Iterations before the first convergence check, between checks, at most.
const FIRST: usize = 12;
const EVERY: usize = 4;
const LAST: usize = 60;

/// Relative growth over [`EVERY`] iterations at convergence.
const CONVERGED: f64 = 0.01;

/// Largest eigenvalue, converged from below to about [`CONVERGED`] and increased by it.
pub(super) fn largest(operator: &mut Operator) -> f64 {
    let n = operator.len();
    let mut now = start(n);
    let mut before = vec![0.0; n];
    let mut next = vec![0.0; n];
    let (mut diagonal, mut beside) = (Vec::new(), Vec::<f64>::new());
    let mut known = 0.0;
    // In a large bed, localised modes are weak in the start vector.
    let first = if n > 50_000 { FIRST + EVERY } else { FIRST };
    for k in 1..=LAST {
        operator.apply(&now, &mut next);
        let link = beside.last().copied().unwrap_or(0.0);
        let alpha = dot(&now, &next);
        next.iter_mut().zip(&now).zip(&before).for_each(|((w, v), u)| *w -= alpha * v + link * u);
        diagonal.push(alpha);
        let beta = dot(&next, &next).sqrt();
        if k >= first && (k - first).is_multiple_of(EVERY) || k == LAST || beta == 0.0 {
            let found = top(&diagonal, &beside);
            let grown = found - known;
            if beta <= 1e-9 * found || grown < CONVERGED * found || k == LAST {
                return found * (1.0 + CONVERGED) + if known > 0.0 { grown } else { 0.0 };
            }
            known = found;
        }
        beside.push(beta);
        std::mem::swap(&mut before, &mut now);
        now.iter_mut().zip(&next).for_each(|(v, w)| *v = w / beta);
    }
    known
}

/// Reproducible unit vector.
fn start(n: usize) -> Vec<f64> {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut v: Vec<f64> = (0..n)
        .map(|_| {
            // Xorshift (Marsaglia, Journal of Statistical Software 8, 2003).
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        })
        .collect();
    let size = dot(&v, &v).sqrt();
    v.iter_mut().for_each(|x| *x /= size);
    v
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Largest eigenvalue by bisection on Sturm's sequence.
fn top(diagonal: &[f64], beside: &[f64]) -> f64 {
    let reach = |k: usize| {
        let left = if k > 0 { beside[k - 1].abs() } else { 0.0 };
        left + beside.get(k).filter(|_| k + 1 < diagonal.len()).map_or(0.0, |b| b.abs())
    };
    let ends = diagonal.iter().enumerate().map(|(k, a)| (a - reach(k), a + reach(k)));
    let (mut low, mut high) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (a, b)| (l.min(a), h.max(b)));
    let above = |x: f64| {
        let mut q = f64::INFINITY;
        diagonal.iter().enumerate().all(|(k, a)| {
            let b = if k > 0 { beside[k - 1] } else { 0.0 };
            q = x - a - b * b / q;
            q > 0.0
        })
    };
    while high - low > 1e-6 * high.abs() {
        let middle = 0.5 * (low + high);
        if above(middle) {
            high = middle
        } else {
            low = middle
        }
        if middle == low && middle == high {
            break;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second difference with fixed ends: eigenvalues 2 − 2 cos(kπ/(n + 1)).
    #[test]
    fn tridiagonal_matrix_of_known_spectrum() {
        for n in [1, 2, 5, 40] {
            let found = top(&vec![2.0; n], &vec![-1.0; n - 1]);
            let exact = 2.0 - 2.0 * (n as f64 * std::f64::consts::PI / (n as f64 + 1.0)).cos();
            assert!((found - exact).abs() < 1e-5 * exact, "{n}: {found} {exact}");
        }
    }
}
