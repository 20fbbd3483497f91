//! Drucker–Prager plasticity with exact return to cone and apex, optional mean-stress cap, non-associated
//! flow and hardening. Zero friction: von Mises.
//!
//! `sqrt(J2) + eta p - xi c <= 0`, `p <= tension`, `p = tr(sigma)/3`; flow by `sqrt(J2) + eta_bar p`.
//! Source: de Souza Neto, Peric and Owen (2008), section 8.3, equations 6.122 to 6.126. Limits:
//! `0 <= psi <= phi < 90°`.
//!
//! Theory manual: equation (4.12) of `docs/theory/solid.md`.

use super::elastic::{Elastic, InvalidConstant};
use super::hardening::Hardening;
use super::law::{ConstitutiveLaw, Response, ReturnError, YIELD_TOLERANCE, elastic_response, elastic_trial};
use super::local;
use super::point::{Point, PointState, ReturnRegion};
use super::spectral::{Voigt, invariants};
use super::strength;
use serde::{Deserialize, Serialize};

/// Match of cone and Mohr–Coulomb surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cone {
    /// Compression edges (outer cone): `eta = 6 sin / (sqrt(3) (3 - sin))`,
    /// `xi = 6 cos / (sqrt(3) (3 - sin))`.
    Compression,
    /// Extension edges (inner cone), with `3 + sin`.
    Extension,
    /// Equal plane-strain limit load: `eta = 3 tan / sqrt(9 + 12 tan²)`, `xi = 3 / sqrt(9 + 12 tan²)`.
    PlaneStrain,
}

impl Cone {
    /// `eta`, `xi` and their derivatives by the angle [rad].
    pub fn coefficients(self, angle: f64) -> [f64; 4] {
        let (sin, cos) = libm::sincos(angle);
        match self {
            Cone::PlaneStrain => {
                let square = 9.0 + 3.0 * sin * sin;
                let root = square.sqrt();
                let cube = square * root;
                [3.0 * sin / root, 3.0 * cos / root, 27.0 * cos / cube, -36.0 * sin / cube]
            }
            Cone::Compression | Cone::Extension => {
                let sign = if self == Cone::Compression { -1.0 } else { 1.0 };
                let below = 3.0 + sign * sin;
                let scale = 6.0 / (3.0_f64.sqrt() * below);
                let slope = scale / below;
                [scale * sin, scale * cos, 3.0 * slope * cos, -slope * (3.0 * sin + sign)]
            }
        }
    }
}

/// Drucker–Prager constants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DruckerPrager {
    /// Cohesion c [Pa], 0 or above; positive without friction.
    pub cohesion: Hardening,
    /// Friction angle phi [rad], in [0, pi/2).
    pub friction: Hardening,
    /// Dilation angle psi [rad], 0 to the smallest friction angle.
    pub dilation: f64,
    /// Match to Mohr–Coulomb.
    pub cone: Cone,
    /// Cap of the mean stress [Pa], 0 to the apex `c cot(phi)`.
    pub tension: Option<f64>,
}

#[derive(Clone, Copy)]
struct Moduli {
    shear: f64,
    bulk: f64,
}

/// Strength at `kappa`: `q <= top - eta p` with `top = xi c`; derivatives by `kappa`.
#[derive(Clone, Copy)]
struct Strength {
    eta: f64,
    top: f64,
    eta_rate: f64,
    top_rate: f64,
    flow: f64,
    tension: Option<f64>,
}

/// `p` and `q = sqrt(J2)`.
type Meridian = [f64; 2];

impl DruckerPrager {
    /// Von Mises with `yield_stress` [Pa] for `sqrt(3 J2)`.
    pub fn von_mises(yield_stress: f64) -> DruckerPrager {
        DruckerPrager {
            cohesion: Hardening::Constant(0.5 * yield_stress),
            friction: Hardening::Constant(0.0),
            dilation: 0.0,
            cone: Cone::Compression,
            tension: None,
        }
    }

