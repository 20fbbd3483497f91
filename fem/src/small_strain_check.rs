//! Check of the small-strain and small-rotation assumptions.

use crate::element::stiffness_points;
use crate::model::Model;

/// Largest strain, rotation and displacement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SmallStrainMeasures {
    /// Largest strain at a Gauss point, `sqrt(ε:ε)` [-].
    pub strain: f64,
    /// Its element (file number).
    pub strain_element: u32,
    /// Largest rotation at a Gauss point, half the curl [rad].
    pub rotation: f64,
    /// Its element.
    pub rotation_element: u32,
    /// Largest displacement relative to element size, without the mean [m].
    pub displacement: f64,
    /// Longest side of that element's bounds [m].
    pub size: f64,
    /// Its element.
    pub displacement_element: u32,
}

/// Computes the extent of a displacement, shape `[3 * nodes]`.
pub fn small_strain_measures(model: &Model, u: &[f64]) -> SmallStrainMeasures {
    let mesh = model.mesh();
    let nodes = mesh.node_count().max(1) as f64;
    let mean: [f64; 3] = std::array::from_fn(|k| u.iter().skip(k).step_by(3).sum::<f64>() / nodes);
    let (mut found, mut worst) = (SmallStrainMeasures::default(), 0.0);
    for (e, &id) in mesh.element_ids.iter().enumerate() {
        let (strains, moved) = (model.element_strains(e), mesh.element_values(e, u));
        for point in stiffness_points(mesh.connectivity.kind(e), model.quadrature()) {
            let at = strains.at_point(point);
            let s = strains.strain(&at, &moved);
            let normal = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
            let size = (normal + 0.5 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])).sqrt();
            if size > found.strain {
                (found.strain, found.strain_element) = (size, id);
            }
            let rotation = rotation(&at.gradients, &moved[..mesh.connectivity[e].len()]);
            if rotation > found.rotation {
                (found.rotation, found.rotation_element) = (rotation, id);
            }
        }
        let nodes = &mesh.connectivity[e];
        let side = |k: usize| {
            let along = || nodes.iter().map(|&n| mesh.coordinates[n as usize][k]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        let size = (0..3).map(side).fold(0.0, f64::max);
        let way = |n: &u32| (0..3).map(|k| (u[3 * *n as usize + k] - mean[k]).powi(2)).sum::<f64>().sqrt();
        let displacement = nodes.iter().map(way).fold(0.0, f64::max);
        if displacement / size > worst {
            worst = displacement / size;
            (found.displacement, found.size, found.displacement_element) = (displacement, size, id);
        }
    }
    found
}

fn rotation(gradients: &[[f64; 3]], moved: &[[f64; 3]]) -> f64 {
    let slope = |i: usize, j: usize| gradients.iter().zip(moved).map(|(g, u)| u[i] * g[j]).sum::<f64>();
    let axis = [slope(2, 1) - slope(1, 2), slope(0, 2) - slope(2, 0), slope(1, 0) - slope(0, 1)];
    0.5 * axis.iter().map(|w| w * w).sum::<f64>().sqrt()
}
