//! Stress recovery: xx, yy, zz, xy, yz, zx [Pa], tension positive.
//!
//! Stresses at the 2×2×2 points, superconvergent in the hex20 (Barlow 1976), are extrapolated trilinearly to
//! the nodes; other shapes: [`crate::element::NaturalShape`]. Shared nodes average over elements of each
//! material, then over materials. Limits: stress jumps at material interfaces are averaged; see
//! [`at_natural`].

use crate::element::quadrature::Quadrature;
use crate::element::{ElementKind, MAX_NODES, stiffness_points};
use crate::kinematics::jacobian;
use crate::model::Model;
use crate::state::State;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Stress at the integration points of an element (index).
pub fn gauss(model: &Model, u: &[f64], element: usize) -> Vec<[f64; 6]> {
    let points = stiffness_points(model.mesh().connectivity.kind(element), model.quadrature());
    at_points(model, u, element, points.iter().map(|p| p.xi))
}

/// Stress at the natural point `xi` of an element (index).
pub fn at_natural(model: &Model, u: &[f64], element: usize, xi: [f64; 3]) -> [f64; 6] {
    let strains = model.element_strains(element);
    let strain = strains.strain(&strains.at(xi), &model.mesh().element_values(element, u));
    model.elastic(element).stress(&strain)
}

fn at_points(
    model: &Model,
    u: &[f64],
    element: usize,
    points: impl Iterator<Item = [f64; 3]>,
) -> Vec<[f64; 6]> {
    let strains = model.element_strains(element);
    let moved = model.mesh().element_values(element, u);
    points.map(|xi| model.elastic(element).stress(&strains.strain(&strains.at(xi), &moved))).collect()
}

pub(crate) fn sampling_points(kind: ElementKind) -> Vec<[f64; 3]> {
    if kind.properties().constant_stress {
        return vec![kind.natural_centre()];
    }
    kind.shape().sampling_rule().iter().map(|p| p.0).collect()
}

/// Averaged nodal stress. Shape `[nodes][6]`.
pub fn nodal(model: &Model, u: &[f64]) -> Vec<[f64; 6]> {
    nodal_mean(model, |e| elastic_at_nodes(model, u, e))
}

pub(crate) fn elastic_at_nodes(model: &Model, u: &[f64], element: usize) -> [[f64; 6]; MAX_NODES] {
    let kind = model.mesh().connectivity.kind(element);
    let stresses = at_points(model, u, element, sampling_points(kind).into_iter());
    extrapolate(kind, &stresses)
}

/// Averaged nodal values of `of_point(element, index in State::points)`. Shape `[nodes][C]`.
///
/// Least squares per element, exact for the 2×2×2 rule.
pub fn nodal_from_points<const C: usize>(
    model: &Model,
    of_point: impl Fn(usize, usize) -> [f64; C] + Send + Sync,
) -> Vec<[f64; C]> {
    nodal_mean(model, |e| fitted_at_nodes(model, e, &of_point))
}

/// Values of an element (index) at its nodes, fitted to `of_point` as in [`nodal_from_points`].
pub(crate) fn fitted_at_nodes<const C: usize>(
    model: &Model,
    element: usize,
    of_point: &impl Fn(usize, usize) -> [f64; C],
) -> [[f64; C]; MAX_NODES] {
    let kind = model.mesh().connectivity.kind(element);
    let start = model.point_start(element);
    let mut values = [[0.0; C]; MAX_NODES];
    for (value, weights) in values.iter_mut().zip(fit_weights(kind, model.quadrature())) {
        for (i, weight) in weights.iter().enumerate() {
            let point = of_point(element, start + i);
            for c in 0..C {
                value[c] += weight * point[c];
            }
        }
    }
    values
}

/// Strain tensor at a point (index in [`State::points`]) of an element (index).
pub fn strain_at_point(model: &Model, u: &[f64], element: usize, point: usize) -> [f64; 6] {
    let kind = model.mesh().connectivity.kind(element);
    let rule = stiffness_points(kind, model.quadrature());
    let strains = model.element_strains(element);
    let moved = model.mesh().element_values(element, u);
    tensor(strains.strain(&strains.at(rule[point - model.point_start(element)].xi), &moved))
}

