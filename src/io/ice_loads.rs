//! Loads of level ice: ISO 19906:2010, A.8.2.4.3.3 (crushing), A.8.2.4.4.2 (cones, Ralston 1977); ships: G. Lindqvist,
//! A straightforward method for calculation of ice resistance of ships, POAC 1989.

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

/// Sea water [kg/m³], and Poisson's ratio of ice, of [`Ship`].
const SEA_WATER: f64 = 1025.0;
const POISSON: f64 = 0.3;

/// Ship through level ice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ship {
    /// Length of the waterline [m].
    pub length: f64,
    /// Beam at the waterline [m].
    pub beam: f64,
    /// Draught [m].
    pub draught: f64,
    /// Angle φ of the stem with the horizontal [rad].
    pub stem_angle: f64,
    /// Entrance angle α of the waterline, from the centre plane [rad].
    pub entrance_angle: f64,
    /// Speed [m/s].
    pub speed: f64,
    /// Friction of ice on the hull.
    pub friction: f64,
    /// Ice thickness [m].
    pub thickness: f64,
    /// Flexural strength of the ice [Pa].
    pub flexural_strength: f64,
    /// Young's modulus of the ice [Pa].
    pub young: f64,
    /// Density of the ice [kg/m³].
    pub density: f64,
}

impl Ship {
    /// Returns the resistance of crushing, of bending and of submersion [N] after Lindqvist, with speed.
    pub fn resistance(&self) -> [f64; 3] {
        let &Ship { length, beam, draught, thickness, friction: mu, .. } = self;
        let (sin, cos) = libm::sincos(self.stem_angle);
        let (sin_entrance, cos_entrance) = libm::sincos(self.entrance_angle);
        let (stem, entrance) = (sin / cos, sin_entrance / cos_entrance);
        let tan_normal = stem / sin_entrance;
        let cos_normal = 1.0 / libm::hypot(1.0, tan_normal);
        let crushing = 0.5 * self.flexural_strength * thickness * thickness * (stem + mu * cos / cos_normal)
            / (1.0 - mu * sin / cos_normal);
        let foundation = 12.0 * (1.0 - POISSON * POISSON) * GRAVITY * SEA_WATER;
        let bending = 27.0 / 64.0 * self.flexural_strength * beam * thickness * thickness.sqrt()
            / (self.young / foundation).sqrt()
            * (tan_normal + mu * cos / (cos_normal * sin_entrance))
            * (1.0 + 1.0 / cos_normal);
        let slope = libm::hypot(1.0 / sin, 1.0 / entrance);
        let rubbed =
            0.7 * length - draught / stem - beam / (4.0 * entrance) + draught * cos * cos_normal * slope;
        let lost = draught * (beam + draught) / (beam + 2.0 * draught);
        let submersion = (SEA_WATER - self.density) * GRAVITY * thickness * beam * (lost + mu * rubbed);
        let break_up = 1.0 + 1.4 * self.speed / (GRAVITY * thickness).sqrt();
        let sliding = 1.0 + 9.4 * self.speed / (GRAVITY * length).sqrt();
        [crushing * break_up, bending * break_up, submersion * sliding]
    }

    /// Whether the friction is small enough for the stem to crush the ice downwards.
    pub fn slides(&self) -> bool {
        let (sin, cos) = libm::sincos(self.stem_angle);
        let slope = libm::hypot(1.0, sin / cos / libm::sin(self.entrance_angle));
        self.friction * sin * slope < 1.0
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

    /// By hand, with tan ψ = 1.15470, cos ψ = 0.654654: crushing 250,000 · 0.70964/0.92362, bending 4,218,750/134.961 · 1.41928 · 2.52753,
    /// submersion 24,525 · (5.55882 + 4.57154); speed factors of 2 m/s.
    #[test]
    fn resistance_matches_lindqvist() {
        let ship = Ship {
            length: 80.0,
            beam: 20.0,
            draught: 7.0,
            stem_angle: 30_f64.to_radians(),
            entrance_angle: 30_f64.to_radians(),
            speed: 0.0,
            friction: 0.1,
            thickness: 1.0,
            flexural_strength: 5e5,
            young: 2e9,
            density: 900.0,
        };
        let still = [192_080.0, 112_134.0, 248_447.0];
        for (speed, factors) in [(0.0, [1.0; 3]), (2.0, [1.893_97, 1.893_97, 1.671_09])] {
            let found = Ship { speed, ..ship }.resistance();
            for (k, found) in found.into_iter().enumerate() {
                close(found, still[k] * factors[k], 2e-5);
            }
        }
        assert!(ship.slides() && !Ship { friction: 1.4, ..ship }.slides());
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
