//! Distributed load transfer over discs about the surface nodes.
//!
//! The surface follows the best-fitting rigid motion of each disc; forces use the transpose. Theory manual:
//! eqs. (5.4), (5.5); RBE3 (MSC/NASTRAN Quick Reference Guide).
//!
//! Compliance ripple on 20-node hexahedra of edge h: 17, 9, 6, 4 % for radii 0.4, 0.6, 0.75, 1 h. Limits:
//! one radius, small rotations; discs wrap around sharp edges.

use crate::face::{cross, dot};

/// Load transfer operator, built by [`distribute_over_discs`](crate::surface::SolidSurface::distribute_over_discs).
pub struct DistributedTransfer {
    pub(crate) radius: f64,
    /// Start of the weights of each node. Shape `[nodes + 1]`.
    pub(crate) first: Vec<u32>,
    /// Surface node and weight.
    pub(crate) weights: Vec<(u32, f64)>,
    /// Nodes off the centroid of their disc.
    pub(crate) eccentric: Vec<EccentricDisc>,
}

/// Rotation of an eccentric disc.
pub(crate) struct EccentricDisc {
    pub node: u32,
    /// xᵢ − c.
    pub arm: [f64; 3],
    pub inverse: [[f64; 3]; 3],
    /// Σ w_k N_j(x_k)(x_k − c) per surface node j.
    pub levers: Vec<(u32, [f64; 3])>,
}

impl DistributedTransfer {
    /// Radius of the discs [m].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Averages `field` over the discs. Shapes `[surface nodes][3]`.
    pub fn mean(&self, field: &[[f64; 3]], out: &mut [[f64; 3]]) {
        for (i, o) in out.iter_mut().enumerate() {
            *o = [0.0; 3];
            for &(j, w) in &self.weights[self.first[i] as usize..self.first[i + 1] as usize] {
                let u = &field[j as usize];
                (0..3).for_each(|d| o[d] += w * u[d]);
            }
        }
        for t in &self.eccentric {
            let mut moment = [0.0; 3];
            for (j, b) in &t.levers {
                let m = cross(*b, field[*j as usize]);
                (0..3).for_each(|d| moment[d] += m[d]);
            }
            let turn = cross(t.inverse.map(|row| dot(row, moment)), t.arm);
            (0..3).for_each(|d| out[t.node as usize][d] += turn[d]);
        }
    }

    /// Distributes nodal forces of shape `[surface nodes][3]`: calls `add` with surface node and force.
    pub fn distribute(&self, forces: &[[f64; 3]], mut add: impl FnMut(u32, [f64; 3])) {
        for (i, force) in forces.iter().enumerate().filter(|(_, f)| **f != [0.0; 3]) {
            for &(j, w) in &self.weights[self.first[i] as usize..self.first[i + 1] as usize] {
                add(j, force.map(|f| w * f));
            }
        }
        for t in self.eccentric.iter().filter(|t| forces[t.node as usize] != [0.0; 3]) {
            let lever = cross(t.arm, forces[t.node as usize]);
            let moment = t.inverse.map(|row| dot(row, lever));
            t.levers.iter().for_each(|(j, b)| add(*j, cross(moment, *b)));
        }
    }
}
