//! Maps of slides and rockfall: probability of reach, energy and depth by cell over all runs of a case.

use super::hazard::{CaseMaps, FOLDER, Hazard};
use super::label::file_names;
use super::outcome::Outcome;
use super::plan::Plan;
use super::store::{Found, Store};
use std::collections::BTreeMap;
use std::path::Path;
use trackbed_io::columns::passage;
use trackbed_io::failure::Failure;
use trackbed_io::results::tables;
use trackbed_io::write::asc::write_asc;
use trackbed_io::write::depth_map::{self, DepthMap};

/// Probabilities whose areas are in the table.
const PROBABILITIES: [f64; 3] = [0.01, 0.1, 0.5];

/// Values of a cell by run that passed it.
#[derive(Default)]
struct CellRuns {
    ground: f64,
    /// Energies of runs that passed [J].
    energies: Vec<f64>,
    depth: f64,
}

/// Cells by row and column.
struct Cells {
    side: f64,
    runs: usize,
    cells: BTreeMap<[i64; 2], CellRuns>,
}

impl Cells {
    /// Smallest energy that at least a fraction of all runs does not exceed [J].
    fn quantile(&self, cell: &CellRuns, quantile: f64) -> f64 {
        let rank = ((quantile * self.runs as f64).ceil() as usize).clamp(1, self.runs);
        let mut energies = cell.energies.clone();
        energies.sort_by(|a, b| b.total_cmp(a));
        // Runs without passage have none.
        energies.get(self.runs - rank).copied().unwrap_or(0.0)
    }

    fn fraction(&self, cell: &CellRuns, above: f64) -> f64 {
        cell.energies.iter().filter(|e| **e > above).count() as f64 / self.runs as f64
    }

    fn probability(&self, cell: &CellRuns) -> f64 {
        cell.energies.len() as f64 / self.runs as f64
    }

    /// Lower corner [m], columns, rows.
    fn grid(&self) -> ([i64; 2], [usize; 2]) {
        let (mut low, mut high) = ([i64::MAX; 2], [i64::MIN; 2]);
        for [j, i] in self.cells.keys() {
            for (d, k) in [*i, *j].into_iter().enumerate() {
                (low[d], high[d]) = (low[d].min(k), high[d].max(k));
            }
        }
        (low, [0, 1].map(|d| (high[d] - low[d] + 1) as usize))
    }
}

/// Writes the maps of all cases.
///
/// # Errors
/// Runs without `passage.csv`, with different cells; I/O errors.
pub fn write(
    plan: &Plan,
    store: &Store,
    outcome: &Outcome,
    found: &[Found],
) -> Result<Vec<CaseMaps>, Failure> {
    let Some(hazard) = &plan.hazard else { return Ok(Vec::new()) };
    let dir = store.dir().join(FOLDER);
    // Of earlier cases.
    if dir.is_dir() {
        std::fs::remove_dir_all(&dir).map_err(|e| Failure::Other(format!("{}: {e}", dir.display())))?;
    }
    std::fs::create_dir_all(&dir).map_err(|e| Failure::Other(format!("{}: {e}", dir.display())))?;
    let groups = groups(outcome, hazard.sampled);
    let files = file_names(groups.iter().map(|(case, _)| case.as_str()));
    let mut maps = Vec::new();
    for ((case, rows), files) in groups.iter().zip(files) {
        let mut cells: Option<Cells> = None;
        for (run, found) in plan.runs.iter().zip(found).filter(|(run, _)| rows.contains(&run.setting)) {
            if let Found::Done(_, summary) = found {
                add(&mut cells, &store.results(run), &summary["runout"]["passage_cell"])?;
            }
        }
        if let Some(cells) = cells.filter(|cells| !cells.cells.is_empty()) {
            maps.push(case_maps(hazard, &dir, (case.clone(), files), &cells)?);
        }
    }
    Ok(maps)
}

/// Cases with the numbers of their rows; samples are releases of one case.
fn groups(outcome: &Outcome, sampled: usize) -> Vec<(String, Vec<usize>)> {
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (k, row) in outcome.rows.iter().enumerate() {
        let case = match sampled {
            0 => row.case.clone(),
            _ if row.levels.len() <= sampled => "all samples".to_string(),
            _ => row.levels[sampled..].join(", "),
        };
        match groups.iter_mut().find(|(known, _)| *known == case) {
            Some((_, rows)) => rows.push(k),
            None => groups.push((case, vec![k])),
        }
    }
    groups
}

