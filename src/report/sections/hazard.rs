//! Statistics of structural loads: warning levels, exceedance, peaks, loads of return periods.

use super::overlay::overlay;
use crate::data::RunData;
use crate::page::{Cell, Section, joined, paragraph, plots, table};
use crate::plot::{Axis, figure};
use crate::quantity::with_unit;
use maud::{Markup, html};
use serde_json::Value;
use trackbed_io::extremes::Fit;

/// Formats the statistics of all structures that have them.
pub fn hazard(runs: &[RunData]) -> Option<Section> {
    let all: Vec<(String, &Value)> = runs.iter().flat_map(|run| named(run, runs.len() > 1)).collect();
    if all.is_empty() {
        return None;
    }
    let cards = joined(all.iter().map(|(name, hazard)| card(name, hazard)));
    let curves = overlay(runs, |run| {
        let of = |(name, hazard): (String, &Value)| {
            [(format!("{name}: peaks"), empirical(hazard)), (format!("{name}: fit"), fitted(hazard))]
        };
        named(run, false).into_iter().flat_map(of).collect()
    });
    let side = Axis::new("exceedance of a peak", "").logarithmic();
    let figure = plots([figure("Peaks of the horizontal load", Axis::new("load", "N"), side, curves)]);
    let note = paragraph(
        "Return period: the load is exceeded once in it on average. Interval: of the fit, not of the number of peaks.",
    );
    Section::new("hazard", "Hazard", joined([cards, exceedance(&all), return_loads(&all), figure, note]))
}

fn named(run: &RunData, with_run: bool) -> Vec<(String, &Value)> {
    let of = |structure: &'static str, s: &Value| {
        let name = s["name"].as_str().unwrap_or(structure);
        if with_run { format!("{}: {name}", run.label) } else { name.to_string() }
    };
    let known = run.list("structures").iter().filter(|s| s["hazard"].is_object());
    known.map(|s| (of("structure", s), &s["hazard"])).collect()
}

fn card(name: &str, hazard: &Value) -> Markup {
    let warning = hazard["warning"].as_str();
    let class = match warning {
        Some("red") => "failed",
        Some("amber") => "warned",
        Some(_) => "passed",
        None => "open",
    };
    let force = |key: &str| hazard[key].as_f64().map(|f| with_unit(f, "N"));
    let levels = [("amber", force("amber")), ("red", force("red"))];
    let levels = levels.into_iter().filter_map(|(name, load)| Some(format!("{name} above {}", load?)));
    let levels: Vec<String> = levels.collect();
    let fit =
        fit(hazard).map_or("no fit".to_string(), |fit| format!("distance of the fit {:.3}", fit.distance));
    let count = hazard["peaks"].as_array().map_or(0, Vec::len);
    html! {
        div class={ "run " (class) } {
            "\n" h3 { (name) } "\n"
            p {
                @if let Some(warning) = warning { strong { "Warning level " (warning) "." } " " (levels.join(", ")) ". " }
                (count) " peaks above " (force("threshold").unwrap_or_default()) ", " (fit) "."
                @if let (Some(ratio), Some(load)) = (hazard["over_level_ice"].as_f64(), force("level_ice")) {
                    " Largest load: " (format!("{ratio:.3}")) " times " (load) " of level ice."
                }
            }
            "\n"
        }
        "\n"
    }
}

fn exceedance(all: &[(String, &Value)]) -> Markup {
    let rows = all.iter().flat_map(|(name, hazard)| {
        hazard["exceedance"].as_array().into_iter().flatten().map(move |e| {
            let percent = e["fraction_of_time"].as_f64().map(|f| 100.0 * f);
            let cells = [(e["load"].as_f64(), "N"), (percent, "%"), (e["events"].as_f64(), "")]
                .map(|(v, unit)| Cell::of(v, unit));
            (name.clone(), cells.to_vec())
        })
    });
    table(&["structure", "load", "time above", "events"], &rows.collect::<Vec<_>>())
}

fn return_loads(all: &[(String, &Value)]) -> Markup {
    let rows = all.iter().flat_map(|(name, hazard)| {
        let confidence = hazard["confidence"].as_f64().map(|c| 100.0 * c);
        hazard["return_loads"].as_array().into_iter().flatten().map(move |r| {
            let load = |key: &str| Cell::of(r["load"][key].as_f64(), "N");
            let cells = vec![
                Cell::of(r["period"].as_f64(), ""),
                load("value"),
                load("low"),
                load("high"),
                Cell::of(confidence, "%"),
            ];
            (name.clone(), cells)
        })
    });
    let heads = ["structure", "return period [years]", "load", "from", "to", "confidence"];
    table(&heads, &rows.collect::<Vec<_>>())
}

fn fit(hazard: &Value) -> Option<Fit> {
    serde_json::from_value(hazard["fit"].clone()).ok()
}

fn peaks(hazard: &Value) -> Vec<f64> {
    let peaks = hazard["peaks"].as_array().into_iter().flatten();
    let mut peaks: Vec<f64> = peaks.filter_map(|p| p.get(1)?.as_f64()).collect();
    peaks.sort_unstable_by(f64::total_cmp);
    peaks
}

/// Exceedance by rank, (n − k + ½) / n of the k-th peak.
fn empirical(hazard: &Value) -> Vec<[f64; 2]> {
    let peaks = peaks(hazard);
    let n = peaks.len() as f64;
    peaks.iter().enumerate().map(|(k, load)| [*load, (n - k as f64 - 0.5) / n]).collect()
}

fn fitted(hazard: &Value) -> Vec<[f64; 2]> {
    let (Some(fit), peaks) = (fit(hazard), peaks(hazard)) else { return Vec::new() };
    peaks.iter().map(|load| [*load, fit.exceedance(*load)]).filter(|p| p[1] > 0.0).collect()
}
