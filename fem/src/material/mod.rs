//! Constitutive laws; tensors xx, yy, zz, xy, yz, zx, tension positive, engineering shear.
//!
//! Implicit (backward Euler) return mapping: Simo and Hughes (1998), chapters 3 and 5; de Souza Neto, Peric
//! and Owen (2008), chapters 7 and 8. Limits: small strain, isotropy.
//!
//! The consistent tangent of [`update`] is singular at apexes, corners and Mohr–Coulomb edges (triaxial
//! compression under load control). [`regularise`] mixes in the elastic matrix.
mod call_error;
mod cam_clay_return;
pub mod drucker_prager;
pub mod elastic;
pub mod hardening;
mod law;
mod linear_elastic;
mod local;
pub mod modified_cam_clay;
pub mod mohr_coulomb;
mod point;
mod principal_return;
mod spectral;
mod strength;
pub mod umat;

pub use call_error::CallError;
pub use drucker_prager::{Cone, DruckerPrager};
pub use elastic::{Elastic, InvalidConstant};
pub use hardening::Hardening;
pub use law::{ConstitutiveLaw, Response, ReturnError, StateValue};
pub use linear_elastic::LinearElastic;
pub use modified_cam_clay::{Consolidation, ModifiedCamClay, Shear};
pub use mohr_coulomb::MohrCoulomb;
pub use point::{Point, PointState, Points, ReturnRegion, UpdateContext};
pub use umat::UserMaterial;

use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// Elastic fraction for [`regularise`] in a global Newton iteration.
pub const REGULARISATION: f64 = 1e-6;

/// Enum of all laws; `update`, the most frequent call, uses a match.
macro_rules! laws {
    ($($(#[$doc:meta])* $law:ident,)*) => {
        /// Constitutive laws.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Law {
            $($(#[$doc])* $law($law),)*
        }

        $(impl From<$law> for Law {
            fn from(law: $law) -> Law {
                Law::$law(law)
            }
        })*

        impl Law {
            fn get(&self) -> &(dyn ConstitutiveLaw + 'static) {
                match self {
                    $(Law::$law(law) => law,)*
                }
            }

            /// See [`ConstitutiveLaw::update`].
            ///
            /// # Errors
            /// [`ReturnError`].
            #[inline]
            pub fn update(
                &self,
                elastic: &Elastic,
                old: Point<'_>,
                increment: &[f64; 6],
                want_tangent: bool,
                values: &mut [f64],
            ) -> Result<Response, ReturnError> {
                match self {
                    $(Law::$law(law) => law.update(elastic, old, increment, want_tangent, values),)*
                }
            }

            /// See [`ConstitutiveLaw::reduced`].
            #[must_use]
            pub fn with_strength_divided_by(&self, factor: f64) -> Law {
                match self {
                    $(Law::$law(law) => Law::$law(law.with_strength_divided_by(factor)),)*
                }
            }
        }
    };
}

impl Deref for Law {
    type Target = dyn ConstitutiveLaw;

    fn deref(&self) -> &Self::Target {
        self.get()
    }
}

laws! {
    /// No yield surface.
    LinearElastic,
    /// Mohr–Coulomb (and Tresca) with Rankine tension cut-off.
    MohrCoulomb,
    /// Drucker–Prager (and von Mises) with mean-stress cap.
    DruckerPrager,
    /// Modified Cam clay.
    ModifiedCamClay,
    /// Routine of a shared library.
    #[serde(skip)]
    UserMaterial,
}

/// Material of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Elastic constants and density (at the reference state).
    pub elastic: Elastic,
    /// Constitutive law.
    pub law: Law,
}

impl From<Elastic> for Material {
    fn from(elastic: Elastic) -> Self {
        Material { elastic, law: LinearElastic.into() }
    }
}

impl Material {
    /// Material with a nonlinear law.
    pub fn plastic(elastic: Elastic, law: impl Into<Law>) -> Self {
        Material { elastic, law: law.into() }
    }

    /// First invalid constant: name, value, expectation.
    pub fn invalid_constant(&self) -> Option<InvalidConstant> {
        let (law, elastic) =
            (|| self.law.invalid_constant(&self.elastic), || self.elastic.invalid_constant());
        // Derived constants are invalid only if the law's are.
        if self.law.has_constant_elasticity() { elastic().or_else(law) } else { law().or_else(elastic) }
    }

    /// Whether stress is proportional to strain.
    pub fn is_linear(&self) -> bool {
        self.law.is_linear()
    }

    /// Whether the tangent is always symmetric.
    pub fn symmetric_tangent(&self) -> bool {
        self.law.has_symmetric_tangent()
    }

    /// Material with strength divided by `factor`, see [`ConstitutiveLaw::reduced`].
    pub fn with_strength_divided_by(&self, factor: f64) -> Material {
        Material { elastic: self.elastic, law: self.law.with_strength_divided_by(factor) }
    }
}

/// Updates a point of a law without state values, as [`ConstitutiveLaw::update`].
///
/// # Errors
/// [`ReturnError`]; perfect plasticity only fails on values not finite.
pub fn update(
    material: &Material,
    old: &PointState,
    increment: &[f64; 6],
    want_tangent: bool,
) -> Result<Response, ReturnError> {
    material.law.update(&material.elastic, old.into(), increment, want_tangent, &mut [])
}

/// Yield function of a law without state values, see [`ConstitutiveLaw::yield_function`].
pub fn yield_function(material: &Material, state: &PointState) -> f64 {
    material.law.yield_function(state.into())
}

/// Principal values of a symmetric tensor, descending; tensor shear.
pub fn principal_values(tensor: &[f64; 6]) -> [f64; 3] {
    spectral::principal(tensor).values
}

/// Sets `tangent` to `(1 - fraction) tangent + fraction D` [Pa].
pub fn regularise(tangent: &mut [[f64; 6]; 6], elastic: &Elastic, fraction: f64) {
    let matrix = elastic.matrix();
    for (row, elastic_row) in tangent.iter_mut().zip(&matrix) {
        for (c, d) in row.iter_mut().zip(elastic_row) {
            *c += fraction * (d - *c);
        }
    }
}
