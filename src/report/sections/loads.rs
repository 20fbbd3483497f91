//! Loads on structures, and their motion.

use super::overlay::overlay;
use crate::data::RunData;
use crate::page::{Section, joined, paragraph, plots};
use crate::plot::{Axis, figure};
use std::f64::consts::TAU;
use trackbed_io::columns::{Definition, Name, history};
use trackbed_io::results::tables::Table;

type Curve<'a> = &'a dyn Fn(&Table, &str) -> Option<Vec<[f64; 2]>>;

/// Formats structural loads.
pub fn loads(runs: &[RunData]) -> Option<Section> {
    let of =
        |stem: &str, f: Curve<'_>, run: &RunData| Some((stem.to_string(), f(run.table("history")?, stem)?));
    let curves = |f: Curve<'_>| {
        overlay(runs, |run| names(run).into_iter().filter_map(|name| of(name, f, run)).collect())
    };
    let time = curves(&|table, name| table.points(history::TIME, history::STRUCTURE_LOAD_LEVEL.of(name)));
    let sectors = curves(&|table, name| rose(table, name));
    let layers = curves(&|table, name| {
        let largest = largest(table, history::STRUCTURE_LAYER.of(name));
        (!largest.is_empty()).then(|| largest.iter().enumerate().map(|(k, f)| [*f, k as f64]).collect())
    });
    let side = |name: &str| Axis::new(name, "N");
    let motion = |column: &'static Definition| {
        overlay(runs, |run| {
            let Some(table) = run.table("history") else { return Vec::new() };
            let of = |name: &str, k: usize| {
                let points = table.points(history::TIME, column.of(name).at(k))?;
                Some((format!("{name} along {}", ["x", "y"][k]), points))
            };
            names(run).into_iter().flat_map(|name| (0..2).filter_map(move |k| of(name, k))).collect()
        })
    };
    let (ways, accelerations) = (motion(history::STRUCTURE_MOTION), motion(history::STRUCTURE_ACCELERATION));
    let html = plots([
        figure("Horizontal load on structures", Axis::new("time", "s"), side("load"), time),
        figure("Displacement of structures", Axis::new("time", "s"), Axis::new("displacement", "m"), ways),
        figure(
            "Acceleration of structures",
            Axis::new("time", "s"),
            Axis::new("acceleration", "m/s2"),
            accelerations,
        ),
        figure("Largest load of each sector", side("towards the axis, from x"), side("from y"), sectors),
        figure(
            "Largest horizontal load of each layer",
            side("load"),
            Axis::count("layer, from below"),
            layers,
        ),
    ]);
    let note = paragraph(
        "The closed curve has for each sector a point in the direction that the sector looks to, as far from the origin as its largest load \
         towards the axis.",
    );
    if html.0.is_empty() { None } else { Section::new("loads", "Loads on structures", joined([html, note])) }
}

fn names(run: &RunData) -> Vec<&str> {
    run.table("history").map(|t| t.items(history::STRUCTURE_LOAD_LEVEL)).unwrap_or_default()
}

fn largest(table: &Table, list: Name<'_>) -> Vec<f64> {
    let of = |k: usize| table.column(list.at(k));
    (0..).map_while(of).map(|column| column.iter().fold(0.0, |m: f64, x| m.max(*x))).collect()
}

/// Sector loads as a closed curve.
fn rose(table: &Table, name: &str) -> Option<Vec<[f64; 2]>> {
    let loads = largest(table, history::STRUCTURE_SECTOR.of(name));
    let count = loads.len();
    (count > 1).then(|| {
        let at = |k: usize| {
            let (sine, cosine) = libm::sincos((k as f64 + 0.5) / count as f64 * TAU);
            [loads[k % count] * cosine, loads[k % count] * sine]
        };
        (0..=count).map(at).collect()
    })
}
