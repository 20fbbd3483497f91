//! Modified Cam clay: an elliptic yield surface in mean stress and shear, associated flow, volumetric hardening, and
//! elasticity in proportion to the pressure.
//!
//! With the effective pressure `p = -tr(sigma)/3`, `q = sqrt(3 J2)` and the specific volume `v = 1 + e` of the start:
//!
//! ```text
//! q²/M² + p (p - pc) <= 0,   d pc / pc = v d eps_v^p / (lambda - kappa),   K = v p / kappa
//! ```
//!
//! so that a normally consolidated clay follows `v0 - v = lambda ln(p/p0)` and an unloaded one `kappa ln(p/p0)`, strains
//! being those of the undeformed volume. Shear is elastic with a constant Poisson's ratio or a constant shear modulus; with a
//! constant Poisson's ratio a closed elastic cycle does not give back all its work (Zytynski, Randolph, Nova and Wroth, Int. J.
//! Numer. Anal. Methods Geomech. 2 (1978) 87-93), with a constant modulus it does.
//!
//! Integration is implicit: pressure and `pc` follow their exponentials exactly, the shear stiffness is that of the secant bulk
//! modulus of the step, and the flow is that at the end. The multiplier is the root of one equation, the elastic volume
//! strain that of another inside it; both have a bracket, so the return always ends.
//!
//! Source: Roscoe and Burland, On the generalised stress-strain behaviour of wet clay, in Engineering Plasticity (1968)
//! 535-609; Borja and Lee, Comput. Methods Appl. Mech. Eng. 78 (1990) 49-72 for the integration and its tangent. Limits: below the
//! `minimum_pressure` the bulk modulus is that of this pressure and `pc` falls no further, so that ground without
//! stress can be computed; the circle of the deviatoric plane gives too much strength in extension.

use super::elastic::{Elastic, Fault};
use super::law::{ConstitutiveLaw, Response, ReturnError, StateValue, YIELD_TOLERANCE};
use super::point::{Point, PointState, Region};
use super::spectral::{Voigt, invariants};
use serde::{Deserialize, Serialize};

/// Pressure of the constant matrices where no preconsolidation pressure is given [Pa]: that of the atmosphere.
const REFERENCE_PRESSURE: f64 = 100e3;
/// Yield function over its terms at which a return counts as found.
const TOLERANCE: f64 = 1e-14;
/// Iterations of either equation; bisection alone needs fewer.
const ITERATIONS: u32 = 200;

/// Elastic stiffness in shear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shear {
    /// Constant Poisson's ratio [-].
    Poisson(f64),
    /// Constant shear modulus [Pa].
    Modulus(f64),
}

/// Size of the yield surface at the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Consolidation {
    /// Preconsolidation pressure `pc` [Pa].
    Pressure(f64),
    /// `pc` over the pressure `p + q²/(M² p)` of the yield surface through the initial stress, 1 or more.
    Ratio(f64),
}

/// Constants of modified Cam clay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModifiedCamClay {
    /// Slope lambda of the normal compression line, volume against ln p [-].
    pub lambda: f64,
    /// Slope kappa of the swelling lines [-], above 0, below lambda.
    pub kappa: f64,
    /// Stress ratio q/p at the critical state, M [-].
    pub critical_ratio: f64,
    /// Void ratio e at the start [-].
    pub void_ratio: f64,
    /// Elastic stiffness in shear.
    pub shear: Shear,
    /// Size of the yield surface at the start.
    pub consolidation: Consolidation,
    /// Pressure [Pa] below which the bulk modulus falls no further.
    pub minimum_pressure: f64,
}

/// Pressure after an elastic volume strain `x`: pressure and tangent, then the secant modulus and its derivative by `x`.
#[derive(Clone, Copy)]
struct Bulk {
    p: f64,
    tangent: f64,
    secant: f64,
    secant_rate: f64,
}

/// A step in compression-positive stress and strain.
struct Step<'a> {
    law: &'a ModifiedCamClay,
    p: f64,
    deviator: Voigt,
    pc: f64,
    volume: f64,
    /// Deviator of the strain increment, shear not doubled.
    shear: Voigt,
}

/// All that depends on the two unknowns of a return: the elastic volume strain `x` and the multiplier.
struct Trial {
    x: f64,
    multiplier: f64,
    bulk: Bulk,
    pc: f64,
    /// `d pc / d eps_v^p`.
    hardening: f64,
    /// Shear modulus and its derivative by `x`.
    g: f64,
    g_rate: f64,
    /// `1 + 6 G multiplier / M²`.
    fade: f64,
    s: Voigt,
    /// Yield function [Pa²], the size of its terms, its derivatives by `x` and by the multiplier.
    f: f64,
    size: f64,
    f_x: f64,
    f_multiplier: f64,
}

