//! Integration rules of hexahedron, wedge, pyramid, tetrahedron and their faces.
//!
//! Gauss: Zienkiewicz and Taylor (2000), vol. 1, table 9.1; exact to degree 2n - 1 per axis. 14 points: Irons
//! (1971), table I; exact to total degree 5.
//!
//! Limits for the hex20: 8 points ("reduced") are usually more accurate, but leave zero-energy modes in a
//! single element or a row one element wide and deep, even if clamped. Two elements across with a clamped
//! side suppress them. 14 points have full rank at half the cost; the curved patch test error is about
//! 1e-3.
//!
//! Triangle: Hammer, Marlowe and Stroud, Math. Tables Aids Comput. 10 (1956) 130-137 (3 points); Dunavant,
//! Int. J. Numer. Methods Eng. 21 (1985) 1129-1148 (6, 7). Tetrahedron: Hammer, Marlowe and Stroud (1956)
//! (4); Walkington, Quadrature on simplices of arbitrary dimension (2000) (14); Keast, Comput. Methods Appl.
//! Mech. Eng. 55 (1986) 339-348 (24); 20 digits from the moment equations. Wedge: triangle × line. Pyramid:
//! conical products after Hammer, Marlowe and Stroud (1956) with Gauss-Jacobi points for (1 - t)². Weights
//! are positive, points inside.

use serde::{Deserialize, Serialize};

const A: f64 = 0.577_350_269_189_625_764_5; // 1/sqrt(3)
const B: f64 = 0.774_596_669_241_483_377_0; // sqrt(3/5)

/// Two-point rule on [-1, 1]: abscissae, weights.
pub const LINE2: [(f64, f64); 2] = [(-A, 1.0), (A, 1.0)];
/// Three-point rule on [-1, 1]: abscissae, weights.
pub const LINE3: [(f64, f64); 3] = [(-B, 5.0 / 9.0), (0.0, 8.0 / 9.0), (B, 5.0 / 9.0)];

/// Natural coordinates and weight.
pub type VolumePoint = ([f64; 3], f64);
/// Natural coordinates and weight.
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

/// 2×2×2 Gauss points; third coordinate fastest.
pub static GAUSS2: [VolumePoint; 8] = volume_rule(LINE2);
/// 3×3×3 Gauss points; third coordinate fastest.
pub static GAUSS3: [VolumePoint; 27] = volume_rule(LINE3);
/// 14 points of Irons: six on the axes, eight on the diagonals.
pub static IRONS14: [VolumePoint; 14] = irons14();
/// 3×3 Gauss points of a face; second coordinate fastest.
pub static FACE3: [FacePoint; 9] = face_rule(LINE3);

/// Integration rule of the stiffness (the mass always uses 3×3×3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quadrature {
    /// 2×2×2 points ("reduced").
    #[default]
    Gauss2,
    /// Irons' 14 points.
    Irons14,
    /// 3×3×3 points ("full").
    Gauss3,
}

/// Two-point Gauss-Jacobi rule for the weight (1 - t)² on [0, 1]: exact to degree 3.
const CONE2: [(f64, f64); 2] = [
    (0.122_514_822_655_441_377_87, 0.232_547_451_253_507_902_75), // 1/3 - sqrt(2/45)
    (0.544_151_844_011_225_288_80, 0.100_785_882_079_825_430_58), // 1/3 + sqrt(2/45)
];
/// Three-point rule: exact to degree 5.
const CONE3: [(f64, f64); 3] = [
    (0.072_994_024_073_149_732_16, 0.157_136_361_064_886_613_32),
    (0.347_003_766_038_351_884_72, 0.146_246_269_259_866_022_00),
    (0.705_002_209_888_498_312_24, 0.029_950_703_008_580_698_01),
];

