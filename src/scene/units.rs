//! Scene quantities: SI number, or string with unit such as `"20 MPa"`.

use serde::de::{self, Deserialize, Deserializer, Unexpected, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Physical dimension with accepted units.
pub trait Dimension {
    /// Noun phrase with an example, for errors.
    const EXPECTED: &'static str;
    /// Accepted units with factors to SI.
    const UNITS: &'static [(&'static str, f64)];
    /// Largest magnitude [SI unit]: keeps squares and products finite.
    const MOST: f64 = f64::MAX;
}

/// A number in SI units of dimension `D`.
pub struct Quantity<D> {
    /// Value in SI units.
    pub si: f64,
    dimension: PhantomData<D>,
}

impl<D> Quantity<D> {
    /// Creates a quantity of `si` SI units.
    pub const fn new(si: f64) -> Quantity<D> {
        Quantity { si, dimension: PhantomData }
    }
}

impl<D> Clone for Quantity<D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D> Copy for Quantity<D> {}

impl<D> fmt::Debug for Quantity<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.si)
    }
}

/// Returns the values of three quantities.
pub fn vector<D>(v: &[Quantity<D>; 3]) -> [f64; 3] {
    [v[0].si, v[1].si, v[2].si]
}

macro_rules! dimensions {
    ($($(#[$doc:meta])* $name:ident: $expected:literal, [$(($unit:literal, $factor:expr)),*] $(, $most:literal)?;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;
        impl Dimension for $name {
            const EXPECTED: &'static str = $expected;
            const UNITS: &'static [(&'static str, f64)] = &[$(($unit, $factor)),*];
            $(const MOST: f64 = $most;)?
        }
    )*};
}

