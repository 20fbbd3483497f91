//! Consistent and lumped mass.
//!
//! Lumped (HRZ): diagonal of the consistent matrix, scaled to the element mass,
//! `m_a = M_aa m / sum_b M_bb`; always positive, unlike row sums. Source: Hinton, Rock and Zienkiewicz
//! (1976). Limits: frequency errors of quadratic elements are of second order instead of fourth.
//!
//! Theory manual: equation (4.5) of `docs/theory/solid.md`.

use serde::{Deserialize, Serialize};

/// Mass discretisation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mass {
    /// Consistent mass.
    #[default]
    Consistent,
    /// Diagonal mass (HRZ).
    Lumped,
}

/// Lumps the consistent mass [kg] of one element.
pub fn lump<const N: usize>(consistent: &[[f64; N]; N]) -> [f64; N] {
    let total: f64 = consistent.iter().flatten().sum();
    let diagonal: f64 = (0..N).map(|a| consistent[a][a]).sum();
    let scale = if diagonal > 0.0 { total / diagonal } else { 0.0 };
    std::array::from_fn(|a| scale * consistent[a][a])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{ElementKind, MAX_NODES, mass_points, on_kind};
    use crate::kinematics::mass_matrix;

    fn of_natural_shape<const N: usize>(kind: ElementKind) -> [f64; N] {
        let mut x = [[0.0; 3]; MAX_NODES];
        x[..N].copy_from_slice(kind.natural());
        let masses = lump(&mass_matrix::<N>(&x, mass_points(kind), 3.0));
        let total: f64 = masses.iter().sum();
        assert!((total / (3.0 * kind.natural_volume()) - 1.0).abs() < 1e-13, "{}: {total}", kind.name());
        assert!(masses.iter().all(|m| *m > 0.0), "{}: {masses:?}", kind.name());
        masses
    }

    #[test]
    fn lumping_keeps_mass_and_positivity() {
        for kind in ElementKind::ALL {
            on_kind!(kind, element => of_natural_shape::<{ element::NODES }>(kind).len());
        }
    }

    #[test]
    fn brick_masses_match_exact_integrals() {
        let masses = of_natural_shape::<20>(ElementKind::Hex20);
        let (corner, side) = (exact_corner(), exact_side());
        let sum = 8.0 * corner + 12.0 * side;
        assert!((masses[0] / 24.0 - corner / sum).abs() < 1e-14, "{}", masses[0] / 24.0);
        assert!((masses[8] / 24.0 - side / sum).abs() < 1e-14, "{}", masses[8] / 24.0);
    }

    fn exact_corner() -> f64 {
        let (m0, m1, m2) = (8.0 / 3.0, 4.0 / 3.0, 16.0 / 15.0);
        let square = 3.0 * m2 * m0 * m0 + 6.0 * m1 * m1 * m0;
        (square - 4.0 * 3.0 * m1 * m0 * m0 + 4.0 * m0 * m0 * m0) / 64.0
    }

    /// `∫ ((1-x²)(1+y)(1+z)/4)²`: `∫(1-x²)² = 16/15`.
    fn exact_side() -> f64 {
        16.0 / 15.0 * (8.0 / 3.0) * (8.0 / 3.0) / 16.0
    }
}
