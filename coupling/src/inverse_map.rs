//! Natural coordinates of a point in an element, by Newton's method.
//!
//! RailwayFEM-DEM manual (2015), eq. 21; Theory manual: eq. (5.1).

use nalgebra::{Matrix3, Vector3};
use trackbed_fem::ElementKind;
use trackbed_fem::kinematics::ElementCoordinates;

const TOLERANCE: f64 = 1e-13;
const MAX_ITERATIONS: usize = 30;

/// Result of the inverse map.
#[derive(Clone, Copy, Debug)]
pub struct Natural {
    /// Natural coordinates (ξ, η, ζ).
    pub xi: [f64; 3],
    /// Newton iterations.
    pub iterations: usize,
}

/// Natural coordinates of `point` [m] in the element with node coordinates `x` [m]. `None` if Newton does not
/// converge or the Jacobian is singular.
pub fn natural_point(
    kind: ElementKind,
    x: &ElementCoordinates,
    point: [f64; 3],
    start: [f64; 3],
) -> Option<Natural> {
    let x = &x[..kind.node_count()];
    let mut size = 0.0_f64;
    for d in 0..3 {
        let low = x.iter().map(|n| n[d]).fold(f64::INFINITY, f64::min);
        let high = x.iter().map(|n| n[d]).fold(f64::NEG_INFINITY, f64::max);
        size = size.max(high - low);
    }
    let mut xi = Vector3::from(start);
    for iterations in 0..=MAX_ITERATIONS {
        let n = kind.shape_functions(xi.into());
        let mut residual = -Vector3::from(point);
        for i in 0..x.len() {
            residual += n[i] * Vector3::from(x[i]);
        }
        if residual.norm() < TOLERANCE * size {
            return Some(Natural { xi: xi.into(), iterations });
        }
        let dn = kind.gradients(xi.into());
        let mut jacobian = Matrix3::zeros();
        for i in 0..x.len() {
            jacobian += Vector3::from(x[i]) * nalgebra::RowVector3::from(dn[i]);
        }
        xi -= jacobian.try_inverse()? * residual;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;
    use trackbed_fem::element::hex20 as element;

    /// Reference study: Newton from ξ = 0 to 10⁻¹³ half-edges, the same 300 random elements, nodes moved by
    /// ±a half-edges.
    #[test]
    fn iterations_on_distorted_elements_match_reference() {
        let mut random = Random::numpy_seed_3();
        for (amplitude, mean) in [(0.05, 3.9), (0.10, 4.0), (0.15, 4.2), (0.20, 4.4), (0.25, 4.6)] {
            let mut total = 0;
            for _ in 0..300 {
                let x = element::NATURAL.map(|p| p.map(|c| c + amplitude * random.symmetric()));
                let xi = [random.symmetric(), random.symmetric(), random.symmetric()];
                let n = element::shape_functions(xi);
                let mut point = [0.0; 3];
                for (x, n) in x.iter().zip(n) {
                    for d in 0..3 {
                        point[d] += n * x[d];
                    }
                }
                let found = natural_point(ElementKind::Hex20, &x, point, [0.0; 3])
                    .expect("no failure up to a = 0.25");
                let error = (0..3).map(|d| (found.xi[d] - xi[d]).abs()).fold(0.0, f64::max);
                assert!(error < 1e-10, "a = {amplitude}: {error:e}");
                assert!(found.iterations <= 7, "a = {amplitude}: {} iterations", found.iterations);
                total += found.iterations;
                let warm = natural_point(ElementKind::Hex20, &x, point, xi.map(|c| c + 1e-4)).unwrap();
                assert!(warm.iterations <= 2, "warm start took {}", warm.iterations);
            }
            println!("a = {amplitude}: mean {} iterations", f64::from(total as u32) / 300.0);
            let measured = f64::from(total as u32) / 300.0;
            assert!((measured - mean).abs() <= 0.1, "a = {amplitude}: mean {measured}, reference {mean}");
        }
    }

    #[test]
    fn inverse_map_is_scale_invariant() {
        let mut random = Random::new(7);
        for size in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            for _ in 0..100 {
                let x = element::NATURAL.map(|p| p.map(|c| size * (c + 0.1 * random.symmetric())));
                let xi = [random.symmetric(), random.symmetric(), random.symmetric()];
                let n = element::shape_functions(xi);
                let point = [0, 1, 2].map(|d| (0..20).map(|i| n[i] * x[i][d]).sum::<f64>());
                let near = xi.map(|c| c + 3e-5);
                let found = natural_point(ElementKind::Hex20, &x, point, near)
                    .unwrap_or_else(|| panic!("no point in an element of {size} m"));
                let error = (0..3).map(|d| (found.xi[d] - xi[d]).abs()).fold(0.0, f64::max);
                assert!(error < 1e-12, "size {size}: {error:e}");
            }
        }
    }
}
