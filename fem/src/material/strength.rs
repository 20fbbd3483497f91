//! Strength parameters shared by Coulomb-type criteria.
//!
//! Theory manual: equation (4.16) of `docs/theory/solid.md`.

use super::elastic::InvalidConstant;
use super::hardening::Hardening;

pub(super) const SOURCE: &str = "plasticity: return maps in principal stresses, de Souza Neto, Peric & Owen 2008; Clausen, \
                                 Damkilde & Andersen 2006";

pub(super) struct Strength<'a> {
    pub cohesion: &'a Hardening,
    pub friction: &'a Hardening,
    pub dilation: f64,
    pub tension: Option<f64>,
}

pub(super) struct ReducedStrength {
    pub cohesion: Hardening,
    pub friction: Hardening,
    pub dilation: f64,
    pub tension: Option<f64>,
}

impl Strength<'_> {
    /// Strength divided by `factor`: `c / F`, `tan(phi) / F`, cut-off `/ F`; dilation angle capped by the
    /// reduced friction angle. Source: Griffiths and Lane (1999), equations 1 and 2.
    pub fn with_strength_divided_by(&self, factor: f64) -> ReducedStrength {
        let friction = self.friction.map(|phi| libm::atan(libm::tan(phi) / factor));
        ReducedStrength {
            cohesion: self.cohesion.map(|c| c / factor),
            dilation: self.dilation.min(friction.range().0),
            friction,
            tension: self.tension.map(|t| t / factor),
        }
    }

    pub fn is_associated(&self) -> bool {
        *self.friction == Hardening::Constant(self.dilation)
    }

    /// First invalid constant; cohesion softening must exceed `softening_limit` [Pa].
    pub fn invalid_constant(&self, softening_limit: impl FnOnce() -> f64) -> Option<InvalidConstant> {
        let Strength { cohesion, friction, dilation, tension } = *self;
        if let Some(fault) = friction
            .invalid_constant("friction angle", true)
            .or_else(|| cohesion.invalid_constant("cohesion", false))
        {
            return Some(fault);
        }
        let (phi, phi_high) = friction.range();
        if phi < 0.0 {
            return Some(("friction angle", phi, "0 or above"));
        }
        if phi_high >= std::f64::consts::FRAC_PI_2 {
            return Some(("friction angle", phi_high, "an angle below pi/2 (in radians)"));
        }
        let c = cohesion.range().0;
        if c < 0.0 {
            return Some(("cohesion", c, "0 or above"));
        }
        if c == 0.0 && phi == 0.0 {
            return Some(("cohesion", c, "a value above 0 if the friction angle is 0"));
        }
        if !(dilation >= 0.0 && dilation <= phi) {
            return Some(("dilation angle", dilation, "between 0 and the smallest friction angle"));
        }
        if let Some(t) = tension {
            if !(t >= 0.0 && t.is_finite()) {
                return Some(("tension cut-off", t, "a finite number, 0 or above"));
            }
            let (c, phi) = (cohesion.at(0.0).0, friction.at(0.0).0);
            if t * libm::sin(phi) > c * libm::cos(phi) {
                return Some(("tension cut-off", t, "at most c cot(phi), the apex"));
            }
        }
        let fall = cohesion.steepest_fall();
        let expected = "softening less steep than the limit at which a point snaps back";
        (fall < 0.0 && fall <= softening_limit()).then_some(("cohesion", fall, expected))
    }
}
