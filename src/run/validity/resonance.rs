//! Loads near a natural mode of the solid on its supports: stiffness and settlement are then those of the mesh's base.

use super::{Check, Limits};
use crate::model::Job;
use crate::plausible::{AMPLIFICATION, resonance};

/// Deflection of a vertical mode over the static one of the solid, without damping.
const AMPLIFIED: Limits = Limits { warn: AMPLIFICATION, fail: None };

/// Checks the load of a track; none where there is no load of one frequency, or modes cannot be had.
pub fn load_near_mode(job: &Job) -> Option<Check> {
    let found = resonance(job)?;
    Some(Check::new(
        "amplification by the vertical mode nearest to the load",
        found.amplification,
        AMPLIFIED,
        || found.message(),
    ))
}
