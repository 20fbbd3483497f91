//! Hazard of slides and rockfall over all runs of a case, written to maps by [`super::maps`].
//!
//! Default energies: weak, medium and strong rockfall of the Swiss guideline (Raetzo et al., Bull. Eng. Geol. Env. 61, 2002).

use super::file::HazardTable;
use super::layout::{Cell, Table};
use serde::{Deserialize, Serialize};
use trackbed_input::scene::{Document, SceneError};

/// Directory of the maps in the study.
pub const FOLDER: &str = "maps";
/// Quantile of the energy map.
const QUANTILE: f64 = 0.95;
/// Energies of medium and strong rockfall [J].
const ENERGIES: [f64; 2] = [30e3, 300e3];

/// What is mapped.
#[derive(Clone, Debug, PartialEq)]
pub struct Hazard {
    /// Quantile of the energy over all runs.
    pub quantile: f64,
    /// Energies whose exceedance is mapped [J].
    pub energies: Vec<f64>,
    /// Number of sampled parameters, whose samples share a map.
    pub sampled: usize,
}

/// Maps of a case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CaseMaps {
    /// Label.
    pub case: String,
    /// First part of the file names.
    pub files: String,
    /// Number of runs.
    pub runs: usize,
    /// Quantile of the energy map.
    pub quantile: f64,
    /// Area reached with at least a probability [m²].
    pub areas: Vec<[f64; 2]>,
    /// Largest value of the energy map [J].
    pub energy: f64,
    /// Largest energy of all runs [J].
    pub largest_energy: f64,
    /// Largest depth of all runs [m].
    pub largest_depth: f64,
}

/// Checks the table.
///
/// # Errors
/// Values out of range.
pub fn resolve(
    document: &Document,
    table: Option<&HazardTable>,
    sampled: usize,
) -> Result<Option<Hazard>, SceneError> {
    let Some(table) = table else { return Ok(None) };
    let quantile = table.quantile.unwrap_or(QUANTILE);
    if !(0.5..1.0).contains(&quantile) {
        return Err(document.error("hazard.quantile", quantile.to_string(), "at least 0.5, below 1"));
    }
    let energies = table.energies.clone().unwrap_or_else(|| ENERGIES.to_vec());
    let ascending = energies.windows(2).all(|pair| pair[0] < pair[1]);
    if !ascending || energies.iter().any(|e| !(*e > 0.0 && e.is_finite())) {
        let expected = "energies above 0 J, ascending";
        return Err(document.error("hazard.energies", format!("{energies:?}"), expected));
    }
    Ok(Some(Hazard { quantile, energies, sampled }))
}

/// Returns the table of all cases.
pub fn table(maps: &[CaseMaps]) -> Table {
    let mut heads = vec!["case".to_string(), "runs".into()];
    let Some(first) = maps.first() else { return Table::default() };
    heads.extend(first.areas.iter().map(|[p, _]| format!("area, probability ≥ {p} [m²]")));
    heads.push(format!("{} % energy [kJ]", (1e6 * first.quantile).round() / 1e4));
    heads.extend(["largest energy [kJ]", "largest depth [m]"].map(String::from));
    let row = |maps: &CaseMaps| {
        let mut row = vec![Cell::text(&maps.case), Cell::text(maps.runs.to_string())];
        row.extend(maps.areas.iter().map(|[_, area]| Cell::number(Some(*area))));
        row.extend(
            [maps.energy / 1e3, maps.largest_energy / 1e3, maps.largest_depth].map(|v| Cell::number(Some(v))),
        );
        row
    };
    Table { heads, rows: maps.iter().map(row).collect() }
}

/// Returns what the number of runs allows to say.
pub fn note(maps: &[CaseMaps]) -> String {
    let runs = maps.iter().map(|m| m.runs).min().unwrap_or(1).max(1);
    let (n, none) = (runs as f64, 1.0 - libm::pow(0.05, 1.0 / runs as f64));
    format!(
        "Standard error of a probability p: √(p (1 − p)/{runs}), at most {:.2}. A cell that no run reached has a probability below {:.3} (95 % confidence)",
        (0.25 / n).sqrt(),
        none
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn note_is_the_rule_of_three() {
        let maps = [CaseMaps { runs: 100, ..CaseMaps::default() }];
        assert!(
            note(&maps).contains("at most 0.05") && note(&maps).contains("below 0.030"),
            "{}",
            note(&maps)
        );
    }
}
