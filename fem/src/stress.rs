//! Stress recovery. Components xx, yy, zz, xy, yz, zx [Pa], tension positive.
//!
//! Nodal stresses: the stress at the eight points of the 2×2×2 rule, where that of the hex20 is one order better than
//! elsewhere (Barlow, Int. J. Numer. Methods Eng. 10 (1976) 243-251), is continued to the nodes by the trilinear
//! polynomial through those points, for both rules of the stiffness. At a shared node the mean over the elements of each
//! material is formed first, then the mean over the materials, so that a layer with many small elements does not
//! outweigh its neighbour. Limits: at a material border the true stress jumps in some components; the mean hides that, and
//! [`at_natural`] on either side shows it.

use crate::element::hex20;
use crate::element::quadrature::{GAUSS2, LINE2};
use crate::kinematics::{ElementCoordinates, spatial_gradients, strain};
use crate::mesh::HEX20_NODES;
use crate::model::Model;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Stress at the points of the model's rule in element `element` (index), in the order of the rule.
pub fn gauss(model: &Model, u: &[f64], element: usize) -> Vec<[f64; 6]> {
    model.quadrature().points().iter().map(|(xi, _)| at_natural(model, u, element, *xi)).collect()
}

/// Stress at the natural point `xi` of element `element` (index).
pub fn at_natural(model: &Model, u: &[f64], element: usize, xi: [f64; 3]) -> [f64; 6] {
    let mesh = model.mesh();
    let moved: ElementCoordinates =
        mesh.connectivity[element].map(|n| std::array::from_fn(|k| u[3 * n as usize + k]));
    let (gradients, _) = spatial_gradients(&mesh.element_coordinates(element), xi);
    model.material(element).stress(&strain(&gradients, &moved))
}

/// Stress at every node, extrapolated and averaged as told above. Shape `[nodes][6]`.
pub fn nodal(model: &Model, u: &[f64]) -> Vec<[f64; 6]> {
    let mesh = model.mesh();
    let elements: Vec<[[f64; 6]; HEX20_NODES]> = (0..mesh.element_count())
        .into_par_iter()
        .map(|e| extrapolate(&GAUSS2.map(|(xi, _)| at_natural(model, u, e, xi))))
        .collect();
    // Sum and count per node and material, in element order.
    let mut sums: Vec<BTreeMap<u32, ([f64; 6], u32)>> = vec![BTreeMap::new(); mesh.node_count()];
    for (e, stresses) in elements.iter().enumerate() {
        for (&node, stress) in mesh.connectivity[e].iter().zip(stresses) {
            let (sum, count) = sums[node as usize].entry(mesh.materials[e]).or_default();
            sum.iter_mut().zip(stress).for_each(|(sum, s)| *sum += s);
            *count += 1;
        }
    }
    sums.iter()
        .map(|by_material| {
            let mut mean = [0.0; 6];
            for (sum, count) in by_material.values() {
                for k in 0..6 {
                    mean[k] += sum[k] / (f64::from(*count) * by_material.len() as f64);
                }
            }
            mean
        })
        .collect()
}

/// Equivalent stress of von Mises [Pa].
pub fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    (0.5 * normal + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])).sqrt()
}

/// Values at the 2×2×2 points → values at the nodes, by the trilinear polynomial through the points.
fn extrapolate(points: &[[f64; 6]; 8]) -> [[f64; 6]; HEX20_NODES] {
    hex20::NATURAL.map(|node| {
        let mut stress = [0.0; 6];
        for (value, (xi, _)) in points.iter().zip(&GAUSS2) {
            let weight: f64 = (0..3).map(|k| 0.5 * (1.0 + node[k] * xi[k] / LINE2[1].0.powi(2))).product();
            for c in 0..6 {
                stress[c] += weight * value[c];
            }
        }
        stress
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extrapolation_is_exact_for_trilinear_fields() {
        let field = |x: [f64; 3]| 2.0 + x[0] - 3.0 * x[1] * x[2] + 0.5 * x[0] * x[1] * x[2];
        let points = GAUSS2.map(|(xi, _)| [field(xi); 6]);
        for (node, s) in hex20::NATURAL.iter().zip(extrapolate(&points)) {
            assert!((s[0] - field(*node)).abs() < 1e-13 && (s[5] - field(*node)).abs() < 1e-13);
        }
    }

    #[test]
    fn von_mises_of_known_states() {
        assert!((von_mises(&[5.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 5.0).abs() < 1e-15);
        assert!((von_mises(&[1.0, 1.0, 1.0, 0.0, 2.0, 0.0]) - 12.0_f64.sqrt()).abs() < 1e-15);
    }
}
