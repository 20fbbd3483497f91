//! Damping and reduction of the solid.

use crate::scene::solid::{Rayleigh, ReductionKind, Solid};
use crate::scene::{SceneError, Table};
use trackbed_fem as fem;

/// Natural modes of a reduced solid.
const MODES: usize = 60;

/// Rejected if useless or unused.
pub(super) fn reduction(
    solid: &Table<Solid>,
    linear: bool,
    coupled: bool,
) -> Result<Option<fem::reduction::Reduction>, SceneError> {
    let Some(r) = solid.reduction else { return Ok(None) };
    if !linear {
        return Err(solid.conflict("reduction", "a plastic material"));
    }
    if solid.initial_stress.is_some() {
        return Err(solid.conflict("reduction", "[solid.initial_stress]"));
    }
    if !coupled {
        return Err(solid.no_effect("reduction", "[[grains]]"));
    }
    let modes = r.modes.unwrap_or(MODES);
    match r.kind {
        ReductionKind::Surface => Ok(Some(fem::reduction::Reduction::Surface { modes })),
        ReductionKind::Modes if modes == 0 => Err(solid.error("reduction.modes", "0", "1 or more")),
        ReductionKind::Modes => Ok(Some(fem::reduction::Reduction::Modes { modes })),
    }
}

pub(super) fn rayleigh(rayleigh: Option<Table<Rayleigh>>) -> Result<fem::damping::Rayleigh, SceneError> {
    let Some(r) = rayleigh else { return Ok(fem::damping::Rayleigh { alpha_m: 0.0, beta_k: 0.0 }) };
    let result = match (r.alpha_m, r.beta_k, r.damping_ratio, r.frequencies) {
        (alpha, beta, None, None) => {
            r.check("alpha_m", alpha, |a| a >= 0.0, "0 or more")?;
            r.check("beta_k", beta, |b| b >= 0.0, "0 or more")?;
            fem::damping::Rayleigh {
                alpha_m: alpha.map_or(0.0, |a| a.si),
                beta_k: beta.map_or(0.0, |b| b.si),
            }
        }
        (None, None, Some(ratio), Some([f1, f2])) => {
            r.check("damping_ratio", ratio, |z| (0.0..1.0).contains(&z), "0 or more, below 1")?;
            let good = f1.si > 0.0 && f2.si > f1.si;
            if !good {
                let found = format!("{} and {} Hz", f1.si, f2.si);
                return Err(r.error("frequencies", found, "two rising positive frequencies"));
            }
            fem::damping::Rayleigh::from_frequencies([f1.si, f2.si], [ratio, ratio])
                .map_err(|e| r.here(e.to_string(), "other frequencies"))?
        }
        _ => {
            return Err(
                r.here("a mixture of keys", "either alpha_m and beta_k, or damping_ratio and frequencies")
            );
        }
    };
    r.check("alpha_m", result.alpha_m, |a| a >= 0.0, "0 or more")?;
    r.check("beta_k", result.beta_k, |b| b >= 0.0, "0 or more")?;
    Ok(result)
}
