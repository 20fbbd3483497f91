//! Output of bonds and grain groups.

use super::recorder::{Now, Recorder};
use super::summary::{BondSummary, BreakageRecord};
use super::system::{GrainsView, System};
use std::path::Path;
use trackbed_dem as dem;
use trackbed_dem::bond::{Break, BreakMode};
use trackbed_io::columns::{breaks, history};
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Field, Row, write_table};

/// Bond count, breaks and energies.
pub struct Bonds;

impl<S: System> Recorder<S> for Bonds {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let part = now.job.grains.as_ref().filter(|part| !part.bonds.is_empty());
        let Some(GrainsView { model, state }) = now.system.grains().filter(|_| part.is_some()) else {
            return;
        };
        let (tension, shear) = state.broken_bonds();
        row.put(history::BONDS, state.bond_count() as f64);
        row.put(history::BROKEN_BY_TENSION, tension as f64);
        row.put(history::BROKEN_BY_SHEAR, shear as f64);
        row.put(history::FRAGMENTS, dem::measure::fragments(model, state).sizes.len() as f64);
        row.put(history::BOND_ENERGY, now.balance.now.bonds);
        row.put(history::DISSIPATED_BONDS, now.balance.spent.bonds);
        row.put(history::RELEASED_BY_BREAKS, now.balance.spent.breaks);
    }
}

/// Mean position, bond and contact force of recorded groups.
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
            row.vector(history::GROUP.of(name), sum / count.max(1.0));
            row.vector(history::GROUP_FORCE.of(name), dem::measure::force_on(model, state, of));
            if part.groups.nets.iter().any(|net| net.part == group) {
                let bonds = dem::measure::bond_records(model, state);
                let tension = bonds.iter().filter(|r| of(r.a) || of(r.b)).map(|r| r.tension);
                row.put(history::GROUP_TENSION.of(name), tension.fold(0.0, f64::max));
            }
        }
    }
}

const BREAKS: [Field<Break>; 9] = [
    (breaks::TIME, |b| b.time),
    (breaks::BOND, |b| f64::from(b.bond)),
    (breaks::A, |b| f64::from(b.bodies[0])),
    (breaks::B, |b| f64::from(b.bodies[1])),
    (breaks::X, |b| b.place.x),
    (breaks::Y, |b| b.place.y),
    (breaks::Z, |b| b.place.z),
    (breaks::SHEAR, |b| f64::from(u8::from(b.mode == BreakMode::Shear))),
    (breaks::ENERGY, |b| b.energy),
];

/// Writes `breaks.csv`.
///
/// # Errors
/// I/O errors.
pub fn write_breaks(dir: &Path, state: &dem::State) -> Result<(), Failure> {
    Ok(write_table(&dir.join("breaks.csv"), &BREAKS, state.breaks())?)
}

/// Summarises the bonds.
pub fn summary(view: GrainsView<'_>) -> BondSummary {
    let (tension, shear) = view.state.broken_bonds();
    let fragments = dem::measure::fragments(view.model, view.state);
    BondSummary {
        made: view.model.bond_count(),
        broken_by_tension: tension,
        broken_by_shear: shear,
        energy_of_breaks: view.state.balance.released_by_breaks,
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