fn add(cells: &mut Option<Cells>, results: &Path, side: &serde_json::Value) -> Result<(), Failure> {
    let file = results.join(passage::TABLE.file);
    let refused = |found: &str, expected: &str| {
        Failure::Input(format!("{}: found {found}, expected {expected}", file.display()))
    };
    let expected = "the cells that grains pass, by `passage = true` in [runout] of the scene";
    let table = tables::Table::read(&file)?.ok_or_else(|| refused("nothing", expected))?;
    let side =
        side.as_f64().ok_or_else(|| refused("no size of cells in summary.json", "a run with [runout]"))?;
    let cells = cells.get_or_insert_with(|| Cells { side, runs: 0, cells: BTreeMap::new() });
    if cells.side != side {
        return Err(refused(
            &format!("cells of {side} m"),
            &format!("{} m as in other runs of the case", cells.side),
        ));
    }
    cells.runs += 1;
    let names = [passage::X, passage::Y, passage::GROUND, passage::ENTRIES, passage::ENERGY, passage::DEPTH];
    let columns = names.map(|name| table.column(name));
    let [Some(x), Some(y), Some(ground), Some(entries), Some(energy), Some(depth)] = columns else {
        return Err(refused("other columns", "those of a run of this version"));
    };
    for k in 0..table.rows() {
        let at = [y[k], x[k]].map(|x| (x / side).floor() as i64);
        let cell = cells.cells.entry(at).or_default();
        cell.ground = ground[k];
        cell.depth = cell.depth.max(depth[k]);
        if entries[k] > 0.0 || depth[k] > 0.0 {
            cell.energies.push(energy[k]);
        }
    }
    Ok(())
}

fn case_maps(
    hazard: &Hazard,
    dir: &Path,
    (case, files): (String, String),
    cells: &Cells,
) -> Result<CaseMaps, Failure> {
    let (low, [columns, rows]) = cells.grid();
    let corner = low.map(|k| k as f64 * cells.side);
    let field = |value: &dyn Fn(&CellRuns) -> f64| {
        let mut values = vec![None; columns * rows];
        for ([j, i], cell) in &cells.cells {
            values[(j - low[1]) as usize * columns + (i - low[0]) as usize] = Some(value(cell));
        }
        values
    };
    let probability = field(&|cell| cells.probability(cell));
    let energy = field(&|cell| cells.quantile(cell, hazard.quantile));
    let mut grids = vec![
        ("reach".to_string(), probability.clone()),
        ("energy".into(), energy.clone()),
        ("depth".into(), field(&|cell| cell.depth)),
    ];
    for above in &hazard.energies {
        grids.push((format!("above_{}", energy_name(*above)), field(&|cell| cells.fraction(cell, *above))));
    }
    for (name, values) in &grids {
        write_asc(&dir.join(format!("{files}_{name}.asc")), (corner, cells.side), columns, values)?;
    }
    picture(
        &dir.join(format!("{files}.png")),
        (corner, cells.side, [columns, rows]),
        &probability,
        &field(&|cell| cell.ground),
    )?;
    let area = |least: f64| {
        let count = probability.iter().flatten().filter(|p| **p >= least).count();
        [least, count as f64 * cells.side * cells.side]
    };
    let most = |values: &[Option<f64>]| values.iter().flatten().copied().fold(0.0, f64::max);
    Ok(CaseMaps {
        case,
        files,
        runs: cells.runs,
        quantile: hazard.quantile,
        areas: PROBABILITIES.map(area).to_vec(),
        energy: most(&energy),
        largest_energy: cells.cells.values().flat_map(|c| &c.energies).copied().fold(0.0, f64::max),
        largest_depth: most(&grids[2].1),
    })
}

fn energy_name(energy: f64) -> String {
    if energy >= 1e3 { format!("{}kJ", energy / 1e3) } else { format!("{energy}J") }
}

/// Draws the probability of reach on the shaded ground.
fn picture(
    file: &Path,
    (low, side, counts): ([f64; 2], f64, [usize; 2]),
    probability: &[Option<f64>],
    ground: &[Option<f64>],
) -> Result<(), Failure> {
    let lowest = ground.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let ground: Vec<f64> = ground.iter().map(|z| z.unwrap_or(lowest)).collect();
    let depth: Vec<f64> = probability.iter().map(|p| p.unwrap_or(0.0)).collect();
    let inside: Vec<bool> = probability.iter().map(Option::is_some).collect();
    let none = vec![0.0; depth.len()];
    let map = DepthMap {
        low: [low[0], low[1], lowest],
        cell: side,
        counts,
        ground: &ground,
        depth: &depth,
        solid: &none,
        travel: &none,
        inside: &inside,
    };
    Ok(depth_map::write_png(file, &map, 1.0)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(energies: &[f64]) -> CellRuns {
        CellRuns { energies: energies.to_vec(), ..CellRuns::default() }
    }

    /// Twenty runs, four of which pass: 80 % of all runs have no energy there.
    #[test]
    fn quantiles_count_runs_that_do_not_pass() {
        let cells = Cells { side: 1.0, runs: 20, cells: BTreeMap::new() };
        let four = cell(&[3.0, 9.0, 5.0, 7.0]);
        let of = |q: f64| cells.quantile(&four, q);
        assert_eq!([of(0.8), of(0.85), of(0.9), of(0.95), of(0.99)], [0.0, 3.0, 5.0, 7.0, 9.0]);
        assert_eq!((cells.probability(&four), cells.fraction(&four, 5.0)), (0.2, 0.1));
    }
}
