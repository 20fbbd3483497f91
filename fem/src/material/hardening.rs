//! Strength as a function of accumulated plastic strain.
//!
//! `d kappa = sqrt(2/3 d eps_p : d eps_p)` (strain hardening; de Souza Neto, Peric and Owen 2008, section
//! 6.3.4).
//!
//! Theory manual: equation (4.11) of `docs/theory/solid.md`.

use super::elastic::InvalidConstant;
use serde::{Deserialize, Serialize};

/// Cohesion [Pa] or friction angle [rad] as a function of `kappa` [-].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Hardening {
    /// Perfect plasticity.
    Constant(f64),
    /// `initial + modulus * kappa`, up to `limit`.
    Linear {
        /// Initial value.
        initial: f64,
        /// Slope; negative for softening.
        modulus: f64,
        /// Final value; required for softening and friction angles.
        limit: Option<f64>,
    },
    /// Points `(kappa, value)`, ascending; linear between, constant outside.
    Table(Vec<(f64, f64)>),
}

impl From<f64> for Hardening {
    fn from(value: f64) -> Self {
        Hardening::Constant(value)
    }
}

impl Hardening {
    /// Value and slope at `kappa`.
    pub fn at(&self, kappa: f64) -> (f64, f64) {
        match self {
            Hardening::Constant(value) => (*value, 0.0),
            Hardening::Linear { initial, modulus, limit } => {
                let value = initial + modulus * kappa;
                match *limit {
                    Some(limit) if *modulus != 0.0 && (value - limit) * modulus >= 0.0 => (limit, 0.0),
                    _ => (value, *modulus),
                }
            }
            Hardening::Table(points) => {
                let after = points.partition_point(|point| point.0 <= kappa);
                if after == 0 || after == points.len() {
                    let end = points.get(after.saturating_sub(1));
                    return (end.map_or(f64::NAN, |point| point.1), 0.0);
                }
                let ((x0, y0), (x1, y1)) = (points[after - 1], points[after]);
                let slope = (y1 - y0) / (x1 - x0);
                (y0 + slope * (kappa - x0), slope)
            }
        }
    }

    /// Whether the value is constant.
    pub fn is_constant(&self) -> bool {
        match self {
            Hardening::Constant(_) => true,
            Hardening::Linear { modulus, .. } => *modulus == 0.0,
            Hardening::Table(points) => points.iter().all(|point| point.1 == points[0].1),
        }
    }

