//! Plausibility of scene values, such as unit errors (80 Pa for 80 MPa, millimetres for metres).
//!
//! Beyond the typical range by a factor of 30 is *implausible*, otherwise *unusual*.

mod bed;
mod borders;
mod contacts;
mod findings;
mod geometry;
mod grains;
mod inertia;
mod materials;
mod resonance;
mod run;
mod solid;
mod track;

use crate::model::Job;
use crate::scene::{Document, Scene};
pub use findings::Finding;
use findings::Findings;
pub use resonance::{AMPLIFICATION, Resonance, near_mode, resonance};
use trackbed_io::failure::Failure;

/// Returns all findings, implausible first.
pub fn weigh(scene: &Scene, job: &Job) -> Vec<Finding> {
    let mut findings = Findings::default();
    materials::weigh(&mut findings, scene);
    solid::weigh(&mut findings, scene, job);
    grains::weigh(&mut findings, scene);
    bed::weigh(&mut findings, scene, job);
    geometry::weigh(&mut findings, scene, job);
    borders::weigh(&mut findings, scene, job);
    contacts::weigh(&mut findings, job);
    track::weigh(&mut findings, scene, job);
    run::weigh(&mut findings, scene, job);
    inertia::weigh(&mut findings, scene, job);
    let mut all = findings.0;
    all.sort_by_key(|finding| !finding.serious);
    all
}

/// Rejects a scene by its worst finding.
///
/// # Errors
/// Input errors.
pub fn refuse(document: &Document, findings: &[Finding]) -> Result<(), Failure> {
    let Some(worst) = findings.first() else { return Ok(()) };
    let others = match findings.len() - 1 {
        0 => String::new(),
        1 => "; 1 more".into(),
        n => format!("; {n} more"),
    };
    Err(document.error(&worst.key, &worst.found, format!("{} (--strict){others}", worst.usual)).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use findings::Usual;

    #[test]
    fn classifies_distance_from_range() {
        let mut findings = Findings::default();
        let young = Usual::new(1e5, 1e12, "Pa");
        for value in [1e5, 3e10, 9e4, 80.0, 4e13] {
            findings.weigh("young", value, young);
        }
        findings.weigh("friction", 0.0, Usual::or_zero(0.01, 1.5, ""));
        let serious: Vec<bool> = findings.0.iter().map(|f| f.serious).collect();
        assert_eq!(serious, [false, true, true]);
        assert_eq!(
            findings.0[1].to_string(),
            "young: found 80 Pa, expected 1.000e5 to 1.000e12 Pa (implausible)"
        );
    }
}
