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
    let [sectors, mean_sectors] =
        [largest, mean].map(|take: Take| curves(&|table, name| rose(table, name, take)));
    let [layers, mean_layers] = [largest, mean].map(|take: Take| {
        curves(&|table, name| {
            let loads = parts(table, history::STRUCTURE_LAYER.of(name), take);
            (!loads.is_empty()).then(|| loads.iter().enumerate().map(|(k, f)| [*f, k as f64]).collect())
        })
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
        figure("Mean load of each sector", side("towards the axis, from x"), side("from y"), mean_sectors),
        figure(
            "Largest horizontal load of each layer",
            side("load"),
            Axis::count("layer, from below"),
            layers,
        ),
        figure(
            "Mean horizontal load of each layer",
            side("load"),
            Axis::count("layer, from below"),
            mean_layers,
        ),
    ]);
    let note = paragraph(
        "The closed curves have a point in the middle direction of each sector; its distance from the origin is the load towards the axis.",
    );
    if html.0.is_empty() { None } else { Section::new("loads", "Loads on structures", joined([html, note])) }
}

fn names(run: &RunData) -> Vec<&str> {
    run.table("history").map(|t| t.items(history::STRUCTURE_LOAD_LEVEL)).unwrap_or_default()
}

type Take = fn(&[f64]) -> f64;

fn largest(column: &[f64]) -> f64 {
    column.iter().fold(0.0, |m: f64, x| m.max(*x))
}

fn mean(column: &[f64]) -> f64 {
    column.iter().sum::<f64>() / column.len().max(1) as f64
}

fn parts(table: &Table, list: Name<'_>, take: Take) -> Vec<f64> {
    (0..).map_while(|k: usize| table.column(list.at(k))).map(take).collect()
}

/// Sector loads as a closed curve.
fn rose(table: &Table, name: &str, take: Take) -> Option<Vec<[f64; 2]>> {
    let loads = parts(table, history::STRUCTURE_SECTOR.of(name), take);
    let count = loads.len();
    (count > 1).then(|| {
        let at = |k: usize| {
            let (sine, cosine) = libm::sincos((k as f64 + 0.5) / count as f64 * TAU);
            [loads[k % count] * cosine, loads[k % count] * sine]
        };
        (0..=count).map(at).collect()
    })
}