/// Triangle rule from centroid weight and orbits (a, w) with area coordinates (a, a, 1 - 2a).
const fn triangle_rule<const P: usize>(centroid: f64, orbits: &[(f64, f64)]) -> [FacePoint; P] {
    let mut points = [([1.0 / 3.0; 2], centroid / 2.0); P];
    let mut p = 0;
    while p < 3 * orbits.len() {
        let (a, w) = orbits[p / 3];
        points[p] = ([a; 2], w / 2.0);
        if p % 3 > 0 {
            points[p].0[p % 3 - 1] = 1.0 - 2.0 * a;
        }
        p += 1;
    }
    points
}

/// Tetrahedron rule from orbits of weight sum 1; rule weights sum to 1/6. `vertex` (a, w): (a, a, a, 1 - 3a);
/// `edge` (a, w): (a, a, 1/2 - a, 1/2 - a); `twelve` (a, b, w): (a, a, b, 1 - 2a - b).
const fn tet_rule<const P: usize>(
    vertex: &[(f64, f64)],
    edge: &[(f64, f64)],
    twelve: &[(f64, f64, f64)],
) -> [VolumePoint; P] {
    let mut points = [([0.0; 3], 0.0); P];
    let mut p = 0;
    while p < P {
        // Coordinate 0 completes the sum to one.
        let mut l;
        let w;
        if p < 4 * vertex.len() {
            let (a, weight) = vertex[p / 4];
            l = [a; 4];
            l[p % 4] = 1.0 - 3.0 * a;
            w = weight;
        } else if p < 4 * vertex.len() + 6 * edge.len() {
            const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
            let local = p - 4 * vertex.len();
            let (a, weight) = edge[local / 6];
            l = [0.5 - a; 4];
            l[PAIRS[local % 6].0] = a;
            l[PAIRS[local % 6].1] = a;
            w = weight;
        } else {
            let local = p - 4 * vertex.len() - 6 * edge.len();
            let (a, b, weight) = twelve[local / 12];
            let (i, j) = (local % 12 / 3, local % 3);
            l = [a; 4];
            l[i] = b;
            l[(i + 1 + j) % 4] = 1.0 - 2.0 * a - b;
            w = weight;
        }
        points[p] = ([l[1], l[2], l[3]], w / 6.0);
        p += 1;
    }
    points
}

const fn wedge_rule<const T: usize, const L: usize, const P: usize>(
    triangle: [FacePoint; T],
    line: [(f64, f64); L],
) -> [VolumePoint; P] {
    let mut points = [([0.0; 3], 0.0); P];
    let mut p = 0;
    while p < P {
        let ((rs, w), (t, v)) = (triangle[p / L], line[p % L]);
        points[p] = ([rs[0], rs[1], t], w * v);
        p += 1;
    }
    points
}

const fn pyramid_rule<const N: usize, const L: usize, const P: usize>(
    line: [(f64, f64); N],
    cone: [(f64, f64); L],
) -> [VolumePoint; P] {
    let mut points = [([0.0; 3], 0.0); P];
    let mut p = 0;
    while p < P {
        let (x, y, (t, w)) = (line[p / (N * L)], line[p / L % N], cone[p % L]);
        points[p] = ([x.0 * (1.0 - t), y.0 * (1.0 - t), t], x.1 * y.1 * w);
        p += 1;
    }
    points
}