    /// Smallest and largest value; infinite without limit.
    pub fn range(&self) -> (f64, f64) {
        match self {
            Hardening::Constant(value) => (*value, *value),
            Hardening::Linear { initial, modulus, limit } => {
                let end = limit.unwrap_or(initial + modulus * f64::INFINITY);
                if *modulus == 0.0 { (*initial, *initial) } else { (initial.min(end), initial.max(end)) }
            }
            Hardening::Table(points) => points
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.1), high.max(p.1))),
        }
    }

    /// Steepest fall per unit `kappa` (0 or below).
    pub fn steepest_fall(&self) -> f64 {
        match self {
            Hardening::Constant(_) => 0.0,
            Hardening::Linear { modulus, .. } => modulus.min(0.0),
            Hardening::Table(points) => {
                points.windows(2).map(|w| (w[1].1 - w[0].1) / (w[1].0 - w[0].0)).fold(0.0, f64::min)
            }
        }
    }

    /// Maps values by `change`, keeping `kappa`.
    pub fn map(&self, change: impl Fn(f64) -> f64) -> Hardening {
        match self {
            Hardening::Constant(value) => Hardening::Constant(change(*value)),
            Hardening::Table(points) => {
                Hardening::Table(points.iter().map(|point| (point.0, change(point.1))).collect())
            }
            Hardening::Linear { initial, modulus, limit } => {
                let start = change(*initial);
                let modulus = match *limit {
                    Some(limit) if limit != *initial => modulus * (change(limit) - start) / (limit - initial),
                    _ => {
                        let step = 1e-6 * initial.abs().max(1e-6);
                        modulus * (change(initial + step) - start) / step
                    }
                };
                Hardening::Linear { initial: start, modulus, limit: limit.map(change) }
            }
        }
    }

    /// First invalid value; `bounded`: growth needs a limit.
    pub(super) fn invalid_constant(&self, name: &'static str, bounded: bool) -> Option<InvalidConstant> {
        match self {
            Hardening::Constant(value) => (!value.is_finite()).then_some((name, *value, "a finite number")),
            Hardening::Linear { initial, modulus, limit } => {
                if !initial.is_finite() {
                    return Some((name, *initial, "a finite initial value"));
                }
                if !modulus.is_finite() {
                    return Some((name, *modulus, "a finite hardening modulus"));
                }
                match *limit {
                    Some(limit) if !(limit.is_finite() && (limit - initial) * modulus >= 0.0) => Some((
                        name,
                        limit,
                        "a limit of hardening on the side towards which the modulus points",
                    )),
                    None if *modulus < 0.0 || (bounded && *modulus != 0.0) => Some((
                        name,
                        *modulus,
                        "a limit of hardening (softening and friction hardening need one)",
                    )),
                    _ => None,
                }
            }
            Hardening::Table(points) => {
                if points.is_empty() {
                    return Some((name, 0.0, "a hardening table of one or more points"));
                }
                if let Some(point) = points.iter().find(|p| !(p.0.is_finite() && p.0 >= 0.0)) {
                    return Some((name, point.0, "a hardening table with finite kappa, 0 or above"));
                }
                if let Some(point) = points.iter().find(|p| !p.1.is_finite()) {
                    return Some((name, point.1, "a hardening table of finite values"));
                }
                let falls = points.windows(2).find(|w| w[1].0 <= w[0].0);
                falls.map(|w| (name, w[1].0, "a hardening table with strictly ascending kappa"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_slopes_and_ranges() {
        let line = Hardening::Linear { initial: 2.0, modulus: 10.0, limit: Some(3.0) };
        assert_eq!(line.at(0.05), (2.5, 10.0));
        assert_eq!(line.at(0.2), (3.0, 0.0));
        assert_eq!(line.range(), (2.0, 3.0));
        let fall = Hardening::Linear { initial: 2.0, modulus: -10.0, limit: Some(1.0) };
        assert_eq!((fall.at(0.05), fall.at(5.0), fall.steepest_fall()), ((1.5, -10.0), (1.0, 0.0), -10.0));
        let table = Hardening::Table(vec![(0.1, 1.0), (0.2, 3.0), (0.4, 2.0)]);
        assert_eq!((table.at(0.0), table.at(1.0)), ((1.0, 0.0), (2.0, 0.0)));
        assert!((table.at(0.15).0 - 2.0).abs() < 1e-14 && (table.at(0.15).1 - 20.0).abs() < 1e-12);
        assert!((table.steepest_fall() + 5.0).abs() < 1e-12);
        assert_eq!(table.range(), (1.0, 3.0));
        let flat = Hardening::Linear { initial: 2.0, modulus: 0.0, limit: Some(3.0) };
        assert!(flat.at(1.0) == (2.0, 0.0) && flat.is_constant() && flat.range() == (2.0, 2.0));
        let free = Hardening::Linear { initial: 2.0, modulus: 10.0, limit: None };
        assert_eq!(free.range(), (2.0, f64::INFINITY));
        assert!(Hardening::Table(vec![(0.0, 1.0), (1.0, 1.0)]).is_constant() && !table.is_constant());
    }

    #[test]
    fn unusable_laws_are_named() {
        let expected = |law: Hardening, bounded| law.invalid_constant("cohesion", bounded).unwrap().2;
        let line = |modulus, limit| Hardening::Linear { initial: 1.0, modulus, limit };
        assert!(expected(line(-1.0, None), false).contains("limit of hardening"));
        assert!(line(1.0, None).invalid_constant("cohesion", false).is_none());
        assert!(expected(line(1.0, None), true).contains("limit of hardening"));
        assert!(expected(line(1.0, Some(0.5)), false).contains("side"));
        assert!(expected(Hardening::Table(vec![]), false).contains("one or more"));
        assert!(expected(Hardening::Table(vec![(0.0, 1.0), (0.0, 2.0)]), false).contains("ascending"));
        assert!(expected(Hardening::Table(vec![(-1.0, 1.0)]), false).contains("0 or above"));
        assert!(expected(Hardening::Table(vec![(0.0, f64::NAN)]), false).contains("finite values"));
        assert!(expected(Hardening::Constant(f64::INFINITY), false).contains("finite"));
    }
}
