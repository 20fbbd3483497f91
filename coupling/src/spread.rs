//! Distributed transfer: contact forces reach the solid through discs, and grains see the motion of the same discs.
//!
//! Every surface node i has a disc of the given radius about it in the surface's tangent plane there, with quadrature
//! points x_k of weights w_k that are fixed to the material. The surface that grains touch has its nodes displaced by
//! the mean motion of their discs; with c = Σ w_k x_k and the inertia J of the points about c,
//!
//! ūᵢ = Σ w_k u(x_k) + Ω × (xᵢ − c),   Ω = J⁻¹ Σ w_k (x_k − c) × u(x_k),
//!
//! the displacement at node i of the rigid motion that fits the disc's motion best. A contact force acts on the nodes of
//! the touched face with its shape functions, and from each node i on its disc by the transpose,
//! f_k = w_k (Fᵢ + m × (x_k − c)), m = J⁻¹ ((xᵢ − c) × Fᵢ). So Σ f_k = Fᵢ and Σ x_k × f_k = xᵢ × Fᵢ to rounding in the
//! mesh's own shape, on curved faces and at borders as well; and because forces go one way by the transpose of what
//! motion comes back by, the work on both sides is that of a point transfer: spreading adds no energy.
//!
//! The operator is made once and applied once per window; between nodes of the surface the shape functions interpolate.
//! On block B (elements of edge h) the ripple of the compliance along the mid-line falls with the radius as that of a disc
//! about the contact point itself would with a radius smaller by a third: 17, 9, 6, 4 % for 0.4, 0.6, 0.75, 1 h.
//!
//! At a border of the surface the disc is squeezed to an ellipse that touches it; opposite points that still miss the
//! surface, as in a corner, move in together. At a corner nothing is left to spread over, and the force acts on the node.
//!
//! Source: mean motion of a set of points as the interpolation element of structural codes has it (RBE3; MSC/NASTRAN
//! Quick Reference Guide); a load and its conjugate motion in point-to-patch coupling. Limits: one radius for all stones;
//! small rotations, as in the solid; where a side's two faces meet at a sharp angle the disc wraps around.
//!
//! Theory manual: equations (5.4), (5.5) of `docs/theory/coupling.md`.

use crate::face::{cross, dot};

/// The operator of a surface. Build it with [`spread_over`](crate::surface::SolidSurface::spread_over).
pub struct Spread {
    pub(crate) radius: f64,
    /// Where the weights of each node begin, and one more. Shape `[nodes + 1]`.
    pub(crate) first: Vec<u32>,
    /// Surface node and weight.
    pub(crate) weights: Vec<(u32, f64)>,
    /// Nodes whose disc is not centred on them.
    pub(crate) turned: Vec<Turned>,
}

/// The rotation of a disc that is not centred on its node.
pub(crate) struct Turned {
    pub node: u32,
    /// xᵢ − c.
    pub arm: [f64; 3],
    pub inverse: [[f64; 3]; 3],
    /// Σ w_k N_j(x_k)(x_k − c) of each surface node j.
    pub levers: Vec<(u32, [f64; 3])>,
}

impl Spread {
    /// Radius of the discs [m].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Mean motion of every node's disc. Shapes `[surface nodes][3]`.
    pub fn mean(&self, field: &[[f64; 3]], out: &mut [[f64; 3]]) {
        for (i, o) in out.iter_mut().enumerate() {
            *o = [0.0; 3];
            for &(j, w) in &self.weights[self.first[i] as usize..self.first[i + 1] as usize] {
                let u = &field[j as usize];
                (0..3).for_each(|d| o[d] += w * u[d]);
            }
        }
        for t in &self.turned {
            let mut moment = [0.0; 3];
            for (j, b) in &t.levers {
                let m = cross(*b, field[*j as usize]);
                (0..3).for_each(|d| moment[d] += m[d]);
            }
            let turn = cross(t.inverse.map(|row| dot(row, moment)), t.arm);
            (0..3).for_each(|d| out[t.node as usize][d] += turn[d]);
        }
    }

    /// Spreads forces at the surface nodes, shape `[surface nodes][3]`: calls `add` with surface node and force.
    pub fn distribute(&self, forces: &[[f64; 3]], mut add: impl FnMut(u32, [f64; 3])) {
        for (i, force) in forces.iter().enumerate().filter(|(_, f)| **f != [0.0; 3]) {
            for &(j, w) in &self.weights[self.first[i] as usize..self.first[i + 1] as usize] {
                add(j, force.map(|f| w * f));
            }
        }
        for t in self.turned.iter().filter(|t| forces[t.node as usize] != [0.0; 3]) {
            let lever = cross(t.arm, forces[t.node as usize]);
            let moment = t.inverse.map(|row| dot(row, lever));
            t.levers.iter().for_each(|(j, b)| add(*j, cross(moment, *b)));
        }
    }
}
