//! Final packing: coordination, porosity, stress; growth and compaction.

use super::overlay::{facts, one};
use crate::data::RunData;
use crate::page::{Cell, Section, columns, headed, joined, plots, table};
use crate::plot::{Axis, figure};
use maud::Markup;
use serde_json::Value;
use trackbed_io::columns::radial;

/// Formats the packing.
pub fn packing(runs: &[RunData]) -> Option<Section> {
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let figures = facts(
        runs,
        &[
            ("coordination number at the start of the run", &path("model.coordination", "")),
            ("coordination number at the end", &path("packing.coordination", "")),
            ("coordination number without rattlers", &path("packing.mechanical_coordination", "")),
            ("rattlers: fraction of grains with at most one neighbour", &path("packing.rattlers", "")),
            ("mean normal contact force", &path("packing.mean_contact_force", "N")),
            ("strong contacts: fraction above the mean force", &path("packing.strong_contacts", "")),
            ("strong contacts: fraction of the normal forces", &path("packing.strong_load", "")),
            ("unbalanced force over mean contact force", &path("packing.unbalanced_ratio", "")),
            ("fouling index: fines by mass", &path("packing.fouling.fouling_index", "")),
            (
                "fines by solid volume over the other grains",
                &path("packing.fouling.relative_fouling_ratio", ""),
            ),
        ],
    );
    let neighbours = one(runs, |r| {
        let counts: Vec<f64> = r.list("packing.neighbours").iter().filter_map(Value::as_f64).collect();
        let all: f64 = counts.iter().sum();
        (all > 0.0).then(|| counts.iter().enumerate().map(|(k, n)| [k as f64, n / all]).collect())
    });
    let radial = one(runs, |r| {
        let table = r.table("radial")?;
        let first = *table.column(radial::MEASURE)?.first()?;
        let of_first = table.column(radial::MEASURE)?.iter().map(|m| *m == first);
        let points = table.points(radial::DISTANCE, radial::G)?;
        Some(points.into_iter().zip(of_first).filter(|(_, own)| *own).map(|(p, _)| p).collect())
    });
    let html = joined([
        figures,
        measures(runs),
        plots([
            figure(
                "Distribution of coordination numbers",
                Axis::count("neighbours").with_zero(),
                Axis::new("fraction of grains", "").with_zero(),
                neighbours,
            ),
            figure(
                "Radial distribution function of the first box",
                Axis::new("distance", "m").with_zero(),
                Axis::new("g", "").with_zero(),
                radial,
            ),
        ]),
        made(runs),
    ]);
    Section::new("packing", "Packing", html)
}

fn measures(runs: &[RunData]) -> Markup {
    let mut names = Vec::new();
    let mut found: Vec<&Value> = Vec::new();
    for run in runs {
        for m in run.list("packing.measures") {
            let name = m["name"].as_str().unwrap_or("box");
            names.push(if runs.len() > 1 { format!("{}: {name}", run.label) } else { name.to_string() });
            found.push(m);
        }
    }
    if names.is_empty() {
        return Markup::default();
    }
    let of = |key: &str| -> Vec<Option<f64>> { found.iter().map(|m| m[key].as_f64()).collect() };
    let solid = of("porosity").into_iter().map(|p| Some(1.0 - p?)).collect();
    let stress =
        |k: usize| -> Vec<Option<f64>> { found.iter().map(|m| m["stress"].get(k)?.as_f64()).collect() };
    let mean =
        (0..found.len()).map(|i| Some(-(stress(0)[i]? + stress(1)[i]? + stress(2)[i]?) / 3.0)).collect();
    let packing = [
        ("porosity", "", of("porosity")),
        ("solid fraction", "", solid),
        ("grains", "", of("grains")),
        ("neighbours", "", of("coordination")),
        ("without rattlers", "", of("mechanical_coordination")),
    ];
    let stresses = [
        ("mean pressure", "Pa", mean),
        ("σxx", "Pa", stress(0)),
        ("σyy", "Pa", stress(1)),
        ("σzz", "Pa", stress(2)),
        ("σxy", "Pa", stress(3)),
        ("σyz", "Pa", stress(4)),
        ("σzx", "Pa", stress(5)),
    ];
    joined([
        headed("Measuring boxes", columns("box", &names, &packing)),
        headed("Stress in the boxes, tension positive", columns("box", &names, &stresses)),
    ])
}

fn made(runs: &[RunData]) -> Markup {
    let several = runs.len() > 1;
    let (mut growth, mut compaction) = (Vec::new(), Vec::new());
    for run in runs {
        let name = |text: &str| if several { format!("{}: {text}", run.label) } else { text.to_string() };
        for g in run.list("growth") {
            let number = |key: &str| Cell::of(g[key].as_f64(), "");
            let cells = vec![number("porosity"), number("largest_overlap"), number("unbalanced_ratio")];
            growth.push((name(g["group"].as_str().unwrap_or_default()), cells));
        }
        for (k, c) in run.list("compaction").iter().enumerate() {
            let number = |key: &str, unit| Cell::of(c[key].as_f64(), unit);
            let cells =
                vec![number("porosity_before", ""), number("porosity_after", ""), number("wall_force", "N")];
            compaction.push((name(&format!("{}: {}", k + 1, c["kind"].as_str().unwrap_or_default())), cells));
        }
    }
    let growth = table(&["group", "porosity", "largest overlap over radius", "unbalanced force"], &growth);
    let compaction =
        table(&["stage", "porosity before", "porosity after", "force on the plane"], &compaction);
    joined([headed("Growth", growth), headed("Compaction", compaction)])
}
