//! Modified Cam clay: elliptic yield surface, associated flow, volumetric hardening, pressure-dependent
//! elasticity.
//!
//! With `p = -tr(sigma)/3`, `q = sqrt(3 J2)` and initial specific volume `v = 1 + e`:
//!
//! ```text
//! q²/M² + p (p - pc) <= 0,   d pc / pc = v d eps_v^p / (lambda - kappa),   K = v p / kappa
//! ```
//!
//! Shear has constant Poisson's ratio, which is not conservative (Zytynski, Randolph, Nova and Wroth 1978),
//! or constant modulus.
//!
//! Source: Roscoe and Burland (1968); Borja and Lee (1990) (integration, tangent). Limits: below
//! `minimum_pressure`, bulk modulus and `pc` are constant; the circular deviatoric section overestimates
//! strength in extension.
//!
//! Theory manual: equation (4.14) of `docs/theory/solid.md`.

pub use super::cam_clay_return::Shear;
use super::cam_clay_return::{Clay, Step, contract, split, tangent};
use super::elastic::{Elastic, InvalidConstant};
use super::law::{ConstitutiveLaw, Response, ReturnError, StateValue, YIELD_TOLERANCE};
use super::point::{Point, PointState, ReturnRegion};
use super::spectral::{Voigt, invariants};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Reference pressure without preconsolidation [Pa].
const REFERENCE_PRESSURE: f64 = 100e3;
/// Initial size of the yield surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Consolidation {
    /// Preconsolidation pressure `pc` [Pa].
    Pressure(f64),
    /// Overconsolidation ratio: `pc` over initial `p + q²/(M² p)`, 1 or more.
    Ratio(f64),
}

/// Modified Cam clay constants.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModifiedCamClay {
    /// Slope lambda of the normal compression line, v against ln p [-].
    pub lambda: f64,
    /// Swelling slope kappa [-], above 0, below lambda.
    pub kappa: f64,
    /// Critical stress ratio M = q/p [-].
    pub critical_ratio: f64,
    /// Initial void ratio e [-].
    pub void_ratio: f64,
    /// Elastic shear stiffness.
    pub shear: Shear,
    /// Initial size of the yield surface.
    pub consolidation: Consolidation,
    /// Pressure of the minimum bulk modulus [Pa].
    pub minimum_pressure: f64,
}

impl ModifiedCamClay {
    /// Elasticity at the preconsolidation pressure, or 100 kPa.
    pub fn reference(&self, density: f64) -> Elastic {
        let p = match self.consolidation {
            Consolidation::Pressure(pc) => pc,
            Consolidation::Ratio(_) => REFERENCE_PRESSURE,
        };
        let bulk = p.max(self.minimum_pressure) / self.clay().swelling;
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

    fn clay(&self) -> Clay {
        let volume = 1.0 + self.void_ratio;
        Clay {
            swelling: self.kappa / volume,
            plastic_slope: (self.lambda - self.kappa) / volume,
            square: self.critical_ratio * self.critical_ratio,
            shear: self.shear,
            floor: self.minimum_pressure,
        }
    }

    /// `q²/M² + p (p - pc)` over `pc` [Pa].
    fn surface(&self, stress: &Voigt, pc: f64) -> f64 {
        let (p, j2) = invariants(stress);
        (3.0 * j2 / (self.critical_ratio * self.critical_ratio) + p * (p + pc)) / pc
    }
}

impl ConstitutiveLaw for ModifiedCamClay {
    fn source(&self) -> &'static str {
        "modified Cam clay: Roscoe & Burland 1968; implicit integration: Borja & Lee, Comput. Methods Appl. Mech. Eng. 78, 1990"
    }

    fn invalid_constant(&self, _: &Elastic) -> Option<InvalidConstant> {
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

    fn state_values(&self) -> &[StateValue] {
        const PRESSURE: StateValue =
            StateValue { name: Cow::Borrowed("preconsolidation_pressure"), unit: Cow::Borrowed("Pa") };
        &[PRESSURE]
    }

    fn initial_values(&self, _: &Elastic, stress: &[f64; 6], values: &mut [f64]) {
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
        let (mean, mut shear) = split(increment);
        shear[3..].iter_mut().for_each(|s| *s *= 0.5);
        let clay = self.clay();
        let step = Step { clay: &clay, p, deviator, pc: old.values[0], volume: 3.0 * mean, shear };
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
        let region = if elastic { ReturnRegion::Elastic } else { ReturnRegion::Named("ellipse") };
        Ok(Response { state, region, tangent })
    }

    fn elastic_tangent(&self, _: &Elastic, point: Point<'_>) -> [[f64; 6]; 6] {
        let p = -invariants(&point.state.stress).0;
        let bulk = p.max(self.minimum_pressure) / self.clay().swelling;
        tangent(2.0 * self.clay().shear_modulus(bulk).0, |i, j| if i < 3 && j < 3 { bulk } else { 0.0 })
    }

    /// `kappa p / v` in compression, plus shear energy at the current modulus.
    fn stored_energy(&self, _: &Elastic, point: Point<'_>) -> f64 {
        let (p, j2) = invariants(&point.state.stress);
        let (p, floor, slope) = (-p, self.minimum_pressure, self.clay().swelling);
        let volume = if p >= floor { p - 0.5 * floor } else { 0.5 * p * p / floor };
        slope * volume + 0.5 * j2 / self.clay().shear_modulus(p.max(floor) / slope).0
    }

    fn yield_function(&self, point: Point<'_>) -> f64 {
        self.surface(&point.state.stress, point.values[0])
    }

    /// Reduces the tangent of the triaxial friction angle, `sin(phi) = 3 M / (6 + M)`.
    fn with_strength_divided_by(&self, factor: f64) -> ModifiedCamClay {
        let phi = libm::asin(3.0 * self.critical_ratio / (6.0 + self.critical_ratio));
        let sin = libm::sin(libm::atan(libm::tan(phi) / factor));
        ModifiedCamClay { critical_ratio: 6.0 * sin / (3.0 - sin), ..*self }
    }
}
