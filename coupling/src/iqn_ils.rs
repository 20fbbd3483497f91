//! Quasi-Newton acceleration of the interface fixed-point iteration x = g(x).
//!
//! Degroote, Bathe & Vierendeels, Comput. Struct. 87 (2009) 793 (IQN-ILS); Anderson, J. ACM 12 (1965) 547.
//! Theory manual: eq. (5.9).

/// Maximum number of stored differences.
const DEPTH: usize = 8;
/// Smallest independent fraction of a column.
const INDEPENDENT: f64 = 1e-8;

#[derive(Default)]
pub(crate) struct IqnIls {
    /// Pairs of residual and g, oldest first.
    passes: Vec<[Vec<f64>; 2]>,
    basis: Vec<Vec<f64>>,
    source: Vec<usize>,
    upper: Vec<Vec<f64>>,
}

impl IqnIls {
    pub fn start(&mut self) {
        self.passes.clear();
    }

    /// Replaces `x` by the start of the next pass, given `g` at `x`.
    pub fn next(&mut self, x: &mut [f64], g: &[f64]) {
        let residual: Vec<f64> = g.iter().zip(x.iter()).map(|(g, x)| g - x).collect();
        x.copy_from_slice(g);
        self.basis.clear();
        self.source.clear();
        self.upper.clear();
        // Newest first; modified Gram–Schmidt.
        for (k, [r, _]) in self.passes.iter().enumerate().rev() {
            let mut column: Vec<f64> = r.iter().zip(&residual).map(|(a, b)| a - b).collect();
            let length = dot(&column, &column).sqrt();
            let mut row = Vec::with_capacity(self.basis.len() + 1);
            for q in &self.basis {
                let share = dot(q, &column);
                column.iter_mut().zip(q).for_each(|(c, q)| *c -= share * q);
                row.push(share);
            }
            let rest = dot(&column, &column).sqrt();
            if rest > INDEPENDENT * length && rest > 0.0 {
                column.iter_mut().for_each(|c| *c /= rest);
                row.push(rest);
                self.basis.push(column);
                self.source.push(k);
                self.upper.push(row);
            }
        }
        let count = self.basis.len();
        let mut alpha: Vec<f64> = self.basis.iter().map(|q| -dot(q, &residual)).collect();
        for i in (0..count).rev() {
            for j in i + 1..count {
                alpha[i] -= self.upper[j][i] * alpha[j];
            }
            alpha[i] /= self.upper[i][i];
        }
        for (a, &k) in alpha.iter().zip(&self.source) {
            for ((x, old), new) in x.iter_mut().zip(&self.passes[k][1]).zip(g) {
                *x += a * (old - new);
            }
        }
        if self.passes.len() == DEPTH {
            self.passes.remove(0);
        }
        self.passes.push([residual, g.to_vec()]);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_linear_map_in_five_passes() {
        let map = |x: &[f64]| {
            vec![-3.0 * x[0] + x[1] + 4.0, 2.0 * x[1] - x[2] + 1.0, 0.3 * x[0] - 0.5 * x[2] - 2.0]
        };
        let mut accelerator = IqnIls::default();
        let mut x = vec![1.0, -2.0, 3.0];
        let mut off = f64::INFINITY;
        for _ in 0..5 {
            let g = map(&x);
            off = x.iter().zip(&g).map(|(x, g)| (x - g).abs()).fold(0.0, f64::max);
            accelerator.next(&mut x, &g);
        }
        let g = map(&x);
        let last = x.iter().zip(&g).map(|(x, g)| (x - g).abs()).fold(0.0, f64::max);
        assert!(last < 1e-9 && off < 1e-8, "{off:e}, {last:e}");
    }
}
