//! Energies, momenta, support reactions and their sums.
//!
//! Kinetic energy `v·M v/2`, strain energy `u·K u/2` with that of the boundary springs in it. Linear momentum is the sum of
//! `M v`; angular momentum is `sum x_a × (M v)_a`, exact for the isoparametric element with its consistent mass. It is
//! taken with the undeformed positions: the linear theory conserves that one, because its stiffness resists no
//! infinitesimal rotation of the undeformed body. Limits: small displacement, for moments too.
//!
//! Theory manual: equation (4.2) of `docs/theory/solid.md`.

use crate::assumed::modes::condense;
use crate::element::stiffness_points;
use crate::kinematics::{ElementCoordinates, jacobian};
use crate::material::{PointState, Points};
use crate::mesh::Mesh;
use crate::model::Model;
use crate::state::State;

/// Kinetic energy [J].
pub fn kinetic(model: &Model, state: &State) -> f64 {
    0.5 * model.matrices().mass_form(&state.v)
}

/// Elastic strain energy [J], that of the boundary springs included: of the stresses where the state has them, else of
/// the displacement.
pub fn strain(model: &Model, state: &State) -> f64 {
    if state.points.is_empty() {
        0.5 * model.matrices().stiffness_form(&state.u)
    } else {
        of_points(model, &state.points) + boundary_springs(model, state)
    }
}

/// Elastic energy of the Gauss points, the integral of [`ConstitutiveLaw::stored_energy`](crate::ConstitutiveLaw::stored_energy) [J].
pub fn of_points(model: &Model, points: &Points) -> f64 {
    let mesh = model.mesh();
    let mut total = 0.0;
    for e in 0..mesh.element_count() {
        let (x, material) = (mesh.element_coordinates(e), model.material(e));
        let rule = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
        for (i, point) in rule.iter().enumerate() {
            let volume = point.weight * jacobian(&x, &point.gradients).1;
            total += volume * material.law.stored_energy(&material.elastic, model.point(points, e, i));
        }
    }
    total
}

/// Forces of the stresses at the Gauss points, `∫ B̄^T s dV` [N], with the strains that the elements assume. Shape
/// `[3 * nodes]`.
pub fn force_of_points(model: &Model, points: &[PointState]) -> Vec<f64> {
    let mesh = model.mesh();
    let mut force = vec![0.0; model.dof_count()];
    for e in 0..mesh.element_count() {
        let strains = model.element_strains(e);
        let rule = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
        let mut on_nodes = ElementCoordinates::default();
        for (point, state) in rule.iter().zip(&points[model.point_start(e)..]) {
            let at = strains.at_point(point);
            let s = state.stress.map(|s| point.weight * at.determinant * s);
            let pressure = (s[0] + s[1] + s[2]) / 3.0;
            for (a, f) in on_nodes.iter_mut().enumerate().take(strains.terms()) {
                let g = &at.gradients[a];
                f[0] += s[0] * g[0] + s[3] * g[1] + s[5] * g[2];
                f[1] += s[3] * g[0] + s[1] * g[1] + s[4] * g[2];
                f[2] += s[5] * g[0] + s[4] * g[1] + s[2] * g[2];
                if let Some(volume) = &at.dilatation {
                    (0..3).for_each(|k| f[k] += pressure * (volume[a][k] - g[k]));
                }
            }
        }
        if let Some(internal) = strains.internal() {
            condense(internal.amplitudes(), &mut on_nodes);
        }
        for (f, &node) in on_nodes.iter().zip(&mesh.connectivity[e]) {
            (0..3).for_each(|k| force[3 * node as usize + k] += f[k]);
        }
    }
    force
}

/// Energy of the boundary springs alone [J]; a part of [`strain`].
pub fn boundary_springs(model: &Model, state: &State) -> f64 {
    0.5 * model.matrices().springs().form(&state.u)
}

/// Linear momentum [N s] and angular momentum about the origin [N m s].
pub fn momentum(model: &Model, state: &State) -> ([f64; 3], [f64; 3]) {
    let mut product = vec![0.0; state.v.len()];
    model.mass_times(&state.v, &mut product);
    let sum = resultant(model.mesh(), &product);
    (sum.force, sum.moment)
}

/// Forces of the supports on the moving body [N], `M a + C v + K u - F` at constrained dofs, 0 elsewhere; with the
/// forces of the stresses in place of `K u` where the state has them. Shape `[3 * nodes]`.
///
/// Exact for states that [`crate::newmark`] left with its own methods; a window step has
/// [`crate::theta::ThetaSolver::mean_reactions`].
pub fn reactions(model: &Model, state: &State, load: &[f64]) -> Vec<f64> {
    let n = model.dof_count();
    let (mut inner, mut scratch) = (vec![0.0; n], vec![0.0; 2 * n]);
    inner_force(model, [&state.u, &state.v, &state.a], &mut inner, &mut scratch);
    if !state.points.is_empty() {
        // The stresses in place of what the elastic matrix makes of the displacement; springs are in both.
        model.stiffness_times(&state.u, &mut scratch[..n]);
        let mut stresses = force_of_points(model, &state.points);
        model.boundary_spring_times(&state.u, &mut stresses);
        (0..n).for_each(|d| inner[d] += stresses[d] - scratch[d]);
    }
    at_supports(model, &inner, load)
}

