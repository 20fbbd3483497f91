//! Fields at points of a mesh, and stress at the integration points of a box.

use crate::element::{MAX_NODES, stiffness_points};
use crate::kinematics::jacobian;
use crate::mesh::Mesh;
use crate::model::Model;
use crate::state::State;
use crate::stress::{self, NodeSum};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::ops::Range;

/// Points at which fields are interpolated.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Node indices, ascending.
    nodes: Vec<u32>,
    /// Elements (indices) with any of these nodes, ascending.
    elements: Vec<u32>,
    /// Position in `nodes` and weight, per point.
    points: Vec<Vec<(usize, f64)>>,
}

impl Samples {
    /// Points of `mesh`, each by node indices and weights.
    pub fn new(mesh: &Mesh, points: &[Vec<(u32, f64)>]) -> Samples {
        let nodes: Vec<u32> =
            points.iter().flatten().map(|(node, _)| *node).collect::<BTreeSet<_>>().into_iter().collect();
        let near = |e: &usize| mesh.connectivity[*e].iter().any(|n| nodes.binary_search(n).is_ok());
        let elements = (0..mesh.element_count()).filter(near).map(|e| e as u32).collect();
        let place = |node: &u32| nodes.partition_point(|n| n < node);
        let points =
            points.iter().map(|point| point.iter().map(|(node, w)| (place(node), *w)).collect()).collect();
        Samples { nodes, elements, points }
    }

    /// Returns the number of points.
    pub fn count(&self) -> usize {
        self.points.len()
    }

    /// Position of a point in `mesh` [m].
    ///
    /// # Panics
    /// If there is no such point.
    pub fn position(&self, mesh: &Mesh, point: usize) -> [f64; 3] {
        std::array::from_fn(|d| {
            self.points[point].iter().map(|(k, w)| w * mesh.coordinates[self.nodes[*k] as usize][d]).sum()
        })
    }

    /// Nodal vectors `field` at the points. Shape of `field` `[3 * nodes]`.
    pub fn vector(&self, field: &[f64]) -> Vec<[f64; 3]> {
        let of_node = |n: &u32| std::array::from_fn(|d| field[3 * *n as usize + d]);
        let values: Vec<[f64; 3]> = self.nodes.iter().map(of_node).collect();
        self.interpolate(&values)
    }

    /// Stress [Pa], as in [`stress::nodal`], or [`stress::nodal_of_points`] if the state has points.
    pub fn stress(&self, model: &Model, state: &State) -> Vec<[f64; 6]> {
        if state.points.is_empty() {
            return self.interpolate(&self.mean(model, |e| stress::elastic_at_nodes(model, &state.u, e)));
        }
        let of_point = |_: usize, p: usize| state.points[p].stress;
        self.interpolate(&self.mean(model, |e| stress::fitted_at_nodes(model, e, &of_point)))
    }

    /// Strain tensor, from [`stress::strain_at_point`].
    pub fn strain(&self, model: &Model, state: &State) -> Vec<[f64; 6]> {
        let of_point = |e: usize, p: usize| stress::strain_at_point(model, &state.u, e, p);
        self.interpolate(&self.mean(model, |e| stress::fitted_at_nodes(model, e, &of_point)))
    }

    /// Averages in the order of [`stress::nodal_mean`], so that bits agree.
    fn mean<const C: usize>(
        &self,
        model: &Model,
        of_element: impl Fn(usize) -> [[f64; C]; MAX_NODES] + Send + Sync,
    ) -> Vec<[f64; C]> {
        let mesh = model.mesh();
        let values: Vec<[[f64; C]; MAX_NODES]> =
            self.elements.par_iter().map(|&e| of_element(e as usize)).collect();
        let mut sums: Vec<NodeSum<C>> = vec![NodeSum::default(); self.nodes.len()];
        for (&e, values) in self.elements.iter().zip(&values) {
            for (node, value) in mesh.connectivity[e as usize].iter().zip(values) {
                if let Ok(k) = self.nodes.binary_search(node) {
                    sums[k].add(mesh.materials[e as usize], value);
                }
            }
        }
        sums.iter().map(NodeSum::mean).collect()
    }

    fn interpolate<const C: usize>(&self, values: &[[f64; C]]) -> Vec<[f64; C]> {
        let at = |point: &Vec<(usize, f64)>| {
            let mut sum = [0.0; C];
            for (k, weight) in point {
                sum.iter_mut().zip(&values[*k]).for_each(|(sum, v)| *sum += weight * v);
            }
            sum
        };
        self.points.iter().map(at).collect()
    }
}

