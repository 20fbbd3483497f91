//! Inner forces and energy terms shared by the time integrators.
//!
//! With mean stresses, `(s0 + s1)/2 : d eps = d(s : C^-1 s)/2 + (s0 + s1)/2 : d eps_p` exactly.

use super::internal_force::InternalForce;
use super::points::PointTable;
use crate::material::Points;
use crate::model::Model;
use crate::state::{State, StepAudit};

/// Elastic energy change and plastic dissipation [J].
pub(crate) fn point_energies(model: &Model, table: &PointTable, old: &Points, new: &Points) -> (f64, f64) {
    let (mut elastic, mut plastic) = (0.0, 0.0);
    for e in 0..model.mesh().element_count() {
        let material = model.material(e);
        let energy = |points, i| material.law.stored_energy(&material.elastic, model.point(points, e, i));
        for (i, p) in table.points(e).enumerate() {
            let (a, b, volume) = (&old[p], &new[p], table.volume(p));
            elastic += volume * (energy(new, i) - energy(old, i));
            let [before, after] = [old, new].map(|points| model.point(points, e, i));
            if let Some(lost) = material.law.dissipation(before, after) {
                plastic += volume * lost;
                continue;
            }
            for k in 0..6 {
                let mean = 0.5 * (a.stress[k] + b.stress[k]);
                plastic += volume * mean * (b.plastic_strain[k] - a.plastic_strain[k]);
            }
        }
    }
    (elastic, plastic)
}

/// `f + S u + M a + C v` [N]. Shapes `[3 * nodes]`; `scratch` twice as long.
pub(crate) fn inner_force(
    model: &Model,
    internal: &mut InternalForce,
    state: &State,
    force: &mut [f64],
    scratch: &mut [f64],
) {
    let c = model.rayleigh();
    internal.of_states(model, &state.points);
    force.copy_from_slice(&internal.force);
    model.boundary_spring_times(&state.u, force);
    let (mixed, product) = scratch.split_at_mut(state.u.len());
    for d in 0..state.u.len() {
        mixed[d] = state.a[d] + c.alpha_m * state.v[d];
    }
    model.mass_times(mixed, product);
    force.iter_mut().zip(&*product).for_each(|(f, p)| *f += p);
    if c.beta_k > 0.0 {
        for d in 0..state.u.len() {
            mixed[d] = c.beta_k * state.v[d];
        }
        model.stiffness_times(mixed, product);
        force.iter_mut().zip(&*product).for_each(|(f, p)| *f += p);
    }
    model.dashpot_times(&state.v, force);
}

/// Completes the energy terms; `velocity` [m/s] for damping. Shape `[3 * nodes]`; `scratch` twice as long.
pub(crate) fn close(
    model: &Model,
    table: &PointTable,
    [old, new]: [&State; 2],
    mut audit: StepAudit,
    velocity: &[f64],
    scratch: &mut [f64],
) -> StepAudit {
    let (c, n, matrices) = (model.rayleigh(), old.u.len(), model.matrices());
    let (du, product) = scratch.split_at_mut(n);
    for d in 0..n {
        du[d] = new.u[d] - old.u[d];
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    if c.beta_k > 0.0 {
        model.stiffness_times(du, product);
        audit.damping_dissipation += c.beta_k * dot(velocity, product);
    }
    if c.alpha_m > 0.0 {
        model.mass_times(du, product);
        audit.damping_dissipation += c.alpha_m * dot(velocity, product);
    }
    if !matrices.dashpots().is_empty() {
        audit.boundary_dissipation = (new.time - old.time) * matrices.dashpots().form(velocity);
    }
    let (elastic, plastic) = point_energies(model, table, &old.points, &new.points);
    let springs = 0.5 * (matrices.springs().form(&new.u) - matrices.springs().form(&old.u));
    let kinetic = 0.5 * (matrices.mass_form(&new.v) - matrices.mass_form(&old.v));
    audit.plastic_dissipation = plastic;
    audit.numerical_dissipation = audit.external_work + audit.support_work
        - audit.damping_dissipation
        - audit.boundary_dissipation
        - plastic
        - elastic
        - springs
        - kinetic;
    audit
}
