//! Block-Jacobi preconditioner: inverse 3x3 blocks of the nodes.
//!
//! Source: Saad (2003), section 10.2.

use crate::solver::conjugate::Preconditioner;
use crate::solver::conjugate::vectors::NODES;
use rayon::prelude::*;

/// Inverse blocks by nodes: xx, xy, xz, yy, yz, zz.
pub struct BlockJacobi {
    inverse: Vec<[f64; 6]>,
}

impl BlockJacobi {
    /// Inverts symmetric blocks by nodes.
    ///
    /// # Errors
    /// Dof `3 * node + direction` of a pivot not above rounding.
    pub fn new(blocks: &[[f64; 9]]) -> Result<BlockJacobi, usize> {
        let inverse = blocks.iter().enumerate().map(|(n, b)| invert(b).map_err(|k| 3 * n + k));
        Ok(BlockJacobi { inverse: inverse.collect::<Result<_, _>>()? })
    }

    /// Inverse blocks: xx, xy, xz, yy, yz, zz.
    pub fn inverse(&self) -> &[[f64; 6]] {
        &self.inverse
    }
}

#[inline]
pub(super) fn times(a: &[f64; 6], x: &[f64; 3]) -> [f64; 3] {
    [
        a[0] * x[0] + a[1] * x[1] + a[2] * x[2],
        a[1] * x[0] + a[3] * x[1] + a[4] * x[2],
        a[2] * x[0] + a[4] * x[1] + a[5] * x[2],
    ]
}

/// Inverse by L D Lᵀ, or the direction of a nonpositive pivot.
fn invert(b: &[f64; 9]) -> Result<[f64; 6], usize> {
    const ROUNDING: f64 = 1e-14;
    let good = |pivot: f64, diagonal: f64| pivot.is_finite() && pivot > ROUNDING * diagonal;
    let d0 = b[0];
    if !(d0.is_finite() && d0 > 0.0) {
        return Err(0);
    }
    let (l1, l2) = (b[1] / d0, b[2] / d0);
    let d1 = b[4] - l1 * b[1];
    if !good(d1, b[4]) {
        return Err(1);
    }
    let rest = b[5] - l1 * b[2];
    let l3 = rest / d1;
    let d2 = b[8] - l2 * b[2] - l3 * rest;
    if !good(d2, b[8]) {
        return Err(2);
    }
    // Rows of L⁻¹: (1), (-l1, 1), (m, -l3, 1).
    let m = l1 * l3 - l2;
    let (i0, i1, i2) = (1.0 / d0, 1.0 / d1, 1.0 / d2);
    Ok([i0 + l1 * l1 * i1 + m * m * i2, -l1 * i1 - m * l3 * i2, m * i2, i1 + l3 * l3 * i2, -l3 * i2, i2])
}

impl Preconditioner for BlockJacobi {
    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let (r, z) = (r.as_chunks::<3>().0, z.as_chunks_mut::<3>().0);
        (z.par_chunks_mut(NODES), r.par_chunks(NODES), self.inverse.par_chunks(NODES))
            .into_par_iter()
            .for_each(|(z, r, inverse)| {
                z.iter_mut().zip(r.iter().zip(inverse)).for_each(|(z, (r, a))| *z = times(a, r));
            });
    }

    fn memory(&self) -> usize {
        size_of_val(self.inverse.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_inverted() {
        let b = [4.0, 1.0, -0.5, 1.0, 3.0, 0.7, -0.5, 0.7, 2.0];
        let mut jacobi = BlockJacobi::new(&[b]).unwrap();
        for x in [[1.0, 0.0, 0.0], [0.3, -2.0, 0.5]] {
            let r: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| b[3 * i + j] * x[j]).sum());
            let mut z = [0.0; 3];
            jacobi.apply(&r, &mut z);
            assert!((0..3).all(|k| (z[k] - x[k]).abs() < 1e-14), "{z:?}");
        }
    }

    #[test]
    fn rejects_nonpositive_block() {
        let good = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let flat = [1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        assert_eq!(BlockJacobi::new(&[good, flat]).err(), Some(4));
        assert_eq!(BlockJacobi::new(&[[f64::NAN; 9]]).err(), Some(0));
    }
}
