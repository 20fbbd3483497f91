//! Solid: displacement, equilibrium, plasticity, safety, modes.

use super::overlay::{dominant, facts, one, overlay};
use super::profiles::is_line_point;
use crate::data::RunData;
use crate::page::{Cell, Section, columns, headed, joined, paragraph, plots, table};
use crate::plot::{Axis, figure};
use maud::Markup;
use trackbed_input::scene::history::TimeFunction;
use trackbed_io::columns::{Definition, gauss, history, modes, safety};

/// Formats the solid.
pub fn solid(runs: &[RunData]) -> Option<Section> {
    let time = || Axis::new("time", "s");
    let driven = overlay(runs, load_displacement);
    let reactions = overlay(runs, |run| {
        let stems =
            run.table("history").map(|t| t.items(history::SUPPORT_REACTION.at(0))).unwrap_or_default();
        let of = |stem: &&str| {
            let (axis, values) = dominant(run, history::SUPPORT_REACTION.of(stem))?;
            let time = run.table("history")?.column(history::TIME)?;
            Some((format!("{stem}, {axis}"), time.iter().zip(values).map(|(t, f)| [*t, *f]).collect()))
        };
        stems.iter().filter_map(of).collect()
    });
    let probes = |motion: &'static Definition| {
        overlay(runs, move |run| {
            let stems = run.table("history").map(|t| t.items(motion.at(0))).unwrap_or_default();
            let of = |stem: &&str| {
                let (axis, values) = dominant(run, motion.of(stem))?;
                let time = run.table("history")?.column(history::TIME)?;
                Some((format!("{stem}, {axis}"), time.iter().zip(values).map(|(t, u)| [*t, *u]).collect()))
            };
            stems.iter().filter(|stem| !is_line_point(run, stem)).filter_map(of).collect()
        })
    };
    let stresses = overlay(runs, |run| {
        let Some(table) = run.table("history") else { return Vec::new() };
        let (point, area) = (history::PROBE_STRESS, history::PROBE_VERTICAL_STRESS);
        let points = table.items(point.at(2)).into_iter().filter(|stem| !is_line_point(run, stem));
        let points = points.map(|stem| (stem, point.of(stem).at(2)));
        let areas = table.items(area).into_iter().map(|stem| (stem, area.of(stem)));
        let of = |(stem, name)| Some((String::from(stem), table.points(history::TIME, name)?));
        points.chain(areas).filter_map(of).collect()
    });
    let note = match driven.is_empty() {
        true => Markup::default(),
        false => paragraph(
            "Load and displacement of supports that are moved: force of the support on the solid against its given displacement, \
             both positive in the direction of the displacement.",
        ),
    };
    let figures = plots([
        figure(
            "Load–displacement",
            Axis::new("displacement of the support", "m"),
            Axis::new("force", "N"),
            driven,
        ),
        figure("Reactions of named supports", time(), Axis::new("force on the solid", "N"), reactions),
        figure("Displacement of probes", time(), Axis::new("displacement", "m"), probes(history::PROBE_U)),
        figure("Velocity of probes", time(), Axis::new("velocity", "m/s"), probes(history::PROBE_V)),
        figure("Vertical stress at probes", time(), Axis::new("stress, tension positive", "Pa"), stresses),
    ]);
    Section::new("solid", "Solid", joined([figures, note, equilibrium(runs), supports(runs)]))
}

fn load_displacement(run: &RunData) -> Vec<(String, Vec<[f64; 2]>)> {
    let (Some(table), Some(scene)) = (run.table("history"), &run.scene) else { return Vec::new() };
    let supports = scene.solid.iter().flat_map(|s| &s.support);
    let moved = supports.filter_map(|s| {
        let (name, size) = (s.name.as_ref()?, s.displacement?.si);
        let [direction] = s.directions.as_slice() else { return None };
        // History files are not in the results.
        let history = s.history.as_ref().filter(|h| h.file.is_none())?;
        let history = TimeFunction::new(history, None).ok().filter(|_| size != 0.0)?;
        let points = table.points(history::TIME, history::SUPPORT_REACTION.of(name).along(direction)?)?;
        let curve =
            points.into_iter().map(|[t, f]| [size.abs() * history.factor(t), f * size.signum()]).collect();
        Some((name.clone(), curve))
    });
    moved.collect()
}

