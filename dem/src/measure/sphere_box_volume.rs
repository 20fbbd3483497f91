//! Volume of the intersection of a sphere and a box, in closed form.
//!
//! The box is a signed sum of octants at its corners:
//!
//! ```text
//! V = Σ ± K(a, b, c),   K(a, b, c) = |{x > a, y > b, z > c, x² + y² + z² < 1}|.
//! ```
//!
//! For a, b, c ≥ 0 and the corner inside, 3 K = S − a A_a − b A_b − c A_c by the divergence theorem, with
//! flat sides A and the spherical face S = 2π − Σ γ − Σ a φ_a (Gauss–Bonnet). The arc on x = a has the angle
//! φ_a and the geodesic curvature a/√(1 − a²); exterior angles are γ_ab = arccos(−ab / √((1 − a²)(1 − b²))).
//! Negative a: K(a, b, c) = K(b, c) − K(−a, b, c), with the wedge K(b, c).
//!
//! Source: own. Rounding error: 1e-15 R³.

use super::BoxRegion;
use crate::base::Vec3;
use std::f64::consts::PI;

/// Returns the volume of a sphere inside a box [m³].
pub fn sphere_box_volume(centre: &Vec3, radius: f64, region: &BoxRegion) -> f64 {
    let low = (region.low - centre) / radius;
    let high = (region.high - centre) / radius;
    if (0..3).any(|d| low[d] >= 1.0 || high[d] <= -1.0 || low[d] >= high[d]) {
        return 0.0;
    }
    let whole = 4.0 / 3.0 * PI;
    let cube = radius * radius * radius;
    if (0..3).all(|d| low[d] <= -1.0 && high[d] >= 1.0) {
        return whole * cube;
    }
    let mut sum = 0.0;
    for corner in 0..8_usize {
        let at = |d: usize| if corner >> d & 1 == 1 { high[d] } else { low[d] };
        let sign = if corner.count_ones() % 2 == 0 { 1.0 } else { -1.0 };
        sum += sign * octant(at(0), at(1), at(2));
    }
    sum.clamp(0.0, whole) * cube
}

/// x > a.
fn cap(a: f64) -> f64 {
    let a = a.clamp(-1.0, 1.0);
    PI * (1.0 - a) * (1.0 - a) * (2.0 + a) / 3.0
}

/// x > a, y > b.
fn wedge(a: f64, b: f64) -> f64 {
    if a < 0.0 {
        return cap(b) - wedge(-a, b);
    }
    if b < 0.0 {
        return cap(a) - wedge(a, -b);
    }
    if a * a + b * b >= 1.0 {
        return 0.0;
    }
    let (ra, rb) = ((1.0 - a * a).sqrt(), (1.0 - b * b).sqrt());
    let (fa, fb) = (2.0 * angle(b / ra), 2.0 * angle(a / rb));
    let segment = |r: f64, h: f64, f: f64| 0.5 * r * r * f - h * (r * r - h * h).max(0.0).sqrt();
    let sphere = 2.0 * PI - 2.0 * turn(a, b, ra, rb) - a * fa - b * fb;
    (sphere - a * segment(ra, b, fa) - b * segment(rb, a, fb)) / 3.0
}

/// x > a, y > b, z > c.
fn octant(a: f64, b: f64, c: f64) -> f64 {
    if a < 0.0 {
        return wedge(b, c) - octant(-a, b, c);
    }
    if b < 0.0 {
        return wedge(a, c) - octant(a, -b, c);
    }
    if c < 0.0 {
        return wedge(a, b) - octant(a, b, -c);
    }
    if a * a + b * b + c * c >= 1.0 {
        return 0.0;
    }
    let r = [a, b, c].map(|h| (1.0 - h * h).sqrt());
    // Face at height h: disc of radius r cut at u and v.
    let side = |r: f64, u: f64, v: f64| {
        let arc = (angle(u / r) - libm::asin((v / r).min(1.0))).max(0.0);
        let chord = |p: f64, q: f64| p * ((r * r - p * p).max(0.0).sqrt() - q);
        (arc, 0.5 * (r * r * arc - chord(u, v) - chord(v, u)))
    };
    let sides = [side(r[0], b, c), side(r[1], c, a), side(r[2], a, b)];
    let turns = turn(a, b, r[0], r[1]) + turn(b, c, r[1], r[2]) + turn(c, a, r[2], r[0]);
    let heights = [a, b, c];
    let arcs: f64 = heights.iter().zip(&sides).map(|(h, s)| h * s.0).sum();
    let flats: f64 = heights.iter().zip(&sides).map(|(h, s)| h * s.1).sum();
    (2.0 * PI - turns - arcs - flats) / 3.0
}

fn angle(cosine: f64) -> f64 {
    libm::acos(cosine.clamp(-1.0, 1.0))
}

