//! Warnings about the exchange between grains and solid at the end of a run.

use crate::run::system::CoupledSystem;
use trackbed_coupling::ledger::Spent;
use trackbed_coupling::scheme::Passes;

/// A remark on windows of the iterated scheme that found no end.
pub fn unconverged(passes: &Passes) -> Option<String> {
    (passes.unconverged > 0).then(|| {
        format!(
            "{} of {} windows had not converged after the last pass allowed (the best pass was used): raise coupling.max_passes, or take fewer \
             coupling.substeps",
            passes.unconverged, passes.windows
        )
    })
}

/// Part of the turnover of energy above which dashpots that act late are remarked on.
const LATE: f64 = 0.05;

/// A remark on dashpots at the solid's surface that take much less than their law has, because the solid does not move as
/// they assume.
pub fn late(spent: &Spent) -> Option<String> {
    let law = spent.dissipated() - spent.dashpot_lag;
    let part = -spent.dashpot_lag / spent.work().abs().max(law);
    (part > LATE).then(|| {
        format!(
            "the dashpots at the solid's surface took {:.3e} J less than their law has, {:.1} % of what was turned over: they act on \
             the surface's velocity at the start of a window; take fewer coupling.substeps, or coupling.theta above 0.5",
            -spent.dashpot_lag,
            100.0 * part
        )
    })
}

/// A remark on grains that have left the solid and lie or fall below its surface, whose lowest point was at `lowest` [m].
pub fn fallen(system: &CoupledSystem<'_>, lowest: f64) -> Option<String> {
    let (model, state) = (&system.model.grains, &system.state.grains);
    let fell = |b: &usize| state.present(*b) && state.position(*b).z < lowest - model.radius(*b);
    let mut below = (0..model.body_count()).filter(fell);
    let first = below.next()?;
    let x = state.position(first);
    Some(format!(
        "bodies that have left the solid and are below its surface: {}, the first is body {first} at ({:.4}, {:.4}, {:.4}) m: enlarge the \
         mesh, or put walls at its borders",
        1 + below.count(),
        x.x,
        x.y,
        x.z
    ))
}
