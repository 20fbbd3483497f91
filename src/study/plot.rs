//! Error over cost with Pareto front.

use super::file::Norm;
use super::outcome::{Outcome, cpu};
use super::plan::Plan;
use crate::write::scatter::{Group, Mark, ScatterPlot};

/// Draws the plot; points are numbered like table rows.
pub fn pareto(plan: &Plan, outcome: &Outcome) -> ScatterPlot {
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
    let group = |name: &str, mark, joined, points| Group { name: name.into(), mark, joined, points };
    let zero = place(reference).is_some_and(|p| p[1] == 0.0);
    let groups = vec![
        group("front", Mark::Circle, true, front.iter().map(shown).collect()),
        group("other cases", Mark::Square, false, of(&|k| k != reference && !outcome.front.contains(&k))),
        group(
            if zero { "reference (error 0)" } else { "reference" },
            Mark::Diamond,
            false,
            of(&|k| k == reference),
        ),
    ];
    ScatterPlot {
        title: plan.title.clone(),
        x_label: "CPU time of a run [s]".into(),
        y_label: if plain { "largest relative error [1]" } else { "largest error over its tolerance [1]" }
            .into(),
        groups: groups.into_iter().filter(|g| !g.points.is_empty()).collect(),
        level: Some(("tolerance".into(), unit)),
    }
}
