//! Adhesion: constant attraction F = 2π w R* in contact, w the work of adhesion, R* the effective radius.
//!
//! With Hertz's law it is the DMT model (Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 1975),
//! with the linear law linear cohesion. Potential −F d. Friction, rolling and twisting limits use the
//! pressure F + P (Derjaguin 1934). The first, jumping force is weighted by θ + ½ (`composed.rs`).
//!
//! Limits: no attraction across a gap; Tabor's number below 0.1 (else 3/4 of the pull-off force: Johnson,
//! Kendall & Roberts 1971); energy error up to F v dt/2 at separation; no boxes, bonds, rigid triangulated
//! bodies.
//!
//! Theory manual: eq. (1.15), `docs/theory/contacts.md`.

use crate::law::material::Pair;
use std::f64::consts::TAU;

pub(super) const SOURCE: &str = "adhesion: Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 1975";

/// Adhesive force over effective radius, 2π w [N/m].
pub(super) fn pull(pair: &Pair<'_>) -> f64 {
    pair.given(|e| e.adhesion).map_or(0.0, |work| TAU * work)
}
