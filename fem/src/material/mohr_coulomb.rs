//! Mohr–Coulomb plasticity with exact return to planes, edges and apex, optional Rankine cut-off,
//! non-associated flow and hardening. Zero friction: Tresca.
//!
//! `(s1 - s3)/2 + (s1 + s3)/2 sin(phi) - c cos(phi) <= 0`, `s1 <= tension`; flow with psi instead of phi.
//! Source: de Souza Neto, Peric and Owen (2008), section 8.2. Limits: `0 <= psi <= phi < 90°`.
//!
//! Theory manual: equation (4.13) of `docs/theory/solid.md`.

use super::elastic::{Elastic, InvalidConstant};
use super::hardening::Hardening;
use super::law::{ConstitutiveLaw, Response, ReturnError, YIELD_TOLERANCE, elastic_response, elastic_trial};
use super::local;
use super::point::{Point, PointState, ReturnRegion};
use super::principal_return::{self, Moduli, Strength};
use super::spectral::{self, Voigt, invariants};
use super::strength;
use serde::{Deserialize, Serialize};

/// Mohr–Coulomb constants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MohrCoulomb {
    /// Cohesion c [Pa], 0 or above; positive without friction.
    pub cohesion: Hardening,
    /// Friction angle phi [rad], in [0, pi/2).
    pub friction: Hardening,
    /// Dilation angle psi [rad], 0 to the smallest friction angle.
    pub dilation: f64,
    /// Tension cut-off [Pa], 0 to the apex `c cot(phi)`.
    pub tension: Option<f64>,
}

const ROOT_TWO_THIRDS: f64 = 0.816496580927726;

impl MohrCoulomb {
    /// Tresca with `yield_stress` [Pa] as principal stress difference.
    pub fn tresca(yield_stress: f64) -> MohrCoulomb {
        MohrCoulomb {
            cohesion: Hardening::Constant(0.5 * yield_stress),
            friction: Hardening::Constant(0.0),
            dilation: 0.0,
            tension: None,
        }
    }

    /// Softening slope `dc/dkappa` [Pa] of nonunique returns:
    /// `dh/dkappa = sqrt(2/3) |D^-1 ds/dc| |dc/dkappa|` reaches 1; plane
    /// `-n.D.m / (2 cos(phi) sqrt(2/3) |m|)` with normal `n` and flow `m`.
    pub fn softening_limit(&self, elastic: &Elastic) -> f64 {
        let moduli = Moduli::new(elastic);
        let (low, high) = self.friction.range();
        let mut most = 0.0_f64;
        for phi in [low, high] {
            let strength = Strength::new((1.0, 1.0), (phi, 0.0), libm::sin(self.dilation), None);
            for region in [
                ReturnRegion::Plane,
                ReturnRegion::EdgeCompression,
                ReturnRegion::EdgeExtension,
                ReturnRegion::Apex,
                ReturnRegion::PlaneTension,
                ReturnRegion::EdgeCompressionTension,
                ReturnRegion::EdgeExtensionTension,
            ] {
                let absent = match region {
                    ReturnRegion::Apex => phi == 0.0,
                    ReturnRegion::Plane | ReturnRegion::EdgeCompression | ReturnRegion::EdgeExtension => {
                        false
                    }
                    _ => self.tension.is_none(),
                };
                if absent {
                    continue;
                }
                let rate = principal_return::rate(region, &[0.0; 3], &strength, &moduli);
                let strain = moduli.scaled_strain(&rate);
                let norm = strain.iter().map(|x| x * x).sum::<f64>().sqrt() / (2.0 * moduli.mu);
                most = most.max(ROOT_TWO_THIRDS * norm);
            }
        }
        -1.0 / most
    }

    fn strength(&self, kappa: f64) -> Strength {
        Strength::new(
            self.cohesion.at(kappa),
            self.friction.at(kappa),
            libm::sin(self.dilation),
            self.tension,
        )
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
        let mut strength = self.strength(old.kappa);
        if clearly_inside(trial, &strength) {
            return Ok(elastic_response(elastic, old, trial, want_tangent));
        }
        let spectrum = spectral::principal(trial);
        let t = spectrum.values;
        let size = t[0].abs().max(t[2].abs());
        let cut = strength.tension.unwrap_or(f64::INFINITY);
        if strength.plane(&t) <= YIELD_TOLERANCE * size && t[0] - cut <= YIELD_TOLERANCE * size {
            return Ok(elastic_response(elastic, old, trial, want_tangent));
        }
        let moduli = Moduli::new(elastic);
        let (mut s, mut region) = principal_return::project(&t, &strength, &moduli);
        let mut flow = plastic(&moduli, &t, &s);
        let mut kappa = old.kappa + equivalent(&flow);
        let hardens = !(self.cohesion.is_constant() && self.friction.is_constant());
        if hardens {
            kappa = local::solve_kappa(old.kappa, |kappa| {
                strength = self.strength(kappa);
                (s, region) = principal_return::project(&t, &strength, &moduli);
                flow = plastic(&moduli, &t, &s);
                let rate = principal_return::rate(region, &s, &strength, &moduli);
                (equivalent(&flow), -by_stress(&moduli, &flow, &rate))
            })?;
        }
        let mut state = PointState {
            stress: spectral::tensor(&s, &spectrum.axes),
            plastic_strain: spectral::tensor(&flow, &spectrum.axes),
            kappa,
        };
        for k in 0..6 {
            let strain = if k < 3 { 1.0 } else { 2.0 } * state.plastic_strain[k];
            state.plastic_strain[k] = old.plastic_strain[k] + strain;
        }
        if !(state.kappa + state.stress.iter().sum::<f64>()).is_finite() {
            return Err(ReturnError::NotFinite);
        }
        let mut tangent = [[0.0; 6]; 6];
        if want_tangent {
            let mut a = principal_return::tangent(region, &strength, &moduli);
            if hardens {
                add_hardening(&mut a, &s, &flow, region, &strength, &moduli);
            }
            tangent = spectral::stiffness(&spectrum.axes, &a, &shear_moduli(&t, &s, region, moduli.mu));
        }
        Ok(Response { state, region, tangent })
    }
}

