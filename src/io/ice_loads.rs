//! Loads of level ice: ISO 19906:2010, A.8.2.4.3.3 (crushing), A.8.2.4.4.2 (cones, Ralston 1977).

use std::f64::consts::FRAC_PI_2;

/// Acceleration of gravity [m/s²].
const GRAVITY: f64 = 9.81;

/// Yield of plates after Tresca (Ralston 1977).
const TRESCA: f64 = 2.711;

/// Returns the crushing load [N] on a vertical width [m]; thickness [m], strength coefficient C_R [Pa].
pub fn crushing(width: f64, thickness: f64, strength: f64) -> f64 {
    let exponent = if thickness < 1.0 { -0.5 + 0.2 * thickness } else { -0.3 };
    let pressure = strength * libm::pow(thickness, exponent) * libm::pow(width / thickness, -0.16);
    pressure * width * thickness
}

/// Upward breaking cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Width at the waterline [m].
    pub width: f64,
    /// Width at the top [m].
    pub top_width: f64,
    /// Slope from the horizontal [rad].
    pub angle: f64,
    /// Friction of ice on the cone.
    pub friction: f64,
    /// Ice thickness [m].
    pub thickness: f64,
    /// Thickness of the ridden-up ice [m].
    pub ride_up: f64,
    /// Flexural strength [Pa].
    pub flexural_strength: f64,
    /// Density of the ice [kg/m³].
    pub density: f64,
}

impl Cone {
    /// Returns the horizontal load of breaking and of ride-up [N] after Ralston (plastic limit).
    pub fn load(&self) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(self.angle);
        let tangent = sine / cosine;
        let [first, second] = elliptic(sine);
        let mu = self.friction;
        let f = sine + mu * first * cosine;
        let g = self.lever();
        let ring = self.width * self.width - self.top_width * self.top_width;
        let weight = self.density * GRAVITY * self.ride_up * ring / (4.0 * cosine);
        let stiffness = self.density * GRAVITY * self.width * self.width
            / (4.0 * self.flexural_strength * self.thickness);
        let x = 1.0 + 1.0 / (3.0 * stiffness + 0.5 * TRESCA).sqrt();
        let plate = (1.0 + TRESCA * x * libm::log(x)) / (x - 1.0) + stiffness * (x - 1.0) * (x + 2.0);
        let breaking =
            self.flexural_strength * self.thickness * self.thickness / 3.0 * tangent / (1.0 - mu * g) * plate;
        let ride_up = weight * (tangent + mu * second - mu * f * g * cosine) / (1.0 - mu * g);
        [breaking, ride_up]
    }

    /// Whether the friction is small enough for the ice to slide up.
    pub fn slides(&self) -> bool {
        self.friction * self.lever() < 1.0
    }

    /// Ratio g_r of the horizontal to the vertical load per friction.
    fn lever(&self) -> f64 {
        let (sine, cosine) = libm::sincos(self.angle);
        let friction = 2.0 * self.friction * self.angle * cosine;
        (sine + self.angle / cosine) / (FRAC_PI_2 * sine * sine + friction)
    }
}

/// Complete elliptic integrals of first and second kind of modulus `k`, by the arithmetic-geometric mean.
fn elliptic(k: f64) -> [f64; 2] {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    let (mut sum, mut power) = (0.5 * k * k, 0.5);
    for _ in 0..8 {
        let c = 0.5 * (a - b);
        power *= 2.0;
        sum += power * c * c;
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let first = FRAC_PI_2 / a;
    [first, first * (1.0 - sum)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn close(found: f64, expected: f64, limit: f64) {
        assert!((found - expected).abs() <= limit * expected.abs(), "{found}, expected {expected}");
    }

    /// Width, thickness, C_R; load by an independent program.
    #[test]
    fn crushing_matches_iso_19906() {
        for [width, thickness, strength, load] in [
            [4.0, 0.5, 1.8e6, 3_405_807.528],
            [4.0, 1.0, 2.8e6, 8_971_982.629],
            [1.0, 0.2, 1.8e6, 583_436.374_8],
            [50.0, 1.5, 2.8e6, 106_103_892.8],
        ] {
            close(crushing(width, thickness, strength), load, 1e-9);
        }
    }

    /// Breaking and ride-up by an independent program; the first row is the test case of IEC 61400-3 (IceFloe).
    #[test]
    fn cone_matches_ralston() {
        let cone =
            |width, top_width, thickness, ride_up, flexural_strength, density, degrees: f64, friction| {
                let angle = degrees.to_radians();
                Cone { width, top_width, angle, friction, thickness, ride_up, flexural_strength, density }
            };
        for (cone, expected) in [
            (cone(5.0, 1.5, 1.0, 2.5, 7e5, 916.2, 60.0, 0.15), [3_077_324.345, 667_426.609_2]),
            (cone(6.0, 4.0, 0.3, 0.3, 7e5, 915.0, 60.0, 0.1), [278_706.997_7, 60_940.129_86]),
            (cone(6.0, 4.0, 0.3, 0.3, 7e5, 915.0, 45.0, 0.1), [155_260.275_6, 24_239.853_57]),
            (cone(6.0, 4.0, 0.3, 0.3, 7e5, 915.0, 60.0, 0.0), [214_388.399_5, 46_641.443_57]),
            (cone(10.0, 4.0, 0.5, 0.5, 5e5, 915.0, 55.0, 0.15), [589_360.008, 341_776.007_1]),
        ] {
            assert!(cone.slides());
            for (found, expected) in cone.load().into_iter().zip(expected) {
                close(found, expected, 1e-8);
            }
        }
        assert!(!cone(6.0, 4.0, 0.3, 0.3, 7e5, 915.0, 80.0, 0.9).slides());
    }
}