/// Integration points inside a box.
#[derive(Clone, Debug)]
pub struct BoxPoints {
    /// Element index, and its points with their volumes [m³].
    elements: Vec<(usize, Vec<(usize, f64)>)>,
}

impl BoxPoints {
    /// Points of `elements` between the corners `low` and `high` [m]; `None` without any.
    pub fn new(model: &Model, elements: Range<usize>, low: [f64; 3], high: [f64; 3]) -> Option<BoxPoints> {
        let mesh = model.mesh();
        let of_element = |e: usize| {
            let x = mesh.element_coordinates(e);
            let rule = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
            let points = rule.iter().enumerate().filter_map(|(i, point)| {
                let place = |d: usize| x.iter().zip(&point.shape).map(|(x, n)| n * x[d]).sum::<f64>();
                let inside = (0..3).all(|d| (low[d]..=high[d]).contains(&place(d)));
                inside.then(|| (i, point.weight * jacobian(&x, &point.gradients).1))
            });
            let points: Vec<(usize, f64)> = points.collect();
            (!points.is_empty()).then_some((e, points))
        };
        let elements: Vec<_> = elements.filter_map(of_element).collect();
        (!elements.is_empty()).then_some(BoxPoints { elements })
    }

    /// Stress [Pa] and volume [m³] of each point.
    pub fn stress(&self, model: &Model, state: &State) -> Vec<([f64; 6], f64)> {
        let of_element = |(e, points): &(usize, Vec<(usize, f64)>)| -> Vec<([f64; 6], f64)> {
            if state.points.is_empty() {
                let stresses = stress::gauss(model, &state.u, *e);
                return points.iter().map(|&(i, volume)| (stresses[i], volume)).collect();
            }
            let first = model.point_start(*e);
            points.iter().map(|&(i, volume)| (state.points[first + i].stress, volume)).collect()
        };
        self.elements.par_iter().map(of_element).collect::<Vec<_>>().concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Elastic, Material};
    use crate::model::ModelInput;
    use std::collections::BTreeMap;

    fn model() -> (Model, State) {
        let mut mesh = Mesh::block([2, 2, 2], [2.0, 1.0, 1.0]);
        mesh.materials[5] = 2;
        let of = |young| Material::from(Elastic { young, poisson: 0.3, density: 2000.0 });
        let materials = BTreeMap::from([(1, of(1e7)), (2, of(3e7))]);
        let model = Model::new(ModelInput { mesh, materials, ..ModelInput::default() }).unwrap();
        let mut state = State::new(&model);
        for (k, u) in state.u.iter_mut().enumerate() {
            *u = 1e-4 * (((k * 37) % 101) as f64 - 50.0);
        }
        (model, state)
    }

    /// Bits of [`stress::nodal`] and [`stress::nodal_from_points`] at all nodes, also between materials.
    #[test]
    fn nodes_have_their_averages() {
        let (model, state) = model();
        let mesh = model.mesh();
        let stresses = stress::nodal(&model, &state.u);
        let strains =
            stress::nodal_from_points(&model, |e, p| stress::strain_at_point(&model, &state.u, e, p));
        for node in 0..mesh.node_count() {
            let sample = Samples::new(mesh, &[vec![(node as u32, 1.0)]]);
            assert_eq!(sample.stress(&model, &state), [stresses[node]]);
            assert_eq!(sample.strain(&model, &state), [strains[node]]);
            assert_eq!(sample.vector(&state.u), [[0, 1, 2].map(|d| state.u[3 * node + d])]);
        }
        let two = Samples::new(mesh, &[vec![(7, 0.25), (3, 0.75)], vec![(9, 1.0)]]);
        let expected = [0, 1, 2, 3, 4, 5].map(|c| 0.25 * stresses[7][c] + 0.75 * stresses[3][c]);
        assert_eq!(two.stress(&model, &state), [expected, stresses[9]]);
    }

    #[test]
    fn point_volumes_sum_to_box() {
        let (model, state) = model();
        let all = BoxPoints::new(&model, 0..8, [0.0; 3], [2.0, 1.0, 1.0]).unwrap();
        let points = all.stress(&model, &state);
        assert_eq!(points.len(), 64);
        assert!((points.iter().map(|p| p.1).sum::<f64>() - 2.0).abs() < 1e-14);
        let upper = BoxPoints::new(&model, 0..8, [0.0, 0.0, 0.5], [2.0, 1.0, 1.0]).unwrap();
        assert!((upper.stress(&model, &state).iter().map(|p| p.1).sum::<f64>() - 1.0).abs() < 1e-14);
        assert!(BoxPoints::new(&model, 0..8, [0.0, 0.0, 0.49], [2.0, 1.0, 0.51]).is_none());
    }
}
