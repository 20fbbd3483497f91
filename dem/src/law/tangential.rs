//! The tangential part of a law: the stiffness of the spring that Coulomb friction limits (`slide.rs`), and how it is
//! carried over when the overlap changes.

use super::constants::Constants;
use super::material::Pair;
use super::normal::NormalLaw;
use crate::lanes::Real;

/// The spring of contacts, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Grip<R> {
    /// Stiffness Ks [N/m].
    pub stiffness: R,
    /// 1/Ks [m/N], where it is known beforehand.
    pub compliance: Option<R>,
}

/// What a change of the overlap does to springs of stiffness Ks, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Carried<R> {
    /// Part of their length that they keep [-].
    pub kept: R,
    /// Energy that they lose, over their length squared before [N/m].
    pub loss: R,
}

/// A tangential law beside the normal law `N`: constants of one pair of materials. Rolling and twisting springs have the
/// same stiffness and are carried over alike.
pub trait TangentialLaw<N: NormalLaw>: Constants {
    /// Name in a scene.
    const NAME: &'static str;
    /// Where it is published.
    const SOURCE: &'static str;
    /// Keys of a material that it needs.
    const KEYS: &'static [&'static str];

    /// Mixes the constants of two materials.
    fn mix(pair: &Pair<'_>, normal: &N) -> Self;

    /// The springs of contacts whose circles have the radius `circle` [m].
    fn grip<R: Real>(law: &Self::Lanes<R>, circle: R) -> Grip<R>;

    /// Largest tangential force [N] of contacts with the coefficient `friction`, the normal force `normal` [N], the effective radius
    /// `radius` [m] and a circle of the radius `circle` [m].
    #[inline(always)]
    fn limit<R: Real>(_: &Self::Lanes<R>, friction: R, normal: R, _radius: R, _circle: R) -> R {
        friction * normal
    }

    /// How springs are carried over to a circle of the radius `circle` from one of the radius `before` [m]; `None`: as they are.
    fn carry<R: Real>(law: &Self::Lanes<R>, circle: R, before: R) -> Option<Carried<R>>;

    /// Stiffness of springs in a contact that ends, where the law has not brought it to zero by then.
    fn at_end<R: Real>(law: &Self::Lanes<R>) -> Option<R>;

    /// Stiffness [N/m] of a contact whose circle has the radius `circle` [m].
    fn stiffness(&self, circle: f64) -> f64;
}
