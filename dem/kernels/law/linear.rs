//! Normal law: linear spring and dashpot.
//!
//! C = 2ζ√(m*K), m* of the *bodies*; ζ from restitution (`restitution.rs`). Source: Cundall & Strack,
//! Géotechnique 29 (1979).
//!
//! Theory manual: eq. (1.3), `docs/theory/contacts.md`.

use super::constants::constants;
use super::half_step_damping;
use super::material::Pair;
use super::normal::{ConstantStiffness, NormalInput, NormalLaw, Response};
use crate::lanes::Real;

/// Pair constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<R = f64> {
    /// Normal stiffness K [N/m].
    pub stiffness: R,
    /// C/√m* = 2ζ√K [√(N/m)].
    damping: R,
    /// Damping ratio ζ [-].
    damping_ratio: R,
}

constants!(Linear { stiffness, damping, damping_ratio });

impl NormalLaw for Linear {
    const NAME: &'static str = "linear";
    const SOURCE: &'static str = super::spring::SOURCE;
    const KEYS: &'static [&'static str] = &["stiffness"];
    const DASHPOT: bool = true;
    const REMEMBERS: bool = false;
    const JUMPS: bool = true;
    const STIFFENS: bool = false;

    fn mix(pair: &Pair<'_>, zeta: f64) -> Linear {
        let stiffness = pair.stiffness();
        Linear { stiffness, damping: 2.0 * zeta * stiffness.sqrt(), damping_ratio: zeta }
    }

    #[inline(always)]
    fn respond<R: Real>(law: &Linear<R>, touch: &NormalInput<R>) -> Response<R> {
        let root = touch.inverse_mass.sqrt();
        let (numerator, denominator) =
            half_step_damping::share(R::splat(0.5) * law.damping * touch.step * root);
        let circle = (touch.radius * touch.overlap).sqrt();
        Response {
            elastic: law.stiffness * touch.overlap,
            damping: law.damping * numerator / (root * denominator),
            circle,
            circle_before: circle,
            remembered: touch.remembered,
            lost: R::zero(),
        }
    }

    #[inline(always)]
    fn force(&self, overlap: f64, _: f64, _: f64) -> f64 {
        self.stiffness * overlap
    }

    fn stored(&self, overlap: f64, _: f64, _: f64) -> f64 {
        0.5 * self.stiffness * overlap * overlap
    }

    fn loading(&self, overlap: f64, _: f64) -> (f64, f64) {
        (self.stiffness * overlap, self.stiffness)
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.stiffness
    }

    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }
}

impl ConstantStiffness for Linear {
    fn constant(&self) -> f64 {
        self.stiffness
    }
}
