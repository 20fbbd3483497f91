//! 3-node triangle (tet4, wedge6, pyramid5): flat, so ½ |x(ξ) − c|² is minimised in closed form.

use super::domain::{Domain, Triangle};
use super::form::Form;
use super::kind::FaceKind;
use super::newton::{self, Closest};

pub(super) struct Tri3;

impl FaceKind for Tri3 {
    type Domain = Triangle;

    #[inline]
    fn powers([q0, q1, q2, ..]: [f64; 8]) -> [f64; 8] {
        [q0, q1 - q0, q2 - q0, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    #[inline]
    fn hull(q: [f64; 8], add: impl FnMut(f64)) {
        q[..3].iter().copied().for_each(add);
    }

    #[inline]
    fn closest_point(form: &Form, centre: [f64; 3], _: [f64; 2]) -> Closest {
        // From the middle, where rounding is least.
        let from = [1.0 / 3.0; 2];
        let step = Triangle::step(&newton::Local::at(form, centre, from), from);
        let natural = Triangle::clamp([from[0] + step[0], from[1] + step[1]]);
        newton::result::<Triangle>(&newton::Local::at(form, centre, natural), natural, 1)
    }
}
