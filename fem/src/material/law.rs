//! What a constitutive law is: the one interface through which the rest of the crate works with materials.

use super::elastic::{Elastic, Fault};
use super::point::{Point, PointState, Region};
use thiserror::Error;

/// A stress on the yield surface counts as elastic up to this overshoot, relative to the size of the stress.
pub(super) const YIELD_TOLERANCE: f64 = 1e-12;

/// A value that a law keeps at every integration point beside [`PointState`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateValue {
    /// Name as in a table of results.
    pub name: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
}

/// What [`ConstitutiveLaw::update`] returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Stress and history at the end of the step.
    pub state: PointState,
    /// Where the step ended.
    pub region: Region,
    /// Consistent tangent [Pa], `d stress[i] / d strain[j]` with engineering shear; zeros where it was not requested.
    pub tangent: [[f64; 6]; 6],
}

/// Why a step has no result. The old state is untouched; a smaller step may pass.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ReturnError {
    /// The trial stress or the return holds a number that is not finite.
    #[error("stress at an integration point is not finite")]
    NotFinite,
    /// The iteration for `kappa` stalled.
    #[error("return mapping not converged (equivalent plastic strain {kappa})")]
    NotConverged {
        /// Equivalent plastic strain at the last iteration.
        kappa: f64,
    },
    /// The strength falls faster than elastic unloading can follow: the local problem has no unique solution.
    #[error("softening is too steep for the elastic stiffness (equivalent plastic strain {kappa})")]
    Softening {
        /// Equivalent plastic strain at which it was noticed.
        kappa: f64,
    },
}

/// A constitutive law: stress and history of an integration point from its strain.
///
/// Every method is given the material's [`Elastic`], isotropic elasticity at the reference state of the law, from which
/// the constant matrices of a model are assembled (stiffness of the first iteration, Rayleigh damping, boundaries). A law
/// whose elasticity is not constant says so and states its own tangent. Stresses are positive in tension; tensors are
/// ordered xx, yy, zz, xy, yz, zx with engineering shear strain.
///
/// The rules below are what the conformance suite tests of every law.
pub trait ConstitutiveLaw {
    /// Where the equations come from, for the list of sources of a run.
    fn source(&self) -> &'static str;

    /// What makes the constants unusable, if anything.
    fn fault(&self, elastic: &Elastic) -> Option<Fault>;

    /// Whether stress is proportional to strain. Only such a law may be given to the linear solvers.
    fn is_linear(&self) -> bool {
        false
    }

    /// Whether elastic steps have the matrix of [`Elastic`] at every stress.
    fn has_constant_elasticity(&self) -> bool {
        true
    }

    /// Whether a closed cycle of elastic strain gives back all its work, so that [`ConstitutiveLaw::stored_energy`] is a
    /// potential of the stress.
    fn is_conservative(&self) -> bool {
        true
    }

    /// Whether plastic flow is normal to the yield surface, so that plastic work is never negative.
    fn is_associated(&self) -> bool;

    /// Whether the consistent tangent is symmetric wherever the step ends.
    fn has_symmetric_tangent(&self) -> bool;

    /// The values that the law keeps at each point of its own.
    fn state_values(&self) -> &'static [StateValue] {
        &[]
    }

    /// Sets the law's own values for a point that starts under `stress` [Pa]. Shape `[state_values]`.
    fn initial_values(&self, _stress: &[f64; 6], _values: &mut [f64]) {}

    /// Stress, history and, if `want_tangent`, the consistent tangent after a strain increment from an old, committed
    /// state. The law's own values at the end go to `values`. Constants must be without [`ConstitutiveLaw::fault`].
    ///
    /// `increment` [-] is the total increment of the step with engineering shear.
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

    /// Value of the yield function [Pa], at or below 0 inside the surface; minus infinity without a yield surface.
    fn yield_function(&self, point: Point<'_>) -> f64;

    /// The law with its strength divided by `factor` (above 0), elasticity as it is.
    #[must_use]
    fn reduced(&self, factor: f64) -> Self
    where
        Self: Sized;
}

/// `old.stress + D increment` of linear elasticity.
pub(super) fn elastic_trial(
    elastic: &Elastic,
    old: &PointState,
    increment: &[f64; 6],
) -> Result<[f64; 6], ReturnError> {
    let step = elastic.stress(increment);
    let trial: [f64; 6] = std::array::from_fn(|k| old.stress[k] + step[k]);
    if trial.iter().sum::<f64>().is_finite() { Ok(trial) } else { Err(ReturnError::NotFinite) }
}

/// A step that stayed inside the yield surface.
pub(super) fn elastic_response(
    elastic: &Elastic,
    old: &PointState,
    trial: &[f64; 6],
    want_tangent: bool,
) -> Response {
    let tangent = if want_tangent { elastic.matrix() } else { [[0.0; 6]; 6] };
    Response { state: PointState { stress: *trial, ..*old }, region: Region::Elastic, tangent }
}
