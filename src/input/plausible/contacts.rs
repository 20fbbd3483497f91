//! Plausibility of start contacts: springs of small overlaps may throw stiff, light grains.

use super::findings::{Findings, shown};
use crate::model::Job;
use crate::model::grains::thrown;

/// Speed beyond the usual of an implausible overlap.
const FAR: f64 = 10.0;

/// Checks the speeds that start contacts cause.
pub fn weigh(findings: &mut Findings, job: &Job) {
    let Some(found) = job.grains.as_ref().and_then(|g| thrown(g, job.ground().as_ref())) else { return };
    findings.add(
        found.speed > FAR * found.usual,
        format!("grains.{}", found.part),
        found.found,
        format!("at most {}: move them apart, or set `accept_overlap = true`", shown(found.usual, "m/s")),
    );
}