impl ConstitutiveLaw for MohrCoulomb {
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

    /// Strain-norm hardening makes edge and apex tangents unsymmetric even for associated flow.
    fn has_symmetric_tangent(&self) -> bool {
        self.cohesion.is_constant() && self.is_associated()
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

    /// `max((s1 - s3)/2 + (s1 + s3)/2 sin(phi) - c cos(phi), s1 - tension)`.
    fn yield_function(&self, point: Point<'_>) -> f64 {
        let strength = self.strength(point.state.kappa);
        let s = spectral::principal(&point.state.stress).values;
        (0.5 * strength.plane(&s)).max(s[0] - strength.tension.unwrap_or(f64::INFINITY))
    }

    fn with_strength_divided_by(&self, factor: f64) -> MohrCoulomb {
        let strength::ReducedStrength { cohesion, friction, dilation, tension } =
            self.shared().with_strength_divided_by(factor);
        MohrCoulomb { cohesion, friction, dilation, tension }
    }
}

/// Bound without principal values, `q = sqrt(J2)`: `s1 <= p + 2 q / sqrt(3)`,
/// `f <= q sqrt(1 + sin²(phi)/3) + p sin(phi) - c cos(phi)`.
fn clearly_inside(t: &Voigt, strength: &Strength) -> bool {
    let (p, j2) = invariants(t);
    let q = j2.sqrt();
    let sin = strength.sin;
    q * (1.0 + sin * sin / 3.0).sqrt() + p * sin <= 0.5 * strength.k
        && strength.tension.is_none_or(|cut| p + 1.1547005383792517 * q <= cut)
}

fn plastic(moduli: &Moduli, trial: &[f64; 3], s: &[f64; 3]) -> [f64; 3] {
    moduli.scaled_strain(&[trial[0] - s[0], trial[1] - s[1], trial[2] - s[2]]).map(|x| x / (2.0 * moduli.mu))
}

fn equivalent(flow: &[f64; 3]) -> f64 {
    ROOT_TWO_THIRDS * (flow[0] * flow[0] + flow[1] * flow[1] + flow[2] * flow[2]).sqrt()
}

fn by_stress(moduli: &Moduli, flow: &[f64; 3], x: &[f64; 3]) -> f64 {
    let h = equivalent(flow);
    if h == 0.0 {
        return 0.0;
    }
    let strain = moduli.scaled_strain(x);
    let product: f64 = (0..3).map(|i| flow[i] * strain[i]).sum();
    product / (3.0 * moduli.mu * h)
}

/// Adds `ds/dkappa dkappa/de`, from `kappa - h(e, kappa) = const`.
fn add_hardening(
    a: &mut [[f64; 3]; 3],
    s: &[f64; 3],
    flow: &[f64; 3],
    region: ReturnRegion,
    strength: &Strength,
    moduli: &Moduli,
) {
    let h = equivalent(flow);
    if h == 0.0 {
        return;
    }
    let rate = principal_return::rate(region, s, strength, moduli);
    let v = moduli.scaled_strain(flow).map(|x| x / (2.0 * moduli.mu));
    let scale = 2.0 / (3.0 * h * (1.0 + by_stress(moduli, flow, &rate)));
    let kappa: [f64; 3] =
        std::array::from_fn(|j| scale * (flow[j] - v[0] * a[0][j] - v[1] * a[1][j] - v[2] * a[2][j]));
    for i in 0..3 {
        for j in 0..3 {
            a[i][j] += rate[i] * kappa[j];
        }
    }
}

/// Spin terms of the tangent, `mu (s_i - s_j) / (t_i - t_j)`; for equal trial values 0 if kept equal, else
/// `mu`.
fn shear_moduli(t: &[f64; 3], s: &[f64; 3], region: ReturnRegion, mu: f64) -> [f64; 3] {
    let (first, second) = principal_return::equal_pairs(region);
    let size = t[0].abs().max(t[2].abs());
    let ratio = |i: usize, j: usize, equal: bool| {
        let gap = t[i] - t[j];
        if equal {
            0.0
        } else if gap <= 1e-14 * size {
            mu
        } else {
            mu * ((s[i] - s[j]) / gap).clamp(0.0, 1.0)
        }
    };
    [ratio(0, 1, first), ratio(1, 2, second), ratio(0, 2, first && second)]
}
