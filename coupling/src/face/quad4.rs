//! 4-node quadrilateral (hex8, wedge6, pyramid5), bilinear.

use super::domain::Square;
use super::kind::FaceKind;

pub(super) struct Quad4;

impl FaceKind for Quad4 {
    type Domain = Square;

    #[inline]
    fn powers([q0, q1, q2, q3, ..]: [f64; 8]) -> [f64; 8] {
        let part = |sum: f64| 0.25 * sum;
        let linear = [part(q1 + q2 - q0 - q3), part(q2 + q3 - q0 - q1)];
        [part(q0 + q1 + q2 + q3), linear[0], linear[1], 0.0, 0.0, part(q0 - q1 + q2 - q3), 0.0, 0.0]
    }

    /// Corners, since 0 ≤ Nᵢ ≤ 1.
    #[inline]
    fn hull(q: [f64; 8], add: impl FnMut(f64)) {
        q[..4].iter().copied().for_each(add);
    }
}
