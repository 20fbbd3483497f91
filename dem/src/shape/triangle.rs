//! Closest point of a triangle to a point (Ericson, Real-Time Collision Detection, 2005, sec. 5.1.5: the regions
//! of the plane by signed products, so that no root and no tolerance is needed).

use crate::base::Vec3;

/// Where on the triangle a point lies. Edge k joins vertices k and k + 1 (mod 3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// The inside.
    Face,
    /// Edge 0, 1 or 2.
    Edge(usize),
    /// Vertex 0, 1 or 2.
    Vertex(usize),
}

/// The point of triangle `abc` closest to `p`, as weights of b and c, with its region.
#[inline]
pub fn closest_point(a: &Vec3, b: &Vec3, c: &Vec3, p: &Vec3) -> ([f64; 2], Region) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([0.0, 0.0], Region::Vertex(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return ([1.0, 0.0], Region::Vertex(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return ([d1 / (d1 - d3), 0.0], Region::Edge(0));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return ([0.0, 1.0], Region::Vertex(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return ([0.0, d2 / (d2 - d6)], Region::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([1.0 - w, w], Region::Edge(1));
    }
    let s = 1.0 / (va + vb + vc);
    ([vb * s, vc * s], Region::Face)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::Rng;
    use rand_pcg::Pcg64Mcg;

    /// The closest point is at least as near as every point of a dense sample, and no nearer than the sample's
    /// spacing allows; the region agrees with the weights.
    #[test]
    fn random_triangles_against_sampling() {
        let mut rng = Pcg64Mcg::new(11);
        let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0;
        let mut regions = [0_usize; 3];
        for _ in 0..2000 {
            let [a, b, c] = [0; 3].map(|_| Vec3::new(unit(), unit(), unit()));
            let p = Vec3::new(unit(), unit(), unit()) * 2.0;
            let ([v, w], region) = closest_point(&a, &b, &c, &p);
            let found = (a + (b - a) * v + (c - a) * w - p).norm();
            let mut sampled = f64::INFINITY;
            for i in 0..=60 {
                for j in 0..=60 - i {
                    let (v, w) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                    sampled = sampled.min((a + (b - a) * v + (c - a) * w - p).norm());
                }
            }
            assert!(found <= sampled + 1e-12 && sampled - found < 0.1, "{found} {sampled}");
            let zeros = [v, w, 1.0 - v - w].iter().filter(|x| x.abs() < 1e-12).count();
            let kind = match region {
                Region::Face => 0,
                Region::Edge(_) => 1,
                Region::Vertex(_) => 2,
            };
            assert_eq!(zeros, kind);
            regions[kind] += 1;
        }
        assert!(regions.iter().all(|&n| n > 50), "{regions:?}");
    }
}
