//! Principal values and axes of symmetric 3×3 tensors.
//!
//! Source: cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, 2013, section 8.5); derivative
//! of isotropic tensor functions (de Souza Neto, Peric and Owen 2008, appendix A). Limits: squares must not
//! overflow or underflow.

/// Voigt order xx yy zz xy yz zx.
pub(super) type Voigt = [f64; 6];

/// Mean stress and J2.
pub(super) fn invariants(t: &Voigt) -> (f64, f64) {
    let p = (t[0] + t[1] + t[2]) / 3.0;
    let d = [t[0] - p, t[1] - p, t[2] - p];
    let j2 = 0.5 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + t[3] * t[3] + t[4] * t[4] + t[5] * t[5];
    (p, j2)
}

pub(super) struct Principal {
    pub values: [f64; 3],
    pub axes: [[f64; 3]; 3],
}

#[inline(always)]
fn rotate(a: &mut [[f64; 3]; 3], v: &mut [[f64; 3]; 3], p: usize, q: usize, r: usize) {
    let apq = a[p][q];
    if apq == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * apq);
    let t = 1.0_f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    a[p][p] -= t * apq;
    a[q][q] += t * apq;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    let (arp, arq) = (a[r][p], a[r][q]);
    a[r][p] = c * arp - s * arq;
    a[p][r] = a[r][p];
    a[r][q] = s * arp + c * arq;
    a[q][r] = a[r][q];
    for k in 0..3 {
        let (vp, vq) = (v[p][k], v[q][k]);
        v[p][k] = c * vp - s * vq;
        v[q][k] = s * vp + c * vq;
    }
}

/// Spectral decomposition with orthonormal axes.
pub(super) fn principal(t: &Voigt) -> Principal {
    let mut a = [[t[0], t[3], t[5]], [t[3], t[1], t[4]], [t[5], t[4], t[2]]];
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let size: f64 = t.iter().map(|x| x.abs()).sum();
    // Converges within six sweeps; the bound guards against NaN.
    for _ in 0..12 {
        let off = a[0][1].abs() + a[1][2].abs() + a[0][2].abs();
        if off <= 1e-17 * size {
            break;
        }
        rotate(&mut a, &mut v, 0, 1, 2);
        rotate(&mut a, &mut v, 1, 2, 0);
        rotate(&mut a, &mut v, 0, 2, 1);
    }
    let mut values = [a[0][0], a[1][1], a[2][2]];
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if values[i] < values[j] {
            values.swap(i, j);
            v.swap(i, j);
        }
    }
    Principal { values, axes: v }
}

/// Symmetric part of `a b`, tensor shear.
#[inline]
fn dyad(a: &[f64; 3], b: &[f64; 3]) -> Voigt {
    [
        a[0] * b[0],
        a[1] * b[1],
        a[2] * b[2],
        0.5 * (a[0] * b[1] + a[1] * b[0]),
        0.5 * (a[1] * b[2] + a[2] * b[1]),
        0.5 * (a[2] * b[0] + a[0] * b[2]),
    ]
}

pub(super) fn tensor(values: &[f64; 3], axes: &[[f64; 3]; 3]) -> Voigt {
    let m: [Voigt; 3] = std::array::from_fn(|i| dyad(&axes[i], &axes[i]));
    std::array::from_fn(|k| values[0] * m[0][k] + values[1] * m[1][k] + values[2] * m[2][k])
}

/// Stiffness from `a[i][j] = d s_i / d e_j` and shear moduli `shear[k]` in the planes (1,2), (2,3), (3,1).
pub(super) fn stiffness(axes: &[[f64; 3]; 3], a: &[[f64; 3]; 3], shear: &[f64; 3]) -> [[f64; 6]; 6] {
    let m: [Voigt; 3] = std::array::from_fn(|i| dyad(&axes[i], &axes[i]));
    let am: [Voigt; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|k| a[i][0] * m[0][k] + a[i][1] * m[1][k] + a[i][2] * m[2][k])
    });
    let d: [Voigt; 3] = std::array::from_fn(|i| dyad(&axes[i], &axes[(i + 1) % 3]));
    let sd: [Voigt; 3] = std::array::from_fn(|i| d[i].map(|x| 4.0 * shear[i] * x));
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            m[0][r] * am[0][c]
                + m[1][r] * am[1][c]
                + m[2][r] * am[2][c]
                + d[0][r] * sd[0][c]
                + d[1][r] * sd[1][c]
                + d[2][r] * sd[2][c]
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rebuilds_tensor_from_principal_form() {
        let cases: [Voigt; 5] = [
            [1.0, -2.0, 3.0, 0.5, -0.7, 1.1],
            [1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
            [2.0, 2.0, 2.0, 1e-13, -2e-13, 1e-13],
            [0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            [-3e9, 4e9, 1e9, 1e-3, 2e9, -5.0],
        ];
        for t in cases {
            let p = principal(&t);
            let size = t.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let back = tensor(&p.values, &p.axes);
            assert!((0..6).all(|k| (back[k] - t[k]).abs() <= 4e-15 * size), "{t:?} {back:?}");
            assert!(p.values[0] >= p.values[1] && p.values[1] >= p.values[2]);
            for i in 0..3 {
                for j in 0..3 {
                    let dot: f64 = (0..3).map(|k| p.axes[i][k] * p.axes[j][k]).sum();
                    assert!((dot - f64::from(u8::from(i == j))).abs() < 1e-15 * 4.0);
                }
            }
        }
    }

    #[test]
    fn isotropic_stiffness_is_axis_independent() {
        let (lambda, mu) = (3.0, 2.0);
        let a =
            std::array::from_fn(|i| std::array::from_fn(|j| lambda + if i == j { 2.0 * mu } else { 0.0 }));
        let p = principal(&[1.0, -2.0, 3.0, 0.5, -0.7, 1.1]);
        let c = stiffness(&p.axes, &a, &[mu; 3]);
        for r in 0..6 {
            for k in 0..6 {
                let normal = r < 3 && k < 3;
                let want = if normal { lambda } else { 0.0 }
                    + if r == k { if normal { 2.0 * mu } else { mu } } else { 0.0 };
                assert!((c[r][k] - want).abs() < 1e-14 * 10.0, "{r} {k}: {} {want}", c[r][k]);
            }
        }
    }
}
