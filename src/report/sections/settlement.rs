//! Settlement under load cycles, with fitted laws.

use super::laws::Law;
use super::overlay::{facts, one};
use crate::columns::{Definition, cycles, history};
use crate::report::data::RunData;
use crate::report::page::{Cell, Section, columns, headed, joined, paragraph, plots, table};
use crate::report::plot::{Curve, Look, Plot, Side};
use crate::report::quantity::{exact, number};
use maud::{Markup, html};
use serde_json::Value;

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
        curves[0].look.marks = true;
        curves[0].look.line = run.table("cycles").is_some_and(|t| t.rows() > 200);
        let drawn = laws[0].iter().filter(|law| !law.curve().is_empty());
        curves.extend(drawn.enumerate().map(|(k, law)| fitted(law, law.name.clone(), 1 + k)));
    } else {
        for (r, laws) in laws.iter().enumerate() {
            let best = laws.iter().filter(|l| !l.curve().is_empty()).max_by(|a, b| a.r2.total_cmp(&b.r2));
            let name = |law: &Law| format!("{}: {}", runs[r].label, law.name);
            curves.extend(best.map(|law| Curve {
                look: Look { colour: r, dash: 1, line: true, marks: false },
                ..fitted(law, name(law), r)
            }));
        }
    }
    curves.retain(|c| !c.points.is_empty());
    let y = || Side::new("settlement", "m").downwards().with_zero();
    let linear =
        Plot::new("Settlement of the sleeper", Side::count("load cycle N").with_zero(), y(), curves.clone());
    let several = runs.iter().any(|r| r.table("cycles").is_some_and(|t| t.rows() > 2));
    let figures = [
        linear.figure(),
        match several {
            true => {
                let x = Side::count("load cycle N").logarithmic();
                Plot::new("Settlement over log N", x, y(), curves).figure()
            }
            false => Markup::default(),
        },
        lowering(runs),
    ];
    let html = joined([plots(figures), figures_of(runs), fits(runs, &laws), by_cycle(runs)]);
    Section::new("settlement", "Settlement", html)
}

fn fitted(law: &Law, name: String, k: usize) -> Curve {
    let look = Look { colour: k, dash: k, line: true, marks: false };
    Curve { name, points: law.curve(), look }
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
    let y = Side::new("settlement since the start", "m").downwards();
    Plot::new("Settlement of the sleeper in time", Side::new("time", "s"), y, curves).figure()
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
            let parameters: Vec<String> =
                law.parameters.iter().map(|(name, v)| format!("{name} = {}", number(*v))).collect();
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
        true => "No law fitted: fewer than ten cycles after the tenth.",
        false => {
            "Least squares in the settlement itself, cycles from the tenth on; settlements in metres. Of several runs the plot \
             has the law with the largest R². Hettler's curve is that of Alva-Hurtado & Selig."
        }
    };
    let missing = runs.iter().all(|r| r.value("settlement") == &Value::Null && r.table("cycles").is_none());
    let note = if missing { Markup::default() } else { paragraph(note) };
    let heads = ["law", "form", "parameters", "R²", "rms error", "cycles"];
    joined([headed("Settlement laws", table(&heads, &rows)), note])
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