    /// Softening slope `dc/dkappa` [Pa] of nonunique returns: cone
    /// `-(G + K eta eta_bar) / (xi sqrt(1/3 + 2 eta_bar²/9))`, apex `-3 K eta / (sqrt(2) xi)`, cap corner
    /// `-sqrt(3) G / xi`.
    pub fn softening_limit(&self, elastic: &Elastic) -> f64 {
        let moduli = Moduli::new(elastic);
        let (low, high) = self.friction.range();
        let mut limit = f64::NEG_INFINITY;
        for phi in [low, high] {
            let [eta, xi, ..] = self.cone.coefficients(phi);
            let flow = self.cone.coefficients(self.dilation)[0];
            let size = (1.0 / 3.0 + 2.0 / 9.0 * flow * flow).sqrt();
            limit = limit.max(-(moduli.shear + moduli.bulk * eta * flow) / (xi * size));
            if eta > 0.0 {
                limit = limit.max(-3.0 * moduli.bulk * eta / (2.0_f64.sqrt() * xi));
            }
            if self.tension.is_some() {
                limit = limit.max(-(3.0_f64.sqrt()) * moduli.shear / xi);
            }
        }
        limit
    }

    fn strength(&self, kappa: f64, flow: f64) -> Strength {
        let ((c, c_rate), (phi, phi_rate)) = (self.cohesion.at(kappa), self.friction.at(kappa));
        let [eta, xi, eta_slope, xi_slope] = self.cone.coefficients(phi);
        let top = xi * c;
        Strength {
            eta,
            top,
            eta_rate: eta_slope * phi_rate,
            top_rate: xi * c_rate + xi_slope * phi_rate * c,
            flow,
            tension: self.tension.filter(|t| t * eta < top),
        }
    }

    fn flow(&self) -> f64 {
        self.cone.coefficients(self.dilation)[0]
    }

    fn shared(&self) -> strength::Strength<'_> {
        strength::Strength {
            cohesion: &self.cohesion,
            friction: &self.friction,
            dilation: self.dilation,
            tension: self.tension,
        }
    }

    fn return_map(
        &self,
        elastic: &Elastic,
        old: &PointState,
        trial: &Voigt,
        want_tangent: bool,
    ) -> Result<Response, ReturnError> {
        let flow = self.flow();
        let mut strength = self.strength(old.kappa, flow);
        let (p, j2) = invariants(trial);
        let t = [p, j2.sqrt()];
        let tolerance = YIELD_TOLERANCE * (p.abs() + t[1]);
        if strength.cone(&t) <= tolerance && p - strength.tension.unwrap_or(f64::INFINITY) <= tolerance {
            return Ok(elastic_response(elastic, old, trial, want_tangent));
        }
        let moduli = Moduli::new(elastic);
        let (mut s, mut region) = strength.project(&t, &moduli);
        let mut kappa = old.kappa + equivalent(&moduli, &t, &s);
        let hardens = !(self.cohesion.is_constant() && self.friction.is_constant());
        if hardens {
            kappa = local::solve_kappa(old.kappa, |kappa| {
                strength = self.strength(kappa, flow);
                (s, region) = strength.project(&t, &moduli);
                let rate = strength.rate(region, &s, &moduli);
                (equivalent(&moduli, &t, &s), -by_stress(&moduli, &t, &s, &rate))
            })?;
        }
        // Deviator direction of norm sqrt(2); zero without shear.
        let direction: Voigt = std::array::from_fn(|k| {
            let deviator = if k < 3 { trial[k] - p } else { trial[k] };
            if t[1] > 0.0 { deviator / t[1] } else { 0.0 }
        });
        let (volume, shear) = ((p - s[0]) / (3.0 * moduli.bulk), (t[1] - s[1]) / (2.0 * moduli.shear));
        let mut state = PointState { kappa, ..*old };
        for k in 0..6 {
            let normal = k < 3;
            state.stress[k] = s[1] * direction[k] + if normal { s[0] } else { 0.0 };
            state.plastic_strain[k] +=
                if normal { volume + shear * direction[k] } else { 2.0 * shear * direction[k] };
        }
        if !(kappa + state.stress.iter().sum::<f64>()).is_finite() {
            return Err(ReturnError::NotFinite);
        }
        let mut tangent = [[0.0; 6]; 6];
        if want_tangent {
            let mut a = strength.tangent(region, &moduli);
            if hardens {
                add_hardening(&mut a, &t, &s, region, &strength, &moduli);
            }
            let ratio = match region {
                ReturnRegion::ConeApex => 0.0,
                ReturnRegion::Cap => 1.0,
                _ => s[1] / t[1],
            };
            tangent = stiffness(&direction, &a, ratio, &moduli);
        }
        Ok(Response { state, region, tangent })
    }
}

