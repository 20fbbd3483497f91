//! What a kind of face says of itself.

use super::domain::Domain;
use super::form::Form;
use super::newton::{self, Closest};

/// A kind of face.
pub(super) trait FaceKind {
    /// Where the natural coordinates run.
    type Domain: Domain;

    /// The coefficients of [`Form`] of one component, from its nodal values.
    fn powers(q: [f64; 8]) -> [f64; 8];

    /// Calls `add` with numbers between whose least and largest one component lies everywhere on the face.
    fn hull(q: [f64; 8], add: impl FnMut(f64));

    /// Closest point of the face to `centre`, starting from the natural coordinates `start`.
    #[inline]
    fn closest_point(form: &Form, centre: [f64; 3], start: [f64; 2]) -> Closest {
        newton::closest_point::<Self::Domain>(form, centre, start)
    }
}
