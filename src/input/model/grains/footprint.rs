//! Plans of sleepers and plates against walls.

use trackbed_dem::wall::PlanCircle;
use trackbed_dem::{Vec3, WallShape};

/// Depth behind a wall that counts [m].
const BEHIND: f64 = 1e-3;
/// Vertical part of the normal of upright walls.
const UPRIGHT: f64 = 0.3;

/// Rectangle in plan, and heights, of a body that moves along z.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Half edge lengths [m].
    pub half: [f64; 2],
    /// Lowest height; −∞ if unknown [m].
    pub bottom: f64,
}

impl Footprint {
    /// Returns the depth [m] behind a vertical plane, above a millimetre.
    pub fn behind(&self, point: &Vec3, normal: &Vec3) -> Option<f64> {
        let n = normal.normalize();
        // Heights are not known: only vertical planes are compared.
        if n.z.abs() > 1e-6 {
            return None;
        }
        let offset: f64 = (0..2).map(|d| (self.centre[d] - point[d]) * n[d]).sum();
        let reach: f64 = (0..2).map(|d| self.half[d] * n[d].abs()).sum();
        Some(reach - offset).filter(|depth| *depth > BEHIND)
    }

    /// Whether a wall that is no plane cuts the rectangle.
    pub fn is_cut_by(&self, shape: &WallShape) -> bool {
        if let Some((vertices, triangles)) = shape.triangulated() {
            return triangles.iter().any(|t| self.is_cut_by_triangle(&t.map(|v| vertices[v as usize])));
        }
        shape.plan_circle().is_some_and(|circle| circle.top > self.bottom && self.is_cut(&circle))
    }

    fn is_cut(&self, circle: &PlanCircle) -> bool {
        let [largest, mean] = circle.radii;
        let away = [0, 1].map(|d| (self.centre[d] - circle.centre[d]).abs());
        let corner = libm::hypot(away[0] + self.half[0], away[1] + self.half[1]);
        let nearest = [0, 1].map(|d| (away[d] - self.half[d]).max(0.0));
        corner > largest + BEHIND && libm::hypot(nearest[0], nearest[1]) < mean - BEHIND
    }

    /// Separating axes in plan.
    fn is_cut_by_triangle(&self, corners: &[Vec3; 3]) -> bool {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a));
        let top = corners.iter().map(|x| x.z).fold(f64::NEG_INFINITY, f64::max);
        if normal.z.abs() > UPRIGHT * normal.norm() || top <= self.bottom {
            return false;
        }
        let edges = [b - a, c - b, a - c].map(|e| [-e.y, e.x]);
        let axes = [[1.0, 0.0], [0.0, 1.0]].into_iter().chain(edges);
        axes.filter_map(|n| {
            let length = libm::hypot(n[0], n[1]);
            (length > 0.0).then(|| [n[0] / length, n[1] / length])
        })
        .all(|n| {
            let along = |x: &Vec3| (x.x - self.centre[0]) * n[0] + (x.y - self.centre[1]) * n[1];
            let (low, high) = corners
                .iter()
                .map(along)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)));
            let reach = self.half[0] * n[0].abs() + self.half[1] * n[1].abs() - BEHIND;
            low < reach && high > -reach
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sleeper(x: f64) -> Footprint {
        Footprint { centre: [x, 0.0], half: [0.3, 0.1], bottom: 0.2 }
    }

    #[test]
    fn vertical_planes_are_compared() {
        let behind = |x: f64, normal: Vec3| sleeper(x).behind(&Vec3::new(0.5, 0.0, 0.0), &normal);
        assert_eq!(behind(0.2, -Vec3::x()), None);
        assert!((behind(0.25, -2.0 * Vec3::x()).unwrap() - 0.05).abs() < 1e-12);
        assert_eq!(behind(0.25, Vec3::z()), None);
    }

    #[test]
    fn curved_walls_cut_intersecting_footprints() {
        let tube = |radius: f64, base: f64| WallShape::Frustum {
            base: Vec3::new(0.0, 0.0, base),
            axis: Vec3::z(),
            height: 0.5,
            radii: [radius; 2],
            caps: [false; 2],
        };
        for (x, radius, cut) in [(0.0, 0.25, true), (0.0, 0.32, false), (0.2, 0.32, true), (0.6, 0.25, false)]
        {
            assert_eq!(sleeper(x).is_cut_by(&tube(radius, 0.0)), cut, "{x} {radius}");
            let ball = WallShape::Sphere { centre: Vec3::zeros(), radius };
            assert_eq!(sleeper(x).is_cut_by(&ball), cut, "{x} {radius}");
        }
        // Below the bed.
        assert!(!sleeper(0.0).is_cut_by(&tube(0.25, -0.4)));
    }

    #[test]
    fn upright_triangles_cut() {
        let wall = |normal_z: f64, top: f64| {
            let vertices = vec![
                Vec3::new(0.25, -1.0, 0.0),
                Vec3::new(0.25, 1.0, 0.0),
                Vec3::new(0.25 + normal_z, 1.0, top),
            ];
            WallShape::Triangles { vertices, triangles: vec![[0, 1, 2]] }
        };
        assert!(sleeper(0.0).is_cut_by(&wall(0.0, 1.0)));
        assert!(!sleeper(-0.1).is_cut_by(&wall(0.0, 1.0)));
        assert!(!sleeper(0.0).is_cut_by(&wall(0.0, 0.1)), "below the bed");
        assert!(!sleeper(0.0).is_cut_by(&wall(10.0, 1.0)), "a slope");
    }
}
