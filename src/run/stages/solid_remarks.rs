//! Warnings about loads missed by solid steps.

use trackbed_input::model::Job;

/// Warns about loads that act only between solid steps or history rows.
pub fn missed(job: &Job) -> Vec<String> {
    let (Some(solid), Some(step)) = (&job.solid, job.solid_step) else { return Vec::new() };
    let loads = solid.loads.iter().enumerate().map(|(i, l)| (format!("solid.load.{i}"), &l.function));
    let moving = solid.supports.moving.iter().take(1).map(|(_, _, f)| ("a moving support".to_string(), f));
    let interval = job.output.history_interval;
    let mut remarks = Vec::new();
    for (name, function) in loads.chain(moving) {
        if let Some(missed) = function.missed(step, job.end) {
            remarks.push(format!(
                "{name}: time.solid_step = {step} s resolves its history with {missed}. The load is not resolved. Reduce time.solid_step."
            ));
        } else if let Some(missed) = function.missed(interval, job.end) {
            remarks.push(format!(
                "{name}: output.history_interval = {interval} s samples its history with {missed}. history.csv does not show it. Reduce output.history_interval."
            ));
        }
    }
    remarks
}
