//! What a run tells of bonds and of groups of grains: columns of `history.csv`, `breaks.csv`, the summary.

use super::summary::BondSummary;
use super::system::GrainsView;
use crate::failure::Failure;
use crate::model::grains::GrainsPart;
use crate::write::csv::{Column, History};
use std::path::Path;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_dem as dem;
use trackbed_dem::bond::BreakMode;

/// Columns of bonds, then of each recorded group.
pub fn columns(part: &GrainsPart) -> Vec<Column> {
    let mut columns = Vec::new();
    if !part.bonds.is_empty() {
        for (name, unit) in [
            ("bonds", ""),
            ("broken_by_tension", ""),
            ("broken_by_shear", ""),
            ("fragments", ""),
            ("bond_energy", "J"),
            ("dissipated_bonds", "J"),
            ("released_by_breaks", "J"),
        ] {
            columns.push(Column::new(name, unit));
        }
    }
    for &group in &part.recorded_groups {
        let name = &part.parts[group as usize];
        for (quantity, unit) in [("", "m"), ("_force", "N")] {
            for d in ["x", "y", "z"] {
                columns.push(Column::new(format!("{name}{quantity}_{d}"), unit));
            }
        }
    }
    columns
}

/// Their values.
pub fn values(part: &GrainsPart, view: GrainsView<'_>, stored: &Stored, spent: &Spent, row: &mut Vec<f64>) {
    let GrainsView { model, state } = view;
    if !part.bonds.is_empty() {
        let (tension, shear) = state.broken_bonds();
        let fragments = dem::measure::fragments(model, state).sizes.len();
        row.extend([state.bond_count() as f64, tension as f64, shear as f64, fragments as f64]);
        row.extend([stored.bonds, spent.bonds, spent.breaks]);
    }
    for &group in &part.recorded_groups {
        let of = |body: usize| state.present(body) && model.part(body) == group;
        let (mut sum, mut count) = (dem::Vec3::zeros(), 0.0_f64);
        for body in (0..model.body_count()).filter(|&b| of(b)) {
            sum += state.position(body);
            count += 1.0;
        }
        let (mean, force) = (sum / count.max(1.0), dem::measure::force_on(model, state, of));
        row.extend(mean.iter().chain(force.iter()));
    }
}

/// Writes every break to `breaks.csv`.
///
/// # Errors
/// The disk refuses.
pub fn write_breaks(dir: &Path, state: &dem::State) -> Result<(), Failure> {
    let columns = [
        ("time", "s"),
        ("bond", ""),
        ("a", ""),
        ("b", ""),
        ("x", "m"),
        ("y", "m"),
        ("z", "m"),
        ("shear", ""),
        ("energy", "J"),
    ];
    let columns = columns.map(|(name, unit)| Column::new(name, unit)).to_vec();
    let mut file = History::create(&dir.join("breaks.csv"), columns)?;
    for b in state.breaks() {
        let shear = f64::from(u8::from(b.mode == BreakMode::Shear));
        let [x, y, z] = b.place.into();
        let ends = b.bodies.map(f64::from);
        file.row(&[b.time, f64::from(b.bond), ends[0], ends[1], x, y, z, shear, b.energy])?;
    }
    Ok(())
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
    }
}
