//! Water: buoyancy and drag at any depth and tilt, current, waves, added mass.
//!
//! Drag moment −½ ρ C_M r³ A_wet |ω| ω about the centre: Liu, Long & Ji 2015, eq. 26, 27.
//!
//! Limits: no lift, shelter, added moment of inertia or diffraction.
//!
//! Theory manual: equations (6.29), (6.30), (6.31) of `docs/theory/track.md`.

mod wave;

pub use wave::{Measured, Orbit, Wave, WaveError};

use super::skin::Wet;
use super::work::{BodyForceModel, ForceInput, ForceWork};
use crate::base::Vec3;
use crate::bodies::table::{Bodies, BodyKind};
use crate::lanes::vec4::xyz;
use std::f64::consts::PI;

pub(super) const SOURCE: &str =
    "drag: Liu, Long & Ji, Chin. J. Theor. Appl. Mech. 47, 2015; waves: Dean & Dalrymple 1991";

/// Reference area of drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DragArea {
    /// Wet area projected along the flow.
    #[default]
    Projected,
    /// The whole wet surface.
    Wetted,
}

/// Water below a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Water {
    /// Height of still water [m].
    pub level: f64,
    /// Density [kg/m³].
    pub density: f64,
    /// Current along x and y [m/s].
    pub current: [f64; 2],
    /// Waves.
    pub wave: Option<Wave>,
    /// Drag coefficient of `drag_area` [-].
    pub drag: f64,
    /// Reference area of `drag`.
    pub drag_area: DragArea,
    /// Skin drag coefficient of the wet surface [-].
    pub skin_drag: f64,
    /// Coefficient of the drag moment [-].
    pub drag_moment: f64,
    /// Added mass coefficient C_m, relative to displaced mass [-].
    pub added_mass: f64,
}

impl Water {
    pub(super) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        if let Some(&v) = [self.level].iter().chain(&self.current).find(|v| !v.is_finite()) {
            return Some(("level or current of the water", v, "be finite"));
        }
        let good = |x: f64| x >= 0.0 && x.is_finite();
        [
            ("density of the water", self.density),
            ("drag coefficient", self.drag),
            ("skin drag coefficient", self.skin_drag),
            ("drag coefficient of turning", self.drag_moment),
            ("added mass coefficient", self.added_mass),
        ]
        .into_iter()
        .find(|&(_, x)| !good(x))
        .map(|(what, x)| (what, x, "be zero or positive, and finite"))
    }

    /// Heave time per radian [s]: √(m/(ρ g A)), A an upper bound.
    pub(super) fn time_constant(&self, bodies: &Bodies, gravity: &Vec3) -> f64 {
        let stiffness = |radius: f64| self.density * gravity.norm() * PI * radius * radius;
        let time = |b: crate::bodies::table::Body| (b.mass / stiffness(b.radius)).sqrt();
        bodies.iter().map(time).fold(f64::INFINITY, f64::min)
    }

    /// Without current.
    fn orbit(&self, at: &Vec3, time: f64) -> Orbit {
        self.wave.map_or(Orbit::default(), |wave| wave.at(at.x, at.y, at.z - self.level, time))
    }

    fn on_body(&self, seen: &ForceInput<'_>, k: usize, work: &mut ForceWork) {
        let block = seen.block;
        let (centre, velocity, spin) = (xyz(&block.centre[k]), xyz(&block.velocity[k]), xyz(&block.spin[k]));
        let orbit = self.orbit(&centre, seen.time);
        let level = self.level + orbit.elevation - centre.z;
        let past = Vec3::new(self.current[0], self.current[1], 0.0) + orbit.velocity - velocity;
        let (wet, reach) = wet_part(seen, k, level, &past, work);
        if wet.volume <= 0.0 {
            return;
        }
        let displaced = self.density * wet.volume;
        let lift = (orbit.acceleration - seen.gravity) * displaced;
        let added = self.added_mass * displaced;
        let carried = orbit.acceleration * added;
        let area = match self.drag_area {
            DragArea::Projected => self.drag * wet.seen,
            DragArea::Wetted => self.drag * wet.area,
        } + self.skin_drag * wet.area;
        let drag = |past: &Vec3| past * (0.5 * self.density * area * past.norm());
        // Velocity half a step ago, advanced to the present time.
        let mass = seen.bodies.mass(block.bodies[k] as usize);
        let others = xyz(seen.sums[k].force()) + seen.gravity * mass + lift + carried;
        let now = past - (others + drag(&past)) * (0.5 * seen.kick / (mass + added));
        let force = lift + drag(&now);
        let brake = 0.5 * self.density * self.drag_moment * reach.powi(3) * wet.area * spin.norm();
        work.acting[k].push(&(force + carried), &(wet.arm.cross(&force) - spin * brake));
        if added > 0.0 {
            work.add_mass(k, added);
        }
    }
}

