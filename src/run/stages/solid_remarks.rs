//! Remarks on a solid that leaves what its equations assume.

use crate::model::Job;
use trackbed_fem::limits::extent;
use trackbed_fem::model::Model;

/// Strain above which small strains are a poor assumption.
const STRAIN: f64 = 0.05;

/// Remarks on strains and displacements that are not small. Shape of `u` `[3·nodes]`.
pub fn large(model: &Model, u: &[f64]) -> Vec<String> {
    let found = extent(model, u);
    let mut remarks = Vec::new();
    if found.strain > STRAIN {
        remarks.push(format!(
            "the solid is strained by {:.3} % in element {}: its equations are those of small strains, good to some {} %",
            100.0 * found.strain,
            found.strained,
            100.0 * STRAIN
        ));
    }
    if found.displacement > found.size {
        remarks.push(format!(
            "element {} of the solid is displaced by {:.4} m, more than its own size of {:.4} m: its equations are those of \
             small displacements",
            found.moved, found.displacement, found.size
        ));
    }
    remarks
}

/// Remarks on loads and moving supports that pass between the steps of the solid, or between the rows of the history.
pub fn missed(job: &Job) -> Vec<String> {
    let (Some(solid), Some(step)) = (&job.solid, job.solid_step) else { return Vec::new() };
    let loads = solid.loads.iter().enumerate().map(|(i, l)| (format!("solid.load.{i}"), &l.function));
    let moving = solid.supports.moving.iter().take(1).map(|(_, _, f)| ("a moving support".to_string(), f));
    let interval = job.output.history_interval;
    let mut remarks = Vec::new();
    for (name, function) in loads.chain(moving) {
        if let Some(missed) = function.missed(step, job.end) {
            remarks.push(format!(
                "{name}: time.solid_step = {step} s gives its history steps {missed}: the result lacks that load"
            ));
        } else if let Some(missed) = function.missed(interval, job.end) {
            remarks.push(format!(
                "{name}: output.history_interval = {interval} s gives its history rows {missed}: history.csv does not show it"
            ));
        }
    }
    remarks
}