impl ConstitutiveLaw for DruckerPrager {
    fn source(&self) -> &'static str {
        strength::SOURCE
    }

    /// Friction softening depends on stress and fails with [`ReturnError::Softening`] instead.
    fn invalid_constant(&self, elastic: &Elastic) -> Option<InvalidConstant> {
        self.shared().invalid_constant(|| self.softening_limit(elastic))
    }

    fn is_associated(&self) -> bool {
        self.shared().is_associated()
    }

    /// Strain-norm hardening makes the apex tangent unsymmetric even for associated flow; von Mises has no
    /// apex.
    fn has_symmetric_tangent(&self) -> bool {
        let von_mises = self.friction == Hardening::Constant(0.0) && self.tension.is_none();
        self.is_associated() && (self.cohesion.is_constant() || von_mises)
    }

    fn update(
        &self,
        elastic: &Elastic,
        old: Point<'_>,
        increment: &[f64; 6],
        want_tangent: bool,
        _: &mut [f64],
    ) -> Result<Response, ReturnError> {
        let trial = elastic_trial(elastic, old.state, increment)?;
        self.return_map(elastic, old.state, &trial, want_tangent)
    }

    /// `max(sqrt(J2) + eta p - xi c, p - tension)`.
    fn yield_function(&self, point: Point<'_>) -> f64 {
        let strength = self.strength(point.state.kappa, 0.0);
        let (p, j2) = invariants(&point.state.stress);
        strength.cone(&[p, j2.sqrt()]).max(p - strength.tension.unwrap_or(f64::INFINITY))
    }

    fn with_strength_divided_by(&self, factor: f64) -> DruckerPrager {
        let strength::ReducedStrength { cohesion, friction, dilation, tension } =
            self.shared().with_strength_divided_by(factor);
        DruckerPrager { cohesion, friction, dilation, tension, cone: self.cone }
    }
}

impl Moduli {
    fn new(elastic: &Elastic) -> Moduli {
        let (lambda, mu) = elastic.lame();
        Moduli { shear: mu, bulk: lambda + 2.0 / 3.0 * mu }
    }
}

impl Strength {
    fn cone(&self, s: &Meridian) -> f64 {
        s[1] + self.eta * s[0] - self.top
    }

    fn stiffness(&self, moduli: &Moduli) -> f64 {
        moduli.shear + moduli.bulk * self.eta * self.flow
    }

    fn project(&self, t: &Meridian, moduli: &Moduli) -> (Meridian, ReturnRegion) {
        let f = self.cone(t);
        let multiplier = f.max(0.0) / self.stiffness(moduli);
        let p = t[0] - moduli.bulk * self.flow * multiplier;
        match self.tension {
            Some(cut) if p > cut => {
                let corner = self.top - self.eta * cut;
                if t[1] <= corner {
                    ([cut, t[1]], ReturnRegion::Cap)
                } else {
                    ([cut, corner], ReturnRegion::ConeCap)
                }
            }
            _ => {
                let q = self.top - self.eta * p;
                // Not `q < 0`: on the axis the apex is the limit.
                if q > 0.0 {
                    ([p, q], ReturnRegion::Cone)
                } else {
                    ([self.top / self.eta, 0.0], ReturnRegion::ConeApex)
                }
            }
        }
    }

