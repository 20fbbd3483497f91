//! Adhesion: two partners that touch attract each other with a constant force.
//!
//! F = 2π w R*, with the work of adhesion w (per contact area) and the effective radius R*: the attraction outside the
//! contact circle after Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975), pull-off force included. Beside
//! Hertz's law this is their model; beside the linear law it is the usual linear cohesion. It acts while the overlap is
//! above zero, with the potential −F d. Friction, rolling and twisting are limited by the pressure F + P of the contact
//! itself, not by what is left of it outside (Derjaguin 1934).
//!
//! The force jumps at first touch; the first one counts for the part θ + ½ of the step, as the linear law's dashpot.
//!
//! Cost: the kernels with rolling resistance know adhesion; scenes without either run those that know neither.
//!
//! Limits: no attraction across a gap, hence no energy lost by jumping into contact; small, stiff spheres (Tabor's number
//! below 0.1), for large and soft ones the pull-off force is 3/4 of it (Johnson, Kendall & Roberts 1971). At parting the last
//! force counts for a whole step, which books up to F v dt/2 too much or too little. No boxes, no bonds, no rigid bodies
//! of triangles.
//!
//! Theory manual: equation (1.15) of `docs/theory/contacts.md`.

use crate::law::material::Pair;
use std::f64::consts::TAU;

/// Where it is published.
pub(super) const SOURCE: &str = "adhesion: Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 1975";

/// Adhesive force over the effective radius, 2π w [N/m].
pub(super) fn pull(pair: &Pair<'_>) -> f64 {
    pair.given(|e| e.adhesion).map_or(0.0, |work| TAU * work)
}
