//! Error over cost with Pareto front.

use super::file::Norm;
use super::outcome::{Outcome, cpu};
use super::plan::Plan;
use trackbed_io::plot::{Axis, Curve, Level, Plot, Style};

/// Draws the plot; points are numbered like table rows.
pub fn pareto(plan: &Plan, outcome: &Outcome) -> Plot {
    // Plain errors are clearer than ratios.
    let plain = plan.quantities.iter().all(|q| q.norm == Norm::Relative && q.tolerance == plan.tolerance);
    let unit = if plain { plan.tolerance } else { 1.0 };
    let place = |k: usize| {
        let row = &outcome.rows[k];
        Some([cpu(row).filter(|s| *s > 0.0)?, unit * row.error_over_tolerance?])
    };
    let placed: Vec<(usize, [f64; 2])> =
        (0..outcome.rows.len()).filter_map(|k| Some((k, place(k)?))).collect();
    let least = placed.iter().map(|(_, p)| p[1]).filter(|e| *e > 0.0).fold(unit, f64::min);
    // Zero errors are drawn below the others.
    let shown = |(k, p): &(usize, [f64; 2])| {
        let y = if p[1] > 0.0 { p[1] } else { least / 5.0 };
        ((k + 1).to_string(), [p[0], y])
    };
    let reference = outcome.reference;
    let of = |accepted: &dyn Fn(usize) -> bool| {
        placed.iter().filter(|(k, _)| accepted(*k)).map(shown).collect::<Vec<_>>()
    };
    let mut front: Vec<(usize, [f64; 2])> =
        outcome.front.iter().filter_map(|k| placed.iter().find(|(other, _)| other == k).copied()).collect();
    front.retain(|(k, _)| *k != reference);
    let zero = place(reference).is_some_and(|p| p[1] == 0.0);
    let curve = |k: usize, name: &str, points: Vec<(String, [f64; 2])>| {
        let (labels, points) = points.into_iter().unzip();
        let style = Style { colour: k, dash: k, line: k == 0, marks: true };
        Curve { labels, ..Curve::new(name, points, style) }
    };
    let exact = if zero { "reference (error 0)" } else { "reference" };
    let curves = vec![
        curve(0, "front", front.iter().map(shown).collect()),
        curve(1, "other cases", of(&|k| k != reference && !outcome.front.contains(&k))),
        curve(2, exact, of(&|k| k == reference)),
    ];
    let y = if plain { "largest relative error" } else { "largest error over its tolerance" };
    Plot {
        title: plan.title.clone(),
        x: Axis::new("CPU time of a run", "s").logarithmic(),
        y: Axis::new(y, "1").logarithmic(),
        curves,
        level: Some(Level { name: "tolerance".into(), y: unit, tolerance: 0.0 }),
    }
}
