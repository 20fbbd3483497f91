//! Constitutive laws at an integration point. Symmetric tensors are ordered xx, yy, zz, xy, yz, zx; tension is positive;
//! shear strains are engineering strains.
//!
//! A [`Material`] is isotropic elasticity with a [`Law`]; a law is whatever implements [`ConstitutiveLaw`] and stands in
//! the list of this module. The plastic laws integrate a strain increment by the implicit (backward Euler) rule: elastic
//! trial, then return to the yield surface of the strength at the end of the step. Source: Simo and Hughes, Computational
//! Inelasticity (1998), chapters 3 and 5; de Souza Neto, Peric and Owen, Computational Methods for Plasticity (2008),
//! chapters 7 and 8. Limits: small strain, isotropy.
//!
//! The tangent of [`update`] is the consistent one: the exact derivative of the returned stress with respect to the
//! strain increment. It is singular where the strength fixes the stress: at every apex and corner, and on the edges of
//! Mohr–Coulomb, where the split of the flow between two principal directions is not unique (triaxial compression with
//! two equal lateral stresses under load control is the well-known case). [`regularise`] mixes in a small part of the
//! elastic matrix for use in a global Newton iteration; this changes the path of the iteration, not its solution.
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

pub use drucker_prager::{Cone, DruckerPrager};
pub use elastic::{Elastic, Fault};
pub use hardening::Hardening;
pub use law::{ConstitutiveLaw, Response, ReturnError, StateValue};
pub use linear_elastic::LinearElastic;
pub use modified_cam_clay::{Consolidation, ModifiedCamClay, Shear};
pub use mohr_coulomb::MohrCoulomb;
pub use point::{Point, PointState, Points, Region};

use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// The share of the elastic matrix that [`regularise`] needs for a global Newton iteration to pass singular tangents.
pub const REGULARISATION: f64 = 1e-6;

/// Makes the enum of all laws. The update, which a run calls most, is dispatched by a match; the rest by a table.
macro_rules! laws {
    ($($(#[$doc:meta])* $law:ident,)*) => {
        /// One of the constitutive laws.
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

            /// As [`ConstitutiveLaw::update`].
            ///
            /// # Errors
            /// See [`ReturnError`].
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

            /// As [`ConstitutiveLaw::reduced`].
            #[must_use]
            pub fn reduced(&self, factor: f64) -> Law {
                match self {
                    $(Law::$law(law) => Law::$law(law.reduced(factor)),)*
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
    /// Mohr–Coulomb (and Tresca), with a Rankine tension cut-off.
    MohrCoulomb,
    /// Drucker–Prager (and von Mises), with a cap on the mean stress.
    DruckerPrager,
    /// Modified Cam clay: ellipse, volumetric hardening, stiffness in proportion to the pressure.
    ModifiedCamClay,
}

/// What a mesh's material number stands for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Elastic constants and density; for a law with an elasticity of its own those at its reference state.
    pub elastic: Elastic,
    /// The constitutive law.
    pub law: Law,
}

impl From<Elastic> for Material {
    fn from(elastic: Elastic) -> Self {
        Material { elastic, law: LinearElastic.into() }
    }
}

impl Material {
    /// A material with a law that is not linear.
    pub fn plastic(elastic: Elastic, law: impl Into<Law>) -> Self {
        Material { elastic, law: law.into() }
    }

    /// What makes the constants unusable, if anything: the name of the constant, its value and what is expected of it.
    pub fn fault(&self) -> Option<Fault> {
        let (law, elastic) = (|| self.law.fault(&self.elastic), || self.elastic.fault());
        // Reference constants that a law derives are faulty only where its own are.
        if self.law.has_constant_elasticity() { elastic().or_else(law) } else { law().or_else(elastic) }
    }

    /// Whether stress is proportional to strain.
    pub fn is_linear(&self) -> bool {
        self.law.is_linear()
    }

    /// Whether the consistent tangent is symmetric wherever a step ends.
    pub fn symmetric_tangent(&self) -> bool {
        self.law.has_symmetric_tangent()
    }

    /// The material with its strength divided by `factor` (above 0), see [`ConstitutiveLaw::reduced`].
    pub fn reduced(&self, factor: f64) -> Material {
        Material { elastic: self.elastic, law: self.law.reduced(factor) }
    }
}

/// Stress, history and, if `want_tangent`, the consistent tangent after a strain increment from an old, committed state
/// of a law without values of its own; with them see [`ConstitutiveLaw::update`].
///
/// # Errors
/// See [`ReturnError`]; perfect plasticity only fails on numbers that are not finite.
pub fn update(
    material: &Material,
    old: &PointState,
    increment: &[f64; 6],
    want_tangent: bool,
) -> Result<Response, ReturnError> {
    material.law.update(&material.elastic, old.into(), increment, want_tangent, &mut [])
}

/// Value of the yield function of a law without values of its own, see [`ConstitutiveLaw::yield_function`].
pub fn yield_function(material: &Material, state: &PointState) -> f64 {
    material.law.yield_function(state.into())
}

/// `tangent` becomes `(1 - fraction) tangent + fraction D`, `D` the elastic matrix [Pa]. [`REGULARISATION`] as the
/// fraction is enough for a global Newton iteration to pass singular tangents, at the price of a linear rate of that
/// order.
pub fn regularise(tangent: &mut [[f64; 6]; 6], elastic: &Elastic, fraction: f64) {
    let matrix = elastic.matrix();
    for (row, elastic_row) in tangent.iter_mut().zip(&matrix) {
        for (c, d) in row.iter_mut().zip(elastic_row) {
            *c += fraction * (d - *c);
        }
    }
}
