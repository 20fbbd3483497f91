//! Integration rules of the hexahedron and of its face.
//!
//! Source of the Gauss rules: Zienkiewicz and Taylor, The Finite Element Method, vol. 1 (2000), table 9.1. A rule of n
//! points per axis is exact for polynomials of degree 2n - 1 per axis. The 14-point rule: Irons, Int. J. Numer. Methods
//! Eng. 3 (1971) 293-294, table I; exact for polynomials of total degree 5.
//!
//! Limits for the 20-node hexahedron: the 27-point rule has full rank and passes the patch test on curved elements.
//! The 8-point rule ("reduced", softer and usually nearer to the exact solution) leaves modes without stiffness in a
//! single element, and in a straight row of elements that is one element wide and one deep, even when its end is
//! clamped; from two elements in one direction on, a clamped side removes them. A static solve names the node where such
//! a mode is left. The 14-point rule has full rank at half the cost of 27 points, and misses the curved patch test
//! by some 1e-3.

use serde::{Deserialize, Serialize};

const A: f64 = 0.577_350_269_189_625_764_5; // 1/sqrt(3)
const B: f64 = 0.774_596_669_241_483_377_0; // sqrt(3/5)

/// Abscissae and weights of the two-point rule on [-1, 1].
pub const LINE2: [(f64, f64); 2] = [(-A, 1.0), (A, 1.0)];
/// Abscissae and weights of the three-point rule on [-1, 1].
pub const LINE3: [(f64, f64); 3] = [(-B, 5.0 / 9.0), (0.0, 8.0 / 9.0), (B, 5.0 / 9.0)];

/// A point of a rule in a hexahedron: natural coordinates and weight.
pub type VolumePoint = ([f64; 3], f64);
/// A point of a rule on a face: natural coordinates and weight.
pub type FacePoint = ([f64; 2], f64);

const fn volume_rule<const N: usize, const P: usize>(line: [(f64, f64); N]) -> [VolumePoint; P] {
    let mut points = [([0.0; 3], 0.0); P];
    let mut p = 0;
    while p < P {
        let (i, j, k) = (p / (N * N), p / N % N, p % N);
        points[p] = ([line[i].0, line[j].0, line[k].0], line[i].1 * line[j].1 * line[k].1);
        p += 1;
    }
    points
}

const fn face_rule<const N: usize, const P: usize>(line: [(f64, f64); N]) -> [FacePoint; P] {
    let mut points = [([0.0; 2], 0.0); P];
    let mut p = 0;
    while p < P {
        let (i, j) = (p / N, p % N);
        points[p] = ([line[i].0, line[j].0], line[i].1 * line[j].1);
        p += 1;
    }
    points
}

const fn irons14() -> [VolumePoint; 14] {
    const AXIS: f64 = 0.795_822_425_754_221_463_3; // sqrt(19/30)
    const DIAGONAL: f64 = 0.758_786_910_639_328_146_3; // sqrt(19/33)
    let mut points = [([0.0; 3], 320.0 / 361.0); 14];
    let mut p = 0;
    while p < 6 {
        points[p].0[p / 2] = if p % 2 == 0 { -AXIS } else { AXIS };
        p += 1;
    }
    while p < 14 {
        let mut d = 0;
        while d < 3 {
            points[p].0[d] = if (p - 6) >> (2 - d) & 1 == 0 { -DIAGONAL } else { DIAGONAL };
            d += 1;
        }
        points[p].1 = 121.0 / 361.0;
        p += 1;
    }
    points
}

/// The 8 points of the 2×2×2 rule; the third coordinate runs fastest.
pub static GAUSS2: [VolumePoint; 8] = volume_rule(LINE2);
/// The 27 points of the 3×3×3 rule; the third coordinate runs fastest.
pub static GAUSS3: [VolumePoint; 27] = volume_rule(LINE3);
/// The 14 points of Irons' rule: six on the axes, eight on the diagonals.
pub static IRONS14: [VolumePoint; 14] = irons14();
/// The 9 points of the 3×3 rule on a face; the second coordinate runs fastest.
pub static FACE3: [FacePoint; 9] = face_rule(LINE3);

/// The rule that integrates the stiffness (the mass always takes 3×3×3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quadrature {
    /// 2×2×2 points ("reduced").
    Gauss2,
    /// Irons' 14 points.
    Irons14,
    /// 3×3×3 points ("full").
    Gauss3,
}

impl Quadrature {
    /// The points of the rule: natural coordinates and weights, whose sum is 8.
    pub fn points(self) -> &'static [VolumePoint] {
        match self {
            Quadrature::Gauss2 => &GAUSS2,
            Quadrature::Irons14 => &IRONS14,
            Quadrature::Gauss3 => &GAUSS3,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_their_degree_exactly() {
        for (rule, degree) in [(Quadrature::Gauss2, 3), (Quadrature::Gauss3, 5)] {
            for i in 0..=degree + 1 {
                let sum: f64 = rule.points().iter().map(|(x, w)| w * x[0].powi(i) * x[2].powi(2)).sum();
                let exact = if i % 2 == 1 { 0.0 } else { 2.0 / f64::from(i + 1) * 2.0 * 2.0 / 3.0 };
                assert_eq!((sum - exact).abs() < 1e-14, i <= degree, "degree {i}: {sum} against {exact}");
            }
        }
        let monomial = |[i, j, k]: [i32; 3]| {
            IRONS14.iter().map(|(x, w)| w * x[0].powi(i) * x[1].powi(j) * x[2].powi(k)).sum::<f64>()
        };
        let exact = |powers: [i32; 3]| {
            powers.iter().map(|&p| if p % 2 == 1 { 0.0 } else { 2.0 / f64::from(p + 1) }).product::<f64>()
        };
        for i in 0..=5 {
            for j in 0..=5 - i {
                for k in 0..=5 - i - j {
                    assert!((monomial([i, j, k]) - exact([i, j, k])).abs() < 1e-14, "{i} {j} {k}");
                }
            }
        }
        assert!((monomial([2, 2, 2]) - exact([2, 2, 2])).abs() > 1e-3, "total degree 6 is beyond the rule");
        let face: f64 = FACE3.iter().map(|(x, w)| w * x[0].powi(4) * x[1].powi(4)).sum();
        assert!((face - 4.0 / 25.0).abs() < 1e-15);
    }
}