/// 2×2 points of a face. Exact to degree 3 per axis.
pub static FACE2: [FacePoint; 4] = face_rule(LINE2);
/// Triangle, 3 points; weights sum to 1/2. Exact to degree 2.
pub static TRIANGLE3: [FacePoint; 3] = triangle_rule(0.0, &[(1.0 / 6.0, 1.0 / 3.0)]);
/// Triangle, 6 points; weights sum to 1/2. Exact to degree 4.
pub static TRIANGLE6: [FacePoint; 6] = triangle_rule(
    0.0,
    &[
        (0.445_948_490_915_964_886_32, 0.223_381_589_678_011_465_70),
        (0.091_576_213_509_770_743_46, 0.109_951_743_655_321_867_64),
    ],
);
/// Triangle, 7 points; weights sum to 1/2. Exact to degree 5.
pub static TRIANGLE7: [FacePoint; 7] = triangle_rule(
    9.0 / 40.0,
    &[
        (0.470_142_064_105_115_089_77, 0.132_394_152_788_506_180_74), // (6 + sqrt(15))/21, (155 + sqrt(15))/1200
        (0.101_286_507_323_456_338_80, 0.125_939_180_544_827_152_60), // (6 - sqrt(15))/21, (155 - sqrt(15))/1200
    ],
);
/// Tetrahedron centroid; weight 1/6. Exact to degree 1.
pub static TET1: [VolumePoint; 1] = [([0.25; 3], 1.0 / 6.0)];
/// Tetrahedron, 4 points; weights sum to 1/6. Exact to degree 2.
pub static TET4: [VolumePoint; 4] = tet_rule(&[(0.138_196_601_125_010_515_18, 0.25)], &[], &[]); // (5 - sqrt(5))/20
/// Tetrahedron, 14 points (Walkington); weights sum to 1/6. Exact to degree 5.
pub static TET14: [VolumePoint; 14] = tet_rule(
    &[
        (0.310_885_919_263_300_609_80, 0.112_687_925_718_015_850_80),
        (0.092_735_250_310_891_226_40, 0.073_493_043_116_361_949_54),
    ],
    &[(0.045_503_704_125_649_649_49, 0.042_546_020_777_081_466_44)],
    &[],
);
/// Tetrahedron, 24 points (Keast); weights sum to 1/6. Exact to degree 6.
pub static TET24: [VolumePoint; 24] = tet_rule(
    &[
        (0.214_602_871_259_152_027_83, 0.039_922_750_258_167_474_79),
        (0.040_673_958_534_611_341_12, 0.010_077_211_055_320_638_36),
        (0.322_337_890_142_275_500_61, 0.055_357_181_543_654_746_94),
    ],
    &[],
    &[(0.063_661_001_875_017_521_75, 0.269_672_331_458_315_799_14, 27.0 / 560.0)],
);
/// Wedge, 3 × 2 points; weights sum to 1. Exact to degree 2 in (r, s), 3 in t.
pub static WEDGE6: [VolumePoint; 6] = wedge_rule(TRIANGLE3, LINE2);
/// Wedge, 3 × 3 points; weights sum to 1. Exact to degree 2 in (r, s), 5 in t.
pub static WEDGE9: [VolumePoint; 9] = wedge_rule(TRIANGLE3, LINE3);
/// Wedge, 7 × 3 points; weights sum to 1. Exact to degree 5.
pub static WEDGE21: [VolumePoint; 21] = wedge_rule(TRIANGLE7, LINE3);
/// Pyramid, 2×2×2 points; weights sum to 4/3. Exact to total degree 3.
pub static PYRAMID8: [VolumePoint; 8] = pyramid_rule(LINE2, CONE2);
/// Pyramid, 3×3×2 points; weights sum to 4/3. Exact to total degree 3 (5 across). With 8 points the pyramid13
/// has a zero-energy mode over a parallelogram.
pub static PYRAMID18: [VolumePoint; 18] = pyramid_rule(LINE3, CONE2);
/// Pyramid, 3×3×3 points; weights sum to 4/3. Exact to total degree 5.
pub static PYRAMID27: [VolumePoint; 27] = pyramid_rule(LINE3, CONE3);

#[cfg(test)]
#[path = "quadrature_tests.rs"]
mod companion_tests;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_their_degree_exactly() {
        for (rule, degree) in [(GAUSS2.as_slice(), 3), (&GAUSS3, 5)] {
            for i in 0..=degree + 1 {
                let sum: f64 = rule.iter().map(|(x, w)| w * x[0].powi(i) * x[2].powi(2)).sum();
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
