//! Properties of a face kind.

use super::domain::Domain;
use super::form::Form;
use super::newton::{self, Closest};

/// Face kind.
pub(super) trait FaceKind {
    /// Natural domain.
    type Domain: Domain;

    /// Coefficients of [`Form`] of one component.
    fn powers(q: [f64; 8]) -> [f64; 8];

    /// Calls `add` with values that bound one component on the whole face.
    fn hull(q: [f64; 8], add: impl FnMut(f64));

    #[inline]
    fn closest_point(form: &Form, centre: [f64; 3], start: [f64; 2]) -> Closest {
        newton::closest_point::<Self::Domain>(form, centre, start)
    }
}
