//! Columns of `cycles.csv`.

use super::solid_probes::CycleStresses;
use crate::system::System;
use trackbed_dem as dem;
use trackbed_input::model::Job;
use trackbed_io::columns::cycles;
use trackbed_io::write::csv::{Column, Row};
use trackbed_track::CyclicLoad;
use trackbed_track::cycles::{BedColumn, Cycle, CycleRecorder};

/// Creates the recorder of load cycles.
pub fn recorder<S: System>(job: &Job, system: &S, load: &CyclicLoad) -> CycleRecorder {
    let part = job.grains.as_ref();
    let between = part.and_then(|g| g.track.after.between).unwrap_or(load.range());
    let column = match (part.and_then(|g| g.track.sleeper.as_ref()), system.grains()) {
        (Some(sleeper), Some(g)) => {
            let there = || (0..g.model.body_count()).filter(|&b| g.state.present(b));
            let spheres = there().flat_map(|b| g.state.spheres(g.model, b)).map(|(x, r)| x.z - r);
            let stones = there().filter_map(|b| dem::measure::lowest(g.model, g.state, b));
            let bottom = spheres.chain(stones).fold(f64::INFINITY, f64::min);
            let area = 4.0 * sleeper.row.half[0] * sleeper.row.half[1];
            let below = -sleeper.row.half[2] - bottom;
            if bottom.is_finite() { BedColumn { area, below } } else { BedColumn::default() }
        }
        _ => BedColumn::default(),
    };
    CycleRecorder::new(load, between, column)
}

fn load_of(job: &Job) -> Option<&CyclicLoad> {
    job.grains.as_ref()?.track.load.as_ref()
}

/// Records a cycle; `broken`: bonds broken in tension, in shear.
pub fn record(job: &Job, c: &Cycle, broken: (u64, u64), row: &mut Row) {
    row.put(cycles::CYCLE, f64::from(c.number));
    row.put(cycles::SETTLEMENT, c.settlement);
    row.put(cycles::RESILIENT_DEFLECTION, c.resilient_deflection);
    row.put(cycles::SECANT_STIFFNESS, c.secant_stiffness);
    row.put(cycles::DISSIPATED_ENERGY, c.dissipated_energy);
    row.put(cycles::PEAK_FORMATION_PRESSURE, c.peak_formation_pressure);
    row.put(cycles::RATE, c.rate);
    row.put(cycles::BED_STIFFNESS, c.bed_stiffness);
    if load_of(job).is_some_and(|l| l.seating.is_some()) {
        row.put(cycles::TOTAL_SETTLEMENT, c.total_settlement);
    }
    if job.solid.is_none() {
        row.put(cycles::RESILIENT_MODULUS, c.resilient_modulus);
    }
    if job.grains.as_ref().is_some_and(|g| g.track.after.jump.is_some()) {
        row.put(cycles::SIMULATED, f64::from(c.simulated));
        row.put(cycles::JUMP_ERROR, c.jump_error);
    }
    if job.grains.as_ref().is_some_and(|g| !g.bonds.is_empty()) {
        row.put(cycles::BROKEN_BY_TENSION, broken.0 as f64);
        row.put(cycles::BROKEN_BY_SHEAR, broken.1 as f64);
    }
}

/// Returns the columns; `stresses`: columns of probes in `history.csv`.
pub fn columns(job: &Job, stresses: &[Column]) -> Vec<Column> {
    Row::columns_of(|row| {
        record(job, &Cycle::default(), (0, 0), row);
        CycleStresses::default().record(stresses, row);
    })
}
