//! Settlement under load cycles, with fitted laws.

use super::laws::Law;
use super::overlay::{facts, one};
use crate::data::RunData;
use crate::page::{Cell, Section, columns, headed, joined, paragraph, plots, table};
use crate::plot::{Axis, Curve, Style, figure};
use crate::quantity::{exact, number};
use maud::{Markup, html};
use serde_json::Value;
use trackbed_io::columns::{Definition, cycles, history};

/// 1, 2, 5 of each decade, and the last.
fn chosen(n: f64, last: f64) -> bool {
    let power = libm::pow(10.0, libm::log10(n).floor());
    n == last || [1.0, 2.0, 5.0].iter().any(|d| (n - d * power).abs() < 1e-6 * n)
}

/// Formats settlement over cycles.
pub fn settlement(runs: &[RunData]) -> Option<Section> {
    let data = one(runs, |r| r.table("cycles")?.points(cycles::CYCLE, cycles::SETTLEMENT));
    if data.is_empty() {
        return None;
    }
    let laws: Vec<Vec<Law>> =
        runs.iter().map(|r| r.list("settlement.fits").iter().filter_map(Law::of).collect()).collect();
    let mut curves = data;
    if let [run] = runs {
        curves[0].name = "simulated".into();
        curves[0].style.marks = true;
        curves[0].style.line = run.table("cycles").is_some_and(|t| t.rows() > 200);
        let drawn = laws[0].iter().filter(|law| !law.curve().is_empty());
        curves.extend(drawn.enumerate().map(|(k, law)| fitted(law, law.name.clone(), [1 + k; 2])));
    } else {
        for (r, laws) in laws.iter().enumerate() {
            let best = laws.iter().filter(|l| !l.curve().is_empty()).max_by(|a, b| a.r2.total_cmp(&b.r2));
            let name = |law: &Law| format!("{}: {}", runs[r].label, law.name);
            curves.extend(best.map(|law| fitted(law, name(law), [r, 1])));
        }
    }
    curves.retain(|c| !c.points.is_empty());
    let y = || Axis::new("settlement", "m").downwards().with_zero();
    let several = runs.iter().any(|r| r.table("cycles").is_some_and(|t| t.rows() > 2));
    let count = || Axis::count("load cycle N");
    let figures = [
        figure("Settlement of the sleeper", count().with_zero(), y(), curves.clone()),
        match several {
            true => figure("Settlement over log N", count().logarithmic(), y(), curves),
            false => Markup::default(),
        },
        lowering(runs),
    ];
    let html = joined([plots(figures), figures_of(runs), fits(runs, &laws), by_cycle(runs)]);
    Section::new("settlement", "Settlement", html)
}

fn fitted(law: &Law, name: String, [colour, dash]: [usize; 2]) -> Curve {
    Curve::new(name, law.curve(), Style { colour, dash, line: true, marks: false })
}

fn lowering(runs: &[RunData]) -> Markup {
    let curves = super::overlay::overlay(runs, |run| {
        let Some(table) = run.table("history") else { return Vec::new() };
        let numbers = table.items(history::SLEEPER_TILT);
        let several = numbers.len() > 1;
        numbers
            .into_iter()
            .filter_map(|number| {
                let points = table.points(history::TIME, history::SLEEPER.of(number).at(2))?;
                let first = points.first()?[1];
                let name =
                    if several { format!("sleeper{}", number.replace('_', " ")) } else { String::new() };
                Some((name, points.into_iter().map(|[t, z]| [t, first - z]).collect()))
            })
            .collect()
    });
    let y = Axis::new("settlement since the start", "m").downwards().with_zero();
    figure("Settlement of the sleeper in time", Axis::new("time", "s"), y, curves)
}

fn figures_of(runs: &[RunData]) -> Markup {
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    facts(
        runs,
        &[
            ("settlement after the last cycle", &|r| {
                Cell::of(super::compare::last_of(r, cycles::SETTLEMENT), "m")
            }),
            ("settlement during seating, not counted", &path("settlement.seating", "m")),
            ("increments of the second half over the first half", &path("settlement.slowing", "")),
            ("cycles simulated, with jumps", &path("settlement.jump.simulated", "")),
            ("cycles skipped", &path("settlement.jump.skipped", "")),
            ("estimated settlement error of cycle jumps", &path("settlement.jump.error_estimate", "m")),
        ],
    )
}

fn fits(runs: &[RunData], laws: &[Vec<Law>]) -> Markup {
    let mut rows = Vec::new();
    for (run, laws) in runs.iter().zip(laws) {
        for law in laws {
            let name = if runs.len() > 1 { format!("{}: {}", run.label, law.name) } else { law.name.clone() };
            let with_error = |(k, (name, v)): (usize, &(String, f64))| match law.standard_errors.get(k) {
                Some(error) => format!("{name} = {} ± {}", number(*v), rounded(1.96 * error)),
                None => format!("{name} = {}", number(*v)),
            };
            let parameters: Vec<String> = law.parameters.iter().enumerate().map(with_error).collect();
            let precise: Vec<String> =
                law.parameters.iter().map(|(name, v)| format!("{name} = {}", exact(*v, ""))).collect();
            let text = html! { span title=(precise.join(", ")) { (parameters.join(", ")) } };
            let [from, to] = law.range;
            rows.push((
                name,
                vec![
                    Cell::text(format!("s = {}", law.form)),
                    Cell::Html(text),
                    Cell::Value(law.r2, ""),
                    Cell::Value(law.rms_error, "m"),
                    Cell::text(format!("{from} to {to}")),
                ],
            ));
        }
    }
    let note = match rows.is_empty() {
        true => "No law fitted: fewer than three cycles from the second on, or constant settlement.",
        false => {
            "Least squares in the settlement itself, cycles from the tenth on, in short runs from the second; settlements in metres; \
             ± 95 % confidence, with the correlation of successive cycles. Of several runs the plot \
             has the law with the largest R². Hettler's curve is that of Alva-Hurtado & Selig."
        }
    };
    let missing = runs.iter().all(|r| r.value("settlement") == &Value::Null && r.table("cycles").is_none());
    let note = if missing { Markup::default() } else { paragraph(note) };
    let heads = ["law", "form", "parameters", "R²", "rms error", "cycles"];
    joined([headed("Settlement laws", table(&heads, &rows)), note])
}

