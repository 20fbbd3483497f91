//! Energy balance of the coupled step.

use super::model::Model;
use super::state::{State, Work};
use crate::energy_balance::{StoredEnergy, WorkAndDissipation};
use crate::scheme::Scheme;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::state::StepAudit;
use trackbed_fem::theta::Stored;

/// Splits the work of the loads, which the solver does not.
pub(super) fn add_step_energy<B>(model: &Model<'_>, state: &mut State, work: &Work<B>, step: &StepAudit) {
    for (i, u) in state.solid.u.iter().enumerate() {
        let du = u - work.before.u[i];
        state.spent.contacts_on_solid += work.contact_load[i] * du;
        state.spent.solid_load_work += work.other_load[i] * du;
    }
    let (u, before) = (&state.solid.u, &work.before.u);
    let rate = |i: usize| work.rate[i];
    let found = |i: usize| (u[i] - before[i]) / model.window();
    let last = |i: usize| if state.rate.is_empty() { work.rate[i] } else { state.rate[i] };
    state.spent.interface_dashpot_error +=
        work.transfer.interface_dashpot_error(&work.surface, rate, last, found);
    if model.scheme != Scheme::Lagged {
        // The lagged surface velocity has no jump.
        state.rate.resize(work.rate.len(), 0.0);
        for d in work.surface.dofs() {
            state.rate[d] = work.rate[d];
        }
    }
    state.spent.rayleigh += step.damping_dissipation;
    state.spent.absorbed += step.boundary_dissipation;
    state.spent.plastic += step.plastic_dissipation;
    state.spent.numerical += step.numerical_dissipation;
}

/// Returns the stored energy; of a reduced solid see [`Work::stored_energy`].
pub fn stored_energy(model: &Model<'_>, state: &State) -> StoredEnergy {
    let solid = Stored {
        kinetic: fem::energy::kinetic(model.solid, &state.solid),
        strain: fem::energy::strain(model.solid, &state.solid),
        dead_load_work: model.dead_load.iter().zip(&state.solid.u).map(|(f, u)| f * u).sum::<f64>(),
    };
    with_solid(model, state, solid)
}

impl<B> Work<B> {
    /// Returns the stored energy.
    pub fn stored_energy(&self, model: &Model<'_>, state: &State) -> StoredEnergy {
        match self.solver.stored(&state.solid) {
            Some(solid) => with_solid(model, state, solid),
            None => stored_energy(model, state),
        }
    }
}

fn with_solid(model: &Model<'_>, state: &State, solid: Stored) -> StoredEnergy {
    let grains = dem::measure::energies(&model.grains, &state.grains);
    StoredEnergy {
        grains_kinetic: grains.kinetic_translation + grains.kinetic_rotation,
        contact_springs: grains.elastic_normal + grains.elastic_tangential,
        bonds: grains.elastic_bonds,
        mounts: grains.elastic_mounts,
        grains_gravity: grains.gravity,
        solid_kinetic: solid.kinetic,
        solid_strain: solid.strain,
        solid_gravity: -solid.dead_load_work,
        ..StoredEnergy::default()
    }
}

/// Returns work and dissipation of both sides since the start.
pub fn work_and_dissipation(state: &State) -> WorkAndDissipation {
    let solid = &state.spent;
    let grains = grain_work_and_dissipation(&state.grains);
    WorkAndDissipation {
        dashpot: grains.dashpot + solid.interface_dashpot_error,
        interface_dashpot_error: solid.interface_dashpot_error,
        solid_load_work: solid.solid_load_work,
        rayleigh: solid.rayleigh,
        absorbed: solid.absorbed,
        plastic: solid.plastic,
        numerical: solid.numerical,
        contacts_on_solid: solid.contacts_on_solid,
        ..grains
    }
}

/// Returns the grains' part of [`work_and_dissipation`].
pub fn grain_work_and_dissipation(grains: &dem::State) -> WorkAndDissipation {
    let ledger = &grains.balance;
    WorkAndDissipation {
        applied_work: ledger.work_applied + ledger.work_body_forces,
        // Includes gravity potential of wrapped and inserted grains.
        wall_work: ledger.work_walls
            + ledger.work_servo
            + ledger.work_constraints
            + ledger.work_periodic
            + ledger.work_flow,
        dashpot: ledger.dissipated_dashpot,
        friction: ledger.dissipated_friction,
        bonds: ledger.dissipated_bonds,
        mounts: ledger.dissipated_mounts,
        breaks: ledger.released_by_breaks,
        local_damping: ledger.dissipated_local_damping,
        surface_on_grains: ledger.work_surface,
        ..WorkAndDissipation::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_grain_energy_terms_are_counted() {
        let model = dem::Model::new(dem::ModelInput::default()).expect("no grains at all");
        let mut grains = dem::State::new(&model);
        let ledger = &mut grains.balance;
        let all = [
            &mut ledger.work_applied,
            &mut ledger.work_body_forces,
            &mut ledger.work_walls,
            &mut ledger.work_servo,
            &mut ledger.work_surface,
            &mut ledger.work_constraints,
            &mut ledger.work_periodic,
            &mut ledger.work_flow,
            &mut ledger.dissipated_dashpot,
            &mut ledger.dissipated_friction,
            &mut ledger.dissipated_bonds,
            &mut ledger.released_by_breaks,
            &mut ledger.dissipated_local_damping,
            &mut ledger.dissipated_mounts,
        ];
        // Powers of two: exact and distinct.
        all.into_iter().zip(0..).for_each(|(part, k)| *part = f64::from(1 << k));
        let spent = grain_work_and_dissipation(&grains);
        assert_eq!(spent.work() + spent.surface_on_grains, grains.balance.work());
        assert_eq!(spent.dissipated(), grains.balance.dissipated());
        assert_eq!(spent.surface_on_grains, grains.balance.work_surface);
    }
}
