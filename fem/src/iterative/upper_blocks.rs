//! Products with the upper half of a symmetric 3x3 block matrix.
//!
//! AVX2 or plain code, selected at run time. Limits: results differ by rounding without fused multiply-add.

/// Rows of the upper half; columns are positions in the vectors of a part.
pub struct UpperBlocks<'a, T> {
    /// Row bounds with any offset.
    pub start: &'a [usize],
    /// Column position of each entry, diagonal first.
    pub place: &'a [u32],
    pub blocks: &'a [[T; 9]],
    /// Multiples of the identity, times `inertia`.
    pub mass: &'a [f64],
    pub inertia: f64,
}

impl<T: Copy + Into<f64>> UpperBlocks<'_, T> {
    /// `y += A x` with the rows and their transpose.
    pub fn times<const MASS: bool>(&self, x: &[[f64; 4]], y: &mut [[f64; 4]]) {
        #[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
        {
            #[target_feature(enable = "avx2,fma")]
            fn wide<T: Copy + Into<f64>, const MASS: bool>(
                rows: &UpperBlocks<'_, T>,
                x: &[[f64; 4]],
                y: &mut [[f64; 4]],
            ) {
                rows.add::<MASS, true>(x, y);
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                // SAFETY: the CPU supports the features that `wide` is compiled for.
                return unsafe { wide::<T, MASS>(self, x, y) };
            }
        }
        // 64-bit ARM always has fused multiply-add.
        self.add::<MASS, { cfg!(target_arch = "aarch64") }>(x, y);
    }

    #[inline(always)]
    fn add<const MASS: bool, const FUSED: bool>(&self, x: &[[f64; 4]], y: &mut [[f64; 4]]) {
        let first = self.start[0];
        for (p, row) in self.start.windows(2).enumerate() {
            let row = row[0] - first..row[1] - first;
            let xp = x[p];
            let mut sums = [[0.0; 4]; 3];
            let mut inertia = [0.0; 4];
            let entries = self.blocks[row.clone()].iter().zip(&self.place[row.clone()]);
            for (i, (k, &place)) in entries.enumerate() {
                let k: [f64; 9] = k.map(Into::into);
                let rows = [[k[0], k[1], k[2], k[3]], [k[3], k[4], k[5], k[6]], [k[6], k[7], k[8], 0.0]];
                let xq = x[place as usize];
                for (sum, k) in sums.iter_mut().zip(&rows) {
                    *sum = fma::<FUSED>(k, &xq, sum);
                }
                let m = if MASS { self.inertia * self.mass[row.start + i] } else { 0.0 };
                if MASS {
                    inertia = fma::<FUSED>(&[m; 4], &xq, &inertia);
                }
                if i > 0 {
                    let y = &mut y[place as usize];
                    let mut sum = *y;
                    for (k, x) in rows.iter().zip(xp) {
                        sum = fma::<FUSED>(k, &[x; 4], &sum);
                    }
                    if MASS {
                        sum = fma::<FUSED>(&[m; 4], &xp, &sum);
                    }
                    *y = sum;
                }
            }
            for (k, sum) in sums.iter().enumerate() {
                y[p][k] += sum[0] + sum[1] + sum[2] + inertia[k];
            }
        }
    }
}

#[inline(always)]
fn fma<const FUSED: bool>(a: &[f64; 4], b: &[f64; 4], c: &[f64; 4]) -> [f64; 4] {
    std::array::from_fn(|l| if FUSED { a[l].mul_add(b[l], c[l]) } else { a[l] * b[l] + c[l] })
}
