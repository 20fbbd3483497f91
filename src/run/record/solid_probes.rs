//! Probes of the solid: columns of `history.csv`, peaks and means of their stresses in `cycles.csv`.

use crate::system::SolidView;
use serde::{Deserialize, Serialize};
use trackbed_input::model::{Job, Observed, PointProbe};
use trackbed_input::scene::ProbeField;
use trackbed_io::columns::{cycles, history};
use trackbed_io::write::csv::{Column, Row};

/// Position of zz in a tensor.
const VERTICAL: usize = 2;

/// Fields of a probe, in this order whatever the order in the scene.
pub fn record(name: &str, observed: &Observed, view: SolidView<'_>, row: &mut Row) {
    let SolidView { model, state } = view;
    if let Observed::Point(point) = observed {
        for (field, column, values) in [
            (ProbeField::Displacement, history::PROBE_U, &state.u),
            (ProbeField::Velocity, history::PROBE_V, &state.v),
            (ProbeField::Acceleration, history::PROBE_A, &state.a),
        ] {
            if point.has(field) {
                let names = point.names(name);
                let values = point.samples.vector(values);
                names.iter().zip(values).for_each(|(name, value)| row.vector(column.of(name), value));
            }
        }
    }
    stresses(name, observed, view, row);
    if let Some(point) = point_with(observed, ProbeField::Strain) {
        let strains = point.names(name).into_iter().zip(point.samples.strain(model, state));
        strains.for_each(|(name, strain)| row.tensor(history::PROBE_STRAIN.of(&name), strain));
    }
}

fn point_with(observed: &Observed, field: ProbeField) -> Option<&PointProbe> {
    match observed {
        Observed::Point(point) if point.has(field) => Some(point),
        _ => None,
    }
}

fn stresses(name: &str, observed: &Observed, SolidView { model, state }: SolidView<'_>, row: &mut Row) {
    let vertical = |s: &[f64; 6]| s[VERTICAL];
    match observed {
        Observed::Point(point) if point.has(ProbeField::Stress) => {
            let stresses = point.names(name).into_iter().zip(point.samples.stress(model, state));
            stresses.for_each(|(name, stress)| row.tensor(history::PROBE_STRESS.of(&name), stress));
        }
        Observed::Plane(samples) => {
            let points: Vec<_> = samples.stress(model, state).into_iter().map(|s| (s, 1.0)).collect();
            let [mean, largest] = mean_and_largest(&points, vertical);
            row.put(history::PROBE_VERTICAL_STRESS.of(name), mean);
            row.put(history::PROBE_VERTICAL_STRESS_LARGEST.of(name), largest);
        }
        Observed::Volume(points) => {
            let points = points.stress(model, state);
            let [mean, largest] = mean_and_largest(&points, vertical);
            row.put(history::PROBE_VERTICAL_STRESS.of(name), mean);
            row.put(history::PROBE_VERTICAL_STRESS_LARGEST.of(name), largest);
            let [mean, largest] = mean_and_largest(&points, |s| (s[0] + s[1] + s[2]) / 3.0);
            row.put(history::PROBE_MEAN_STRESS.of(name), mean);
            row.put(history::PROBE_MEAN_STRESS_LARGEST.of(name), largest);
        }
        _ => {}
    }
}

/// Weighted mean, and value of largest magnitude.
fn mean_and_largest(points: &[([f64; 6], f64)], of: impl Fn(&[f64; 6]) -> f64) -> [f64; 2] {
    let (mut sum, mut weights, mut largest) = (0.0, 0.0, 0.0);
    for (stress, weight) in points {
        let value = of(stress);
        sum += weight * value;
        weights += weight;
        largest = larger(largest, value);
    }
    [sum / weights, largest]
}

fn larger(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}

fn all_stresses(job: &Job, view: SolidView<'_>, row: &mut Row) {
    job.probes.iter().for_each(|(name, observed)| stresses(name, observed, view, row));
}

/// Stresses of all probes over the windows of a load cycle.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct CycleStresses {
    windows: u64,
    sums: Vec<f64>,
    peaks: Vec<f64>,
}

impl CycleStresses {
    /// Adds the state after a window.
    pub fn add(&mut self, job: &Job, view: SolidView<'_>) {
        let values = Row::values_of(|row| all_stresses(job, view, row));
        self.sums.resize(values.len(), 0.0);
        self.peaks.resize(values.len(), 0.0);
        for (k, value) in values.into_iter().enumerate() {
            self.sums[k] += value;
            self.peaks[k] = larger(self.peaks[k], value);
        }
        self.windows += 1;
    }

    /// Records the cycle; `columns` are the stresses in `history.csv`.
    pub fn record(&self, columns: &[Column], row: &mut Row) {
        let value = |of: &[f64], k: usize| of.get(k).copied().unwrap_or(0.0);
        for (k, column) in columns.iter().enumerate() {
            row.put(cycles::STRESS_PEAK.of(&column.name), value(&self.peaks, k));
            row.put(cycles::STRESS_MEAN.of(&column.name), value(&self.sums, k) / self.windows.max(1) as f64);
        }
    }
}

/// Returns the stress columns of probes in `history.csv`.
pub fn stress_columns(job: &Job, view: Option<SolidView<'_>>) -> Vec<Column> {
    view.map_or_else(Vec::new, |view| Row::columns_of(|row| all_stresses(job, view, row)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn largest_keeps_its_sign() {
        let points = [([0.0, 0.0, -4.0, 0.0, 0.0, 0.0], 1.0), ([0.0, 0.0, 2.0, 0.0, 0.0, 0.0], 2.0)];
        assert_eq!(mean_and_largest(&points, |s| s[2]), [0.0, -4.0]);
    }

    #[test]
    fn cycle_has_peak_and_mean() {
        let cycle = CycleStresses { windows: 4, sums: vec![-6.0], peaks: vec![-3.0] };
        let columns = [Column::new("crest_stress_zz", "Pa")];
        assert_eq!(Row::values_of(|row| cycle.record(&columns, row)), [-3.0, -1.5]);
        let heads = Row::columns_of(|row| cycle.record(&columns, row));
        assert_eq!(heads, ["peak", "mean"].map(|k| Column::new(format!("crest_stress_zz_{k}"), "Pa")));
    }
}
