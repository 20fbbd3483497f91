//! Scarring: soil over rigid ground, penetrated and ploughed by falling rocks.
//!
//! Soil drag acts on the centre of mass; friction grows with the path in contact, and the path decays without
//! contact.
//!
//! Sources: Lu, Caviezel, Christen, Demmel, Ringenbach, Bühler, Dinneen, Gerber & Bartelt, Landslides 16,
//! 2019, 2353–2367 (eqs 9, 11 to 14); friction: Leine, Schweizer, Christen, Glover, Bartelt & Gerber,
//! Multibody Syst. Dyn. 32, 2014, 241–271 (eqs 46, 47).
//!
//! Limits: no drag torque; soil as deep as the penetration.
//!
//! Theory manual: eqs (6.37), (6.38), `docs/theory/track.md`.

use crate::base::Vec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_2_PI;

/// Source.
pub const SOURCE: &str = "ground that rocks scar: Lu and others, Landslides 16, 2019; Leine and others, Multibody Syst. Dyn. 32, 2014";

/// Scarred ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scarring {
    /// Soil strength Me [Pa].
    pub strength: f64,
    /// Drag coefficient C, flow (1) plus compaction [-].
    pub drag: f64,
    /// Soil density [kg/m³].
    pub density: f64,
    /// Friction before, μ₀, and after long sliding, μ₁ [-].
    pub friction: [f64; 2],
    /// Friction growth κ [1/m].
    pub growth: f64,
    /// Path decay rate β [1/s].
    pub decay: f64,
}

impl Scarring {
    #[doc(hidden)]
    pub fn fault(&self) -> Option<&'static str> {
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

    /// Returns penetration [m] at a vertical speed [m/s].
    pub fn depth(&self, mass: f64, speed: f64) -> f64 {
        0.1 * libm::cbrt(mass) * libm::pow(self.strength * 1e-3, -0.4) * libm::pow(speed.max(0.0), 0.8)
    }

    /// Returns friction after a path [m].
    pub fn friction(&self, way: f64) -> f64 {
        let [first, last] = self.friction;
        first + FRAC_2_PI * (last - first) * libm::atan(self.growth * way)
    }

    /// Returns the path [m] after a step `dt` [s] at a speed [m/s].
    pub fn update_path(&self, way: f64, touches: bool, speed: f64, dt: f64) -> f64 {
        if touches { way + speed * dt } else { way * libm::exp(-self.decay * dt) }
    }

    /// Returns drag over speed squared [kg/m] for a submerged area [m²].
    pub fn resistance(&self, area: f64) -> f64 {
        0.5 * self.drag * self.density * area
    }
}

/// State of a rock in scarred ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scar {
    /// Whether in the soil.
    pub inside: bool,
    /// Soil displacement [m].
    pub sunk: Vec3,
    /// Path [m].
    pub way: f64,
    /// Drag over speed squared [kg/m].
    pub resistance: f64,
    /// Friction [-].
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

    /// Four impacts of 780 kg by Lu and others (table 3, two digits; speeds of table 2).
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
    fn friction_grows_and_decays() {
        let own = CHANT_SURA;
        assert_eq!(own.friction(0.0), 0.55);
        // atan 1 = π/4.
        assert!((own.friction(1.0 / 3.0) - 1.275).abs() < 1e-12);
        assert!((own.friction(1e9) - 2.0).abs() < 1e-6);
        let mut way = 0.0;
        for _ in 0..1000 {
            way = own.update_path(way, true, 5.0, 1e-4);
        }
        assert!((way - 0.5).abs() < 1e-12);
        for _ in 0..1000 {
            way = own.update_path(way, false, 5.0, 1e-4);
        }
        assert!((way / (0.5 * libm::exp(-18.5)) - 1.0).abs() < 1e-9);
    }
}
