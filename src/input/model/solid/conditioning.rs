//! Ill-conditioned solids: constrained, but with too different stiffnesses.

use trackbed_fem::model::Model;

/// Modulus ratio that may explain a lost pivot.
const UNLIKE: f64 = 1e6;
/// Edge ratio that may explain a lost pivot.
const FLAT: f64 = 500.0;

fn contrast(model: &Model) -> f64 {
    let moduli = || (0..model.mesh().element_count()).map(|e| model.elastic(e).young);
    moduli().fold(0.0, f64::max) / moduli().fold(f64::INFINITY, f64::min)
}

fn flattest(model: &Model) -> (f64, u32) {
    let mesh = model.mesh();
    let ratio = |e: usize| {
        let nodes = &mesh.connectivity[e];
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        for &[a, b] in mesh.connectivity.kind(e).edges() {
            let (x, y) = (mesh.coordinates[nodes[a] as usize], mesh.coordinates[nodes[b] as usize]);
            let length = (0..3).map(|k| (x[k] - y[k]).powi(2)).sum::<f64>().sqrt();
            (shortest, longest) = (shortest.min(length), longest.max(length));
        }
        longest / shortest
    };
    let ratios = (0..mesh.element_count()).map(|e| (ratio(e), mesh.element_ids[e]));
    ratios.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, 0))
}

/// Whether a pivot may be lost in a constrained body.
pub fn is_poor(model: &Model) -> bool {
    contrast(model) >= UNLIKE || flattest(model).0 >= FLAT
}

/// Describes the ill-conditioning; `pivot` remains at node `node`.
pub fn message(model: &Model, node: u32, pivot: f64) -> String {
    let (flatness, element) = flattest(model);
    format!(
        "mesh: found an ill-conditioned stiffness matrix: pivot {pivot:.1e} of the diagonal at node {node} (limit 1e-11), ratio of Young's moduli {:.1e}, aspect ratio of element {element} {flatness:.1e}, expected smaller ratios and sufficient supports",
        contrast(model)
    )
}
