//! Interface of tangential laws.

use super::constants::Constants;
use super::material::Pair;
use super::normal::NormalLaw;
use crate::lanes::Real;

/// Tangential spring, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct SpringInput<R> {
    /// Stiffness Ks [N/m].
    pub stiffness: R,
    /// 1/Ks [m/N], if constant.
    pub compliance: Option<R>,
}

/// Effect of an overlap change, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct SpringTransfer<R> {
    /// Length fraction kept [-].
    pub kept: R,
    /// Energy loss over previous length squared [N/m].
    pub loss: R,
}

/// Tangential law for normal law `N`: pair constants, also for rolling and twisting springs.
pub trait TangentialLaw<N: NormalLaw>: Constants {
    /// Scene name.
    const NAME: &'static str;
    /// Source.
    const SOURCE: &'static str;
    /// Required material keys.
    const KEYS: &'static [&'static str];

    /// Mixes two materials.
    fn mix(pair: &Pair<'_>, normal: &N) -> Self;

    /// Returns the spring for circle radius `circle` [m].
    fn grip<R: Real>(law: &Self::Lanes<R>, circle: R) -> SpringInput<R>;

    /// Returns the friction limit [N], by default Coulomb's.
    #[inline(always)]
    fn limit<R: Real>(_: &Self::Lanes<R>, friction: R, normal: R, _radius: R) -> R {
        friction * normal
    }

    /// Transfers springs from circle radius `before` to `circle` [m]; `None`: unchanged.
    fn transfer_spring<R: Real>(law: &Self::Lanes<R>, circle: R, before: R) -> Option<SpringTransfer<R>>;

    /// Returns the stiffness at contact end, unless zero.
    fn at_end<R: Real>(law: &Self::Lanes<R>) -> Option<R>;

    /// Returns the stiffness [N/m] for radius `circle` [m].
    fn stiffness(&self, circle: f64) -> f64;
}
