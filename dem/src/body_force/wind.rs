//! Drag of a fluid that moves with one velocity everywhere: wind, or the draught of a train.
//!
//! F = ½ ρ C_d π r² |u| u, u the velocity of the fluid less that of the body's centre, r the radius of the sphere of the body's
//! volume. C_d belongs to that radius and does not change with the speed: crushed stone of sphericity 0.8 has about 1.4, of 0.9
//! 0.9, and a smooth sphere 0.45, at Reynolds numbers of 10⁴ to 10⁵ (Haider & Levenspiel, Powder Technology 58, 1989,
//! eq. 11). No lift, no shelter behind other bodies, no torque.
//!
//! Theory manual: equation (6.34) of `docs/theory/track.md`.

use super::four::{self, ActOnFour, Bodies4};
use super::work::{Act, ForceWork, Seen};
use crate::base::Vec3;
use crate::bodies::table::{Bodies, Body};
use crate::lanes::{Real, V3};

/// Where it is published.
pub(super) const SOURCE: &str = "drag: Haider & Levenspiel, Powder Technology 58, 1989";

/// A fluid that moves with one velocity everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wind {
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Density of the fluid [kg/m³].
    pub density: f64,
    /// Drag coefficient [-], of the sphere of a body's volume.
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
    /// Time in which the lightest body takes on the speed of the fluid [s]: m/(ρ C_d π r² u), r of the sphere around it, u the speed of
    /// the fluid and that at which the body falls in it.
    pub(super) fn time_constant(&self, bodies: &Bodies, gravity: &Vec3) -> f64 {
        let time = |b: Body| {
            let area = self.density * self.drag * std::f64::consts::PI * b.radius * b.radius;
            let falling = (2.0 * b.mass * gravity.norm() / area).sqrt();
            b.mass / (area * (self.velocity.norm() + falling))
        };
        let free = bodies.iter().filter(|b| b.inverse_mass > 0.0);
        // A fluid without density or drag has none.
        free.map(time).filter(|t| t.is_finite()).fold(f64::INFINITY, f64::min)
    }
}

impl Act for Wind {
    fn act(&self, seen: &Seen<'_>, work: &mut ForceWork) {
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
