//! Stress and strain of a specimen between platens.
//!
//! Stress is the mean platen force over the section; in the Brazilian test 2 F/(π D t) at the disc centre
//! (Carneiro 1943; ISRM 1978). Grain strains are least-squares slopes of displacement over initial
//! position, so platen gaps do not affect Poisson's ratio.
//!
//! Theory manual: equation (6.40) of `docs/theory/track.md`.

mod record;

pub use record::{SpecimenRecord, record};

use super::recorder::{Now, Recorder};
use super::runout;
use super::system::{GrainsView, System};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;
use trackbed_input::model::grains::{Platen, SpecimenPlan};
use trackbed_io::columns::history;
use trackbed_io::write::csv::Row;

/// Specimen state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Time [s].
    pub time: f64,
    /// Platen approach over distance.
    pub strain: f64,
    /// Stress [Pa].
    pub stress: f64,
    /// Axial grain strain, compression positive.
    pub axial: f64,
    /// Mean lateral strain, bulging positive.
    pub lateral: f64,
    /// Mean confining pressure [Pa].
    pub confinement: f64,
}

/// Measures the specimen.
pub fn point(plan: &SpecimenPlan, view: GrainsView<'_>, time: f64) -> Point {
    let GrainsView { model, state } = view;
    let from = runout::origins(model);
    let platen = |platen: Platen| match platen {
        Platen::Wall(k) => (state.wall_offset(k)[plan.axis], state.wall_force(k).0[plan.axis]),
        Platen::Group(part) => {
            let bodies = || (0..model.body_count()).filter(|&b| model.part(b) == part);
            let count = bodies().count().max(1) as f64;
            let way: f64 = bodies().map(|b| (state.position(b) - from[b])[plan.axis]).sum();
            (way / count, dem::measure::force_on(model, state, |b| model.part(b) == part)[plan.axis])
        }
    };
    let [(low, pushed_down), (high, pushed_up)] = plan.platens.map(platen);
    let bodies: Vec<usize> = (0..model.body_count())
        .filter(|&b| state.present(b) && plan.parts.binary_search(&model.part(b)).is_ok())
        .collect();
    let slope = |d: usize| {
        let count = bodies.len().max(1) as f64;
        let mean = bodies.iter().map(|&b| from[b][d]).sum::<f64>() / count;
        let (mut sum, mut square) = (0.0, 0.0);
        for &b in &bodies {
            let x = from[b][d] - mean;
            sum += x * (state.position(b)[d] - from[b][d]);
            square += x * x;
        }
        if square > 0.0 { sum / square } else { 0.0 }
    };
    let strains = [slope(0), slope(1), slope(2)];
    let across = strains.iter().sum::<f64>() - strains[plan.axis];
    let (sides, area) = &plan.sides;
    let pressure: f64 = sides.iter().map(|k| state.wall_force(*k).0.norm()).sum();
    Point {
        time,
        strain: (low - high) / plan.length,
        stress: 0.5 * (pushed_up - pushed_down) / plan.area,
        axial: -strains[plan.axis],
        lateral: 0.5 * across,
        confinement: pressure / (area * sides.len().max(1) as f64),
    }
}

/// Stress and strains in the history.
pub struct Specimens;

impl<S: System> Recorder<S> for Specimens {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let Some(plan) = now.job.grains.as_ref().and_then(|g| g.specimen.as_ref()) else { return };
        let Some(view) = now.system.grains() else { return };
        let p = point(plan, view, now.time);
        row.put(history::SPECIMEN_STRAIN, p.strain);
        row.put(history::SPECIMEN_STRESS, p.stress);
        row.put(history::SPECIMEN_AXIAL_STRAIN, p.axial);
        row.put(history::SPECIMEN_LATERAL_STRAIN, p.lateral);
        row.put(history::SPECIMEN_CONFINEMENT, p.confinement);
    }
}
