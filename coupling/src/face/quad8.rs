//! 8-node quadrilateral (hex20, wedge15, pyramid13).

use super::domain::Square;
use super::kind::FaceKind;

pub(super) struct Quad8;

impl FaceKind for Quad8 {
    type Domain = Square;

    #[inline]
    fn powers([q0, q1, q2, q3, m4, m5, m6, m7]: [f64; 8]) -> [f64; 8] {
        let quarter = 0.25 * (q0 + q1 + q2 + q3);
        [
            0.5 * (m4 + m5 + m6 + m7) - quarter,
            0.5 * (m5 - m7),
            0.5 * (m6 - m4),
            quarter - 0.5 * (m4 + m6),
            quarter - 0.5 * (m5 + m7),
            0.25 * (q0 - q1 + q2 - q3),
            0.25 * (q2 + q3 - q0 - q1) + 0.5 * (m4 - m6),
            0.25 * (q1 + q2 - q0 - q3) + 0.5 * (m7 - m5),
        ]
    }

    /// Nine Bernstein control points: the field is biquadratic.
    #[inline]
    fn hull(q: [f64; 8], mut add: impl FnMut(f64)) {
        let corner = [q[0], q[1], q[2], q[3]];
        let side = [0, 1, 2, 3].map(|k| 2.0 * q[4 + k] - 0.5 * (corner[k] + corner[(k + 1) % 4]));
        let corners: f64 = corner.iter().sum();
        let centre = 0.5 * (q[4] + q[5] + q[6] + q[7]) - 0.25 * corners;
        let middle = 4.0 * centre - 0.25 * corners - 0.5 * side.iter().sum::<f64>();
        corner.into_iter().chain(side).chain([middle]).for_each(&mut add);
    }
}