impl BodyForceModel for Water {
    fn act(&self, seen: &ForceInput<'_>, work: &mut ForceWork) {
        for k in 0..seen.block.bodies.len() {
            self.on_body(seen, k, work);
        }
    }
}

fn wet_part(seen: &ForceInput<'_>, k: usize, level: f64, past: &Vec3, work: &mut ForceWork) -> (Wet, f64) {
    let members = seen.members;
    let radius = work.radius[k];
    let kind = if members.rigid { members.kind[k] } else { BodyKind::Sphere };
    if kind == BodyKind::Sphere && level >= radius {
        return (submerged(radius), radius);
    }
    let speed = past.norm();
    let along = if speed > 0.0 { past / speed } else { Vec3::x() };
    let wet = match kind {
        BodyKind::Sphere => ball(radius, level, &along),
        BodyKind::Clump => {
            let whole = 4.0 / 3.0 * PI * radius.powi(3);
            let middle = xyz(&seen.block.centre[k]);
            let spheres = members.spheres_of(k).iter().map(|s| (xyz(s) - middle, s[3]));
            clump(spheres, whole, radius, level)
        }
        BodyKind::Solid => {
            let (shape, scale) = members.solids[k];
            let turn = &seen.block.rotation[k].orientation;
            let [up, along] = [&Vec3::z(), &along].map(|x| turn.inverse_transform_vector(x));
            let skin = &seen.skins[shape as usize];
            let wet = skin.below(&up, level / scale, &along, &mut work.heights);
            let (length, area) = (scale, scale * scale);
            let wet = Wet {
                volume: wet.volume * area * length,
                arm: turn * wet.arm * length,
                area: wet.area * area,
                seen: wet.seen * area,
            };
            return (wet, skin.reach * scale);
        }
    };
    (wet, radius)
}

/// Ball below the level: the same area from all sides.
fn submerged(r: f64) -> Wet {
    let circle = PI * r * r;
    Wet { volume: 4.0 / 3.0 * circle * r, arm: Vec3::zeros(), area: 4.0 * circle, seen: circle }
}

/// Spherical cap (Bronstein & Semendjajew).
fn ball(r: f64, level: f64, along: &Vec3) -> Wet {
    let h = (r + level).clamp(0.0, 2.0 * r);
    let volume = PI * h * h * (r - h / 3.0);
    if volume <= 0.0 {
        return Wet::default();
    }
    let low = 2.0 * r - h;
    let arm = -0.75 * low * low / (3.0 * r - h);
    let s = (h - r) / r;
    let side = r * r * (0.5 * PI + libm::asin(s) + s * (1.0 - s * s).max(0.0).sqrt());
    let below = PI * if h < r { h * low } else { r * r };
    let flat = along.x * along.x + along.y * along.y;
    let seen = (side * side * flat + below * below * along.z * along.z).sqrt();
    Wet { volume, arm: Vec3::z() * arm, area: 2.0 * PI * r * h, seen }
}

/// Member spheres, scaled to the clump's volume; areas of the volume-equivalent sphere.
fn clump(spheres: impl Iterator<Item = (Vec3, f64)>, whole: f64, radius: f64, level: f64) -> Wet {
    let (mut all, mut off) = (0.0, Vec3::zeros());
    let (mut volume, mut moment) = (0.0, Vec3::zeros());
    for (at, r) in spheres {
        let full = 4.0 / 3.0 * PI * r.powi(3);
        let wet = ball(r, level - at.z, &Vec3::x());
        all += full;
        off += at * full;
        volume += wet.volume;
        moment += (at + wet.arm) * wet.volume;
    }
    if volume <= 0.0 {
        return Wet::default();
    }
    let share = volume / all;
    // Fully wet: centre of mass.
    let arm = (moment - off * share) / volume;
    let surface = PI * radius * radius;
    Wet { volume: whole * share, arm, area: 4.0 * surface * share, seen: surface * share }
}

#[cfg(test)]
#[path = "water_tests.rs"]
mod tests;
