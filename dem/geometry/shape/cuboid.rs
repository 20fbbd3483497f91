//! Rigid rectangular block, such as a sleeper.

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
