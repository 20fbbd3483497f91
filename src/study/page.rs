//! HTML report of a study directory, from `study.json`.

use super::analysis::Analysis;
use super::extreme::{self, ExtremeRow};
use super::figure;
use super::hazard;
use super::layout::{Cell, Table};
use super::summary;
use maud::{Markup, html};
use serde_json::Value;
use std::path::{Path, PathBuf};
use trackbed_io::failure::Failure;
use trackbed_io::read::source;
use trackbed_report::page::{
    Cell as PageCell, Section, facts_table, headed, joined, paragraph, picture, plots, table,
};
use trackbed_report::{self as report, Options};

/// Cases of smallest misfit on the page.
const BEST: usize = 10;

/// Whether `dir` is the directory of a study.
pub fn is_study(dir: &Path) -> bool {
    dir.join("runs").is_dir() && !dir.join("run.json").exists() && !dir.join("summary.json").exists()
}

/// Writes the report of a study and returns its path.
///
/// # Errors
/// Input and I/O errors.
pub fn write(options: &Options) -> Result<PathBuf, Failure> {
    let dir = &options.folders[0];
    if let Some(load) = options.axle_load {
        return Err(Failure::Input(format!(
            "--axle-load: found {load} with a study, expected a directory of a run"
        )));
    }
    let out = report::output_file(options)?;
    let (study, analysis) = read(&dir.join("study.json"))?;
    let title =
        options.title.clone().or_else(|| study["title"].as_str().map(String::from)).unwrap_or_default();
    let sections = [
        overview(&study, &analysis),
        failed(&analysis),
        hazard_maps(dir, &analysis),
        targets(&analysis),
        posterior(&analysis),
        sensitivity(&analysis),
        extremes(&study),
        responses(&analysis),
        cases(&analysis),
        errors(&study),
    ];
    report::save(
        &out,
        &title,
        &report::results_in(dir),
        &sections.into_iter().flatten().collect::<Vec<_>>(),
    )?;
    Ok(out)
}

fn read(file: &Path) -> Result<(Value, Analysis), Failure> {
    let refused = |found: String| {
        let remedy = "`trackbed study STUDY --merge --out DIR` writes them";
        Failure::Input(format!("{}: found {found}, expected the tables of a study. {remedy}", file.display()))
    };
    if !file.exists() {
        return Err(refused("nothing".into()));
    }
    let bytes = source::bytes(file, source::LARGEST).map_err(|r| Failure::Input(r.sentence(file)))?;
    let study: Value = serde_json::from_slice(&bytes).map_err(|e| refused(e.to_string()))?;
    let analysis: Analysis = serde_json::from_value(study["analysis"].clone())
        .map_err(|e| refused(format!("an analysis of another format ({e})")))?;
    let (q, p) = (analysis.results.len(), analysis.factors.len());
    let fits = analysis.sensitivities.len() == q
        && analysis.sensitivities.iter().all(|s| {
            let coefficients = s.regression.as_ref().map(|r| [r.coefficients.len(), r.standard_errors.len()]);
            s.responses.len() == p
                && s.rank_correlations.len() == p
                && coefficients.is_none_or(|c| c == [p, p])
        })
        && analysis.points.iter().all(|point| point.results.len() == q && point.values.len() == p)
        && analysis.targets.iter().all(|t| t.quantity < q)
        && analysis.best.iter().all(|k| *k < analysis.points.len());
    if fits { Ok((study, analysis)) } else { Err(refused("lists of different lengths".into())) }
}

fn cell(cell: &Cell) -> PageCell {
    match cell {
        Cell::Nothing => PageCell::Nothing,
        Cell::Number(value, None) => PageCell::Value(*value, ""),
        other => PageCell::Text(other.shown()),
    }
}

fn html_of(Table { heads, rows }: &Table) -> Markup {
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let rows: Vec<(String, Vec<PageCell>)> = rows
        .iter()
        .map(|row| (row.first().map(Cell::shown).unwrap_or_default(), row.iter().skip(1).map(cell).collect()))
        .collect();
    table(&heads, &rows)
}

fn overview(study: &Value, analysis: &Analysis) -> Option<Section> {
    let sum = |of: fn(&super::point::Point) -> usize| analysis.points.iter().map(of).sum::<usize>();
    let mut rows = vec![
        (
            "scene",
            study["scene"].as_str().map(|s| report::page::shown_path(Path::new(s)).display().to_string()),
        ),
        ("cases", Some(analysis.points.len().to_string())),
        ("completed runs", Some(format!("{} of {}", sum(|p| p.done), sum(|p| p.runs)))),
        ("parameters", joined_names(analysis.factors.iter().map(|f| f.head()))),
        ("quantities", joined_names(analysis.results.iter().map(|r| r.head()))),
    ];
    rows.extend(["reference", "recommended"].map(|key| (key, study[key].as_str().map(String::from))));
    let rows: Vec<(String, Vec<PageCell>)> = rows
        .into_iter()
        .filter_map(|(name, value)| Some((name.to_string(), vec![PageCell::Text(value?)])))
        .collect();
    Section::new("overview", "Overview", facts_table(&["study", "value"], &rows))
}

