//! Solves the mass matrix by conjugate gradients with diagonal preconditioner.
//!
//! The condition depends on the element shape only (Wathen, IMA J. Numer. Anal. 7 (1987) 449-457): a few
//! dozen products reach rounding.

use crate::assembly::Matrices;
use crate::error::SolveError;
use crate::supports::Supports;

/// Relative residual of convergence [-].
const TOLERANCE: f64 = 1e-14;
/// Relative residual [-] accepted at stagnation by rounding.
const ACCEPTED: f64 = 1e-11;
const ITERATIONS: usize = 2000;

/// Solves `M x = b` on the free dofs; `x` is 0 at constrained dofs. Shapes `[3 * nodes]`.
///
/// # Errors
/// [`SolveError::MassNotSolved`] if the residual stays above 1e-11 of the load.
pub fn solve_mass(
    matrices: &Matrices,
    supports: &Supports,
    b: &[f64],
    x: &mut [f64],
) -> Result<(), SolveError> {
    let free = supports.free();
    let dot = |a: &[f64], b: &[f64]| free.iter().map(|&d| a[d as usize] * b[d as usize]).sum::<f64>();
    let diagonal = matrices.mass_diagonal();
    x.fill(0.0);
    let mut r = vec![0.0; b.len()];
    for &d in free {
        r[d as usize] = b[d as usize];
    }
    let scaled = |r: &[f64]| -> Vec<f64> { r.iter().enumerate().map(|(d, r)| r / diagonal[d / 3]).collect() };
    let size = dot(&r, &scaled(&r));
    if size == 0.0 {
        return Ok(());
    }
    let mut direction = scaled(&r);
    let mut product = vec![0.0; b.len()];
    let (mut rho, mut best) = (size, f64::INFINITY);
    for _ in 0..ITERATIONS {
        matrices.mass_times(&direction, &mut product);
        let step = rho / dot(&direction, &product);
        for &d in free {
            let d = d as usize;
            x[d] += step * direction[d];
            r[d] -= step * product[d];
        }
        let z = scaled(&r);
        let next = dot(&r, &z);
        best = (next / size).sqrt();
        if best <= TOLERANCE || !best.is_finite() {
            break;
        }
        for &d in free {
            let d = d as usize;
            direction[d] = z[d] + next / rho * direction[d];
        }
        rho = next;
    }
    if best <= ACCEPTED {
        Ok(())
    } else {
        Err(SolveError::MassNotSolved { residual: best, iterations: ITERATIONS })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::quadrature::Quadrature;
    use crate::material::elastic::Elastic;
    use crate::mesh::{Constraint, Mesh};

    #[test]
    fn solves_graded_mass_to_rounding() {
        let mut mesh = Mesh::block([4, 3, 3], [1.0; 3]);
        mesh.coordinates.iter_mut().for_each(|c| c[0] = c[0].powf(1.5));
        let (light, heavy) = (
            Elastic { young: 1.0, poisson: 0.0, density: 2.0 },
            Elastic { young: 1.0, poisson: 0.0, density: 7850.0 },
        );
        let m = Matrices::assemble(&mesh, Quadrature::Gauss3, |e| if e % 2 == 0 { &light } else { &heavy });
        let constraint = Constraint { node: 5, direction: 2, value: 0.0 };
        let supports = Supports::new(&mesh, &[constraint]).unwrap();
        let n = 3 * mesh.node_count();
        let exact: Vec<f64> = (0..n).map(|i| if i == 17 { 0.0 } else { (1.3 * i as f64).cos() }).collect();
        let (mut b, mut x) = (vec![0.0; n], vec![0.0; n]);
        m.mass_times(&exact, &mut b);
        solve_mass(&m, &supports, &b, &mut x).unwrap();
        assert!(x.iter().zip(&exact).all(|(x, e)| (x - e).abs() < 1e-10));
        assert_eq!(x[17], 0.0);
    }
}
