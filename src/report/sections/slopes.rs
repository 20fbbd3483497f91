//! Slides and rock specimens.

use super::overlay::{facts, one, overlay};
use crate::data::RunData;
use crate::page::{Cell, Section, joined, plots};
use crate::plot::{Axis, figure};
use trackbed_io::columns::{Definition, history};

/// Formats the runout.
pub fn runout(runs: &[RunData]) -> Option<Section> {
    let of =
        |column: &'static Definition| one(runs, move |r| r.table("history")?.points(history::TIME, column));
    let time = || Axis::new("time", "s");
    let figures = plots([
        figure(
            "Front of the slide",
            time(),
            Axis::new("position along the slide", "m"),
            of(history::RUNOUT_FRONT),
        ),
        figure(
            "Motion of the slide",
            time(),
            Axis::new("kinetic energy", "J").with_zero(),
            of(history::RUNOUT_KINETIC),
        ),
    ]);
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let sums = facts(
        runs,
        &[
            ("travel of the front", &path("runout.advance", "m")),
            ("height from head to toe", &path("runout.drop", "m")),
            ("distance from head to toe", &path("runout.length", "m")),
            ("reach angle", &path("runout.reach_angle", "°")),
            ("area of the deposit", &path("runout.deposit_area", "m²")),
            ("length of the deposit", &path("runout.deposit_length", "m")),
            ("width of the deposit", &path("runout.deposit_width", "m")),
            ("largest depth of the deposit", &path("runout.deepest", "m")),
            ("bulk volume of the deposit", &path("runout.deposit_volume", "m³")),
            ("volume of the grains", &path("runout.solid_volume", "m³")),
            ("fragments", &path("runout.fragments", "")),
            ("mass fraction of the largest", &path("runout.largest_share", "")),
            ("grains below the ground", &path("runout.below_ground", "")),
        ],
    );
    Section::new("runout", "Run-out", joined([figures, sums]))
}

/// Formats specimen results.
pub fn specimen(runs: &[RunData]) -> Option<Section> {
    let curve = overlay(runs, |run| {
        let Some(table) = run.table("history") else { return Vec::new() };
        [
            ("platens", history::SPECIMEN_STRAIN),
            ("grains, axial", history::SPECIMEN_AXIAL_STRAIN),
            ("lateral", history::SPECIMEN_LATERAL_STRAIN),
        ]
        .into_iter()
        .filter_map(|(name, x)| Some((name.to_string(), table.points(x, history::SPECIMEN_STRESS)?)))
        .collect()
    });
    let figures = plots([figure(
        "Stress and strain",
        Axis::new("strain", ""),
        Axis::new("stress", "Pa").with_zero(),
        curve,
    )]);
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let sums = facts(
        runs,
        &[
            ("strength", &path("specimen.strength", "Pa")),
            ("strain at the peak", &path("specimen.peak_strain", "")),
            ("confining pressure at the peak", &path("specimen.confinement", "Pa")),
            ("modulus", &path("specimen.modulus", "Pa")),
            ("Poisson's ratio", &path("specimen.poisson", "")),
            ("cracks in tension at the peak", &path("specimen.tension_cracks_at_peak", "")),
            ("cracks in shear at the peak", &path("specimen.shear_cracks_at_peak", "")),
            ("tension cracks within 30° of the axis", &path("specimen.axial_cracks", "")),
            ("b-value of the acoustic events", &path("bonds.events.b_value", "")),
            ("error of the b-value", &path("bonds.events.b_error", "")),
        ],
    );
    Section::new("specimen", "Specimen", joined([figures, sums]))
}
