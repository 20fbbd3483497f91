//! Rigid rectangular block, such as a sleeper.

use super::body_shape::{BodyShape, Outline, positive};
use crate::base::Vec3;

/// Closest surface point, outward unit normal and signed distance, negative inside [m]; block frame.
#[inline]
pub fn closest_point(half: &Vec3, p: &Vec3) -> (Vec3, Vec3, f64) {
    let inside = Vec3::from_fn(|d, _| p[d].clamp(-half[d], half[d]));
    let offset = p - inside;
    let distance = offset.norm();
    if distance > 0.0 {
        return (inside, offset / distance, distance);
    }
    let depth = Vec3::from_fn(|d, _| half[d] - p[d].abs());
    let face = depth.imin();
    let sign = 1.0_f64.copysign(p[face]);
    let mut normal = Vec3::zeros();
    normal[face] = sign;
    let mut point = *p;
    point[face] = sign * half[face];
    (point, normal, -depth[face])
}

/// Principal moments of inertia per unit mass [m²].
#[inline]
pub fn inertia(half: &Vec3) -> Vec3 {
    let s = half.component_mul(half);
    Vec3::new(s.y + s.z, s.z + s.x, s.x + s.y) / 3.0
}

/// Corner `k` (0–7): bit d selects the positive side of axis d.
#[inline]
pub fn corner(half: &Vec3, k: usize) -> Vec3 {
    Vec3::from_fn(|d, _| if k >> d & 1 == 1 { half[d] } else { -half[d] })
}

/// Squared lever arms about the axes [m²]: over a side a third of the squared half length along it, all of
/// it across.
pub fn levers2(half: &Vec3) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| {
        let (a, b) = (half[(k + 1) % 3].powi(2), half[(k + 2) % 3].powi(2));
        (a + b / 3.0).max(a / 3.0 + b)
    })
}

/// Rectangular block.
#[derive(Clone, Copy, Debug)]
pub struct Cuboid {
    /// Half lengths [m].
    pub half: [f64; 3],
}

impl BodyShape for Cuboid {
    fn fault(&self) -> Option<String> {
        let found = || format!("half sides are {:?}; each must be positive and finite", self.half);
        (!self.half.iter().all(|&h| positive(h))).then(found)
    }

    fn volume(&self) -> f64 {
        8.0 * self.half.iter().product::<f64>()
    }

    fn gyration2(&self) -> Vec3 {
        inertia(&Vec3::from(self.half))
    }

    fn bounding_radius(&self) -> f64 {
        Vec3::from(self.half).norm()
    }

    fn reference_radius(&self) -> f64 {
        self.half.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn contact_radius(&self) -> Option<f64> {
        None
    }

    fn levers2(&self) -> [f64; 3] {
        levers2(&Vec3::from(self.half))
    }

    fn contacts(&self, scale: f64, smallest: f64, several: bool) -> f64 {
        let h = self.half.map(|h| 2.0 * h * scale / (2.0 * smallest) + 1.0);
        let grains = 4.0 * (h[0] * h[1]).max(h[1] * h[2]).max(h[2] * h[0]);
        // Two opposite sides, four contact points each.
        if several { grains.max(16.0) } else { grains }
    }

    fn chord(&self, scale: f64, origin: &Vec3, along: &Vec3) -> Option<(f64, f64)> {
        let half = Vec3::from(self.half) * scale;
        let mut span = (f64::NEG_INFINITY, f64::INFINITY);
        for d in 0..3 {
            if along[d].abs() < 1e-14 {
                if origin[d].abs() > half[d] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((-half[d] - origin[d]) / along[d], (half[d] - origin[d]) / along[d]);
            span = (span.0.max(a.min(b)), span.1.min(a.max(b)));
        }
        (span.0 < span.1).then_some(span)
    }

    fn distance(&self, scale: f64, point: &Vec3) -> Option<f64> {
        Some(closest_point(&(Vec3::from(self.half) * scale), point).2)
    }

    fn permanent(&self) -> Option<&'static str> {
        Some("it is a box")
    }

    fn outline(&self) -> Option<Outline> {
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let corners = (0..8).map(|k| corner(&Vec3::from(self.half), k));
        Some((corners.collect(), sides.iter().map(|side| side.to_vec()).collect()))
    }

    fn solid_name(&self) -> Option<&'static str> {
        Some("boxes")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_inside_edge_and_corner() {
        let half = Vec3::new(1.0, 2.0, 3.0);
        let (p, n, d) = closest_point(&half, &Vec3::new(0.2, 0.3, 4.0));
        assert_eq!((p, n, d), (Vec3::new(0.2, 0.3, 3.0), Vec3::z(), 1.0));
        let (p, n, d) = closest_point(&half, &Vec3::new(-0.9, 0.3, 0.1));
        assert_eq!((p, n), (Vec3::new(-1.0, 0.3, 0.1), -Vec3::x()));
        assert!((d + 0.1).abs() < 1e-15);
        let (p, n, d) = closest_point(&half, &Vec3::new(4.0, 6.0, 0.0));
        assert_eq!((p, n, d), (Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.6, 0.8, 0.0), 5.0));
        let (p, _, d) = closest_point(&half, &Vec3::new(2.0, 4.0, 5.0));
        assert_eq!((p, d), (Vec3::new(1.0, 2.0, 3.0), 3.0));
    }
}
