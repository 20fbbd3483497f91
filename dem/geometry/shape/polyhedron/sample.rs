//! Area-weighted surface sampling.
//!
//! Point i of n samples the area fraction [i/n, (i+1)/n): M. Roberts' R2 sequence, folded onto the triangle.

use super::surface::Surface;

/// 1/g and 1/g² with g³ = g + 1.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

pub(super) fn surface_points(surface: &Surface, count: usize) -> Vec<[f64; 3]> {
    let area = |t: usize| {
        let [a, b, c] = surface.corners(t);
        0.5 * (b - a).cross(&(c - a)).norm()
    };
    let areas: Vec<f64> = (0..surface.triangles.len()).map(area).collect();
    let total: f64 = areas.iter().sum();
    let (mut t, mut before) = (0, 0.0);
    (0..count)
        .map(|i| {
            let middle = (i as f64 + 0.5) / count as f64 * total;
            while t + 1 < areas.len() && before + areas[t] < middle {
                before += areas[t];
                t += 1;
            }
            let [mut v, mut w] = R2.map(|r| (0.5 + i as f64 * r).fract());
            if v + w > 1.0 {
                (v, w) = (1.0 - v, 1.0 - w);
            }
            let [a, b, c] = surface.corners(t);
            (a + (b - a) * v + (c - a) * w).into()
        })
        .collect()
}
