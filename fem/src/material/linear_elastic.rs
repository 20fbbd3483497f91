//! Linear elasticity as a constitutive law.

use super::elastic::{Elastic, InvalidConstant};
use super::law::{ConstitutiveLaw, Response, ReturnError, elastic_response, elastic_trial};
use super::point::Point;
use serde::{Deserialize, Serialize};

/// Stress proportional to strain, without a yield surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinearElastic;

impl ConstitutiveLaw for LinearElastic {
    fn source(&self) -> &'static str {
        "linear elasticity: Timoshenko & Goodier, Theory of Elasticity 1970"
    }

    fn invalid_constant(&self, _: &Elastic) -> Option<InvalidConstant> {
        None
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn is_associated(&self) -> bool {
        true
    }

    fn has_symmetric_tangent(&self) -> bool {
        true
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
        Ok(elastic_response(elastic, old.state, &trial, want_tangent))
    }

    fn yield_function(&self, _: Point<'_>) -> f64 {
        f64::NEG_INFINITY
    }

    fn with_strength_divided_by(&self, _: f64) -> LinearElastic {
        LinearElastic
    }
}