fn joined_names(names: impl Iterator<Item = String>) -> Option<String> {
    Some(names.collect::<Vec<_>>().join(", ")).filter(|names| !names.is_empty())
}

fn failed(analysis: &Analysis) -> Option<Section> {
    let html = html! {
        @if !analysis.failed.is_empty() {
            div class="run failed" { "\n" ul { "\n" @for reason in &analysis.failed { li { (reason) } "\n" } } "\n" } "\n"
        }
    };
    Section::new("failed", "Runs without results", html)
}

fn hazard_maps(dir: &Path, analysis: &Analysis) -> Option<Section> {
    if analysis.hazard.is_empty() {
        return None;
    }
    let maps = analysis.hazard.iter().filter_map(|maps| {
        let bytes = std::fs::read(dir.join(hazard::FOLDER).join(format!("{}.png", maps.files))).ok()?;
        Some(picture("png", &bytes, &format!("{}: probability of reach, dark red 1", maps.case)))
    });
    let note = paragraph(&format!("{}.", hazard::note(&analysis.hazard)));
    Section::new("hazard", "Hazard", joined([plots(maps), html_of(&hazard::table(&analysis.hazard)), note]))
}

fn targets(analysis: &Analysis) -> Option<Section> {
    if analysis.targets.is_empty() {
        return None;
    }
    let best = headed("Cases of smallest misfit", html_of(&summary::best(analysis, BEST)));
    let note = paragraph(
        "Misfit: root mean square of the deviations in tolerances. ±: standard error over the seeds.",
    );
    Section::new("targets", "Targets", joined([html_of(&summary::targets(analysis)), best, note]))
}

fn posterior(analysis: &Analysis) -> Option<Section> {
    let posterior = analysis.posterior.as_ref()?;
    let notes = posterior.notes().into_iter().map(|note| paragraph(&format!("{note}.")));
    let tables =
        [html_of(&posterior.parameter_table()), html_of(&posterior.prediction_table()), joined(notes)];
    Section::new("posterior", "Posterior", joined(tables))
}

fn sensitivity(analysis: &Analysis) -> Option<Section> {
    let figures = (0..analysis.results.len()).filter_map(|q| Some(figure::tornado(analysis, q)?.html));
    let notes = summary::notes(analysis).into_iter().map(|note| paragraph(&format!("{note}.")));
    let table = html_of(&summary::sensitivities(analysis));
    Section::new("sensitivity", "Sensitivity", joined([plots(figures), table, joined(notes)]))
}

fn extremes(study: &Value) -> Option<Section> {
    let rows: Vec<ExtremeRow> = serde_json::from_value(study["extremes"].clone()).ok()?;
    let rows = Some(rows).filter(|rows| !rows.is_empty())?;
    let note = paragraph("Gumbel law of the values of the runs; interval of the fit.");
    Section::new("extremes", "Return periods", joined([html_of(&extreme::table(&rows)), note]))
}

fn responses(analysis: &Analysis) -> Option<Section> {
    let pairs = (0..analysis.results.len()).flat_map(|q| (0..analysis.factors.len()).map(move |j| (q, j)));
    let figures = pairs.filter_map(|(q, j)| Some(figure::response(analysis, q, j)?.html));
    Section::new("responses", "Responses", plots(figures))
}

fn cases(analysis: &Analysis) -> Option<Section> {
    let all: Vec<usize> = (0..analysis.points.len()).collect();
    Section::new("cases", "Cases", html_of(&summary::points(analysis, &all)))
}

/// Errors against the reference, and costs.
fn errors(study: &Value) -> Option<Section> {
    study["reference"].as_str()?;
    let quantities = study["quantities"].as_array()?;
    let mut heads = vec!["case".to_string()];
    heads.extend(quantities.iter().map(|q| format!("{} error", q["name"].as_str().unwrap_or_default())));
    heads.extend(["CPU time", "speed-up", "within tolerances"].map(String::from));
    let row = |case: &Value| {
        let errors = case["quantities"].as_array().into_iter().flatten();
        let mut cells: Vec<PageCell> = errors.map(|q| PageCell::of(q["error"].as_f64(), "")).collect();
        cells.push(PageCell::of(case["cost"]["cpu_seconds"].as_f64(), "s"));
        cells.push(PageCell::of(case["speed_up"].as_f64(), ""));
        cells.push(PageCell::text(if case["within"] == true { "yes" } else { "no" }));
        (case["case"].as_str().unwrap_or_default().to_string(), cells)
    };
    let rows: Vec<(String, Vec<PageCell>)> = study["cases"].as_array()?.iter().map(row).collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    Section::new("errors", "Errors and costs", table(&heads, &rows))
}
