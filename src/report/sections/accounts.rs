//! Balances of energy, momentum and interface.

use super::overlay::{facts, one, overlay};
use crate::data::RunData;
use crate::page::{Cell, Section, columns, joined, plots};
use crate::plot::{Axis, figure};
use maud::{Markup, html};
use serde_json::Value;
use trackbed_io::columns::{Definition, history};

const STORED: [(&Definition, &str); 9] = [
    (history::GRAINS_KINETIC, "kinetic energy of grains"),
    (history::CONTACT_SPRINGS, "contact springs"),
    (history::BOND_ENERGY, "bonds"),
    (history::MOUNT_ENERGY, "mounts"),
    (history::GRAINS_GRAVITY, "potential energy of grains"),
    (history::SOLID_KINETIC, "kinetic energy of solid"),
    (history::SOLID_STRAIN, "strain energy of solid"),
    (history::SOLID_GRAVITY, "potential energy of solid"),
    (history::RAIL_ENERGY, "rails"),
];

const SPENT: [(&Definition, &str); 7] = [
    (history::WORK, "work"),
    (history::DISSIPATED_DASHPOT, "dashpots of contacts"),
    (history::DISSIPATED_FRICTION, "friction"),
    (history::DISSIPATED_SOLID, "dissipation in solid"),
    (history::DISSIPATED_BONDS, "dashpots of bonds"),
    (history::DISSIPATED_MOUNTS, "dashpots of mounts"),
    (history::DISSIPATED_TRACK, "rail pads and track outside the model"),
];

/// Formats energy, momentum, interface.
pub fn energy(runs: &[RunData]) -> Option<Section> {
    let time = || Axis::new("time", "s");
    let curves = |columns: &'static [(&'static Definition, &'static str)], change: bool| {
        overlay(runs, move |run| {
            let Some(table) = run.table("history") else { return Vec::new() };
            let of = |&(column, name): &(&'static Definition, &str)| {
                let mut points = table.points(history::TIME, column)?;
                let first = if change { points.first()?[1] } else { 0.0 };
                points.iter_mut().for_each(|p| p[1] -= first);
                points.iter().any(|p| p[1] != 0.0).then(|| (name.to_string(), points))
            };
            columns.iter().filter_map(of).collect()
        })
    };
    let error = one(runs, |r| r.table("history")?.points(history::TIME, history::ENERGY_ERROR));
    // Several runs would give too many curves.
    let balance = match runs {
        [_] => vec![
            figure("Work and dissipation", time(), Axis::new("energy", "J"), curves(&SPENT, false)),
            figure("Stored energy since the start", time(), Axis::new("change", "J"), curves(&STORED, true)),
        ],
        _ => vec![figure("Work", time(), Axis::new("work", "J"), curves(&SPENT[..1], false))],
    };
    let error = figure("Energy error", time(), Axis::new("error", "J"), error);
    let figures = plots(balance.into_iter().chain([error]));
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let sums = facts(
        runs,
        &[
            ("external work", &path("energy.work", "J")),
            ("reference energy", &path("energy.reference_energy", "J")),
            ("energy error at the end", &path("energy.error", "J")),
            ("energy error over reference energy", &path("energy.relative_error", "")),
            ("largest energy error", &path("energy.largest_error", "J")),
            ("largest energy error over reference energy", &path("energy.largest_relative_error", "")),
            ("momentum error over impulses", &path("momentum.linear", "")),
            ("angular momentum error over impulses", &path("momentum.angular", "")),
            ("interface: largest force error", &path("coupling.transfer.force", "")),
            ("interface: largest moment error", &path("coupling.transfer.moment", "")),
            ("interface: difference of work on both sides", &path("coupling.interface_work_error", "J")),
        ],
    );
    Section::new("energy", "Energy and momentum balances", joined([figures, sums, parts(runs)]))
}

fn parts(runs: &[RunData]) -> Markup {
    joined(runs.iter().map(|run| {
        let object = |path: &str| run.value(path).as_object().cloned().unwrap_or_default();
        let (start, end, spent) = (object("energy.start"), object("energy.end"), object("energy.flows"));
        let whose = match runs.len() {
            1 => String::new(),
            _ => format!(": {}", run.label),
        };
        let number = |v: Option<&Value>| v.and_then(Value::as_f64);
        let stored: Vec<&String> = start
            .keys()
            .filter(|k| [start.get(*k), end.get(*k)].into_iter().any(|v| number(v).is_some_and(|v| v != 0.0)))
            .collect();
        let names: Vec<String> = stored.iter().map(|k| k.replace('_', " ")).collect();
        let both = [
            ("at the start", "J", stored.iter().map(|k| number(start.get(*k))).collect::<Vec<_>>()),
            ("at the end", "J", stored.iter().map(|k| number(end.get(*k))).collect()),
        ];
        let lost: Vec<(&String, f64)> =
            spent.iter().filter_map(|(k, v)| Some((k, v.as_f64().filter(|v| *v != 0.0)?))).collect();
        let spent_names: Vec<String> = lost.iter().map(|(k, _)| k.replace('_', " ")).collect();
        let spent_values = [("energy", "J", lost.iter().map(|(_, v)| Some(*v)).collect::<Vec<_>>())];
        html! {
            @if !names.is_empty() || !spent_names.is_empty() {
                details {
                    "\n" summary { "Terms of the energy balance" (whose) } "\n"
                    (columns("stored", &names, &both))
                    (columns("work and dissipation", &spent_names, &spent_values))
                }
                "\n"
            }
        }
    }))
}
