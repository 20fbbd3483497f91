//! Interface of constitutive laws.

use super::call_error::CallError;
use super::elastic::{Elastic, InvalidConstant};
use super::point::{Point, PointState, ReturnRegion};
use std::borrow::Cow;
use thiserror::Error;

/// Relative overshoot that still counts as elastic.
pub(super) const YIELD_TOLERANCE: f64 = 1e-12;

/// State value of a law beyond [`PointState`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateValue {
    /// Column name.
    pub name: Cow<'static, str>,
    /// Unit; empty if dimensionless.
    pub unit: Cow<'static, str>,
}

/// Result of [`ConstitutiveLaw::update`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Final stress and history.
    pub state: PointState,
    /// Region of the final stress.
    pub region: ReturnRegion,
    /// Consistent tangent [Pa], `d stress[i] / d strain[j]`, engineering shear; zero unless requested.
    pub tangent: [[f64; 6]; 6],
}

/// Failed update; the old state is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ReturnError {
    /// Trial stress or result not finite.
    #[error("stress at an integration point is not finite")]
    NotFinite,
    /// Iteration for `kappa` stalled.
    #[error("return mapping not converged (equivalent plastic strain {kappa})")]
    NotConverged {
        /// Equivalent plastic strain at the last iteration.
        kappa: f64,
    },
    /// Softening steeper than elastic unloading: no unique solution.
    #[error("softening is too steep for the elastic stiffness (equivalent plastic strain {kappa})")]
    Softening {
        /// Equivalent plastic strain.
        kappa: f64,
    },
    /// Failed call of a user material.
    #[error(transparent)]
    UserMaterial(#[from] CallError),
}

/// Constitutive law: stress and history of an integration point.
///
/// [`Elastic`] is the reference elasticity of constant matrices (first iteration, Rayleigh damping,
/// boundaries). Tension is positive; order xx, yy, zz, xy, yz, zx, engineering shear.
pub trait ConstitutiveLaw {
    /// Reference of the equations.
    fn source(&self) -> &'static str;

    /// First invalid constant.
    fn invalid_constant(&self, elastic: &Elastic) -> Option<InvalidConstant>;

    /// Whether stress is proportional to strain, as linear solvers require.
    fn is_linear(&self) -> bool {
        false
    }

    /// Whether elastic steps have the matrix of [`Elastic`] at every stress.
    fn has_constant_elasticity(&self) -> bool {
        true
    }

    /// Whether elastic cycles dissipate nothing: [`ConstitutiveLaw::stored_energy`] is a stress potential.
    fn is_conservative(&self) -> bool {
        true
    }

    /// Whether plastic flow is associated, so that plastic work is never negative.
    fn is_associated(&self) -> bool;

    /// Whether the plastic strain is a state of the law, rather than the strain beyond the reference elasticity.
    fn has_plastic_strain(&self) -> bool {
        true
    }

    /// Whether the response is the same in all directions, so that it rotates with stress and strain.
    fn is_isotropic(&self) -> bool {
        true
    }

    /// Whether the tangent is always symmetric.
    fn has_symmetric_tangent(&self) -> bool;

    /// State values of this law.
    fn state_values(&self) -> &[StateValue] {
        &[]
    }

    /// Sets the initial state values under `stress` [Pa]. Shape `[state_values]`.
    fn initial_values(&self, _elastic: &Elastic, _stress: &[f64; 6], _values: &mut [f64]) {}

    /// Integrates a strain increment [-] (engineering shear) from a committed state.
    ///
    /// `values` receives the new state values; requires no [`ConstitutiveLaw::invalid_constant`].
    ///
    /// # Errors
    /// See [`ReturnError`].
    fn update(
        &self,
        elastic: &Elastic,
        old: Point<'_>,
        increment: &[f64; 6],
        want_tangent: bool,
        values: &mut [f64],
    ) -> Result<Response, ReturnError>;

    /// Elastic tangent at a point [Pa].
    fn elastic_tangent(&self, elastic: &Elastic, _point: Point<'_>) -> [[f64; 6]; 6] {
        elastic.matrix()
    }

    /// Elastic energy of a point [J/m³].
    fn stored_energy(&self, elastic: &Elastic, point: Point<'_>) -> f64 {
        elastic.stored_energy(&point.state.stress)
    }

    /// Energy dissipated from `old` to `new` [J/m³]; default: work of the mean stress on the plastic strain.
    fn dissipation(&self, _old: Point<'_>, _new: Point<'_>) -> Option<f64> {
        None
    }

    /// Yield function [Pa], at most 0 inside; minus infinity without yield surface.
    fn yield_function(&self, point: Point<'_>) -> f64;

    /// Law with strength divided by `factor` (above 0).
    #[must_use]
    fn with_strength_divided_by(&self, factor: f64) -> Self
    where
        Self: Sized;
}

pub(super) fn elastic_trial(
    elastic: &Elastic,
    old: &PointState,
    increment: &[f64; 6],
) -> Result<[f64; 6], ReturnError> {
    let step = elastic.stress(increment);
    let trial: [f64; 6] = std::array::from_fn(|k| old.stress[k] + step[k]);
    if trial.iter().sum::<f64>().is_finite() { Ok(trial) } else { Err(ReturnError::NotFinite) }
}

pub(super) fn elastic_response(
    elastic: &Elastic,
    old: &PointState,
    trial: &[f64; 6],
    want_tangent: bool,
) -> Response {
    let tangent = if want_tangent { elastic.matrix() } else { [[0.0; 6]; 6] };
    Response { state: PointState { stress: *trial, ..*old }, region: ReturnRegion::Elastic, tangent }
}