/// Two digits.
fn rounded(value: f64) -> String {
    let decimals = (1 - libm::log10(value.abs().max(f64::MIN_POSITIVE)).floor() as i32).clamp(-300, 300);
    let unit = libm::pow(10.0, f64::from(decimals));
    number((value * unit).round() / unit)
}

/// Traffic for which laws are extrapolated [MGT].
const TRAFFIC: [f64; 5] = [0.01, 0.1, 1.0, 10.0, 100.0];
/// Laws of the band.
const FAIR: f64 = 0.5;

/// Settlement against traffic for the axle load of one cycle [t]: laws beyond the cycles, with their range.
pub fn traffic(runs: &[RunData], axle_load: f64) -> Option<Section> {
    let per_cycle = 1e-6 * axle_load;
    let curves = one(runs, |r| {
        let points = r.table("cycles")?.points(cycles::CYCLE, cycles::SETTLEMENT)?;
        Some(points.into_iter().map(|[n, s]| [n * per_cycle, s]).collect())
    });
    let mut rows = Vec::new();
    for run in runs {
        let laws: Vec<Law> = run.list("settlement.fits").iter().filter_map(Law::of).collect();
        let last = laws.iter().map(|law| law.range[1]).fold(0.0, f64::max);
        for mgt in TRAFFIC.into_iter().filter(|mgt| last > 0.0 && mgt / per_cycle > last) {
            let n = mgt / per_cycle;
            let fair = laws.iter().filter(|law| law.r2 >= FAIR);
            // A law that rises again, as a parabola does, is no extrapolation.
            let beyond = |law: &Law| law.at(n).filter(|s| Some(*s) >= law.at(law.range[1]));
            let all: Vec<(f64, &Law, f64)> =
                fair.filter_map(|law| Some((law.r2, law, beyond(law)?))).collect();
            let Some(best) = all.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            let bound = |pick: fn(f64, f64) -> f64| all.iter().map(|a| a.2).reduce(pick);
            let name =
                if runs.len() > 1 { format!("{}: {} MGT", run.label, mgt) } else { format!("{mgt} MGT") };
            rows.push((
                name,
                vec![
                    Cell::text(format!("{n:.0}")),
                    Cell::of(Some(best.2), "m"),
                    Cell::text(best.1.name.clone()),
                    Cell::of(bound(f64::min), "m"),
                    Cell::of(bound(f64::max), "m"),
                ],
            ));
        }
    }
    let (x, y) =
        (Axis::new("traffic", "MGT").with_zero(), Axis::new("settlement", "m").downwards().with_zero());
    let figure = figure("Settlement against traffic", x, y, curves);
    let heads = ["traffic", "passages", "best law", "law", "smallest of all laws", "largest"];
    let note = paragraph(&format!(
        "A cycle is the passage of an axle of {axle_load} t; 1 MGT is a million gross tonnes. Laws with R² of at least {FAIR}, beyond the simulated \
         cycles: an extrapolation, whose error is at least the range of the laws. Not included: tamping, wet weather, mixed axle loads."
    ));
    let table = headed("Extrapolation", table(&heads, &rows));
    Section::new("traffic", "Settlement against traffic", joined([plots([figure]), table, note]))
}

fn by_cycle(runs: &[RunData]) -> Markup {
    let mut parts = Vec::new();
    for run in runs {
        let Some(table) = run.table("cycles") else { continue };
        let Some(cycles) = table.column(cycles::CYCLE) else { continue };
        let last = cycles.last().copied().unwrap_or(0.0);
        let rows: Vec<usize> = (0..cycles.len()).filter(|&k| chosen(cycles[k], last)).collect();
        let names: Vec<String> = rows.iter().map(|&k| number(cycles[k])).collect();
        let of = |column: &'static Definition| -> Vec<Option<f64>> {
            let column = table.column(column);
            rows.iter().map(|&k| column.map(|c| c[k])).collect()
        };
        // Zero means undefined.
        let known = |column: &'static Definition| -> Vec<Option<f64>> {
            of(column).into_iter().map(|v| v.filter(|v| *v != 0.0)).collect()
        };
        let all = [
            ("settlement", "m", of(cycles::SETTLEMENT)),
            ("rate per cycle", "m", of(cycles::RATE)),
            ("resilient deflection", "m", of(cycles::RESILIENT_DEFLECTION)),
            ("secant stiffness", "N/m", known(cycles::SECANT_STIFFNESS)),
            ("bed stiffness", "N/m", known(cycles::BED_STIFFNESS)),
            ("resilient modulus", "Pa", known(cycles::RESILIENT_MODULUS)),
            ("dissipated", "J", of(cycles::DISSIPATED_ENERGY)),
            ("peak formation pressure", "Pa", known(cycles::PEAK_FORMATION_PRESSURE)),
        ];
        let some: Vec<_> = all.into_iter().filter(|c| c.2.iter().flatten().any(|v| *v != 0.0)).collect();
        let whose = if runs.len() > 1 { format!(" of {}", run.label) } else { String::new() };
        parts.push(headed(&format!("Load cycles{whose}"), columns("cycle", &names, &some)));
    }
    joined(parts)
}
