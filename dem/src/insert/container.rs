//! Filling regions: box, cylinder or cone, closed surface.

use super::closed::ClosedSurface;
use crate::base::Vec3;
use std::f64::consts::PI;

/// Region to fill.
#[derive(Clone, Debug)]
pub enum Container {
    /// Axis-aligned box.
    Box {
        /// Lower corner [m].
        low: Vec3,
        /// Upper corner [m].
        high: Vec3,
    },
    /// Cylinder or truncated cone (funnel).
    Cone {
        /// First end centre [m].
        from: Vec3,
        /// Second end centre [m].
        to: Vec3,
        /// Radius at `from` [m].
        from_radius: f64,
        /// Radius at `to` [m].
        to_radius: f64,
    },
    /// Interior of a closed surface.
    Surface(ClosedSurface),
}

impl Container {
    /// Volume [m³].
    pub fn volume(&self) -> f64 {
        match self {
            Container::Box { low, high } => (high - low).iter().product(),
            Container::Cone { from, to, from_radius: a, to_radius: b } => {
                PI / 3.0 * (to - from).norm() * (a * a + a * b + b * b)
            }
            Container::Surface(surface) => surface.volume(),
        }
    }

    /// Bounding box [m].
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match self {
            Container::Box { low, high } => (*low, *high),
            Container::Cone { from, to, from_radius, to_radius } => {
                // A disc of radius r normal to n extends r √(1 − n_d²) along d.
                let n = (to - from).normalize();
                let reach = n.map(|x| (1.0 - x * x).max(0.0).sqrt());
                let (a, b) = (reach * *from_radius, reach * *to_radius);
                ((from - a).inf(&(to - b)), (from + a).sup(&(to + b)))
            }
            Container::Surface(surface) => surface.bounds(),
        }
    }

    /// Returns true if a sphere is entirely inside.
    pub fn holds(&self, centre: &Vec3, radius: f64) -> bool {
        match self {
            Container::Box { low, high } => {
                (0..3).all(|d| centre[d] - radius >= low[d] && centre[d] + radius <= high[d])
            }
            Container::Cone { from, to, from_radius, to_radius } => {
                let length = (to - from).norm();
                let axis = (to - from) / length;
                let along = (centre - from).dot(&axis);
                let off = (centre - from - axis * along).norm();
                let slope = (to_radius - from_radius) / length;
                // Normal distance to the side.
                let side = (from_radius + slope * along - off) / (1.0 + slope * slope).sqrt();
                along >= radius && along + radius <= length && side >= radius
            }
            Container::Surface(surface) => surface.holds(centre, radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Random;

    /// Largest sphere in a funnel: radius h sin α at height h above the tip, half opening angle α.
    #[test]
    fn cones_hold_what_fits() {
        let (from, to) = (Vec3::new(0.2, 0.1, -0.3), Vec3::new(0.8, -0.5, 0.9));
        let cone = Container::Cone { from, to, from_radius: 0.1, to_radius: 0.5 };
        let (low, high) = cone.bounds();
        let mut random = Random::new(4, 99);
        let n = 200_000;
        let mut inside = 0;
        for _ in 0..n {
            let p = low + Vec3::from_fn(|d, _| random.uniform() * (high[d] - low[d]));
            inside += usize::from(cone.holds(&p, 0.0));
        }
        let found = (high - low).iter().product::<f64>() * inside as f64 / n as f64;
        assert!((found / cone.volume() - 1.0).abs() < 0.01, "{found} {}", cone.volume());

        let funnel = Container::Cone { from: Vec3::zeros(), to: Vec3::z(), from_radius: 0.0, to_radius: 1.0 };
        let fits = 0.6 * 0.5_f64.sqrt();
        assert!(
            funnel.holds(&Vec3::new(0.0, 0.0, 0.6), 0.39) && !funnel.holds(&Vec3::new(0.0, 0.0, 0.6), 0.41)
        );
        let low = Vec3::new(0.0, 0.0, 0.5);
        let reach = 0.5 * 0.5_f64.sqrt();
        assert!(funnel.holds(&low, reach - 1e-9) && !funnel.holds(&low, reach + 1e-9) && fits > reach);
    }
}