/// Tensor components of a strain with engineering shear.
pub fn tensor([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> [f64; 6] {
    [xx, yy, zz, 0.5 * xy, 0.5 * yz, 0.5 * zx]
}

/// Nodal stress from point states. Shape `[nodes][6]`.
pub fn nodal_of_points(model: &Model, state: &State) -> Vec<[f64; 6]> {
    nodal_from_points(model, |_, p| state.points[p].stress)
}

/// Nodal equivalent plastic strain [-], not below 0. Shape `[nodes]`.
pub fn nodal_kappa(model: &Model, state: &State) -> Vec<f64> {
    nodal_from_points(model, |_, p| [state.points[p].kappa]).into_iter().map(|[k]| k.max(0.0)).collect()
}

/// Nodal yield function [Pa]; minus infinity next to elastic elements. Shape `[nodes]`.
pub fn nodal_yield_function(model: &Model, state: &State) -> Vec<f64> {
    nodal_from_points(model, |e, p| {
        let point = model.point(&state.points, e, p - model.point_start(e));
        [model.material(e).law.yield_function(point)]
    })
    .into_iter()
    .map(|[f]| if f.is_nan() { f64::NEG_INFINITY } else { f })
    .collect()
}

/// Centre [m] and mean stress [Pa] of an element (index).
pub fn centroid_of_points(model: &Model, state: &State, element: usize) -> ([f64; 3], [f64; 6]) {
    let mesh = model.mesh();
    let (x, kind) = (mesh.element_coordinates(element), mesh.connectivity.kind(element));
    let shape = kind.shape_functions(kind.natural_centre());
    let centre = std::array::from_fn(|k| shape.iter().zip(&x).map(|(n, x)| n * x[k]).sum());
    let (mut mean, mut volume) = ([0.0; 6], 0.0);
    let first = model.point_start(element);
    for (i, point) in stiffness_points(kind, model.quadrature()).iter().enumerate() {
        let part = point.weight * jacobian(&x, &point.gradients).1;
        volume += part;
        for (mean, s) in mean.iter_mut().zip(&state.points[first + i].stress) {
            *mean += part * s;
        }
    }
    (centre, mean.map(|m| m / volume))
}

/// Least-squares weights. Shape `[nodes][points]`.
fn fit_weights(kind: ElementKind, rule: Quadrature) -> &'static [Vec<f64>] {
    static TABLES: [[OnceLock<Vec<Vec<f64>>>; 3]; ElementKind::ALL.len()] =
        [const { [const { OnceLock::new() }; 3] }; ElementKind::ALL.len()];
    TABLES[kind as usize][rule as usize].get_or_init(|| {
        let terms = |x: [f64; 3]| {
            if kind.properties().constant_stress { vec![1.0] } else { kind.shape().fit_terms(x) }
        };
        let points: Vec<Vec<f64>> = stiffness_points(kind, rule).iter().map(|p| terms(p.xi)).collect();
        let a = DMatrix::from_fn(points.len(), points[0].len(), |i, j| points[i][j]);
        // Invertible: the points of every rule separate these polynomials.
        let fit = (a.transpose() * &a).try_inverse().map(|inverse| inverse * a.transpose());
        let weights = |x: &[f64; 3]| {
            let at = DMatrix::from_row_slice(1, points[0].len(), &terms(*x));
            fit.as_ref().map_or_else(
                || vec![1.0 / points.len() as f64; points.len()],
                |fit| (at * fit).iter().copied().collect(),
            )
        };
        kind.natural().iter().map(weights).collect()
    })
}

/// Averages `of_element(e)` over elements of each material, then over materials. Shape `[nodes][C]`.
pub(crate) fn nodal_mean<const C: usize>(
    model: &Model,
    of_element: impl Fn(usize) -> [[f64; C]; MAX_NODES] + Send + Sync,
) -> Vec<[f64; C]> {
    let mesh = model.mesh();
    let elements: Vec<[[f64; C]; MAX_NODES]> =
        (0..mesh.element_count()).into_par_iter().map(of_element).collect();
    let mut sums: Vec<NodeSum<C>> = vec![NodeSum::default(); mesh.node_count()];
    for (e, values) in elements.iter().enumerate() {
        for (&node, value) in mesh.connectivity[e].iter().zip(values) {
            sums[node as usize].add(mesh.materials[e], value);
        }
    }
    sums.iter().map(NodeSum::mean).collect()
}

/// Sums and counts of element values at a node, by material.
#[derive(Clone, Debug, Default)]
pub(crate) struct NodeSum<const C: usize>(BTreeMap<u32, ([f64; C], u32)>);

impl<const C: usize> NodeSum<C> {
    pub(crate) fn add(&mut self, material: u32, value: &[f64; C]) {
        let (sum, count) = self.0.entry(material).or_insert(([0.0; C], 0));
        sum.iter_mut().zip(value).for_each(|(sum, s)| *sum += s);
        *count += 1;
    }

    pub(crate) fn mean(&self) -> [f64; C] {
        let mut mean = [0.0; C];
        for (sum, count) in self.0.values() {
            for k in 0..C {
                mean[k] += sum[k] / (f64::from(*count) * self.0.len() as f64);
            }
        }
        mean
    }
}

/// Von Mises stress [Pa].
pub fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    (0.5 * normal + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])).sqrt()
}

