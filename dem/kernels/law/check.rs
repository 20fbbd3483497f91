//! Consistency of materials and pairs with their laws.

use super::damping::Damping;
use super::material::{Material, Pair, PairOverride};
use super::table::{LawInfo, combination};
use crate::base::error::ModelError;

/// Rejects constants that no contact uses.
pub fn laws(materials: &[Material], exceptions: &[PairOverride]) -> Result<(), ModelError> {
    let count = materials.len();
    let law = |i: usize, j: usize| -> Result<Option<&'static LawInfo>, ModelError> {
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
        let of_material = |parameter, value, expected: &str| {
            Err(ModelError::Material { material: i, parameter, value, expected: expected.into() })
        };
        if m.stiffness.is_finite() && !uses {
            return of_material("stiffness", m.stiffness, "not set (infinite): no contact law uses it");
        }
        let first = m.normal.and_then(|_| law(i, i).ok().flatten()).map(|c| c.normal_keys[0]);
        if first == Some("stiffness") && m.stiffness.is_infinite() {
            return of_material("stiffness", m.stiffness, "a finite value, which its normal law needs");
        }
        if first == Some("young") && m.young.is_none() {
            return of_material("young", 0.0, "a modulus, which its normal law needs");
        }
    }
    for (index, e) in exceptions.iter().enumerate() {
        let Some(c) = law(e.a, e.b)? else { continue };
        let of_pair = |parameter, value, expected: &str| {
            Err(ModelError::Pair { index, parameter, value, expected: expected.into() })
        };
        if let Some(stiffness) = e.stiffness.filter(|_| !c.uses("stiffness")) {
            return of_pair("stiffness", stiffness, "not set: its contact law does not use it");
        }
        if e.damping.is_some() && !c.dashpot {
            let ratio = if let Some(Damping::Ratio(ratio)) = e.damping { ratio } else { 0.0 };
            return of_pair("damping", ratio, "not set: its normal law has no dashpot");
        }
    }
    Ok(())
}
