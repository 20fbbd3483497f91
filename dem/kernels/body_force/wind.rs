//! Drag of a fluid of uniform velocity, such as wind.
//!
//! C_d at Reynolds numbers of 10⁴ to 10⁵: crushed stone of sphericity 0.8 about 1.4, 0.9 about 0.9, a smooth
//! sphere 0.45 (Haider & Levenspiel, Powder Technology 58, 1989, eq. 11). No lift, shelter or torque.
//!
//! Theory manual: equation (6.34) of `docs/theory/track.md`.

use super::four::{self, ActOnFour, Bodies4};
use super::work::{BodyForceModel, ForceInput, ForceWork};
use crate::base::Vec3;
use crate::bodies::table::{Bodies, Body};
use crate::lanes::{Real, V3};

pub(super) const SOURCE: &str = "drag: Haider & Levenspiel, Powder Technology 58, 1989";

/// Fluid of uniform velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wind {
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Density of the fluid [kg/m³].
    pub density: f64,
    /// Drag coefficient [-], for the volume-equivalent sphere.
    pub drag: f64,
}

impl Wind {
    pub(super) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        let good = |x: f64| x >= 0.0 && x.is_finite();
        if let Some(&v) = self.velocity.iter().find(|v| !v.is_finite()) {
            return Some(("velocity", v, "be finite"));
        }
        [("density", self.density), ("drag coefficient", self.drag)]
            .into_iter()
            .find(|&(_, x)| !good(x))
            .map(|(what, x)| (what, x, "be zero or positive, and finite"))
    }
}

impl Wind {
    /// Response time of the lightest body [s]: m/(ρ C_d π r² u), r bounding radius, u fluid plus terminal
    /// speed.
    pub(super) fn time_constant(&self, bodies: &Bodies, gravity: &Vec3) -> f64 {
        let time = |b: Body| {
            let area = self.density * self.drag * std::f64::consts::PI * b.radius * b.radius;
            let falling = (2.0 * b.mass * gravity.norm() / area).sqrt();
            b.mass / (area * (self.velocity.norm() + falling))
        };
        let free = bodies.iter().filter(|b| b.inverse_mass > 0.0);
        // Infinite without density or drag.
        free.map(time).filter(|t| t.is_finite()).fold(f64::INFINITY, f64::min)
    }
}

impl BodyForceModel for Wind {
    fn act(&self, seen: &ForceInput<'_>, work: &mut ForceWork) {
        four::act(self, seen, work);
    }
}

impl ActOnFour for Wind {
    #[inline(always)]
    fn act_on_four<R: Real>(&self, on: &Bodies4<R>) -> (V3<R>, V3<R>) {
        let v = &self.velocity;
        let past = V3::new(R::splat(v.x), R::splat(v.y), R::splat(v.z)) - on.velocity;
        let share = R::splat(0.5 * std::f64::consts::PI * self.density * self.drag);
        (past * (share * on.radius * on.radius * past.norm2().sqrt()), V3::zero())
    }
}
