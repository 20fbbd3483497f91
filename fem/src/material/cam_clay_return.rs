//! Return mapping of modified Cam clay, compression positive.
//!
//! Pressure and preconsolidation pressure follow their exponentials exactly; shear uses the secant bulk
//! modulus. Nested bracketed roots: multiplier, then elastic volumetric strain.
//!
//! Source: Borja and Lee (1990).

use super::law::ReturnError;
use super::spectral::Voigt;
use serde::{Deserialize, Serialize};

/// Relative convergence tolerance.
const TOLERANCE: f64 = 1e-14;
/// Iteration limit; bisection alone needs fewer.
const ITERATIONS: u32 = 200;

/// Elastic shear stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shear {
    /// Constant Poisson's ratio [-].
    Poisson(f64),
    /// Constant shear modulus [Pa].
    Modulus(f64),
}

pub(super) struct Clay {
    /// `kappa / v`.
    pub swelling: f64,
    /// `(lambda - kappa) / v`.
    pub plastic_slope: f64,
    /// `M²`.
    pub square: f64,
    pub shear: Shear,
    /// Pressure of the minimum bulk modulus.
    pub floor: f64,
}

/// Pressure and tangent after an elastic volumetric strain `x`; secant modulus and its derivative.
#[derive(Clone, Copy)]
pub(super) struct Bulk {
    pub p: f64,
    pub tangent: f64,
    pub secant: f64,
    pub secant_rate: f64,
}

pub(super) struct Step<'a> {
    pub clay: &'a Clay,
    pub p: f64,
    pub deviator: Voigt,
    pub pc: f64,
    pub volume: f64,
    /// Deviatoric strain increment, tensor shear.
    pub shear: Voigt,
}

/// Functions of elastic volumetric strain `x` and multiplier.
pub(super) struct Trial {
    pub x: f64,
    pub multiplier: f64,
    pub bulk: Bulk,
    pub pc: f64,
    /// `d pc / d eps_v^p`.
    pub hardening: f64,
    /// Shear modulus and its derivative by `x`.
    pub g: f64,
    pub g_rate: f64,
    /// `1 + 6 G multiplier / M²`.
    pub fade: f64,
    pub s: Voigt,
    /// Yield function [Pa²], magnitude of its terms, derivatives.
    pub f: f64,
    pub size: f64,
    pub f_x: f64,
    pub f_multiplier: f64,
}

pub(super) fn contract(a: &Voigt, b: &Voigt) -> f64 {
    (0..6).map(|k| if k < 3 { 1.0 } else { 2.0 } * a[k] * b[k]).sum()
}

/// Pressure and deviator, compression positive.
pub(super) fn split(stress: &Voigt) -> (f64, Voigt) {
    let p = -(stress[0] + stress[1] + stress[2]) / 3.0;
    (p, std::array::from_fn(|k| -stress[k] - if k < 3 { p } else { 0.0 }))
}

/// `(e^t - 1)/t` and its derivative.
fn mean_exponential(t: f64) -> (f64, f64) {
    if t.abs() < 1e-3 {
        let value = 1.0 + t / 2.0 * (1.0 + t / 3.0 * (1.0 + t / 4.0 * (1.0 + t / 5.0)));
        (value, 0.5 + t / 3.0 * (1.0 + 3.0 * t / 8.0 * (1.0 + 4.0 * t / 15.0)))
    } else {
        let value = libm::expm1(t) / t;
        (value, (libm::exp(t) - value) / t)
    }
}

impl Clay {
    /// Shear modulus and its derivative by the bulk modulus.
    pub fn shear_modulus(&self, bulk: f64) -> (f64, f64) {
        match self.shear {
            Shear::Poisson(nu) => {
                let ratio = 1.5 * (1.0 - 2.0 * nu) / (1.0 + nu);
                (ratio * bulk, ratio)
            }
            Shear::Modulus(g) => (g, 0.0),
        }
    }

