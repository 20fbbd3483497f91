//! Energy of stress at the Gauss points.
//!
//! Elastic energy `∫ sigma : C^-1 : sigma / 2 dV`, of all the stress, that before the run included. Plastic work of a step
//! `∫ (sigma_0 + sigma_1)/2 : d eps_p dV`: with the mean of both ends the work of the internal force splits into the change
//! of elastic energy and the plastic work without remainder, because the elastic law is linear.

use crate::element::stiffness_points;
use crate::kinematics::jacobian;
use crate::material::{Elastic, PointState};
use crate::model::Model;

/// Elastic energy [J] of the states of the points. Shape `[points]`.
pub fn elastic(model: &Model, points: &[PointState]) -> f64 {
    sum(model, |e, p| 0.5 * complementary(model.elastic(e), &points[p].stress))
}

/// Plastic work [J] from the states `old` to `new`. Shapes `[points]`.
pub fn plastic_work(model: &Model, old: &[PointState], new: &[PointState]) -> f64 {
    sum(model, |_, p| {
        (0..6)
            .map(|k| {
                let mean = 0.5 * (old[p].stress[k] + new[p].stress[k]);
                mean * (new[p].plastic_strain[k] - old[p].plastic_strain[k])
            })
            .sum()
    })
}

/// Sums a density at the points [J/m³] over the body, element by element.
fn sum(model: &Model, density: impl Fn(usize, usize) -> f64) -> f64 {
    let mesh = model.mesh();
    let mut total = 0.0;
    for e in 0..mesh.element_count() {
        let x = mesh.element_coordinates(e);
        let first = model.point_start(e);
        let points = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
        for (i, point) in points.iter().enumerate() {
            total += point.weight * jacobian(&x, &point.gradients).1 * density(e, first + i);
        }
    }
    total
}

/// `sigma : C^-1 : sigma` [Pa].
fn complementary(elastic: &Elastic, s: &[f64; 6]) -> f64 {
    let (young, poisson) = (elastic.young, elastic.poisson);
    let normal = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    let mixed = s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (normal - 2.0 * poisson * mixed + 2.0 * (1.0 + poisson) * shear) / young
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_energy_of_a_strain_is_half_of_stress_times_strain() {
        let soil = Elastic { young: 3e7, poisson: 0.31, density: 0.0 };
        let strain = [1e-3, -2e-3, 0.5e-3, 0.7e-3, -0.3e-3, 0.2e-3];
        let stress = soil.stress(&strain);
        let work: f64 = stress.iter().zip(&strain).map(|(s, e)| s * e).sum();
        assert!((complementary(&soil, &stress) / work - 1.0).abs() < 1e-13);
    }
}
