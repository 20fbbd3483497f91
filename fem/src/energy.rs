//! Energies, momenta and support reactions.
//!
//! Angular momentum `sum x_a × (M v)_a` uses undeformed positions, for which linear theory conserves it.
//! Limits: small displacements.
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

/// Elastic strain energy [J] with boundary springs, from stresses if present.
pub fn strain(model: &Model, state: &State) -> f64 {
    if state.points.is_empty() {
        0.5 * model.matrices().stiffness_form(&state.u)
    } else {
        of_points(model, &state.points) + boundary_springs(model, state)
    }
}

/// Elastic energy of the Gauss points [J], integral of
/// [`ConstitutiveLaw::stored_energy`](crate::ConstitutiveLaw::stored_energy).
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

/// Internal force `∫ B̄^T s dV` [N] with assumed strains. Shape `[3 * nodes]`.
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

/// Energy of the boundary springs [J], included in [`strain`].
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

/// Support reactions [N], `M a + C v + K u - F` at constrained dofs, 0 elsewhere. Shape `[3 * nodes]`.
///
/// Stresses replace `K u` if present.
pub fn reactions(model: &Model, state: &State, load: &[f64]) -> Vec<f64> {
    let n = model.dof_count();
    let (mut inner, mut scratch) = (vec![0.0; n], vec![0.0; 2 * n]);
    inner_force(model, [&state.u, &state.v, &state.a], &mut inner, &mut scratch);
    if !state.points.is_empty() {
        model.stiffness_times(&state.u, &mut scratch[..n]);
        let mut stresses = force_of_points(model, &state.points);
        model.boundary_spring_times(&state.u, &mut stresses);
        (0..n).for_each(|d| inner[d] += stresses[d] - scratch[d]);
    }
    at_supports(model, &inner, load)
}

pub(crate) fn at_supports(model: &Model, force: &[f64], load: &[f64]) -> Vec<f64> {
    let mut reactions = vec![0.0; force.len()];
    for &(dof, _) in model.supports().fixed() {
        reactions[dof as usize] = force[dof as usize] - load[dof as usize];
    }
    reactions
}

/// Forces of boundary springs and dashpots on the body [N], `-(K_s (u + beta_k v) + D v)`. Shape
/// `[3 * nodes]`.
pub fn boundary_forces(model: &Model, state: &State) -> Vec<f64> {
    let mut forces = vec![0.0; model.dof_count()];
    let beta = model.rayleigh().beta_k;
    let strained: Vec<f64> = state.u.iter().zip(&state.v).map(|(u, v)| u + beta * v).collect();
    model.boundary_spring_times(&strained, &mut forces);
    model.dashpot_times(&state.v, &mut forces);
    forces.iter_mut().for_each(|f| *f = -*f);
    forces
}

/// Resultant of nodal forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// Force [N].
    pub force: [f64; 3],
    /// Moment about the origin [N m], undeformed positions.
    pub moment: [f64; 3],
}

/// Named set of dofs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DofSet {
    /// Name.
    pub name: String,
    /// Dofs, `3 * node + direction`.
    pub dofs: Vec<u32>,
}

/// Resultant of nodal forces [N], shape `[3 * nodes]`.
pub fn resultant(mesh: &Mesh, forces: &[f64]) -> Resultant {
    sum(mesh, (0..forces.len()).map(|d| (d, forces[d])))
}

/// Resultant on a set of dofs [N]. Shape `[3 * nodes]`.
pub fn resultant_of(mesh: &Mesh, forces: &[f64], set: &DofSet) -> Resultant {
    sum(mesh, set.dofs.iter().map(|&d| (d as usize, forces[d as usize])))
}

/// Sum of all [`reactions`].
pub fn reaction_sum(model: &Model, state: &State, load: &[f64]) -> Resultant {
    resultant(model.mesh(), &reactions(model, state, load))
}

/// Sum of the reactions of each set.
pub fn reaction_sums(model: &Model, state: &State, load: &[f64], sets: &[DofSet]) -> Vec<Resultant> {
    let reactions = reactions(model, state, load);
    sets.iter().map(|set| resultant_of(model.mesh(), &reactions, set)).collect()
}

fn sum(mesh: &Mesh, forces: impl Iterator<Item = (usize, f64)>) -> Resultant {
    let mut total = Resultant::default();
    for (dof, force) in forces {
        let (x, k) = (mesh.coordinates[dof / 3], dof % 3);
        // Moment x × e_k f: lever x[j] about i = k+1, -x[i] about j = k+2.
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        total.force[k] += force;
        total.moment[i] += x[j] * force;
        total.moment[j] -= x[i] * force;
    }
    total
}

/// `M a + C v + K u` of a motion `[u, v, a]`. Shapes `[3 * nodes]`; scratch twice as long.
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