fn contract(a: &Voigt, b: &Voigt) -> f64 {
    (0..6).map(|k| if k < 3 { 1.0 } else { 2.0 } * a[k] * b[k]).sum()
}

/// Pressure, deviator of a stress, both positive in compression.
fn split(stress: &Voigt) -> (f64, Voigt) {
    let p = -(stress[0] + stress[1] + stress[2]) / 3.0;
    (p, std::array::from_fn(|k| -stress[k] - if k < 3 { p } else { 0.0 }))
}

/// `(e^t - 1)/t` and its derivative.
fn mean_exponential(t: f64) -> (f64, f64) {
    if t.abs() < 1e-3 {
        let value = 1.0 + t / 2.0 * (1.0 + t / 3.0 * (1.0 + t / 4.0 * (1.0 + t / 5.0)));
        (value, 0.5 + t / 3.0 * (1.0 + 3.0 * t / 8.0 * (1.0 + 4.0 * t / 15.0)))
    } else {
        let value = t.exp_m1() / t;
        (value, (t.exp() - value) / t)
    }
}

impl ModifiedCamClay {
    /// Elasticity at the reference state: the preconsolidation pressure, or 100 kPa.
    pub fn reference(&self, density: f64) -> Elastic {
        let p = match self.consolidation {
            Consolidation::Pressure(pc) => pc,
            Consolidation::Ratio(_) => REFERENCE_PRESSURE,
        };
        let bulk = p.max(self.minimum_pressure) / self.swelling();
        match self.shear {
            Shear::Poisson(poisson) => {
                Elastic { young: 3.0 * bulk * (1.0 - 2.0 * poisson), poisson, density }
            }
            Shear::Modulus(g) => Elastic {
                young: 9.0 * bulk * g / (3.0 * bulk + g),
                poisson: (3.0 * bulk - 2.0 * g) / (2.0 * (3.0 * bulk + g)),
                density,
            },
        }
    }

    /// `kappa / v`.
    fn swelling(&self) -> f64 {
        self.kappa / (1.0 + self.void_ratio)
    }

    /// `(lambda - kappa) / v`.
    fn plastic_slope(&self) -> f64 {
        (self.lambda - self.kappa) / (1.0 + self.void_ratio)
    }

    /// Shear modulus at a bulk modulus, and its derivative by that.
    fn shear_modulus(&self, bulk: f64) -> (f64, f64) {
        match self.shear {
            Shear::Poisson(nu) => {
                let ratio = 1.5 * (1.0 - 2.0 * nu) / (1.0 + nu);
                (ratio * bulk, ratio)
            }
            Shear::Modulus(g) => (g, 0.0),
        }
    }

    /// Elastic volume strain from the pressure `start` to `end`: logarithmic above the minimum, linear below.
    fn elastic_strain(&self, start: f64, end: f64) -> f64 {
        let floor = self.minimum_pressure;
        let from_floor = |p: f64| if p >= floor { (p / floor).ln() } else { p / floor - 1.0 };
        self.swelling() * (from_floor(end) - from_floor(start))
    }

    fn bulk(&self, start: f64, x: f64) -> Bulk {
        let (slope, floor) = (self.swelling(), self.minimum_pressure);
        let t = x / slope;
        let grown = start * t.exp();
        if start >= floor && grown >= floor {
            let (mean, rate) = mean_exponential(t);
            let secant_rate = start / (slope * slope) * rate;
            return Bulk { p: grown, tangent: grown / slope, secant: start / slope * mean, secant_rate };
        }
        let to = t - self.elastic_strain(start, floor) / slope;
        let p = floor * if to >= 0.0 { to.exp() } else { 1.0 + to };
        let tangent = p.max(floor) / slope;
        if start <= floor && p <= floor {
            return Bulk { p, tangent, secant: floor / slope, secant_rate: 0.0 };
        }
        let secant = (p - start) / x;
        Bulk { p, tangent, secant, secant_rate: (tangent - secant) / x }
    }

    /// `q²/M² + p (p - pc)` over `pc` [Pa].
    fn surface(&self, stress: &Voigt, pc: f64) -> f64 {
        let (p, j2) = invariants(stress);
        (3.0 * j2 / (self.critical_ratio * self.critical_ratio) + p * (p + pc)) / pc
    }
}

