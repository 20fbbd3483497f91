//! Formation pressure, sleepers, lateral push.

use super::overlay::{facts, one, overlay};
use crate::data::RunData;
use crate::page::{Cell, Section, joined, plots, table};
use crate::plot::{Axis, figure};
use trackbed_io::columns::{Definition, cycles, history, push};

/// Formats formation pressure and force on the solid.
pub fn pressure(runs: &[RunData]) -> Option<Section> {
    let time = || Axis::new("time", "s");
    let in_time = one(runs, |r| r.table("history")?.points(history::TIME, history::PEAK_FORMATION_PRESSURE));
    let force = one(runs, |r| {
        let points = r.table("history")?.points(history::TIME, history::CONTACT_FORCE_ON_SOLID.at(2))?;
        Some(points.into_iter().map(|[t, f]| [t, -f]).collect())
    });
    let by_cycle = one(runs, |r| {
        let table = r.table("cycles").filter(|t| t.rows() > 1)?;
        let points = table.points(cycles::CYCLE, cycles::PEAK_FORMATION_PRESSURE)?;
        Some(points.into_iter().filter(|p| p[1] > 0.0).collect())
    });
    let y = |name: &str| Axis::new(name, "Pa").with_zero();
    let html = plots([
        figure("Peak pressure on the formation", time(), y("peak pressure"), in_time),
        figure(
            "Peak pressure on the formation per cycle",
            Axis::count("load cycle N").logarithmic(),
            y("peak pressure"),
            by_cycle,
        ),
        figure("Vertical force of the bed on the solid", time(), Axis::new("force", "N").with_zero(), force),
    ]);
    Section::new("pressure", "Pressure on the formation", html)
}

/// Formats sleeper loads and results.
pub fn sleepers(runs: &[RunData]) -> Option<Section> {
    let numbered = |run: &RunData, what: &str, column: &'static Definition| -> Vec<(String, Vec<[f64; 2]>)> {
        let Some(table) = run.table("history") else { return Vec::new() };
        let all = table.items(column).into_iter().filter_map(|number| {
            let label = number.strip_prefix('_').map_or(String::new(), |n| format!("{what} {n}"));
            Some((label, table.points(history::TIME, column.of(number))?))
        });
        all.collect()
    };
    let time = || Axis::new("time", "s");
    let load = overlay(runs, |r| numbered(r, "sleeper", history::LOAD));
    let rail = overlay(runs, |r| numbered(r, "sleeper", history::RAIL));
    let axles = overlay(runs, |r| numbered(r, "axle", history::AXLE_FORCE));
    let mut rows = Vec::new();
    for run in runs {
        for (k, s) in run.list("track.sleepers").iter().enumerate() {
            let name = format!("sleeper {}", k + 1);
            let name = if runs.len() > 1 { format!("{}: {name}", run.label) } else { name };
            let number = |key: &str, unit| Cell::of(s[key].as_f64(), unit);
            rows.push((
                name,
                vec![
                    number("largest_force", "N"),
                    number("smallest_force", "N"),
                    number("lowering", "m"),
                    number("load_share", ""),
                    number("dynamic_amplification", ""),
                    Cell::of(s["lifted_off"]["seconds"].as_f64(), "s"),
                ],
            ));
        }
    }
    let heads = [
        "sleeper",
        "largest force",
        "smallest force",
        "lowering",
        "axle load share",
        "dynamic factor",
        "time without contact",
    ];
    let figures = plots([
        figure("Vertical load on rail seats", time(), Axis::new("load", "N"), load),
        figure("Rail deflection at the sleepers", time(), Axis::new("deflection, upwards", "m"), rail),
        figure("Force of the axles on the track", time(), Axis::new("axle force", "N").with_zero(), axles),
    ]);
    Section::new("sleepers", "Sleepers", joined([figures, table(&heads, &rows)]))
}

/// Formats the lateral push.
pub fn push(runs: &[RunData]) -> Option<Section> {
    let curve =
        |column: &'static Definition| one(runs, move |r| r.table("push")?.points(push::DISPLACEMENT, column));
    let x = || Axis::new("lateral displacement of the sleeper", "m");
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let html = plots([
        figure("Lateral resistance", x(), Axis::new("actuator force", "N").with_zero(), curve(push::FORCE)),
        figure("Uplift of the sleeper", x(), Axis::new("uplift", "m"), curve(push::UPLIFT)),
    ]);
    let figures = facts(
        runs,
        &[
            ("actuator force at 2 mm", &path("push.resistance_at_2_mm", "N")),
            ("largest force", &path("push.peak", "N")),
            ("displacement at the largest force", &path("push.displacement_at_peak", "m")),
            ("force over the last quarter", &path("push.residual", "N")),
            ("vertical force", &path("push.vertical_force", "N")),
            ("uplift of the sleeper at the end", &path("push.uplift", "m")),
        ],
    );
    Section::new("push", "Lateral resistance test", joined([html, figures]))
}
