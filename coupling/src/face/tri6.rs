//! 6-node triangle (tet10, wedge15, pyramid13).

use super::domain::Triangle;
use super::kind::FaceKind;

pub(super) struct Tri6;

impl FaceKind for Tri6 {
    type Domain = Triangle;

    /// N = L (2 L − 1) at corners and 4 Lᵢ Lⱼ at mid-sides, L = (1 − ξ − η, ξ, η).
    #[inline]
    fn powers([q0, q1, q2, m3, m4, m5, ..]: [f64; 8]) -> [f64; 8] {
        [
            q0,
            4.0 * m3 - 3.0 * q0 - q1,
            4.0 * m5 - 3.0 * q0 - q2,
            2.0 * (q0 + q1 - 2.0 * m3),
            2.0 * (q0 + q2 - 2.0 * m5),
            4.0 * (q0 - m3 + m4 - m5),
            0.0,
            0.0,
        ]
    }

    /// Bernstein control points.
    #[inline]
    fn hull(q: [f64; 8], mut add: impl FnMut(f64)) {
        for k in 0..3 {
            add(q[k]);
            add(2.0 * q[3 + k] - 0.5 * (q[k] + q[(k + 1) % 3]));
        }
    }
}
