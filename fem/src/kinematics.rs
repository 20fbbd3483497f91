//! Small-strain kinematics and elastic matrices of isoparametric elements.
//!
//! `K_ab = ∫ lambda g_a⊗g_b + mu g_b⊗g_a + mu (g_a·g_b) 1 dV` with `g_a = dN_a/dx`,
//! `M_ab = ∫ rho N_a N_b dV`. Source: Zienkiewicz and Taylor (2000), vol. 1, chapters 4 and 9.
//!
//! Theory manual: equation (4.5) of `docs/theory/solid.md`.

use crate::element::{IntegrationPoint, MAX_NODES};

/// Vector per node, such as coordinates [m]; zero-padded.
pub type ElementCoordinates = [[f64; 3]; MAX_NODES];

/// Jacobian `J[i][k] = dx_i/dxi_k` [m] and its determinant [m³].
#[inline]
pub fn jacobian(coordinates: &ElementCoordinates, gradients: &ElementCoordinates) -> ([[f64; 3]; 3], f64) {
    let mut j = [[0.0; 3]; 3];
    for (x, d) in coordinates.iter().zip(gradients) {
        for i in 0..3 {
            for k in 0..3 {
                j[i][k] += x[i] * d[k];
            }
        }
    }
    let det = j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1])
        - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0])
        + j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
    (j, det)
}

/// Spatial gradients [1/m] and det J [m³] from the natural gradients.
#[inline]
pub fn spatial_gradients(
    coordinates: &ElementCoordinates,
    natural: &ElementCoordinates,
) -> (ElementCoordinates, f64) {
    let (j, det) = jacobian(coordinates, natural);
    let mut inverse = [[0.0; 3]; 3];
    for r in 0..3 {
        for c in 0..3 {
            let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
            inverse[c][r] = (j[r1][c1] * j[r2][c2] - j[r1][c2] * j[r2][c1]) / det;
        }
    }
    let gradients = natural
        .map(|d| std::array::from_fn(|i| d[0] * inverse[0][i] + d[1] * inverse[1][i] + d[2] * inverse[2][i]));
    (gradients, det)
}

/// Strain (engineering shear) of nodal displacements `u` [m].
#[inline]
pub fn strain(g: &ElementCoordinates, u: &ElementCoordinates) -> [f64; 6] {
    let mut e = [0.0; 6];
    for (g, u) in g.iter().zip(u) {
        e[0] += g[0] * u[0];
        e[1] += g[1] * u[1];
        e[2] += g[2] * u[2];
        e[3] += g[1] * u[0] + g[0] * u[1];
        e[4] += g[2] * u[1] + g[1] * u[2];
        e[5] += g[0] * u[2] + g[2] * u[0];
    }
    e
}

/// Volume mean of the gradients [1/m] and volume [m³] for B-bar (Hughes 1980).
pub fn mean_gradients(
    coordinates: &ElementCoordinates,
    points: &[IntegrationPoint],
) -> (ElementCoordinates, f64) {
    let (mut mean, mut volume) = (ElementCoordinates::default(), 0.0);
    for point in points {
        let (g, det) = spatial_gradients(coordinates, &point.gradients);
        let part = point.weight * det;
        volume += part;
        for (mean, g) in mean.iter_mut().zip(&g) {
            for k in 0..3 {
                mean[k] += part * g[k];
            }
        }
    }
    mean.iter_mut().flatten().for_each(|m| *m /= volume);
    (mean, volume)
}

/// Gradient products `[xx, yy, zz, xy, yz, xz][a][b]` of N nodes, `∫ dN_a/dx_i dN_b/dx_j dV` [m].
pub type GradientProducts<const N: usize> = [[[f64; N]; N]; 6];

/// Gradient products of one element.
pub fn gradient_products<const N: usize>(
    coordinates: &ElementCoordinates,
    points: &[IntegrationPoint],
) -> GradientProducts<N> {
    let mut sum = [[[0.0; N]; N]; 6];
    for point in points {
        let (g, det) = spatial_gradients(coordinates, &point.gradients);
        add_gradient_products(&mut sum, &g, point.weight * det);
    }
    sum
}

