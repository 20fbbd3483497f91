//! Check of small strains and displacements.

use super::{Check, Limits};
use trackbed_fem::model::Model;
use trackbed_fem::small_strain_check::{SmallStrainMeasures, small_strain_measures};

/// Poor, and invalid: neglected terms are half of those kept.
const STRAIN: Limits = Limits { warn: 0.05, fail: Some(1.0) };

/// Relative to the body mean, over element size.
const DISPLACEMENT: Limits = Limits { warn: 1.0, fail: Some(10.0) };

/// Rotation [rad]: cosine differs from 1 by 2 %; rigid-rotation strain is half of it.
const ROTATION: Limits = Limits { warn: 0.2, fail: Some(1.0) };

/// Quasi-static collapse: the limit load is correct while strains grow without bound.
const COLLAPSE: Limits = Limits { warn: 1.0, fail: Some(10.0) };

/// Checks strains, rotations and displacements; shape of `u` `[3·nodes]` [m].
pub fn small_strain(model: &Model, u: &[f64]) -> [Check; 3] {
    let found = small_strain_measures(model, u);
    [strain(&found, STRAIN), rotation(&found, ROTATION), displacement(&found)]
}

/// Checks a plastic solid in equilibrium likewise.
pub fn quasi_static_strain(model: &Model, u: &[f64]) -> [Check; 3] {
    let found = small_strain_measures(model, u);
    [strain(&found, COLLAPSE), rotation(&found, COLLAPSE), displacement(&found)]
}

fn rotation(found: &SmallStrainMeasures, limits: Limits) -> Check {
    Check::new("largest rotation of the solid [rad]", found.rotation, limits, || {
        format!(
            "solid: rotation {1:.1} degrees in element {0}, small rotations are valid to about {2:.0} degrees. Reduce the load, or stiffen the solid.",
            found.rotation_element,
            found.rotation.to_degrees(),
            ROTATION.warn.to_degrees()
        )
    })
}

fn strain(found: &SmallStrainMeasures, limits: Limits) -> Check {
    Check::new("largest strain of the solid", found.strain, limits, || {
        format!(
            "solid: strain {:.3} % in element {}, small strains are valid to about {} %. Reduce the load, or use strength reduction.",
            100.0 * found.strain,
            found.strain_element,
            100.0 * STRAIN.warn
        )
    })
}

fn displacement(found: &SmallStrainMeasures) -> Check {
    let value = if found.size > 0.0 { found.displacement / found.size } else { 0.0 };
    Check::new("largest displacement of the solid over its element's size", value, DISPLACEMENT, || {
        format!(
            "solid: displacement of element {}: {:.4} m, more than its size of {:.4} m. Small displacements are assumed.",
            found.displacement_element, found.displacement, found.size
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    #[test]
    fn classifies_strains() {
        let status = |s: f64, limits| {
            strain(&SmallStrainMeasures { strain: s, ..SmallStrainMeasures::default() }, limits).status
        };
        let all = [Outcome::Passed, Outcome::Warned, Outcome::Failed];
        assert_eq!([0.01, 0.2, 559.3].map(|s| status(s, STRAIN)), all);
        assert_eq!([0.7, 2.0, 559.3].map(|s| status(s, COLLAPSE)), all);
    }

    #[test]
    fn a_solid_at_rest_passes() {
        assert_eq!(displacement(&SmallStrainMeasures::default()).status, Outcome::Passed);
        let far = SmallStrainMeasures { displacement: 132.4, size: 0.5, ..SmallStrainMeasures::default() };
        assert_eq!(displacement(&far).status, Outcome::Failed);
    }
}
