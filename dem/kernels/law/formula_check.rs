//! Checks of an own law before a run.

use super::formula::{Formula, MEMORY, MODULUS, STIFFNESS};
use super::formula_law::FormulaLaw;
use crate::base::Vec3;
use crate::law::composed::Composed;
use crate::law::material::Pair;
use crate::law::mindlin::Mindlin;
use crate::law::normal::NormalLaw;
use crate::law::spring::Spring;
use crate::law::tangential::TangentialLaw;
use crate::law::{ContactGeometry, ContactLaw, History};
use std::fmt;

/// Effective radii [m] and overlaps over radius of the checks.
const RADII: [f64; 3] = [1e-3, 1e-2, 0.1];
const OVERLAPS: [f64; 5] = [1e-6, 1e-4, 1e-3, 0.01, 0.05];
/// Effective density of the impacts [kg/m³]: mass over radius cubed.
const DENSITY: f64 = 5000.0;
/// Largest relative difference of energy and work.
const TOLERANCE: f64 = 1e-6;
const STEPS: usize = 4000;

/// What is wrong with an own law.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Formula: `"force"`, `"damping"`, `"energy"` or `"loss"`.
    pub key: &'static str,
    /// Problem, with figures.
    pub problem: String,
}

fn fault<T>(key: &'static str, problem: String) -> Result<T, Fault> {
    Err(Fault { key, problem })
}

/// Figures of an own law that passed its checks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Stiffness at an overlap of 1 % of a radius of 10 mm [N/m].
    pub stiffness: f64,
    /// Restitution of a central impact at 1 m/s.
    pub restitution: f64,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "force, energy and dissipation agree; at a radius of 10 mm: restitution {:.3} at 1 m/s, stiffness {:.4e} N/m at an \
             overlap of 1 %",
            self.restitution, self.stiffness
        )
    }
}

/// Checks an own law with the constants of a pair.
///
/// # Errors
/// What is wrong, with figures.
pub fn verify(formula: &Formula, pair: &Pair<'_>) -> Result<Verdict, Fault> {
    match formula.kind {
        MODULUS => of::<FormulaLaw<MODULUS>, Mindlin>(formula, pair),
        STIFFNESS => of::<FormulaLaw<STIFFNESS>, Spring>(formula, pair),
        _ => of::<FormulaLaw<MEMORY>, Spring>(formula, pair),
    }
}

fn of<N: NormalLaw, T: TangentialLaw<N>>(formula: &Formula, pair: &Pair<'_>) -> Result<Verdict, Fault> {
    let law = Composed::<N, T>::mix(pair);
    let energy = formula.energy.is_some();
    for radius in RADII {
        shape(&law.normal, radius, energy)?;
    }
    let losing = match formula.kind {
        MEMORY => "loss",
        _ if formula.is_damped => "damping",
        _ => "force",
    };
    cycle(&law, losing)?;
    let stiffness = law.normal.stiffness(1e-4, 1e-2);
    let restitution = impact(&law, losing)?;
    if restitution > 1.0 + 1e-3 || !restitution.is_finite() {
        return fault(losing, format!("a restitution of {restitution:.3} at 1 m/s and a radius of 10 mm"));
    }
    Ok(Verdict { stiffness, restitution })
}