fn equilibrium(runs: &[RunData]) -> Markup {
    let path = |path: &'static str, unit: &'static str| move |r: &RunData| Cell::of(r.number(path), unit);
    let index = |path: &'static str, k: usize, unit: &'static str| {
        move |r: &RunData| Cell::of(r.value(path).get(k).and_then(|v| v.as_f64()), unit)
    };
    facts(
        runs,
        &[
            ("sum of the loads, x", &index("statics.load", 0, "N")),
            ("sum of the loads, y", &index("statics.load", 1, "N")),
            ("sum of the loads, z", &index("statics.load", 2, "N")),
            ("sum of the reactions, x", &index("statics.reaction", 0, "N")),
            ("sum of the reactions, y", &index("statics.reaction", 1, "N")),
            ("sum of the reactions, z", &index("statics.reaction", 2, "N")),
            ("equilibrium error", &path("statics.equilibrium_error", "")),
            ("largest displacement", &index("statics.largest_displacement", 0, "m")),
            ("at node", &index("statics.largest_displacement", 1, "")),
            ("strain energy", &path("statics.strain_energy", "J")),
            ("yielded integration points, fraction at the end", &|r| Cell::of(plastic_share(r), "")),
            ("largest equivalent plastic strain at the end", &|r| {
                Cell::of(plastic(r).map(|k| k.iter().copied().fold(0.0, f64::max)), "")
            }),
            ("Newton steps", &path("newton.steps", "")),
            ("halved steps", &path("newton.halvings", "")),
            ("iterations", &path("newton.iterations", "")),
            ("symmetric factorizations", &path("newton.factorizations_symmetric", "")),
            ("unsymmetric factorizations", &path("newton.factorizations_unsymmetric", "")),
            ("modes of the reduced solid", &path("model.reduction.shapes", "")),
        ],
    )
}

fn plastic(run: &RunData) -> Option<&[f64]> {
    run.table("gauss")?.column(gauss::EQUIVALENT_PLASTIC_STRAIN)
}

fn plastic_share(run: &RunData) -> Option<f64> {
    let all = plastic(run)?;
    Some(all.iter().filter(|k| **k > 0.0).count() as f64 / all.len().max(1) as f64)
}

fn supports(runs: &[RunData]) -> Markup {
    let mut names = Vec::new();
    let mut forces = Vec::new();
    for run in runs {
        for r in run.list("reactions") {
            let name = r["name"].as_str().unwrap_or_default();
            names.push(if runs.len() > 1 { format!("{}: {name}", run.label) } else { name.to_string() });
            forces.push([0, 1, 2].map(|k| r["force"].get(k).and_then(|v| v.as_f64())));
        }
    }
    if names.is_empty() {
        return Markup::default();
    }
    let of = |k: usize| forces.iter().map(|f| f[k]).collect();
    let all = [("x", "N", of(0)), ("y", "N", of(1)), ("z", "N", of(2))];
    headed("Reactions at the end", columns("support", &names, &all))
}

/// Formats the factor of safety.
pub fn safety(runs: &[RunData]) -> Option<Section> {
    let curve = one(runs, |r| {
        let table = r.table("safety")?;
        table.points(safety::FACTOR, safety::LARGEST_DISPLACEMENT)
    });
    let figure = figure(
        "Largest displacement over strength reduction factor",
        Axis::new("strength reduction factor", ""),
        Axis::new("largest displacement", "m").with_zero(),
        curve,
    );
    let path = |path: &'static str| move |r: &RunData| Cell::of(r.number(path), "");
    let sums = facts(
        runs,
        &[
            ("largest stable factor", &path("safety.stable_at")),
            ("smallest unstable factor", &path("safety.unstable_at")),
        ],
    );
    let mut rows = Vec::new();
    for run in runs {
        for t in run.list("safety.trials") {
            let number = |key: &str, unit| Cell::of(t[key].as_f64(), unit);
            let stands =
                Cell::text(if t["stands"].as_bool().unwrap_or(false) { "stable" } else { "unstable" });
            let name = crate::quantity::number(t["factor"].as_f64().unwrap_or(0.0));
            let name = if runs.len() > 1 { format!("{}: {name}", run.label) } else { name };
            let cells = vec![
                stands,
                number("share_of_load", ""),
                number("iterations", ""),
                number("largest_displacement", "m"),
            ];
            rows.push((name, cells));
        }
    }
    let heads = ["factor", "", "fraction of the load applied", "iterations", "largest displacement"];
    Section::new("safety", "Factor of safety", joined([sums, plots([figure]), table(&heads, &rows)]))
}

/// Formats natural modes.
pub fn modes(runs: &[RunData]) -> Option<Section> {
    let mut parts = Vec::new();
    for run in runs {
        let Some(table) = run.table("modes") else { continue };
        let names: Vec<String> =
            table.column(modes::MODE).unwrap_or_default().iter().map(|m| format!("{m}")).collect();
        let of = |column: &'static Definition| -> Vec<Option<f64>> {
            table.column(column).unwrap_or_default().iter().map(|v| Some(*v)).collect()
        };
        let all = [
            ("frequency", "Hz", of(modes::FREQUENCY)),
            ("effective mass x", "kg", of(modes::EFFECTIVE_MASS_X)),
            ("effective mass y", "kg", of(modes::EFFECTIVE_MASS_Y)),
            ("effective mass z", "kg", of(modes::EFFECTIVE_MASS_Z)),
            ("residual", "", of(modes::RESIDUAL)),
        ];
        let columns = columns("mode", &names, &all);
        parts.push(if runs.len() > 1 { headed(&run.label, columns) } else { columns });
    }
    Section::new("modes", "Natural modes", joined(parts))
}