/// Exterior angle of the circles at heights a and b.
fn turn(a: f64, b: f64, ra: f64, rb: f64) -> f64 {
    angle(-a * b / (ra * rb))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rand_core::Rng;
    use rand_pcg::Pcg64Mcg;

    fn unit_box(low: [f64; 3], high: [f64; 3]) -> BoxRegion {
        BoxRegion { low: low.into(), high: high.into() }
    }

    /// Half, quarter, eighth, slab, and cap of height h: π h² (3R − h)/3.
    #[test]
    fn parts_with_closed_forms() {
        let (c, r) = (Vec3::new(0.3, -0.2, 5.0), 0.7);
        let whole = 4.0 / 3.0 * PI * r * r * r;
        let far = 10.0;
        let at = |d: [f64; 3]| {
            sphere_box_volume(&c, r, &BoxRegion { low: c + Vec3::from(d), high: c.add_scalar(far) })
        };
        assert_relative_eq!(at([-far, -far, -far]), whole, max_relative = 1e-15);
        assert_relative_eq!(at([0.0, -far, -far]), whole / 2.0, max_relative = 1e-14);
        assert_relative_eq!(at([-far, 0.0, 0.0]), whole / 4.0, max_relative = 1e-14);
        assert_relative_eq!(at([0.0, 0.0, 0.0]), whole / 8.0, max_relative = 1e-14);
        assert_eq!(at([0.71, 0.0, 0.0]), 0.0);
        for h in [0.01, 0.2, 0.9, 1.3] {
            let exact = PI * h * h * (3.0 * r - h) / 3.0;
            assert_relative_eq!(at([-far, r - h, -far]), exact, epsilon = 1e-14, max_relative = 1e-12);
        }
        let slab = unit_box([-0.1, -9.0, -9.0], [0.4, 9.0, 9.0]);
        let exact = PI * (0.5 - (0.064 + 0.001) / 3.0);
        assert_relative_eq!(sphere_box_volume(&Vec3::zeros(), 1.0, &slab), exact, max_relative = 1e-14);
        let small = unit_box([-0.3, 0.0, -0.2], [0.4, 0.1, 0.5]);
        assert_relative_eq!(sphere_box_volume(&Vec3::zeros(), 1.0, &small), 0.049, max_relative = 1e-13);
    }

    fn quadrature(region: &BoxRegion) -> f64 {
        let n = 1500;
        let mut sum = 0.0;
        let (t0, t1) = (region.low.x.max(-1.0).asin(), region.high.x.min(1.0).asin());
        for i in 0..n {
            let t = t0 + (i as f64 + 0.5) * (t1 - t0) / n as f64;
            let r = t.cos();
            let (s0, s1) =
                ((region.low.y / r).clamp(-1.0, 1.0).asin(), (region.high.y / r).clamp(-1.0, 1.0).asin());
            for j in 0..n {
                let s = s0 + (j as f64 + 0.5) * (s1 - s0) / n as f64;
                let z = r * s.cos();
                let height = (region.high.z.min(z) - region.low.z.max(-z)).max(0.0);
                sum += height * r * r * s.cos() * (t1 - t0) * (s1 - s0) / (n * n) as f64;
            }
        }
        sum
    }

    #[test]
    fn random_boxes_match_quadrature() {
        let mut rng = Pcg64Mcg::new(5);
        let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let mut cut = 0;
        for k in 0..2000 {
            let (p, q) = ([0; 3].map(|_| 2.6 * unit() - 1.3), [0; 3].map(|_| 2.6 * unit() - 1.3));
            let low: [f64; 3] = std::array::from_fn(|d| p[d].min(q[d]));
            let high: [f64; 3] = std::array::from_fn(|d| p[d].max(q[d]));
            let region = unit_box(low, high);
            let volume = sphere_box_volume(&Vec3::zeros(), 1.0, &region);
            if k < 10 {
                assert!(
                    (volume - quadrature(&region)).abs() < 2e-5,
                    "{region:?}: {volume} {}",
                    quadrature(&region)
                );
            }
            let middle: [f64; 3] = std::array::from_fn(|d| low[d] + unit() * (high[d] - low[d]));
            let parts: f64 = (0..8_usize)
                .map(|c| {
                    let bit = |d: usize| c >> d & 1 == 1;
                    let l = std::array::from_fn(|d| if bit(d) { middle[d] } else { low[d] });
                    let h = std::array::from_fn(|d| if bit(d) { high[d] } else { middle[d] });
                    sphere_box_volume(&Vec3::zeros(), 1.0, &unit_box(l, h))
                })
                .sum();
            assert!((volume - parts).abs() < 1e-13, "{region:?}: {volume} {parts}");
            cut += usize::from(volume > 0.01 && volume < 4.0);
        }
        assert!(cut > 1000);
    }
}