/// Extrapolates from [`sampling_points`] to nodes.
pub(crate) fn extrapolate<const C: usize>(kind: ElementKind, points: &[[f64; C]]) -> [[f64; C]; MAX_NODES] {
    let constant = kind.properties().constant_stress;
    let mut nodes = [[0.0; C]; MAX_NODES];
    for (value, node) in nodes.iter_mut().zip(kind.natural()) {
        for (i, point) in points.iter().enumerate() {
            let weight = if constant { 1.0 } else { kind.shape().extrapolation_weight(i, *node) };
            for c in 0..C {
                value[c] += weight * point[c];
            }
        }
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::NaturalShape;

    #[test]
    fn extrapolation_is_exact_for_polynomials() {
        for kind in ElementKind::ALL {
            let field = |x: [f64; 3]| match kind.shape() {
                NaturalShape::Hexahedron => 2.0 + x[0] - 3.0 * x[1] * x[2] + 0.5 * x[0] * x[1] * x[2],
                NaturalShape::Wedge => 2.0 + x[0] - 3.0 * x[1] + x[2] * (0.5 - x[0] + 2.0 * x[1]),
                _ if !kind.properties().constant_stress => 2.0 + x[0] - 3.0 * x[1] + 0.5 * x[2],
                _ => 2.0,
            };
            let points: Vec<_> = sampling_points(kind).into_iter().map(|xi| [field(xi); 6]).collect();
            for (node, s) in kind.natural().iter().zip(extrapolate(kind, &points)) {
                let name = kind.name();
                assert!((s[0] - field(*node)).abs() < 1e-13 && (s[5] - field(*node)).abs() < 1e-13, "{name}");
            }
        }
    }

    #[test]
    fn fit_reproduces_polynomials() {
        for kind in ElementKind::ALL {
            let field = |x: [f64; 3]| match kind.shape() {
                NaturalShape::Hexahedron => 2.0 + x[0] - 3.0 * x[1] * x[2] + 0.5 * x[0] * x[1] * x[2],
                NaturalShape::Wedge => 2.0 + x[0] - 3.0 * x[1] + x[2] * (0.5 - x[0] + 2.0 * x[1]),
                NaturalShape::Tetrahedron if !kind.properties().constant_stress => {
                    2.0 + x[0] - 3.0 * x[1] + 0.5 * x[2]
                }
                _ => 2.0,
            };
            for rule in [Quadrature::Gauss2, Quadrature::Irons14, Quadrature::Gauss3] {
                let points = stiffness_points(kind, rule);
                for (node, weights) in kind.natural().iter().zip(fit_weights(kind, rule)) {
                    let value: f64 = weights.iter().zip(points).map(|(w, p)| w * field(p.xi)).sum();
                    assert!((value - field(*node)).abs() < 1e-12, "{} {rule:?}: {value}", kind.name());
                }
            }
        }
    }

    #[test]
    fn von_mises_of_known_states() {
        assert!((von_mises(&[5.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 5.0).abs() < 1e-15);
        assert!((von_mises(&[1.0, 1.0, 1.0, 0.0, 2.0, 0.0]) - 12.0_f64.sqrt()).abs() < 1e-15);
    }
}