/// Adds the products of gradients `g` [1/m] with `volume` [m³].
#[inline]
pub fn add_gradient_products<const N: usize>(
    sum: &mut GradientProducts<N>,
    g: &ElementCoordinates,
    volume: f64,
) {
    let (mut x, mut y, mut z) = ([0.0; N], [0.0; N], [0.0; N]);
    for b in 0..N {
        (x[b], y[b], z[b]) = (g[b][0], g[b][1], g[b][2]);
    }
    for a in 0..N {
        let (wx, wy, wz) = (volume * x[a], volume * y[a], volume * z[a]);
        for b in 0..N {
            sum[0][a][b] += wx * x[b];
            sum[1][a][b] += wy * y[b];
            sum[2][a][b] += wz * z[b];
            sum[3][a][b] += wx * y[b];
            sum[4][a][b] += wy * z[b];
            sum[5][a][b] += wx * z[b];
        }
    }
}

/// Stiffness block (a, b), row-major [N/m].
#[inline]
pub fn stiffness_block<const N: usize>(
    p: &GradientProducts<N>,
    lambda: f64,
    mu: f64,
    a: usize,
    b: usize,
) -> [f64; 9] {
    // Product yx of (a, b) equals xy of (b, a).
    let (xx, yy, zz) = (p[0][a][b], p[1][a][b], p[2][a][b]);
    let (xy, yz, xz) = (p[3][a][b], p[4][a][b], p[5][a][b]);
    let (yx, zy, zx) = (p[3][b][a], p[4][b][a], p[5][b][a]);
    let (trace, both) = (mu * (xx + yy + zz), lambda + mu);
    [
        both * xx + trace,
        lambda * xy + mu * yx,
        lambda * xz + mu * zx,
        lambda * yx + mu * xy,
        both * yy + trace,
        lambda * yz + mu * zy,
        lambda * zx + mu * xz,
        lambda * zy + mu * yz,
        both * zz + trace,
    ]
}

/// Consistent mass per direction [kg]. Shape `[nodes][nodes]`.
pub fn mass_matrix<const N: usize>(
    coordinates: &ElementCoordinates,
    points: &[IntegrationPoint],
    density: f64,
) -> [[f64; N]; N] {
    let mut m = [[0.0; N]; N];
    for point in points {
        let (_, det) = jacobian(coordinates, &point.gradients);
        for a in 0..N {
            let factor = density * point.weight * det * point.shape[a];
            for b in 0..N {
                m[a][b] += factor * point.shape[b];
            }
        }
    }
    m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::quadrature::Quadrature;
    use crate::element::{ElementKind, hex20, mass_points, stiffness_points};
    use crate::material::elastic::Elastic;

    fn distorted() -> ElementCoordinates {
        let mut seed = 7_u64;
        hex20::NATURAL.map(|x| {
            x.map(|v| {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                v + 0.2 * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
            })
        })
    }

    /// Against explicit B^T D B.
    #[test]
    fn stiffness_matches_btdb() {
        let (x, steel) = (distorted(), Elastic { young: 3.0, poisson: 0.27, density: 2.0 });
        let (lambda, mu) = steel.lame();
        for rule in [Quadrature::Gauss2, Quadrature::Gauss3] {
            let points = stiffness_points(ElementKind::Hex20, rule);
            let products = gradient_products::<20>(&x, points);
            for (a, i, b, j) in [(0, 0, 0, 0), (3, 1, 17, 2), (17, 2, 3, 1), (8, 0, 9, 1), (12, 2, 12, 0)] {
                let unit = |node: usize, k: usize| {
                    let mut u = [[0.0; 3]; MAX_NODES];
                    u[node][k] = 1.0;
                    u
                };
                let mut work = 0.0;
                for point in points {
                    let (g, det) = spatial_gradients(&x, &point.gradients);
                    let stress = steel.stress(&strain(&g, &unit(a, i)));
                    let e = strain(&g, &unit(b, j));
                    work += point.weight * det * (0..6).map(|c| stress[c] * e[c]).sum::<f64>();
                }
                let block = stiffness_block(&products, lambda, mu, a, b);
                assert!(
                    (block[3 * i + j] - work).abs() < 1e-13,
                    "{a}{i} {b}{j}: {} {work}",
                    block[3 * i + j]
                );
            }
        }
    }

    #[test]
    fn mass_sums_to_density_times_volume() {
        let x = hex20::NATURAL.map(|x| [1.5 * x[0], 0.5 * x[1], 2.0 * x[2] + 0.3 * x[0]]);
        let total: f64 =
            mass_matrix::<20>(&x, mass_points(ElementKind::Hex20), 2000.0).iter().flatten().sum();
        assert!((total / (2000.0 * 12.0) - 1.0).abs() < 1e-14);
    }
}
