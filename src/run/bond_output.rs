//! What a run says of bonds and of groups of grains: columns of `history.csv`, `breaks.csv`, the summary.

use super::recorder::{Now, Recorder};
use super::summary::{BondSummary, BreakageRecord};
use super::system::{GrainsView, System};
use crate::failure::Failure;
use crate::write::csv::{Field, Row, write_table};
use std::path::Path;
use trackbed_dem as dem;
use trackbed_dem::bond::{Break, BreakMode};

/// Number, breaks and energies of bonds.
pub struct Bonds;

impl<S: System> Recorder<S> for Bonds {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let part = now.job.grains.as_ref().filter(|part| !part.bonds.is_empty());
        let Some(GrainsView { model, state }) = now.system.grains().filter(|_| part.is_some()) else {
            return;
        };
        let (tension, shear) = state.broken_bonds();
        row.put("bonds", "", state.bond_count() as f64);
        row.put("broken_by_tension", "", tension as f64);
        row.put("broken_by_shear", "", shear as f64);
        row.put("fragments", "", dem::measure::fragments(model, state).sizes.len() as f64);
        row.put("bond_energy", "J", now.balance.now.bonds);
        row.put("dissipated_bonds", "J", now.balance.spent.bonds);
        row.put("released_by_breaks", "J", now.balance.spent.breaks);
    }
}

/// Mean place of each recorded group of grains, and the force of its bonds and contacts.
pub struct Groups;

impl<S: System> Recorder<S> for Groups {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (Some(part), Some(view)) = (&now.job.grains, now.system.grains()) else { return };
        let GrainsView { model, state } = view;
        for &group in &part.groups.recorded {
            let of = |body: usize| state.present(body) && model.part(body) == group;
            let (mut sum, mut count) = (dem::Vec3::zeros(), 0.0_f64);
            for body in (0..model.body_count()).filter(|&b| of(b)) {
                sum += state.position(body);
                count += 1.0;
            }
            let name = &part.groups.names[group as usize];
            row.vector(name, "m", sum / count.max(1.0));
            row.vector(format_args!("{name}_force"), "N", dem::measure::force_on(model, state, of));
        }
    }
}

/// Columns of `breaks.csv`.
const BREAKS: [Field<Break>; 9] = [
    ("time", "s", |b| b.time),
    ("bond", "", |b| f64::from(b.bond)),
    ("a", "", |b| f64::from(b.bodies[0])),
    ("b", "", |b| f64::from(b.bodies[1])),
    ("x", "m", |b| b.place.x),
    ("y", "m", |b| b.place.y),
    ("z", "m", |b| b.place.z),
    ("shear", "", |b| f64::from(u8::from(b.mode == BreakMode::Shear))),
    ("energy", "J", |b| b.energy),
];

/// Writes every break to `breaks.csv`.
///
/// # Errors
/// The disk refuses.
pub fn write_breaks(dir: &Path, state: &dem::State) -> Result<(), Failure> {
    Ok(write_table(&dir.join("breaks.csv"), &BREAKS, state.breaks())?)
}

/// What became of the bonds.
pub fn summary(view: GrainsView<'_>) -> BondSummary {
    let (tension, shear) = view.state.broken_bonds();
    let fragments = dem::measure::fragments(view.model, view.state);
    BondSummary {
        made: view.model.bond_count(),
        broken_by_tension: tension,
        broken_by_shear: shear,
        energy_of_breaks: view.state.ledger.released_by_breaks,
        fragments: fragments.sizes.len(),
        largest_fragment: fragments.sizes.iter().copied().max().unwrap_or(0),
        events: None,
        breakage: dem::measure::breakage(view.model, view.state).map(|b| BreakageRecord {
            marsal: b.marsal,
            ballast_index: b.ballast,
            sieves: b.sieves,
            passing_before: b.before,
            passing_after: b.after,
        }),
    }
}
