//! Plastic work at the Gauss points, `∫ (sigma_0 + sigma_1)/2 : d eps_p dV`.

use crate::element::stiffness_points;
use crate::kinematics::jacobian;
use crate::material::Points;
use crate::model::Model;

/// Plastic work, or dissipation by the law, [J] from `old` to `new`. Shapes `[points]`.
pub fn plastic_work(model: &Model, old: &Points, new: &Points) -> f64 {
    let mesh = model.mesh();
    let mut total = 0.0;
    for e in 0..mesh.element_count() {
        let x = mesh.element_coordinates(e);
        let points = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
        for (i, (point, p)) in points.iter().zip(model.point_start(e)..).enumerate() {
            let volume = point.weight * jacobian(&x, &point.gradients).1;
            let [before, after] = [old, new].map(|points| model.point(points, e, i));
            if let Some(lost) = model.material(e).law.dissipation(before, after) {
                total += volume * lost;
                continue;
            }
            for k in 0..6 {
                let mean = 0.5 * (old[p].stress[k] + new[p].stress[k]);
                total += volume * mean * (new[p].plastic_strain[k] - old[p].plastic_strain[k]);
            }
        }
    }
    total
}
