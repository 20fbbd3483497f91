//! Closest point of a triangle (Ericson, Real-Time Collision Detection, 2005, sec. 5.1.5: without root or
//! tolerance).

use crate::base::Vec3;
use crate::lanes::{Real, V3};

/// Feature of a triangle. Edge k joins vertices k and k + 1 (mod 3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// Interior.
    Face,
    /// Edge 0, 1 or 2.
    Edge(usize),
    /// Vertex 0, 1 or 2.
    Vertex(usize),
}

/// Signed products that classify regions.
struct Products<R> {
    d: [R; 6],
    va: R,
    vb: R,
    vc: R,
}

impl<R: Real> Products<R> {
    #[inline(always)]
    fn new(a: V3<R>, b: V3<R>, c: V3<R>, p: V3<R>) -> Products<R> {
        let (ab, ac) = (b - a, c - a);
        let (ap, bp, cp) = (p - a, p - b, p - c);
        let d = [ab.dot(ap), ac.dot(ap), ab.dot(bp), ac.dot(bp), ab.dot(cp), ac.dot(cp)];
        let [d1, d2, d3, d4, d5, d6] = d;
        Products { d, va: d3 * d6 - d5 * d4, vb: d5 * d2 - d1 * d6, vc: d1 * d4 - d3 * d2 }
    }

    /// Region: 0 interior, 1–3 vertices, 4–6 edges.
    #[inline(always)]
    fn region(&self) -> R {
        let ([d1, d2, d3, d4, d5, d6], zero) = (self.d, R::zero());
        let code = |k: u8| R::splat(f64::from(k));
        let edge_1 = R::select(self.va.le(zero) & d3.le(d4) & d6.le(d5), code(5), zero);
        let edge_2 = R::select(self.vb.le(zero) & zero.le(d2) & d6.le(zero), code(6), edge_1);
        let vertex_2 = R::select(zero.le(d6) & d5.le(d6), code(3), edge_2);
        let edge_0 = R::select(self.vc.le(zero) & zero.le(d1) & d3.le(zero), code(4), vertex_2);
        let vertex_1 = R::select(zero.le(d3) & d4.le(d3), code(2), edge_0);
        R::select(d1.le(zero) & d2.le(zero), code(1), vertex_1)
    }
}

/// Closest feature of `abc`: 0 interior, 1–3 vertices, 4–6 edges.
#[inline(always)]
pub fn region<R: Real>(a: V3<R>, b: V3<R>, c: V3<R>, p: V3<R>) -> R {
    Products::new(a, b, c, p).region()
}

#[inline(always)]
fn named(region: f64) -> Region {
    match region as usize {
        0 => Region::Face,
        k @ 1..=3 => Region::Vertex(k - 1),
        k => Region::Edge(k - 4),
    }
}

/// Closest feature of `abc` to `p`.
#[inline]
pub fn region_of(a: &Vec3, b: &Vec3, c: &Vec3, p: &Vec3) -> Region {
    let of = V3::from_vec;
    named(region(of(a), of(b), of(c), of(p)))
}

/// Closest point as weights of b and c, with its region.
#[inline]
pub fn closest_point(a: &Vec3, b: &Vec3, c: &Vec3, p: &Vec3) -> ([f64; 2], Region) {
    let of = V3::from_vec;
    let products = Products::new(of(a), of(b), of(c), of(p));
    let ([d1, d2, d3, d4, d5, d6], region) = (products.d, named(products.region()));
    let weights = match region {
        Region::Vertex(k) => [f64::from(u8::from(k == 1)), f64::from(u8::from(k == 2))],
        Region::Edge(0) => [d1 / (d1 - d3), 0.0],
        Region::Edge(1) => {
            let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            [1.0 - w, w]
        }
        Region::Edge(_) => [0.0, d2 / (d2 - d6)],
        Region::Face => {
            let s = 1.0 / (products.va + products.vb + products.vc);
            [products.vb * s, products.vc * s]
        }
    };
    (weights, region)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::Rng;
    use rand_pcg::Pcg64Mcg;

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
