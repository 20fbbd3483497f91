//! Adhesion: constant attraction in contact.
//!
//! With Hertz's law it is the DMT model (Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 1975).
//! Friction, rolling and twisting limits include the adhesive pressure (Derjaguin 1934).
//!
//! Limits: Tabor's number below 0.1 (else Johnson, Kendall & Roberts 1971); energy error up to F v dt/2 at
//! separation; no boxes, bonds, rigid triangulated bodies.
//!
//! Theory manual: eq. (1.15), `docs/theory/contacts.md`.

use crate::law::material::Pair;
use std::f64::consts::TAU;

pub(super) const SOURCE: &str = "adhesion: Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 1975";

/// Adhesive force over effective radius, 2π w [N/m].
pub(super) fn pull(pair: &Pair<'_>) -> f64 {
    pair.given(|e| e.adhesion).map_or(0.0, |work| TAU * work)
}
