//! Element tests: one stress point of a constitutive law under mixed control of stress and strain.
//!
//! The strain increments of stress-controlled components follow from Newton's method with the consistent
//! tangent; a step that fails is halved. Limits: small strain.
//!
//! Tension is positive; order xx, yy, zz, xy, yz, zx, engineering shear.

mod checks;
mod driver;
mod path;

pub use checks::{Checks, OBJECTIVITY_LIMIT, TANGENT_LIMIT, TangentCheck, WORK_LIMIT};
pub use driver::{MOST_PARTS, StepFailure, TOLERANCE};
pub use path::{Control, Sample, Segment};

use crate::material::Material;
use driver::Driver;

/// Result of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Initial state, then one state per step.
    pub samples: Vec<Sample>,
    /// Checks of all steps.
    pub checks: Checks,
}

/// Yield function of the initial state over the size of `stress`; above 0 outside of the yield surface.
pub fn initial_excess(material: &Material, stress: &[f64; 6]) -> f64 {
    let driver = Driver::new(material, stress);
    let size = stress.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    let excess = material.law.yield_function(driver.point());
    if size > 0.0 { excess / size } else { excess }
}

/// Runs a test from `stress` [Pa].
///
/// # Errors
/// A step that does not converge.
pub fn run(material: &Material, stress: &[f64; 6], segments: &[Segment]) -> Result<Curve, StepFailure> {
    let mut driver = Driver::new(material, stress);
    let mut checks = Checks::new(material);
    let mut samples = vec![driver.sample()];
    for segment in segments {
        let start = driver.values_of(&segment.controls);
        for step in 1..=segment.steps {
            let part = step as f64 / segment.steps as f64;
            let aim = std::array::from_fn(|k| start[k] + part * (segment.target[k] - start[k]));
            driver.step(samples.len(), &segment.controls, &aim, &mut checks)?;
            samples.push(driver.sample());
        }
    }
    Ok(Curve { samples, checks })
}

#[cfg(test)]
mod tests;
