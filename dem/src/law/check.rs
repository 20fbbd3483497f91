//! Checks of what materials and pairs say of their laws.

use super::damping::Damping;
use super::material::{Material, Pair, PairOverride};
use super::table::{Combination, combination};
use crate::base::error::ModelError;

/// Laws for which a constant of a material or a pair is used by no contact have no effect, which is refused.
pub(crate) fn laws(materials: &[Material], exceptions: &[PairOverride]) -> Result<(), ModelError> {
    let count = materials.len();
    let law = |i: usize, j: usize| -> Result<Option<&'static Combination>, ModelError> {
        combination(&Pair::of(materials, exceptions, i, j)).map_err(|problem| ModelError::Law {
            a: i,
            b: j,
            problem: problem.to_string(),
        })
    };
    for (i, m) in materials.iter().enumerate() {
        let mut uses = false;
        for j in 0..count {
            uses |= law(i, j)?.is_some_and(|c| c.uses("stiffness"));
        }
        let of_material = |quantity, value, requirement| {
            Err(ModelError::Material { material: i, quantity, value, requirement })
        };
        if m.stiffness.is_finite() && !uses {
            return of_material(
                "stiffness",
                m.stiffness,
                "be absent (infinite) where no law of contact uses it",
            );
        }
        let first = m.normal.and_then(|_| law(i, i).ok().flatten()).map(|c| c.normal_keys[0]);
        if first == Some("stiffness") && m.stiffness.is_infinite() {
            return of_material("stiffness", m.stiffness, "be finite, as its normal law needs it");
        }
        if first == Some("young") && m.young.is_none() {
            return of_material("Young's modulus", 0.0, "be there, as its normal law needs it");
        }
    }
    for (index, e) in exceptions.iter().enumerate() {
        let Some(c) = law(e.a, e.b)? else { continue };
        let of_pair =
            |quantity, value, requirement| Err(ModelError::Override { index, quantity, value, requirement });
        if let Some(stiffness) = e.stiffness.filter(|_| !c.uses("stiffness")) {
            return of_pair("stiffness", stiffness, "be absent where the law of contact does not use it");
        }
        match e.damping {
            Some(Damping::Ratio(zeta)) if !(zeta >= 0.0 && zeta.is_finite()) => {
                return of_pair("damping ratio", zeta, "be zero or positive, and finite");
            }
            Some(_) if !c.dashpot => {
                return of_pair("damping", f64::NAN, "be absent where the normal law has no dashpot");
            }
            _ => {}
        }
    }
    Ok(())
}
