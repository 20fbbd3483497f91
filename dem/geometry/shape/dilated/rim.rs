//! Contact of a disk rim, integrated (`edge_contact.rs`) over fixed arcs, which provide friction points for rolling.

use super::circle::{Circle, Turns};
use super::disk::ARCS;
use super::edge_contact::{CURVED, Indentation, Target};
use crate::base::Vec3;
use std::f64::consts::TAU;

/// Sums over an arc.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// ∫ (R − d) n ds, ∫ (R − d) p × n ds, ∫ (R − d) p ds, ∫ (R − d) ds and ∫ (R − d)² ds.
    force: Vec3,
    torque: Vec3,
    place: Vec3,
    whole: f64,
    squares: f64,
}

impl Sum {
    fn add(&mut self, circle: &Circle, [low, high]: [f64; 2], reach: f64, at: &dyn Fn(&Vec3) -> (f64, Vec3)) {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        for [x, w] in CURVED {
            let p = circle.at(middle + half * x);
            let (d, n) = at(&p);
            let overlap = reach - d;
            let part = half * w * overlap;
            let force = n * part;
            self.force += force;
            self.torque += p.cross(&force);
            self.place += p * part;
            self.whole += part;
            self.squares += part * overlap;
        }
    }

    /// Equivalent force at the mean position; `radius` of the circle.
    fn pressed(&self, radius: f64) -> Option<Indentation> {
        let size = self.force.norm();
        if size <= 0.0 || self.whole <= 0.0 {
            return None;
        }
        let point = self.place / self.whole;
        let couple = (self.torque - point.cross(&self.force)) / size;
        Some(Indentation {
            force: self.force * radius,
            overlap: self.squares / size,
            point,
            couple,
            edge: true,
        })
    }
}

/// Calls `put` with each arc in contact.
pub fn rim(
    target: &impl Target,
    circle: &Circle,
    floor: [f64; 3],
    reach: f64,
    mut put: impl FnMut(u32, &Indentation),
) {
    let mut turns = Turns::whole();
    turns.cut(floor);
    if !turns.some() {
        return;
    }
    let turns = turns.cells();
    let mut sums = [Sum::default(); ARCS];
    const STEP: f64 = TAU / ARCS as f64;
    target.turns(circle, &turns, reach, |range, at| {
        for (k, sum) in sums.iter_mut().enumerate() {
            let part = [range[0].max(k as f64 * STEP), range[1].min((k + 1) as f64 * STEP)];
            if part[0] < part[1] {
                sum.add(circle, part, reach, at);
            }
        }
    });
    let radius = circle.x.norm();
    for (k, sum) in sums.iter().enumerate() {
        if let Some(pressed) = sum.pressed(radius) {
            put(k as u32, &pressed);
        }
    }
}
