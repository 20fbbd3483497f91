//! Plastic work at the Gauss points, `∫ (sigma_0 + sigma_1)/2 : d eps_p dV`.

use crate::element::stiffness_points;
use crate::kinematics::jacobian;
use crate::material::PointState;
use crate::model::Model;

/// Plastic work [J] from `old` to `new`. Shapes `[points]`.
pub fn plastic_work(model: &Model, old: &[PointState], new: &[PointState]) -> f64 {
    let mesh = model.mesh();
    let mut total = 0.0;
    for e in 0..mesh.element_count() {
        let x = mesh.element_coordinates(e);
        let points = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
        for (point, p) in points.iter().zip(model.point_start(e)..) {
            let volume = point.weight * jacobian(&x, &point.gradients).1;
            for k in 0..6 {
                let mean = 0.5 * (old[p].stress[k] + new[p].stress[k]);
                total += volume * mean * (new[p].plastic_strain[k] - old[p].plastic_strain[k]);
            }
        }
    }
    total
}
