//! Flat disk as contact target of corners, edges and rims.

use super::circle::{self, Circle, Turns};
use super::disk::distance;
use super::edge_contact::{Nearest, Segment, Stretch};
use super::scan::{self, Places};
use crate::base::Vec3;

/// Flat disk ([`super::press::Target`]).
pub struct Flat(pub f64);

impl Flat {
    pub fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        Some(distance(self.0, p)).filter(|(d, _)| *d < reach && *d > 0.0)
    }

    pub fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let Segment { from, direction, range, .. } = segment;
        let a = direction.x * direction.x + direction.y * direction.y;
        let b = from.x * direction.x + from.y * direction.y;
        let c = from.x * from.x + from.y * from.y - self.0 * self.0;
        let mut places = Places::new();
        let root = b * b - a * c;
        if root > 0.0 {
            let q = -(b + root.sqrt().copysign(b));
            places.extend([q / a, c / q]);
        }
        places.push(-from.z / direction.z);
        places.retain(|s| *s > range[0] && *s < range[1]);
        places.sort_by(f64::total_cmp);
        let at = |s: f64| distance(self.0, &(from + direction * s));
        scan::between(*range, &places, |[low, high]| {
            let middle = from + direction * (0.5 * (low + high));
            if middle.x * middle.x + middle.y * middle.y <= self.0 * self.0 {
                let normal = Vec3::new(0.0, 0.0, middle.z.signum());
                let (at, slope) = (normal.z * from.z, normal.z * direction.z);
                let mut stretch = Stretch([low, high]);
                stretch.cut(at - reach, slope);
                if stretch.some() {
                    f(stretch.0, &Nearest::Plane { normal, at, slope });
                }
                return;
            }
            let gap = |s: f64| {
                let (d, n) = at(s);
                [d - reach, n.dot(direction)]
            };
            scan::below([low, high], [low, high], &gap, |part| f(part, &Nearest::Curve(&at)));
        });
    }

    pub fn turns(
        &self,
        circle: &Circle,
        turns: &Turns,
        reach: f64,
        mut f: impl FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3)),
    ) {
        let outside = |t: f64| {
            let (p, slope) = circle.moving(t);
            [p.x * p.x + p.y * p.y - self.0 * self.0, 2.0 * (p.x * slope.x + p.y * slope.y)]
        };
        let at = |p: &Vec3| distance(self.0, p);
        for &range in &turns.0 {
            let mut places = Places::new();
            scan::roots(circle::ends(range), &outside, &mut places);
            scan::between(range, &places, |part| {
                let middle = 0.5 * (part[0] + part[1]);
                if outside(middle)[0] > 0.0 {
                    return circle.near(part, reach, &at, |part| f(part, &at));
                }
                let normal = Vec3::new(0.0, 0.0, circle.at(middle).z.signum());
                let mut over = Turns::of(part);
                over.cut(circle.along(&normal, reach));
                over.0.iter().for_each(|part| f(*part, &|p: &Vec3| (normal.z * p.z, normal)));
            });
        }
    }
}
