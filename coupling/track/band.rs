//! Symmetric band matrices with Cholesky factorisation, without pivoting.

/// Symmetric band matrix, lower half by rows.
#[derive(Clone, Debug)]
pub struct Band {
    size: usize,
    width: usize,
    /// Row i holds columns i − width … i. Shape `[size × (width + 1)]`.
    values: Vec<f64>,
}

impl Band {
    /// Zero matrix.
    pub fn zeros(size: usize, width: usize) -> Band {
        Band { size, width, values: vec![0.0; size * (width + 1)] }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    fn place(&self, row: usize, column: usize) -> usize {
        debug_assert!(column <= row && row - column <= self.width);
        row * (self.width + 1) + self.width + column - row
    }

    /// Adds to an entry and its mirror image.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let k = self.place(row.max(column), row.min(column));
        self.values[k] += value;
    }

    /// Adds a spring, dashpot or mass.
    pub fn add_between(&mut self, a: usize, b: usize, value: f64) {
        self.add(a, a, value);
        self.add(b, b, value);
        self.add(a, b, -value);
    }

    /// Adds `factor` times `other`.
    pub fn add_scaled(&mut self, factor: f64, other: &Band) {
        self.values.iter_mut().zip(&other.values).for_each(|(a, b)| *a += factor * b);
    }

    /// Adds `factor` A x to `y`. Shapes `[size]`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        for i in 0..self.size {
            let first = i.saturating_sub(self.width);
            let row = &self.values[self.place(i, first)..=self.place(i, i)];
            let xi = factor * x[i];
            let mut sum = row[i - first] * x[i];
            for (j, a) in (first..i).zip(row) {
                sum += a * x[j];
                y[j] += a * xi;
            }
            y[i] += factor * sum;
        }
    }

    /// ½ xᵀ A x.
    pub fn half_square(&self, x: &[f64]) -> f64 {
        let mut sum = 0.0;
        for i in 0..self.size {
            let first = i.saturating_sub(self.width);
            let row = &self.values[self.place(i, first)..=self.place(i, i)];
            let below: f64 = (first..i).zip(row).map(|(j, a)| a * x[j]).sum();
            sum += x[i] * (below + 0.5 * row[i - first] * x[i]);
        }
        sum
    }

    /// Cholesky factor L of A = L Lᵀ; `None` unless A is positive definite.
    pub fn factor(mut self) -> Option<BandFactor> {
        for i in 0..self.size {
            let first = i.saturating_sub(self.width);
            for j in first..=i {
                let from = first.max(j.saturating_sub(self.width));
                let mut sum = self.values[self.place(i, j)];
                for k in from..j {
                    sum -= self.values[self.place(i, k)] * self.values[self.place(j, k)];
                }
                let at = self.place(i, j);
                self.values[at] = if j < i {
                    sum / self.values[self.place(j, j)]
                } else if sum > 0.0 {
                    sum.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(BandFactor { factor: self })
    }
}

/// Cholesky factor.
#[derive(Clone, Debug)]
pub struct BandFactor {
    factor: Band,
}

impl BandFactor {
    /// Solves A x = b in place. Shape `[size]`.
    pub fn solve(&self, b: &mut [f64]) {
        let l = &self.factor;
        for i in 0..l.size {
            let first = i.saturating_sub(l.width);
            let row = &l.values[l.place(i, first)..=l.place(i, i)];
            let known: f64 = (first..i).zip(row).map(|(j, a)| a * b[j]).sum();
            b[i] = (b[i] - known) / row[i - first];
        }
        for i in (0..l.size).rev() {
            let first = i.saturating_sub(l.width);
            let row = &l.values[l.place(i, first)..=l.place(i, i)];
            b[i] /= row[i - first];
            let xi = b[i];
            for (j, a) in (first..i).zip(row) {
                b[j] -= a * xi;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_inverts_multiplication() {
        let (n, width) = (40, 4);
        let mut a = Band::zeros(n, width);
        for i in 0..n {
            for j in i.saturating_sub(width)..=i {
                a.add(i, j, if i == j { 9.0 } else { ((i * 7 + j * 3) % 5) as f64 - 2.0 });
            }
        }
        let x: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin()).collect();
        let mut b = vec![0.0; n];
        a.multiply_add(1.0, &x, &mut b);
        let dot: f64 = x.iter().zip(&b).map(|(x, b)| x * b).sum();
        assert!((a.half_square(&x) - 0.5 * dot).abs() < 1e-12);
        a.clone().factor().unwrap().solve(&mut b);
        assert!(x.iter().zip(&b).all(|(x, b)| (x - b).abs() < 1e-13));
        a.add(n - 1, n - 1, -100.0);
        assert!(a.factor().is_none(), "not positive definite");
    }
}
