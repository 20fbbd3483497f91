//! Bond breakage and fragments.

use super::overlay::{facts, one, overlay};
use crate::data::RunData;
use crate::page::{Cell, Section, joined, plots};
use crate::plot::{Axis, figure};
use trackbed_io::columns::history;

/// Formats bonds.
pub fn bonds(runs: &[RunData]) -> Option<Section> {
    let broken = overlay(runs, |run| {
        let Some(table) = run.table("history") else { return Vec::new() };
        let of = |(name, column): (&str, _)| Some((name.to_string(), table.points(history::TIME, column)?));
        [("by tension", history::BROKEN_BY_TENSION), ("by shear", history::BROKEN_BY_SHEAR)]
            .into_iter()
            .filter_map(of)
            .collect()
    });
    let pieces = one(runs, |r| r.table("history")?.points(history::TIME, history::FRAGMENTS));
    let energy = one(runs, |r| r.table("history")?.points(history::TIME, history::BOND_ENERGY));
    let time = || Axis::new("time", "s");
    let figures = plots([
        figure("Broken bonds", time(), Axis::new("bonds", "").with_zero(), broken),
        figure("Fragments", time(), Axis::new("fragments, including single grains", "").with_zero(), pieces),
        figure("Elastic energy of the bonds", time(), Axis::new("energy", "J").with_zero(), energy),
    ]);
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let sums = facts(
        runs,
        &[
            ("bonds at the start", &path("bonds.made", "")),
            ("broken in tension and bending", &path("bonds.broken_by_tension", "")),
            ("broken in shear and twisting", &path("bonds.broken_by_shear", "")),
            ("energy released by breakage", &path("bonds.energy_of_breaks", "J")),
            ("fragments at the end", &path("bonds.fragments", "")),
            ("bodies of the largest fragment", &path("bonds.largest_fragment", "")),
            ("Marsal breakage, mass fraction", &path("bonds.breakage.marsal", "")),
            ("ballast breakage index", &path("bonds.breakage.ballast_index", "")),
        ],
    );
    Section::new("bonds", "Bonds", joined([figures, sums]))
}