    fn elastic_strain(&self, start: f64, end: f64) -> f64 {
        let floor = self.floor;
        let from_floor = |p: f64| if p >= floor { libm::log(p / floor) } else { p / floor - 1.0 };
        self.swelling * (from_floor(end) - from_floor(start))
    }

    fn bulk(&self, start: f64, x: f64) -> Bulk {
        let (slope, floor) = (self.swelling, self.floor);
        let t = x / slope;
        let grown = start * libm::exp(t);
        if start >= floor && grown >= floor {
            let (mean, rate) = mean_exponential(t);
            let secant_rate = start / (slope * slope) * rate;
            return Bulk { p: grown, tangent: grown / slope, secant: start / slope * mean, secant_rate };
        }
        let to = t - self.elastic_strain(start, floor) / slope;
        let p = floor * if to >= 0.0 { libm::exp(to) } else { 1.0 + to };
        let tangent = p.max(floor) / slope;
        if start <= floor && p <= floor {
            return Bulk { p, tangent, secant: floor / slope, secant_rate: 0.0 };
        }
        let secant = (p - start) / x;
        Bulk { p, tangent, secant, secant_rate: (tangent - secant) / x }
    }
}

impl Step<'_> {
    pub fn at(&self, x: f64, multiplier: f64) -> Trial {
        let (clay, m2) = (self.clay, self.clay.square);
        let bulk = clay.bulk(self.p, x);
        let grown = self.pc * libm::exp((self.volume - x) / clay.plastic_slope);
        let floor = clay.floor.min(self.pc);
        let (pc, hardening) = if grown > floor { (grown, grown / clay.plastic_slope) } else { (floor, 0.0) };
        let (g, by_bulk) = clay.shear_modulus(bulk.secant);
        let g_rate = by_bulk * bulk.secant_rate;
        let fade = 1.0 + 6.0 * g * multiplier / m2;
        let s: Voigt = std::array::from_fn(|k| (self.deviator[k] + 2.0 * g * self.shear[k]) / fade);
        let (square, p) = (contract(&s, &s), bulk.p);
        let shear = 1.5 * square / m2;
        let along = 2.0 * g_rate * contract(&s, &self.shear) - 6.0 * g_rate * multiplier / m2 * square;
        Trial {
            x,
            multiplier,
            bulk,
            pc,
            hardening,
            g,
            g_rate,
            fade,
            s,
            f: shear + p * (p - pc),
            // Size of the cancelling terms below the minimum.
            size: shear + p * p + pc * if p < clay.floor { clay.floor } else { p },
            f_x: 3.0 / (m2 * fade) * along + (2.0 * p - pc) * bulk.tangent + p * hardening,
            f_multiplier: -18.0 * g * square / (m2 * m2 * fade),
        }
    }

    /// Solves `x + multiplier (2 p - pc) = volume` for x, increasing on the left.
    fn balance(&self, multiplier: f64, start: f64) -> Result<Trial, ReturnError> {
        let enough = |x: f64| 1e-16 * self.clay.swelling + 2.0 * f64::EPSILON * x.abs();
        let rest = |t: &Trial| self.volume - t.x - multiplier * (2.0 * t.bulk.p - t.pc);
        let half = self.clay.elastic_strain(self.p, 0.5 * self.pc);
        let (mut low, mut high) = (self.volume.min(half), self.volume.max(half));
        let mut trial = self.at(start.clamp(low, high), multiplier);
        for _ in 0..ITERATIONS {
            let r = rest(&trial);
            if r.is_nan() {
                return Err(ReturnError::NotFinite);
            }
            if r > 0.0 {
                low = trial.x;
            } else {
                high = trial.x;
            }
            let slope = 1.0 + multiplier * (2.0 * trial.bulk.tangent + trial.hardening);
            let newton = trial.x + r / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if r == 0.0 || next == trial.x || (next - trial.x).abs() <= enough(next) {
                return Ok(trial);
            }
            trial = self.at(next, multiplier);
        }
        Ok(trial)
    }

    /// Returns a trial state to the yield surface.
    pub fn solve(&self, kappa: f64) -> Result<Trial, ReturnError> {
        let mut trial = self.balance(0.0, self.volume)?;
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut best = f64::INFINITY;
        for _ in 0..ITERATIONS {
            if !(trial.f + trial.f_x).is_finite() {
                return Err(ReturnError::NotFinite);
            }
            best = best.min(trial.f.abs() / trial.size);
            if trial.f.abs() <= TOLERANCE * trial.size {
                return Ok(trial);
            }
            if trial.f > 0.0 {
                low = trial.multiplier;
            } else {
                high = trial.multiplier;
            }
            let slope = trial.f_multiplier - trial.f_x * self.dilation(&trial) / self.resistance(&trial);
            let newton = trial.multiplier - trial.f / slope;
            let middle = if high.is_finite() { 0.5 * (low + high) } else { 2.0 * low };
            let next = if slope < 0.0 && newton > low && newton < high { newton } else { middle };
            // No better multiplier: the bracket is one ulp wide.
            if next <= low || next >= high || next == trial.multiplier {
                break;
            }
            trial = self.balance(next, trial.x)?;
        }
        if best <= 1e-9 { Ok(trial) } else { Err(ReturnError::NotConverged { kappa }) }
    }

    /// `2 p - pc`: volumetric flow per multiplier.
    fn dilation(&self, t: &Trial) -> f64 {
        2.0 * t.bulk.p - t.pc
    }

    /// Derivative of `x + multiplier (2 p - pc)` by `x`.
    fn resistance(&self, t: &Trial) -> f64 {
        1.0 + t.multiplier * (2.0 * t.bulk.tangent + t.hardening)
    }

    pub fn elastic_tangent(&self, t: &Trial) -> [[f64; 6]; 6] {
        let spread: Voigt = std::array::from_fn(|i| {
            2.0 * t.g_rate * self.shear[i] + if i < 3 { t.bulk.tangent } else { 0.0 }
        });
        tangent(2.0 * t.g, |i, j| if j < 3 { spread[i] } else { 0.0 })
    }

    /// Consistent tangent of a return, from both linearised equations.
    pub fn plastic_tangent(&self, t: &Trial) -> [[f64; 6]; 6] {
        let m2 = self.clay.square;
        let (d, r) = (self.dilation(t), self.resistance(t));
        let (beta, push) = (6.0 * t.g / (m2 * t.fade), t.bulk.p * t.hardening);
        let own = 1.0 + t.multiplier * t.hardening;
        let determinant = r * t.f_multiplier - d * t.f_x;
        let x_v = (own * t.f_multiplier - d * push) / determinant;
        let x_s = d * beta / determinant;
        let multiplier_v = (r * push - t.f_x * own) / determinant;
        let multiplier_s = -r * beta / determinant;
        let along: Voigt = std::array::from_fn(|i| {
            let shear = 2.0 * t.g_rate * self.shear[i] - 6.0 * t.g_rate * t.multiplier / m2 * t.s[i];
            shear / t.fade + if i < 3 { t.bulk.tangent } else { 0.0 }
        });
        tangent(2.0 * t.g / t.fade, |i, j| {
            let one = if j < 3 { 1.0 } else { 0.0 };
            along[i] * (x_v * one + x_s * t.s[j])
                - beta * t.s[i] * (multiplier_v * one + multiplier_s * t.s[j])
        })
    }
}

/// `shear I_dev + rest(i, j)`.
pub(super) fn tangent(shear: f64, rest: impl Fn(usize, usize) -> f64) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let deviatoric = match (i < 3 && j < 3, i == j) {
                (true, true) => 2.0 / 3.0,
                (true, false) => -1.0 / 3.0,
                (false, true) => 0.5,
                (false, false) => 0.0,
            };
            shear * deviatoric + rest(i, j)
        })
    })
}
