//! Load–deflection loops; cyclic stiffness, modulus, damping.

use super::overlay::one;
use crate::data::RunData;
use crate::page::{Section, joined, paragraph, plots};
use crate::plot::{Axis, Curve, Style, figure};
use maud::Markup;
use std::f64::consts::PI;
use trackbed_io::columns::{Definition, cycles, history};

const ROWS: usize = 12;

/// Deflection [m] downwards, load [N].
struct Loop {
    number: usize,
    points: Vec<[f64; 2]>,
}

/// Formats loops, stiffness, damping.
pub fn loops(runs: &[RunData]) -> Option<Section> {
    let x = || Axis::count("load cycle N").logarithmic();
    let of = |column: &'static Definition| {
        one(runs, move |r| {
            // Zero means undefined.
            let points = r.table("cycles")?.points(cycles::CYCLE, column)?;
            Some(points.into_iter().filter(|p| p[1] != 0.0).collect())
        })
    };
    let plot = |title: &str, name: &str, unit: &str, curves: Vec<Curve>| {
        figure(title, x(), Axis::new(name, unit).with_zero(), curves)
    };
    let single = runs.iter().all(|r| r.table("cycles").is_none_or(|t| t.rows() < 2));
    let over_cycles = match single {
        true => Vec::new(),
        false => vec![
            plot("Resilient deflection", "resilient deflection", "m", of(cycles::RESILIENT_DEFLECTION)),
            plot(
                "Secant stiffness",
                "load range / resilient deflection",
                "N/m",
                of(cycles::SECANT_STIFFNESS),
            ),
            plot("Bed stiffness", "slope between two loads", "N/m", of(cycles::BED_STIFFNESS)),
            plot(
                "Resilient modulus",
                "pressure range / resilient strain",
                "Pa",
                of(cycles::RESILIENT_MODULUS),
            ),
            plot("Hysteresis loop area", "energy dissipated in a cycle", "J", of(cycles::DISSIPATED_ENERGY)),
            plot("Damping ratio", "damping ratio D", "", one(runs, damping)),
        ],
    };
    let (figure, note) = single_loops(runs);
    let html = plots(std::iter::once(figure).chain(over_cycles));
    if html.0.is_empty() {
        return None;
    }
    let formulas = paragraph(
        "Secant stiffness K: load range over the resilient deflection u, the rebound of the sleeper from its lowest position to the end of the cycle. Area of the loop E: work of the load over the cycle, settlement included. Damping \
         ratio D = 2 E/(π K u²): E over 4π times the energy of a spring K at half the range of u.",
    );
    Section::new("loops", "Load–deflection", joined([html, note, formulas]))
}

/// E/(4π ½ K (u/2)²).
fn damping(run: &RunData) -> Option<Vec<[f64; 2]>> {
    let table = run.table("cycles")?;
    let [n, u, k, e] =
        [cycles::CYCLE, cycles::RESILIENT_DEFLECTION, cycles::SECANT_STIFFNESS, cycles::DISSIPATED_ENERGY]
            .map(|c| table.column(c));
    let (n, u, k, e) = (n?, u?, k?, e?);
    let ratio = |i: usize| 2.0 * e[i] / (PI * k[i] * u[i] * u[i]);
    let known = (0..n.len()).filter(|&i| u[i] > 0.0 && k[i] > 0.0 && ratio(i).is_finite());
    Some(known.map(|i| [n[i], ratio(i)]).collect())
}

fn single_loops(runs: &[RunData]) -> (Markup, Markup) {
    let mut curves = Vec::new();
    let mut coarse = false;
    for (r, run) in runs.iter().enumerate() {
        let Some(all) = loops_of(run) else { continue };
        let fine: Vec<&Loop> = all.iter().filter(|l| l.points.len() >= ROWS).collect();
        coarse |= fine.len() < all.len();
        // Numbered as cycles only if all were detected.
        let counted = run.table("cycles").is_some_and(|t| t.rows() == all.len());
        for (k, one) in selected(&fine, if runs.len() > 1 { 2 } else { 6 }).into_iter().enumerate() {
            let kind = if counted { "cycle" } else { "loop" };
            let name = format!("{kind} {}", one.number);
            let (name, colour) =
                if runs.len() > 1 { (format!("{}: {name}", run.label), r) } else { (name, k) };
            let style = Style { colour, dash: k, line: true, marks: false };
            curves.push(Curve::new(name, one.points.clone(), style));
        }
    }
    let text = "Loops are drawn from the rows of the history; a cycle with fewer than 12 of them is left out \
                (output.history_interval sets the time between rows).";
    let note = if coarse { paragraph(text) } else { Markup::default() };
    let x = Axis::new("settlement since the start", "m");
    (figure("Load–deflection loops", x, Axis::new("load on the sleeper", "N").with_zero(), curves), note)
}

/// First, last, others in geometric spacing.
fn selected<'a>(all: &[&'a Loop], most: usize) -> Vec<&'a Loop> {
    if all.len() <= most {
        return all.to_vec();
    }
    let last = (all.len() - 1) as f64;
    let mut places: Vec<usize> = (0..most)
        .map(|k| (libm::pow(last + 1.0, k as f64 / (most - 1) as f64) - 1.0).round() as usize)
        .collect();
    places.dedup();
    places.into_iter().map(|k| all[k.min(all.len() - 1)]).collect()
}

/// Loops of the first loaded sleeper, between load minima.
fn loops_of(run: &RunData) -> Option<Vec<Loop>> {
    let table = run.table("history")?;
    let (load, z) = ["", "_1"].into_iter().find_map(|n| {
        Some((table.column(history::LOAD.of(n))?, table.column(history::SLEEPER.of(n).at(2))?))
    })?;
    let least = load.iter().copied().fold(f64::INFINITY, f64::min);
    let most = load.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Must cross the middle range: a ramp is no cycle.
    let (low, high) = (least + 0.45 * (most - least), least + 0.55 * (most - least));
    let mut rises = Vec::new();
    let mut below = true;
    for (k, f) in load.iter().enumerate() {
        if below && *f > high {
            rises.push(k);
            below = false;
        }
        below |= *f < low;
    }
    let lowest = |from: usize, to: usize| (from..to).min_by(|a, b| load[*a].total_cmp(&load[*b]));
    let mut ends = Vec::new();
    for (k, &rise) in rises.iter().enumerate() {
        let from = if k == 0 { 0 } else { rises[k - 1] };
        // Rest and ramp before the first rise are no part of the cycle.
        let near = |i: &usize| load[*i] <= load[lowest(from, rise).unwrap_or(from)] + 0.08 * (most - least);
        let start = if k == 0 { (from..rise).rev().find(near) } else { lowest(from, rise) };
        ends.push(start.unwrap_or(from));
    }
    if let Some(&rise) = rises.last() {
        // The last cycle may be incomplete.
        ends.extend(lowest(rise, load.len()).filter(|&k| load[k] < low));
    }
    let first = *z.first()?;
    let points = |w: &[usize]| (w[0]..=w[1]).map(|i| [first - z[i], load[i]]).collect();
    Some(ends.windows(2).enumerate().map(|(k, w)| Loop { number: k + 1, points: points(w) }).collect())
}