    /// Derivative of the returned stress by `kappa` at fixed trial.
    fn rate(&self, region: ReturnRegion, s: &Meridian, moduli: &Moduli) -> Meridian {
        let top = self.top_rate - self.eta_rate * s[0];
        match region {
            ReturnRegion::Cone => {
                let multiplier = top / self.stiffness(moduli);
                [moduli.bulk * self.flow * multiplier, moduli.shear * multiplier]
            }
            ReturnRegion::ConeApex => [top / self.eta, 0.0],
            ReturnRegion::ConeCap => [0.0, top],
            _ => [0.0; 2],
        }
    }

    /// Derivative of the returned by the trial `(p, q)` at fixed strength.
    fn tangent(&self, region: ReturnRegion, moduli: &Moduli) -> [[f64; 2]; 2] {
        match region {
            ReturnRegion::Cone => {
                let d = 1.0 / self.stiffness(moduli);
                let (p, q) = (moduli.bulk * self.flow * d, moduli.shear * d);
                [[1.0 - p * self.eta, -p], [-q * self.eta, 1.0 - q]]
            }
            ReturnRegion::Cap => [[0.0, 0.0], [0.0, 1.0]],
            _ => [[0.0; 2]; 2],
        }
    }
}

/// Equivalent plastic strain, `sqrt(2/3 (e:e + (tr eps_p)²/3))` with plastic deviator `e`.
fn equivalent(moduli: &Moduli, t: &Meridian, s: &Meridian) -> f64 {
    let (volume, shear) = ((t[0] - s[0]) / moduli.bulk, (t[1] - s[1]) / moduli.shear);
    (shear * shear / 3.0 + 2.0 / 9.0 * volume * volume).sqrt()
}

fn by_stress(moduli: &Moduli, t: &Meridian, s: &Meridian, x: &Meridian) -> f64 {
    let h = equivalent(moduli, t, s);
    if h == 0.0 {
        return 0.0;
    }
    let volume = (t[0] - s[0]) / (moduli.bulk * moduli.bulk);
    let shear = (t[1] - s[1]) / (moduli.shear * moduli.shear);
    (shear * x[1] / 3.0 + 2.0 / 9.0 * volume * x[0]) / h
}

/// Adds `d(p,q)/dkappa dkappa/d(trial)`, from `kappa - h(trial, kappa) = const`.
fn add_hardening(
    a: &mut [[f64; 2]; 2],
    t: &Meridian,
    s: &Meridian,
    region: ReturnRegion,
    strength: &Strength,
    moduli: &Moduli,
) {
    let rate = strength.rate(region, s, moduli);
    let scale = 1.0 / (1.0 + by_stress(moduli, t, s, &rate));
    let along_p = scale * by_stress(moduli, t, s, &[1.0 - a[0][0], -a[1][0]]);
    let along_q = scale * by_stress(moduli, t, s, &[-a[0][1], 1.0 - a[1][1]]);
    for i in 0..2 {
        a[i][0] += rate[i] * along_p;
        a[i][1] += rate[i] * along_q;
    }
}

/// `d sigma = 1 dp + n dq + (q / q_trial) (2 G I_dev - G n n) d eps`, n deviator direction.
fn stiffness(n: &Voigt, a: &[[f64; 2]; 2], ratio: f64, moduli: &Moduli) -> [[f64; 6]; 6] {
    let (k, g) = (moduli.bulk, moduli.shear);
    std::array::from_fn(|i| {
        let one_i = if i < 3 { 1.0 } else { 0.0 };
        let by_p = (one_i * a[0][0] + n[i] * a[1][0]) * k;
        let by_q = (one_i * a[0][1] + n[i] * (a[1][1] - ratio)) * g;
        std::array::from_fn(|j| {
            let one_j = if j < 3 { 1.0 } else { 0.0 };
            let identity = if i != j {
                0.0
            } else if i < 3 {
                1.0
            } else {
                0.5
            };
            by_p * one_j + by_q * n[j] + 2.0 * g * ratio * (identity - one_i * one_j / 3.0)
        })
    })
}