/// Force, stiffness and, if stated, energy of first loading.
fn shape<N: NormalLaw>(law: &N, radius: f64, energy: bool) -> Result<(), Fault> {
    let at_touch = law.force(0.0, radius, 0.0).abs();
    let usual = law.force(0.01 * radius, radius, 0.0).abs();
    if at_touch > 1e-9 * usual || !(at_touch + usual).is_finite() {
        return fault("force", format!("a force of {at_touch:.3e} N at zero overlap (radius {radius} m)"));
    }
    let (mut work, mut last) = (0.0, 0.0);
    for share in OVERLAPS {
        let d = share * radius;
        let (force, stiffness) = law.loading(d, radius);
        if !(force >= 0.0 && stiffness >= 0.0 && (force + stiffness).is_finite()) {
            return fault(
                "force",
                format!(
                    "a force of {force:.3e} N and a stiffness of {stiffness:.3e} N/m in first loading (overlap {d:e} m, radius \
                 {radius} m)"
                ),
            );
        }
        if !energy {
            continue;
        }
        // Simpson's rule in √d.
        let (from, to): (f64, f64) = (f64::sqrt(last), d.sqrt());
        let value = |root: f64| 2.0 * root * law.loading(root * root, radius).0;
        let step = (to - from) / STEPS as f64;
        for k in 0..STEPS {
            let left = from + step * k as f64;
            work += step / 6.0 * (value(left) + 4.0 * value(left + 0.5 * step) + value(left + step));
        }
        last = d;
        let stored = law.stored(d, radius, d);
        let differs = if N::REMEMBERS {
            stored > work * (1.0 + TOLERANCE)
        } else {
            (stored / work - 1.0).abs() > TOLERANCE
        };
        if differs || !stored.is_finite() || stored < 0.0 {
            return fault(
                "energy",
                format!(
                    "an energy of {stored:.6e} J where loading takes {work:.6e} J (overlap {d:e} m, radius {radius} m)"
                ),
            );
        }
    }
    Ok(())
}

/// Loading, unloading and loading again.
fn cycle<L: ContactLaw>(law: &L, key: &'static str) -> Result<(), Fault> {
    let (radius, depth, rate) = (1e-2, 1e-4, 10.0);
    let mass = DENSITY * radius * radius * radius;
    let overlap = |k: f64| {
        let part = std::f64::consts::PI * k / STEPS as f64;
        depth * libm::sin(part) * (1.0 - 0.6 * libm::cos(3.0 * part)).max(0.0)
    };
    let dt = 1.0 / (rate * STEPS as f64);
    let (mut history, mut work, mut lost, mut largest) = (History::NONE, 0.0, 0.0, 0.0_f64);
    let mut before = 0.0;
    for k in 1..STEPS {
        let (d, approach) = (overlap(k as f64), (overlap(k as f64 + 0.5) - overlap(k as f64 - 0.5)) / dt);
        if d <= 0.0 {
            law.release(&mut history);
            before = 0.0;
            continue;
        }
        let geometry = ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap: d, radius };
        let velocity = Vec3::new(0.0, 0.0, -approach);
        let force = law.evaluate_one(1.0 / mass, &geometry, &velocity, &Vec3::zeros(), &mut history, dt);
        work += 0.5 * (before + force.normal) * (d - overlap(k as f64 - 1.0));
        before = force.normal;
        lost += force.dashpot;
        largest = largest.max(law.stored(d, radius, &history).0.abs());
    }
    let fraction = work / largest;
    if fraction < -1e-3 || lost < -1e-9 * largest || !(fraction + lost).is_finite() {
        return fault(
            key,
            format!(
                "a closed cycle that gains {:.3e} of the largest energy",
                (-fraction).max(-lost / largest)
            ),
        );
    }
    if (work - lost).abs() > 0.02 * largest {
        return fault(
            key,
            format!(
                "a closed cycle that takes {:.4} of the largest energy where {:.4} are stated as dissipated",
                fraction,
                lost / largest
            ),
        );
    }
    Ok(())
}

/// Restitution of a central impact at 1 m/s.
fn impact<L: ContactLaw>(law: &L, key: &'static str) -> Result<f64, Fault> {
    let radius = 1e-2;
    let mass = DENSITY * radius * radius * radius;
    let mut dt = f64::INFINITY;
    for share in [1e-3, 1e-2, 0.05] {
        dt = dt.min(0.02 * (mass / law.stiffness(share * radius, radius)).sqrt());
    }
    let (mut overlap, mut speed, mut history) = (0.0, 1.0, History::NONE);
    for _ in 0..1_000_000 {
        overlap += speed * dt;
        if overlap <= 0.0 {
            return Ok(-speed);
        }
        let geometry = ContactGeometry { point: Vec3::zeros(), normal: Vec3::z(), overlap, radius };
        let velocity = Vec3::new(0.0, 0.0, -speed);
        let force = law.evaluate_one(1.0 / mass, &geometry, &velocity, &Vec3::zeros(), &mut history, dt);
        speed -= force.normal / mass * dt;
        if force.normal <= 0.0 && speed < 0.0 {
            return Ok(-speed);
        }
    }
    fault(key, "an impact at 1 m/s that does not end".to_string())
}