dimensions! {
    /// Length [m].
    Length: "a length in m, such as 0.3 or \"300 mm\"", [("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("km", 1e3)], 1e15;
    /// Time [s].
    Time: "a time in s, such as 0.1 or \"100 ms\"", [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0), ("h", 3600.0)];
    /// Frequency [Hz].
    Frequency: "a frequency in Hz, such as 10 or \"10 Hz\"", [("Hz", 1.0), ("kHz", 1e3), ("1/s", 1.0)], 1e15;
    /// Mass [kg].
    Mass: "a mass in kg, such as 300 or \"300 kg\"", [("kg", 1.0), ("t", 1e3), ("g", 1e-3)], 1e30;
    /// Mass per time [kg/s].
    MassRate: "a mass per time in kg/s, such as 2 or \"2 kg/s\"", [("kg/s", 1.0), ("g/s", 1e-3), ("t/h", 1.0 / 3.6), ("kg/min", 1.0 / 60.0)];
    /// Density [kg/m³].
    Density: "a density in kg/m3, such as 2000 or \"2 t/m3\"", [("kg/m3", 1.0), ("t/m3", 1e3), ("g/cm3", 1e3)];
    /// Stress or pressure [Pa].
    Stress: "a stress in Pa, such as 2e7 or \"20 MPa\"", [("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9), ("N/mm2", 1e6), ("kN/m2", 1e3)];
    /// Force [N].
    Force: "a force in N, such as 5e4 or \"50 kN\"", [("N", 1.0), ("kN", 1e3), ("MN", 1e6)], 1e30;
    /// Stiffness [N/m].
    Stiffness: "a stiffness in N/m, such as 2e6 or \"2 MN/m\"", [("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6), ("N/mm", 1e3), ("kN/mm", 1e6), ("GN/m", 1e9)], 1e30;
    /// Energy over area [J/m²].
    Adhesion: "a work of adhesion in J/m2, such as 0.05 or \"50 mJ/m2\"", [("J/m2", 1.0), ("mJ/m2", 1e-3), ("N/m", 1.0)];
    /// Velocity [m/s].
    Velocity: "a velocity in m/s, such as 0.1 or \"10 cm/s\"", [("m/s", 1.0), ("mm/s", 1e-3), ("cm/s", 1e-2), ("km/h", 1.0 / 3.6)], 1e15;
    /// Acceleration [m/s²].
    Acceleration: "an acceleration in m/s2, such as -9.81 or \"1 g\"", [("m/s2", 1.0), ("g", 9.806_65)], 1e15;
    /// Angular velocity [rad/s].
    Spin: "an angular velocity in rad/s, such as 1.5", [("rad/s", 1.0), ("1/s", 1.0)], 1e15;
    /// Angle [rad].
    Angle: "an angle in rad, or with its unit such as \"60 deg\"", [("rad", 1.0), ("deg", std::f64::consts::PI / 180.0)];
    /// Mass per length [kg/m].
    LineMass: "a mass per length in kg/m, such as 60", [("kg/m", 1.0), ("t/m", 1e3)], 1e30;
    /// Bending stiffness [N m²].
    Bending: "a bending stiffness in N m2, such as 6.4e6 or \"6.4 MN m2\"", [("N m2", 1.0), ("kN m2", 1e3), ("MN m2", 1e6)], 1e30;
    /// Damping of a dashpot [N s/m].
    Dashpot: "a damping in N s/m, such as 4e4 or \"40 kN s/m\"", [("N s/m", 1.0), ("kN s/m", 1e3), ("MN s/m", 1e6)], 1e30;
    /// Rate [1/s].
    Rate: "a rate in 1/s, such as 4.2", [("1/s", 1.0)];
}

impl<'de, D: Dimension> Deserialize<'de> for Quantity<D> {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct QuantityVisitor<D>(PhantomData<D>);
        impl<D: Dimension> Visitor<'_> for QuantityVisitor<D> {
            type Value = Quantity<D>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(D::EXPECTED)
            }
            fn visit_f64<E: de::Error>(self, v: f64) -> Result<Self::Value, E> {
                match v {
                    _ if !v.is_finite() => Err(E::invalid_value(Unexpected::Float(v), &self)),
                    _ if v.abs() > D::MOST => {
                        let expected = format!("{}, at most {:e}", D::EXPECTED, D::MOST);
                        Err(E::invalid_value(Unexpected::Other(&format!("{v:e}")), &expected.as_str()))
                    }
                    _ => Ok(Quantity::new(v)),
                }
            }
            fn visit_i64<E: de::Error>(self, v: i64) -> Result<Self::Value, E> {
                self.visit_f64(v as f64)
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
                match parse::<D>(text).filter(|v| v.is_finite()) {
                    Some(value) => self.visit_f64(value),
                    None => Err(E::invalid_value(Unexpected::Str(text), &self)),
                }
            }
        }
        deserializer.deserialize_any(QuantityVisitor(PhantomData))
    }
}

fn parse<D: Dimension>(text: &str) -> Option<f64> {
    let text = text.trim();
    let number = |text: &str| text.trim_end().parse().ok().filter(|v: &f64| v.is_finite());
    // A unit may follow without blank. "5mm" ends in "m" too, but "5m" is no number.
    let with_unit = |(unit, factor): &(&str, f64)| Some(number(text.strip_suffix(unit)?)? * factor);
    number(text).or_else(|| D::UNITS.iter().find_map(with_unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_si_and_units_convert() {
        assert_eq!(parse::<Stress>("20 MPa"), Some(2e7));
        assert_eq!(parse::<Stress>("2e7"), Some(2e7));
        assert_eq!(parse::<Velocity>("36 km/h"), Some(10.0));
        assert_eq!(parse::<Angle>("180 deg"), Some(std::f64::consts::PI));
        assert_eq!(parse::<Stress>("20MPa"), Some(2e7));
        assert_eq!(parse::<Length>("5mm"), Some(5.0 * 1e-3));
        assert_eq!(parse::<Length>("1e-2 m"), Some(1e-2));
        assert_eq!(parse::<super::Dashpot>("4 kN s/m"), Some(4e3));
    }

    #[test]
    fn rejects_overflowing_magnitudes() {
        #[derive(Debug, serde::Deserialize)]
        struct Keys {
            x: Option<Quantity<Length>>,
            v: Option<Quantity<Velocity>>,
            k: Option<Quantity<super::Stiffness>>,
        }
        let read = |text: &str| toml::from_str::<Keys>(text).map_err(|e| e.message().to_string());
        let keys = read("x = -1e15\nv = 3e8\nk = \"1e3 GN/m\"").unwrap();
        assert_eq!([keys.x.unwrap().si, keys.v.unwrap().si, keys.k.unwrap().si], [-1e15, 3e8, 1e12]);
        for (text, found) in [
            ("x = -1e300", "-1e300"),
            ("x = \"1e13 km\"", "1e16"),
            ("v = 1e155", "1e155"),
            ("k = 1e300", "1e300"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.starts_with(&format!("invalid value: {found}, expected a ")), "{error}");
            assert!(error.contains(", at most 1e"), "{error}");
        }
    }

    #[test]
    fn rejects_unit_of_other_dimension() {
        assert_eq!(parse::<Stress>("20 kg"), None);
        assert_eq!(parse::<Length>("2 s"), None);
        assert_eq!(parse::<Length>("wide"), None);
        assert_eq!(parse::<Length>("nan m"), None);
        assert_eq!(parse::<Length>("nanm"), None);
        assert_eq!(parse::<Length>("5m m"), None);
    }
}
