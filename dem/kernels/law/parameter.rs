//! Parameters of materials and pairs, for validation, warnings and scene schema.

use super::damping::Damping;
use super::material::{Material, PairOverride};
use std::fmt;

/// Valid values of a parameter, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Least value.
    pub low: f64,
    /// Largest value; infinite where no bound exists.
    pub high: f64,
    /// Whether the least and the largest value themselves are excluded.
    pub open: [bool; 2],
}

impl Range {
    const POSITIVE: Range = Range { low: 0.0, high: f64::INFINITY, open: [true, false] };
    const NOT_NEGATIVE: Range = Range { low: 0.0, high: f64::INFINITY, open: [false, false] };

    const fn closed(low: f64, high: f64) -> Range {
        Range { low, high, open: [false, false] }
    }

    /// Whether a finite value lies within.
    pub fn contains(&self, value: f64) -> bool {
        let low = if self.open[0] { value > self.low } else { value >= self.low };
        let high = if self.open[1] { value < self.high } else { value <= self.high };
        value.is_finite() && low && high
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Range { low, high, open } = self;
        match (open, high.is_finite()) {
            ([true, _], false) => write!(f, "above {low}"),
            ([false, _], false) => write!(f, "{low} or more"),
            ([false, false], true) => write!(f, "{low} to {high}"),
            ([true, false], true) => write!(f, "above {low}, at most {high}"),
            ([true, true], true) => write!(f, "above {low}, below {high}"),
            ([false, true], true) => write!(f, "{low} or more, below {high}"),
        }
    }
}

/// Values that occur in practice, in the unit of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Typical {
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Whether zero is typical too, as it switches an effect off.
    pub or_zero: bool,
}

/// A parameter of `T`: a material, or a pair of materials.
pub struct Parameter<T> {
    /// Key in a scene.
    pub key: &'static str,
    /// Unit; empty for a ratio.
    pub unit: &'static str,
    /// One unit in SI units.
    pub si: f64,
    /// Valid values.
    pub range: Range,
    /// Values that occur in practice.
    pub typical: Typical,
    /// Its value [SI units]; `None` where it is not set.
    pub get: fn(&T) -> Option<f64>,
}

impl<T> Parameter<T> {
    /// Value in the unit of the parameter; `None` where it is not set.
    pub fn value(&self, of: &T) -> Option<f64> {
        (self.get)(of).map(|value| value / self.si)
    }

    /// Valid values with the unit.
    pub fn expected(&self) -> String {
        format!("{} {}", self.range, self.unit).trim_end().to_string()
    }
}

