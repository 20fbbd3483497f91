//! Final coupling warnings.

use crate::summary::{CouplingRecord, ReductionRecord};
use crate::system::CoupledSystem;
use trackbed_coupling::energy_balance::WorkAndDissipation;
use trackbed_coupling::interface_stability::InterfaceStabilityNumbers;
use trackbed_coupling::scheme::IterationStats;
use trackbed_coupling::stability::{INTERFACE_LIMITS, interface_excess, largest_phase};
use trackbed_input::model::exchange::CouplingPart;

/// Warns about unconverged windows of the iterated scheme.
pub fn unconverged(passes: &IterationStats) -> Option<String> {
    (passes.unconverged > 0).then(|| {
        format!(
            "coupling: {} of {} windows not converged within coupling.max_passes. The best pass was used. Increase coupling.max_passes, or reduce coupling.substeps.",
            passes.unconverged, passes.windows
        )
    })
}

/// Late dissipation over reference energy.
const LATE: f64 = 0.05;

/// Warns about dashpots that dissipate less than their law, because the solid deviates from its prediction.
pub fn late(spent: &WorkAndDissipation) -> Option<String> {
    let law = spent.dissipated() - spent.interface_dashpot_error;
    let part = -spent.interface_dashpot_error / spent.work().abs().max(law);
    (part > LATE).then(|| {
        format!(
            "coupling: interface dashpot error {:.3e} J, {:.1} % of the reference energy. Dashpots at the solid surface act on its velocity at the start of a window. Reduce coupling.substeps, or set coupling.theta above 0.5.",
            -spent.interface_dashpot_error,
            100.0 * part
        )
    })
}

/// Largest errors of a reduced solid that pass without a warning: of displacements, of the stress.
const REDUCED: [f64; 2] = [0.01, 0.1];

/// Warns about a reduced solid that deviates from the full one.
pub fn inaccurate_reduction(found: &ReductionRecord) -> Option<String> {
    let errors = [found.displacement, found.stress];
    errors.iter().zip(REDUCED).any(|(error, limit)| *error > limit).then(|| {
        let [displacement, stress] = errors.map(|e| 100.0 * e);
        format!(
            "solid.reduction: error of displacements {displacement:.2} %, of the stress {stress:.2} % of their largest. Set kind = \"surface\", or more modes."
        )
    })
}

/// Growth exponent of undamped amplitudes.
const GROWTH: f64 = 1.0;

/// Warns about an interface beyond its stability limit.
pub fn unstable_interface(
    system: &CoupledSystem<'_>,
    record: &CouplingRecord,
    plan: &CouplingPart,
) -> Option<String> {
    let (model, check) = (&system.model, &system.state.interface_check);
    let InterfaceStabilityNumbers { stiffness, damping, phase } = check.largest;
    let numbers = InterfaceStabilityNumbers { phase: 0.0, ..check.largest };
    let excess = interface_excess(model.scheme, model.theta, &numbers);
    if !system.automatic && excess > 1.0 {
        let fitting = (f64::from(record.substeps) / excess) as u32;
        let fewer = if fitting > 0 {
            format!("coupling.substeps = {fitting} or \"auto\"")
        } else {
            "\"auto\"".into()
        };
        return Some(format!(
            "coupling: unstable windows: W = {stiffness:.2}, D = {damping:.2} for all contacts on the solid (limit {}). Contacts may excite the ground. Set {fewer}.",
            INTERFACE_LIMITS[0]
        ));
    }
    (check.growth > GROWTH).then(|| {
        format!(
            "coupling.theta: undamped contacts at rest: phase {phase:.2} per window (limit {1:.2} for theta = {0:.4}). Amplitudes may have grown by a factor of {2:.1e}. {3}.",
            model.theta,
            largest_phase(model.theta),
            libm::exp(check.growth.min(700.0)),
            plan.phase_remedies(phase, model.theta, record.substeps)
        )
    })
}
