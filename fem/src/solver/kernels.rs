//! Solve kernels on column-major blocks for `K` interleaved right-hand sides.
//!
//! AVX-512, AVX2 or plain code, selected at run time. Limits: results differ by rounding between CPU types.

const LANES: usize = 8;

#[inline(always)]
fn fma<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

macro_rules! kernel {
    ($(#[$doc:meta])* $name:ident = $body:ident($($argument:ident: $type:ty),*)) => {
        $(#[$doc])*
        pub(crate) fn $name<const K: usize>($($argument: $type),*) {
            #[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
            {
                #[target_feature(enable = "avx512f,avx2,fma")]
                fn wide<const K: usize>($($argument: $type),*) {
                    $body::<K, true>($($argument),*);
                }
                #[target_feature(enable = "avx2,fma")]
                fn middle<const K: usize>($($argument: $type),*) {
                    $body::<K, true>($($argument),*);
                }
                let avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
                if avx2 && is_x86_feature_detected!("avx512f") {
                    // SAFETY: the CPU supports the features that `wide` is compiled for.
                    return unsafe { wide::<K>($($argument),*) };
                }
                if avx2 {
                    // SAFETY: the CPU supports the features that `middle` is compiled for.
                    return unsafe { middle::<K>($($argument),*) };
                }
            }
            // 64-bit ARM always has fused multiply-add.
            $body::<K, { cfg!(target_arch = "aarch64") }>($($argument),*);
        }
    };
}

kernel!(
    /// `y -= A x`; leading dimension `ld`, `x` `[columns x K]`, `y` `[rows x K]`.
    subtract_product = product(a: &[f64], ld: usize, x: &[f64], y: &mut [f64])
);
kernel!(
    /// `x -= A^T y`; shapes as above.
    subtract_transposed = transposed(a: &[f64], ld: usize, x: &mut [f64], y: &[f64])
);
kernel!(
    /// `x = L^-1 x`, unit diagonal if `unit`.
    solve_lower = lower(a: &[f64], ld: usize, x: &mut [f64], unit: bool)
);
kernel!(
    /// `x = L^-T x`.
    solve_lower_transposed = lower_transposed(a: &[f64], ld: usize, x: &mut [f64])
);
kernel!(
    /// `x = U^-1 x`.
    solve_upper = upper(a: &[f64], ld: usize, x: &mut [f64])
);

#[inline(always)]
fn product<const K: usize, const FUSED: bool>(a: &[f64], ld: usize, x: &[f64], y: &mut [f64]) {
    if y.is_empty() {
        return;
    }
    let columns = x.len() / K;
    let mut j = 0;
    while j + 8 <= columns && K < 8 {
        product_of::<K, 8, FUSED>(&a[j * ld..], ld, &x[j * K..], y);
        j += 8;
    }
    while j + 4 <= columns {
        product_of::<K, 4, FUSED>(&a[j * ld..], ld, &x[j * K..], y);
        j += 4;
    }
    while j < columns {
        product_of::<K, 1, FUSED>(&a[j * ld..], ld, &x[j * K..], y);
        j += 1;
    }
}

#[inline(always)]
fn product_of<const K: usize, const C: usize, const FUSED: bool>(
    a: &[f64],
    ld: usize,
    x: &[f64],
    y: &mut [f64],
) {
    let rows = y.len() / K;
    let column: [&[f64]; C] = std::array::from_fn(|c| &a[c * ld..][..rows]);
    let x: [[f64; K]; C] = std::array::from_fn(|c| std::array::from_fn(|k| -x[c * K + k]));
    for (i, y) in y.chunks_exact_mut(K).enumerate() {
        let mut sum: [f64; K] = std::array::from_fn(|k| y[k]);
        for c in 0..C {
            for k in 0..K {
                sum[k] = fma::<FUSED>(column[c][i], x[c][k], sum[k]);
            }
        }
        y.copy_from_slice(&sum);
    }
}

#[inline(always)]
fn transposed<const K: usize, const FUSED: bool>(a: &[f64], ld: usize, x: &mut [f64], y: &[f64]) {
    if y.is_empty() {
        return;
    }
    let columns = x.len() / K;
    let mut j = 0;
    while j + 4 <= columns {
        transposed_of::<K, 4, FUSED>(&a[j * ld..], ld, &mut x[j * K..(j + 4) * K], y);
        j += 4;
    }
    while j < columns {
        transposed_of::<K, 1, FUSED>(&a[j * ld..], ld, &mut x[j * K..(j + 1) * K], y);
        j += 1;
    }
}

#[inline(always)]
fn transposed_of<const K: usize, const C: usize, const FUSED: bool>(
    a: &[f64],
    ld: usize,
    x: &mut [f64],
    y: &[f64],
) {
    let rows = y.len() / K;
    let column: [&[f64]; C] = std::array::from_fn(|c| &a[c * ld..][..rows]);
    let mut sum = [[0.0; K]; C];
    let mut done = 0;
    if K == 1 {
        let mut lanes = [[0.0; LANES]; C];
        for (block, y) in y.chunks_exact(LANES).enumerate() {
            for c in 0..C {
                let column = &column[c][block * LANES..(block + 1) * LANES];
                for l in 0..LANES {
                    lanes[c][l] = fma::<FUSED>(column[l], y[l], lanes[c][l]);
                }
            }
        }
        for c in 0..C {
            sum[c][0] = lanes[c].iter().sum();
        }
        done = rows / LANES * LANES;
    }
    for (i, y) in y.chunks_exact(K).enumerate().skip(done) {
        for c in 0..C {
            for k in 0..K {
                sum[c][k] = fma::<FUSED>(column[c][i], y[k], sum[c][k]);
            }
        }
    }
    for c in 0..C {
        for k in 0..K {
            x[c * K + k] -= sum[c][k];
        }
    }
}

const STEP: usize = 4;

#[inline(always)]
fn lower<const K: usize, const FUSED: bool>(a: &[f64], ld: usize, x: &mut [f64], unit: bool) {
    let n = x.len() / K;
    for first in (0..n).step_by(STEP) {
        let end = (first + STEP).min(n);
        for j in first..end {
            for i in first..j {
                for k in 0..K {
                    x[j * K + k] = fma::<FUSED>(-a[i * ld + j], x[i * K + k], x[j * K + k]);
                }
            }
            if !unit {
                for k in 0..K {
                    x[j * K + k] /= a[j * ld + j];
                }
            }
        }
        let (now, later) = x[first * K..].split_at_mut((end - first) * K);
        if end < n {
            product::<K, FUSED>(&a[first * ld + end..], ld, now, later);
        }
    }
}

#[inline(always)]
fn lower_transposed<const K: usize, const FUSED: bool>(a: &[f64], ld: usize, x: &mut [f64]) {
    let n = x.len() / K;
    for first in (0..n).step_by(STEP).rev() {
        let end = (first + STEP).min(n);
        let (now, later) = x[first * K..].split_at_mut((end - first) * K);
        if end < n {
            transposed::<K, FUSED>(&a[first * ld + end..], ld, now, later);
        }
        for j in (first..end).rev() {
            for i in j + 1..end {
                for k in 0..K {
                    x[j * K + k] = fma::<FUSED>(-a[j * ld + i], x[i * K + k], x[j * K + k]);
                }
            }
            for k in 0..K {
                x[j * K + k] /= a[j * ld + j];
            }
        }
    }
}

#[inline(always)]
fn upper<const K: usize, const FUSED: bool>(a: &[f64], ld: usize, x: &mut [f64]) {
    let n = x.len() / K;
    for first in (0..n).step_by(STEP).rev() {
        let end = (first + STEP).min(n);
        for j in (first..end).rev() {
            for i in j + 1..end {
                for k in 0..K {
                    x[j * K + k] = fma::<FUSED>(-a[i * ld + j], x[i * K + k], x[j * K + k]);
                }
            }
            for k in 0..K {
                x[j * K + k] /= a[j * ld + j];
            }
        }
        let (earlier, now) = x[..end * K].split_at_mut(first * K);
        product::<K, FUSED>(&a[first * ld..], ld, now, earlier);
    }
}