/// The first parameter of `of` out of its range, with the value.
pub fn first_invalid<T>(table: &'static [Parameter<T>], of: &T) -> Option<(&'static Parameter<T>, f64)> {
    table.iter().find_map(|p| p.value(of).filter(|value| !p.range.contains(*value)).map(|value| (p, value)))
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

const fn typical(low: f64, high: f64) -> Typical {
    Typical { low, high, or_zero: false }
}

const fn typical_or_zero(low: f64, high: f64) -> Typical {
    Typical { low, high, or_zero: true }
}

/// Infinite values mean that a limit does not exist: a rigid wall, corners that do not crush.
fn limited(value: f64) -> Option<f64> {
    Some(value).filter(|v| *v != f64::INFINITY)
}

/// One line of a table.
macro_rules! parameters {
    ($of:ty: $($key:literal [$unit:literal $(= $si:expr)?] $range:expr, $typical:expr, $get:expr;)*) => {
        [$(Parameter::<$of> {
            key: $key,
            unit: $unit,
            si: 1.0 $(* $si)?,
            range: $range,
            typical: $typical,
            get: $get,
        }),*]
    };
}

/// Models of small grains to blocks of rock of tens of metres.
const STIFFNESS: Typical = typical(10.0, 2e10);
const FRICTION: Typical = typical_or_zero(0.01, 1.5);
const RESTITUTION: Typical = typical(0.01, 1.0);
/// The critical time step falls with the restitution without bound; below 1e-4 of the speed no rebound can be observed.
const RESTITUTION_RANGE: Range = Range::closed(1e-4, 1.0);
const RESISTANCE: Typical = typical_or_zero(1e-4, 0.9);

/// Parameters of a material.
pub const MATERIAL: [Parameter<Material>; 15] = parameters! { Material:
    // Light plastics to lead.
    "density" ["kg/m3"] Range::POSITIVE, typical(300.0, 12_000.0), |m| Some(m.density);
    "stiffness" ["N/m"] Range::POSITIVE, STIFFNESS, |m| limited(m.stiffness);
    // Soft models to diamond.
    "young" ["Pa"] Range::POSITIVE, typical(1e4, 1.2e12), |m| m.young;
    "poisson" [""] Range { low: -1.0, high: 0.5, open: [true, false] }, typical_or_zero(0.01, 0.495), |m| Some(m.poisson);
    "edge_factor" [""] Range::closed(0.01, 100.0), typical(0.2, 5.0), |m| Some(m.edge_factor);
    // Weak model corners to a tenth of the modulus of hard rock.
    "corner_strength" ["Pa"] Range::POSITIVE, typical(1e4, 1e10), |m| limited(m.corner_strength);
    "corner_angle" ["deg" = DEGREE] Range { low: 0.0, high: 90.0, open: [true, true] }, typical(30.0, 89.9),
        |m| limited(m.corner_strength).map(|_| m.corner_angle);
    "tangential_ratio" [""] Range::closed(0.0, 1.0), typical_or_zero(0.05, 2.0), |m| Some(m.tangential_ratio);
    "tangential_damping_ratio" [""] Range::closed(0.0, 1.0), typical_or_zero(0.0, 1.0), |m| Some(m.tangential_damping_ratio);
    "friction" [""] Range::NOT_NEGATIVE, FRICTION, |m| Some(m.friction);
    // Joints of rough rock reach 75 degrees at small stress.
    "asperity_friction" [""] Range::NOT_NEGATIVE, typical_or_zero(0.05, 4.0), |m| Some(m.asperity_friction);
    "asperity_pressure" ["Pa"] Range::POSITIVE, typical(1e4, 1e9), |m| limited(m.asperity_pressure);
    "restitution" [""] RESTITUTION_RANGE, RESTITUTION, |m| Some(m.restitution);
    "rolling_friction" [""] Range::NOT_NEGATIVE, RESISTANCE, |m| Some(m.rolling_friction);
    "twisting_friction" [""] Range::NOT_NEGATIVE, RESISTANCE, |m| Some(m.twisting_friction);
};

/// Parameters of a pair of materials.
pub const PAIR: [Parameter<PairOverride>; 7] = parameters! { PairOverride:
    "friction" [""] Range::NOT_NEGATIVE, FRICTION, |c| c.friction;
    "restitution" [""] RESTITUTION_RANGE, RESTITUTION, |c| c.restitution;
    "stiffness" ["N/m"] Range::POSITIVE, STIFFNESS, |c| c.stiffness;
    "adhesion" ["J/m2"] Range::NOT_NEGATIVE, typical_or_zero(1e-4, 100.0), |c| c.adhesion;
    "damping_ratio" [""] Range::NOT_NEGATIVE, typical_or_zero(1e-3, 10.0), |c| match c.damping {
        Some(Damping::Ratio(ratio)) => Some(ratio),
        _ => None,
    };
    "rolling_friction" [""] Range::NOT_NEGATIVE, RESISTANCE, |c| c.rolling_friction;
    "twisting_friction" [""] Range::NOT_NEGATIVE, RESISTANCE, |c| c.twisting_friction;
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_read_as_they_check() {
        for (range, text, [within, beyond]) in [
            (Range::POSITIVE, "above 0", [1e-300, 0.0]),
            (Range::NOT_NEGATIVE, "0 or more", [0.0, -1e-300]),
            (Range::closed(0.0, 1.0), "0 to 1", [1.0, 1.1]),
            (MATERIAL[3].range, "above -1, at most 0.5", [0.5, -1.0]),
            (MATERIAL[6].range, "above 0, below 90", [89.9, 90.0]),
        ] {
            assert_eq!(range.to_string(), text);
            assert!(range.contains(within) && !range.contains(beyond), "{text}");
            assert!(!range.contains(f64::NAN) && !range.contains(f64::INFINITY), "{text}");
        }
        assert_eq!(MATERIAL[6].expected(), "above 0, below 90 deg");
    }

    #[test]
    fn typical_values_are_valid() {
        for p in &MATERIAL {
            let Typical { low, high, or_zero } = p.typical;
            assert!(low <= high && (p.range.contains(low) || or_zero), "{}", p.key);
            let default = p.value(&Material::RIGID);
            assert!(default.is_none_or(|v| p.range.contains(v)), "{}: {default:?}", p.key);
        }
        assert!(first_invalid(&MATERIAL, &Material::RIGID).is_none());
        let (p, value) = first_invalid(&MATERIAL, &Material { friction: -0.1, ..Material::RIGID }).unwrap();
        assert_eq!((p.key, value), ("friction", -0.1));
    }
}
