//! Ground that falling rocks scar: soil that gives way over a plane that does not.
//!
//! A rock that comes down at the vertical speed v sinks by d = 0.1 M^⅓ Me^−0.4 v^0.8 (M its mass [kg], Me the mechanical strength of the
//! soil [kPa]) before the soil is as hard as rock: from there on contacts are those of two solids. Until it has left the soil, the drag
//! ½ C ρ A |u| u is on its centre of mass, A the area of its part below the surface as seen along its velocity u. Soil piles up before
//! it while it slides, so friction grows with the way s that its centre of mass has made while it touches,
//! μ = μ₀ + 2/π (μ₁ − μ₀) atan(κ s); once it touches no more, ds/dt = −β s.
//!
//! Sources: Lu, Caviezel, Christen, Demmel, Ringenbach, Bühler, Dinneen, Gerber & Bartelt, Landslides 16, 2019, 2353–2367 (eqs 9, 11 to 14); friction:
//! Leine, Schweizer, Christen, Glover, Bartelt & Gerber, Multibody Syst. Dyn. 32, 2014, 241–271 (eqs 46, 47).
//!
//! Limits: the drag gives no torque. Soil below the surface is as deep as a rock sinks, and the scar is forgotten when the rock has left.
//!
//! Theory manual: equations (6.37), (6.38) of `docs/theory/track.md`.

use crate::base::Vec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_2_PI;

/// Where it is published.
pub const SOURCE: &str = "ground that rocks scar: Lu and others, Landslides 16, 2019; Leine and others, Multibody Syst. Dyn. 32, 2014";

/// Ground that rocks scar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scarring {
    /// Mechanical strength of the soil Me [Pa].
    pub strength: f64,
    /// Drag coefficient of the soil C, that of its flow (1) and that of its compaction together [-].
    pub drag: f64,
    /// Density of the soil [kg/m³].
    pub density: f64,
    /// Friction coefficient where a rock has not slid, μ₀, and where it has slid far, μ₁ [-].
    pub friction: [f64; 2],
    /// How fast friction grows with the way, κ [1/m].
    pub growth: f64,
    /// How fast that way is forgotten, β [1/s].
    pub decay: f64,
}

impl Scarring {
    /// What of it is out of range.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let not_negative = |x: f64| x >= 0.0 && x.is_finite();
        let [first, last] = self.friction;
        let good = positive(self.strength)
            && [self.drag, self.density, self.growth, self.decay, first].into_iter().all(not_negative)
            && last >= first
            && last.is_finite();
        (!good).then_some(
            "ground that is scarred needs a strength above zero, a drag, a density, a growth and a decay that are zero or positive, and \
             two coefficients of friction that do not fall",
        )
    }

    /// How deep a rock sinks that comes down at a vertical speed [m].
    pub fn depth(&self, mass: f64, speed: f64) -> f64 {
        0.1 * libm::cbrt(mass) * libm::pow(self.strength * 1e-3, -0.4) * libm::pow(speed.max(0.0), 0.8)
    }

    /// Friction coefficient after a way [m].
    pub fn friction(&self, way: f64) -> f64 {
        let [first, last] = self.friction;
        first + FRAC_2_PI * (last - first) * libm::atan(self.growth * way)
    }

    /// The way after another step of `dt` [s] at a speed [m/s], with or without a contact.
    pub fn way(&self, way: f64, touches: bool, speed: f64, dt: f64) -> f64 {
        if touches { way + speed * dt } else { way * libm::exp(-self.decay * dt) }
    }

    /// Drag over the square of the speed of a rock with an area in the soil [m²], [kg/m].
    pub fn resistance(&self, area: f64) -> f64 {
        0.5 * self.drag * self.density * area
    }
}

/// What a rock does to such ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scar {
    /// Whether it is in the soil.
    pub inside: bool,
    /// The way that the ground gives way beneath it [m].
    pub sunk: Vec3,
    /// The way that friction has grown with [m].
    pub way: f64,
    /// Drag over the square of its speed [kg/m].
    pub resistance: f64,
    /// Friction coefficient [-].
    pub friction: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHANT_SURA: Scarring = Scarring {
        strength: 15e6,
        drag: 2.5,
        density: 1700.0,
        friction: [0.55, 2.0],
        growth: 3.0,
        decay: 185.0,
    };

    /// Depths that Lu and others compute for four impacts of 780 kg (their table 3, two digits). Their table 2 has the speed at the start of each
    /// simulation, their figure 8 when the rock meets the ground, to about 0.01 s.
    #[test]
    fn depths_are_the_published_ones() {
        for (strength, speed, fall, depth) in [
            (25e6, 11.20, 0.32, 0.14),
            (15e6, 10.74, 0.28, 0.16),
            (10e6, 10.36, 0.22, 0.18),
            (10e6, 8.52, 0.36, 0.18),
        ] {
            let found = Scarring { strength, ..CHANT_SURA }.depth(780.0, speed + 9.81 * fall);
            println!("{strength:e} Pa: {found:.3} m, published {depth} m");
            assert!((found - depth).abs() < 0.012, "{found} {depth}");
        }
    }

    #[test]
    fn friction_grows_with_the_way_and_is_forgotten() {
        let own = CHANT_SURA;
        assert_eq!(own.friction(0.0), 0.55);
        // atan 1 = π/4: half way up.
        assert!((own.friction(1.0 / 3.0) - 1.275).abs() < 1e-12);
        assert!((own.friction(1e9) - 2.0).abs() < 1e-6);
        let mut way = 0.0;
        for _ in 0..1000 {
            way = own.way(way, true, 5.0, 1e-4);
        }
        assert!((way - 0.5).abs() < 1e-12);
        for _ in 0..1000 {
            way = own.way(way, false, 5.0, 1e-4);
        }
        assert!((way / (0.5 * libm::exp(-18.5)) - 1.0).abs() < 1e-9);
    }
}