impl Step<'_> {
    fn at(&self, x: f64, multiplier: f64) -> Trial {
        let (law, m2) = (self.law, self.law.critical_ratio * self.law.critical_ratio);
        let bulk = law.bulk(self.p, x);
        let grown = self.pc * ((self.volume - x) / law.plastic_slope()).exp();
        let floor = law.minimum_pressure.min(self.pc);
        let (pc, hardening) = if grown > floor { (grown, grown / law.plastic_slope()) } else { (floor, 0.0) };
        let (g, by_bulk) = law.shear_modulus(bulk.secant);
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
            // Below the minimum the pressure is a difference of numbers of that size.
            size: shear + p * p + pc * if p < law.minimum_pressure { law.minimum_pressure } else { p },
            f_x: 3.0 / (m2 * fade) * along + (2.0 * p - pc) * bulk.tangent + p * hardening,
            f_multiplier: -18.0 * g * square / (m2 * m2 * fade),
        }
    }

    /// The elastic volume strain of a multiplier: `x + multiplier (2 p - pc) = volume`. The left side rises with `x`, and the root
    /// lies between the whole volume strain (no flow) and the one at which `p` is half the old `pc`, since beyond it `2 p - pc`
    /// would have the other sign.
    fn balance(&self, multiplier: f64, start: f64) -> Result<Trial, ReturnError> {
        let enough = |x: f64| 1e-16 * self.law.swelling() + 2.0 * f64::EPSILON * x.abs();
        let rest = |t: &Trial| self.volume - t.x - multiplier * (2.0 * t.bulk.p - t.pc);
        let half = self.law.elastic_strain(self.p, 0.5 * self.pc);
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

    /// The return to the yield surface of a trial outside it.
    fn solve(&self, kappa: f64) -> Result<Trial, ReturnError> {
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
            // The bracket is one unit in the last place wide: no better multiplier exists.
            if next <= low || next >= high || next == trial.multiplier {
                break;
            }
            trial = self.balance(next, trial.x)?;
        }
        if best <= 1e-9 { Ok(trial) } else { Err(ReturnError::NotConverged { kappa }) }
    }

    /// `2 p - pc`: volume strain of the flow per multiplier.
    fn dilation(&self, t: &Trial) -> f64 {
        2.0 * t.bulk.p - t.pc
    }

    /// Derivative of `x + multiplier (2 p - pc)` by `x`.
    fn resistance(&self, t: &Trial) -> f64 {
        1.0 + t.multiplier * (2.0 * t.bulk.tangent + t.hardening)
    }

    /// Consistent tangent of an elastic step.
    fn elastic_tangent(&self, t: &Trial) -> [[f64; 6]; 6] {
        let spread: Voigt = std::array::from_fn(|i| {
            2.0 * t.g_rate * self.shear[i] + if i < 3 { t.bulk.tangent } else { 0.0 }
        });
        tangent(2.0 * t.g, |i, j| if j < 3 { spread[i] } else { 0.0 })
    }

    /// Consistent tangent of a return: the two equations linearised about their solution.
    fn plastic_tangent(&self, t: &Trial) -> [[f64; 6]; 6] {
        let m2 = self.law.critical_ratio * self.law.critical_ratio;
        let (d, r) = (self.dilation(t), self.resistance(t));
        let (beta, push) = (6.0 * t.g / (m2 * t.fade), t.bulk.p * t.hardening);
        let own = 1.0 + t.multiplier * t.hardening;
        let determinant = r * t.f_multiplier - d * t.f_x;
        // Derivatives of x and of the multiplier by the volume strain and by `s : d e`.
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

/// `shear I_dev` and what `rest(i, j)` adds.
fn tangent(shear: f64, rest: impl Fn(usize, usize) -> f64) -> [[f64; 6]; 6] {
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

impl ConstitutiveLaw for ModifiedCamClay {
    fn source(&self) -> &'static str {
        "modified Cam clay: Roscoe & Burland 1968; implicit integration: Borja & Lee, Comput. Methods Appl. Mech. Eng. 78, 1990"
    }

    fn fault(&self, _: &Elastic) -> Option<Fault> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let above = "a finite number above 0";
        let (shear, good) = match self.shear {
            Shear::Poisson(nu) => (("Poisson's ratio", nu, "above -1, below 0.5"), nu > -1.0 && nu < 0.5),
            Shear::Modulus(g) => (("shear modulus", g, above), positive(g)),
        };
        let (size, sized) = match self.consolidation {
            Consolidation::Pressure(p) => (("preconsolidation pressure", p, above), positive(p)),
            Consolidation::Ratio(r) => {
                (("overconsolidation ratio", r, "a finite number, 1 or above"), r >= 1.0 && r.is_finite())
            }
        };
        let steeper = "a finite number above kappa";
        [
            (("kappa", self.kappa, above), positive(self.kappa)),
            (("lambda", self.lambda, steeper), self.lambda > self.kappa && self.lambda.is_finite()),
            (
                ("critical ratio", self.critical_ratio, "above 0, below 3"),
                (1e-6..3.0).contains(&self.critical_ratio),
            ),
            (("void ratio", self.void_ratio, above), positive(self.void_ratio)),
            (shear, good),
            (size, sized),
            (("minimum pressure", self.minimum_pressure, above), positive(self.minimum_pressure)),
        ]
        .into_iter()
        .find_map(|(fault, fine)| (!fine).then_some(fault))
    }

    fn has_constant_elasticity(&self) -> bool {
        false
    }

    fn is_conservative(&self) -> bool {
        matches!(self.shear, Shear::Modulus(_))
    }

    fn is_associated(&self) -> bool {
        true
    }

    fn has_symmetric_tangent(&self) -> bool {
        false
    }

    fn state_values(&self) -> &'static [StateValue] {
        &[StateValue { name: "preconsolidation_pressure", unit: "Pa" }]
    }

    fn initial_values(&self, stress: &[f64; 6], values: &mut [f64]) {
        values[0] = match self.consolidation {
            Consolidation::Pressure(pc) => pc,
            Consolidation::Ratio(ratio) => {
                let (p, j2) = invariants(stress);
                let p = (-p).max(self.minimum_pressure);
                ratio * (p + 3.0 * j2 / (self.critical_ratio * self.critical_ratio * p))
            }
        };
    }

    fn update(
        &self,
        _: &Elastic,
        old: Point<'_>,
        increment: &[f64; 6],
        want_tangent: bool,
        values: &mut [f64],
    ) -> Result<Response, ReturnError> {
        let (p, deviator) = split(&old.state.stress);
        // Strain splits as stress does; its mean is a third of the volume strain and its shear is doubled.
        let (mean, mut shear) = split(increment);
        shear[3..].iter_mut().for_each(|s| *s *= 0.5);
        let step = Step { law: self, p, deviator, pc: old.values[0], volume: 3.0 * mean, shear };
        let mut end = step.at(step.volume, 0.0);
        if !(end.f + end.size).is_finite() {
            return Err(ReturnError::NotFinite);
        }
        let elastic = end.f <= YIELD_TOLERANCE * end.size;
        if !elastic {
            end = step.solve(old.state.kappa)?;
        }
        let mut state = PointState {
            stress: std::array::from_fn(|k| -end.s[k] - if k < 3 { end.bulk.p } else { 0.0 }),
            ..*old.state
        };
        values[0] = if elastic { step.pc } else { end.pc };
        if !elastic {
            let (volume, flow) =
                (step.volume - end.x, 3.0 * end.multiplier / (self.critical_ratio * self.critical_ratio));
            for k in 0..6 {
                state.plastic_strain[k] -=
                    if k < 3 { volume / 3.0 + flow * end.s[k] } else { 2.0 * flow * end.s[k] };
            }
            let square = flow * flow * contract(&end.s, &end.s) + volume * volume / 3.0;
            state.kappa += (2.0 / 3.0 * square).sqrt();
        }
        if !(state.stress.iter().sum::<f64>() + values[0] + state.kappa).is_finite() {
            return Err(ReturnError::NotFinite);
        }
        let tangent = match (want_tangent, elastic) {
            (false, _) => [[0.0; 6]; 6],
            (true, true) => step.elastic_tangent(&end),
            (true, false) => step.plastic_tangent(&end),
        };
        let region = if elastic { Region::Elastic } else { Region::Named("ellipse") };
        Ok(Response { state, region, tangent })
    }

    fn elastic_tangent(&self, _: &Elastic, point: Point<'_>) -> [[f64; 6]; 6] {
        let p = -invariants(&point.state.stress).0;
        let bulk = p.max(self.minimum_pressure) / self.swelling();
        tangent(2.0 * self.shear_modulus(bulk).0, |i, j| if i < 3 && j < 3 { bulk } else { 0.0 })
    }

    /// `kappa p / v` in compression, and the energy of the shear at the shear modulus of the pressure.
    fn stored_energy(&self, _: &Elastic, point: Point<'_>) -> f64 {
        let (p, j2) = invariants(&point.state.stress);
        let (p, floor, slope) = (-p, self.minimum_pressure, self.swelling());
        let volume = if p >= floor { p - 0.5 * floor } else { 0.5 * p * p / floor };
        slope * volume + 0.5 * j2 / self.shear_modulus(p.max(floor) / slope).0
    }

    fn yield_function(&self, point: Point<'_>) -> f64 {
        self.surface(&point.state.stress, point.values[0])
    }

    /// The friction angle of triaxial compression, `sin(phi) = 3 M / (6 + M)`, with its tangent divided by the factor.
    fn reduced(&self, factor: f64) -> ModifiedCamClay {
        let phi = (3.0 * self.critical_ratio / (6.0 + self.critical_ratio)).asin();
        let sin = (phi.tan() / factor).atan().sin();
        ModifiedCamClay { critical_ratio: 6.0 * sin / (3.0 - sin), ..*self }
    }
}