/// `force - load` at constrained dofs, 0 elsewhere [N]. Shapes `[3 * nodes]`.
pub(crate) fn at_supports(model: &Model, force: &[f64], load: &[f64]) -> Vec<f64> {
    let mut reactions = vec![0.0; force.len()];
    for &(dof, _) in model.supports().fixed() {
        reactions[dof as usize] = force[dof as usize] - load[dof as usize];
    }
    reactions
}

/// Forces of the boundary springs and dashpots on the body [N], `-(K_s (u + beta_k v) + D v)`: Rayleigh damping takes the
/// springs for a part of the stiffness. Shape `[3 * nodes]`.
pub fn boundary_forces(model: &Model, state: &State) -> Vec<f64> {
    let mut forces = vec![0.0; model.dof_count()];
    let beta = model.rayleigh().beta_k;
    let strained: Vec<f64> = state.u.iter().zip(&state.v).map(|(u, v)| u + beta * v).collect();
    model.boundary_spring_times(&strained, &mut forces);
    model.dashpot_times(&state.v, &mut forces);
    forces.iter_mut().for_each(|f| *f = -*f);
    forces
}

/// Force and moment of nodal forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// Sum of the forces [N].
    pub force: [f64; 3],
    /// Moment about the origin [N m], with the undeformed positions.
    pub moment: [f64; 3],
}

/// Some dofs under a name, such as the supports of one side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DofSet {
    /// Name.
    pub name: String,
    /// Dofs, `3 * node + direction`.
    pub dofs: Vec<u32>,
}

/// Force and moment of nodal forces [N], shape `[3 * nodes]`.
pub fn resultant(mesh: &Mesh, forces: &[f64]) -> Resultant {
    sum(mesh, (0..forces.len()).map(|d| (d, forces[d])))
}

/// Force and moment of those nodal forces [N], shape `[3 * nodes]`, that act at the dofs of a set.
pub fn resultant_of(mesh: &Mesh, forces: &[f64], set: &DofSet) -> Resultant {
    sum(mesh, set.dofs.iter().map(|&d| (d as usize, forces[d as usize])))
}

/// Sum of the reactions of all supports, as [`reactions`] gives them.
pub fn reaction_sum(model: &Model, state: &State, load: &[f64]) -> Resultant {
    resultant(model.mesh(), &reactions(model, state, load))
}

/// Sums of the reactions by set, in the order of the sets.
pub fn reaction_sums(model: &Model, state: &State, load: &[f64], sets: &[DofSet]) -> Vec<Resultant> {
    let reactions = reactions(model, state, load);
    sets.iter().map(|set| resultant_of(model.mesh(), &reactions, set)).collect()
}

fn sum(mesh: &Mesh, forces: impl Iterator<Item = (usize, f64)>) -> Resultant {
    let mut total = Resultant::default();
    for (dof, force) in forces {
        let (x, k) = (mesh.coordinates[dof / 3], dof % 3);
        // e_k f at x has the moment x × e_k f: along i = k+1 the lever is x[j], along j = k+2 it is -x[i].
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        total.force[k] += force;
        total.moment[i] += x[j] * force;
        total.moment[j] -= x[i] * force;
    }
    total
}

/// `M a + C v + K u` of a motion `[u, v, a]`, with all the damping. Shapes `[3 * nodes]`; scratch is twice as long.
pub(crate) fn inner_force(model: &Model, motion: [&[f64]; 3], force: &mut [f64], scratch: &mut [f64]) {
    let (c, [u, v, a]) = (model.rayleigh(), motion);
    let (mixed, inertia) = scratch.split_at_mut(u.len());
    for d in 0..u.len() {
        mixed[d] = u[d] + c.beta_k * v[d];
    }
    model.stiffness_times(mixed, force);
    for d in 0..u.len() {
        mixed[d] = a[d] + c.alpha_m * v[d];
    }
    model.mass_times(mixed, inertia);
    force.iter_mut().zip(inertia).for_each(|(f, i)| *f += *i);
    model.dashpot_times(v, force);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_cross_products() {
        let mut mesh = Mesh::block([1, 1, 1], [1.0; 3]);
        mesh.coordinates[3] = [0.3, -0.7, 1.9];
        let mut forces = vec![0.0; 60];
        forces[9..12].copy_from_slice(&[5.0, 7.0, -11.0]);
        let all = resultant(&mesh, &forces);
        let expected = [-0.7 * -11.0 - 1.9 * 7.0, 1.9 * 5.0 - 0.3 * -11.0, 0.3 * 7.0 + 0.7 * 5.0];
        assert_eq!(all.force, [5.0, 7.0, -11.0]);
        assert!((0..3).all(|k| (all.moment[k] - expected[k]).abs() < 1e-14), "{all:?} {expected:?}");
        let part = resultant_of(&mesh, &forces, &DofSet { name: "y".into(), dofs: vec![10, 11] });
        assert_eq!(part.force, [0.0, 7.0, -11.0]);
    }
}
