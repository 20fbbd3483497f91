//! Pressure on the formation, sleepers, lateral push.

use super::overlay::{facts, one, overlay};
use crate::report::data::RunData;
use crate::report::page::{Cell, Section, joined, plots, table};
use crate::report::plot::{Plot, Side};

/// Pressure on the formation and force on the solid.
pub fn pressure(runs: &[RunData]) -> Option<Section> {
    let time = || Side::new("time", "s");
    let in_time = one(runs, |r| r.table("history")?.points("time", "peak_formation_pressure"));
    let force = one(runs, |r| {
        let points = r.table("history")?.points("time", "contact_force_on_solid_z")?;
        Some(points.into_iter().map(|[t, f]| [t, -f]).collect())
    });
    let by_cycle = one(runs, |r| {
        let table = r.table("cycles").filter(|t| t.rows() > 1)?;
        let points = table.points("cycle", "peak_formation_pressure")?;
        Some(points.into_iter().filter(|p| p[1] > 0.0).collect())
    });
    let y = |name: &str| Side::new(name, "Pa").with_zero();
    let html = plots([
        Plot::new("Peak pressure on the formation", time(), y("peak pressure"), in_time).figure(),
        Plot::new(
            "Peak pressure on the formation per cycle",
            Side::count("load cycle N").logarithmic(),
            y("peak pressure"),
            by_cycle,
        )
        .figure(),
        Plot::new(
            "Vertical force of the bed on the solid",
            time(),
            Side::new("force", "N").with_zero(),
            force,
        )
        .figure(),
    ]);
    Section::new("pressure", "Pressure on the formation", html)
}

/// Loads on the sleepers, and what became of each.
pub fn sleepers(runs: &[RunData]) -> Option<Section> {
    let named = |run: &RunData, stem: &str| -> Vec<(String, Vec<[f64; 2]>)> {
        let Some(table) = run.table("history") else { return Vec::new() };
        let number =
            |name: &str| name.strip_prefix(stem).and_then(|n| n.strip_prefix('_')?.parse::<u32>().ok());
        let all = table.heads.iter().filter_map(|name| {
            let label = match number(name) {
                Some(n) => format!("sleeper {n}"),
                None if name == stem => String::new(),
                None => return None,
            };
            Some((label, table.points("time", name)?))
        });
        all.collect()
    };
    let time = || Side::new("time", "s");
    let load = overlay(runs, |r| named(r, "load"));
    let rail = overlay(runs, |r| named(r, "rail"));
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
        Plot::new("Vertical load on rail seats", time(), Side::new("load", "N"), load).figure(),
        Plot::new("Rail deflection at the sleepers", time(), Side::new("deflection, upwards", "m"), rail)
            .figure(),
    ]);
    Section::new("sleepers", "Sleepers", joined([figures, table(&heads, &rows)]))
}

/// Lateral push of a sleeper.
pub fn push(runs: &[RunData]) -> Option<Section> {
    let curve = |column: &'static str| one(runs, move |r| r.table("push")?.points("displacement", column));
    let x = || Side::new("lateral displacement of the sleeper", "m");
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let html = plots([
        Plot::new("Lateral resistance", x(), Side::new("actuator force", "N").with_zero(), curve("force"))
            .figure(),
        Plot::new("Uplift of the sleeper", x(), Side::new("uplift", "m"), curve("uplift")).figure(),
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
