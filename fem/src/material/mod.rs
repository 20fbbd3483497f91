//! Materials at a Gauss point. Symmetric tensors are ordered xx, yy, zz, xy, yz, zx; tension is positive; shear
//! strains are engineering strains.
//!
//! [`update`] integrates a strain increment by the implicit (backward Euler) rule: elastic trial, then return to the
//! yield surface of the strength at the end of the step. Source: Simo and Hughes, Computational Inelasticity (1998),
//! chapters 3 and 5; de Souza Neto, Peric and Owen, Computational Methods for Plasticity (2008), chapters 7 and 8.
//! Limits: small strain, isotropic elasticity that does not depend on pressure, isotropic hardening.
//!
//! The tangent of [`update`] is the consistent one: the exact derivative of the returned stress with respect to the
//! strain increment. It is singular where the strength fixes the stress: at every apex and corner, and on the edges of
//! Mohr–Coulomb, where the split of the flow between two principal directions is not unique (triaxial compression with
//! two equal lateral stresses under load control is the well-known case). [`regularise`] mixes in a small part of the
//! elastic matrix for use in a global Newton iteration; this changes the path of the iteration, not its solution.
pub mod drucker_prager;
pub mod elastic;
pub mod hardening;
mod local;
pub mod mohr_coulomb;
mod principal_return;
mod spectral;

pub use drucker_prager::{Cone, DruckerPrager};
pub use elastic::Elastic;
pub use hardening::Hardening;
pub use mohr_coulomb::MohrCoulomb;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// An unusable constant: its name, its value, and what is asked of it.
pub type Fault = (&'static str, f64, &'static str);

/// A stress on the yield surface counts as elastic up to this overshoot, relative to the size of the stress.
const YIELD_TOLERANCE: f64 = 1e-12;

/// The share of the elastic matrix that [`regularise`] needs for a global Newton iteration to pass singular tangents.
pub const REGULARISATION: f64 = 1e-6;

/// What a mesh's material number stands for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Elastic constants and density.
    pub elastic: Elastic,
    /// Yield surface, flow rule and hardening; none for a linear elastic material.
    pub plasticity: Option<Plasticity>,
}

/// The yield criterion with its flow rule and hardening.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Plasticity {
    /// Mohr–Coulomb (and Tresca), with a Rankine tension cut-off.
    MohrCoulomb(MohrCoulomb),
    /// Drucker–Prager (and von Mises), with a cap on the mean stress.
    DruckerPrager(DruckerPrager),
}

impl From<Elastic> for Material {
    fn from(elastic: Elastic) -> Self {
        Material { elastic, plasticity: None }
    }
}

impl Material {
    /// An elastic and plastic material.
    pub fn plastic(elastic: Elastic, plasticity: impl Into<Plasticity>) -> Self {
        Material { elastic, plasticity: Some(plasticity.into()) }
    }

    /// What makes the constants unusable, if anything: the name of the constant, its value and what is asked of it.
    pub fn fault(&self) -> Option<Fault> {
        self.elastic.fault().or_else(|| match &self.plasticity {
            None => None,
            Some(Plasticity::MohrCoulomb(law)) => law.fault(&self.elastic),
            Some(Plasticity::DruckerPrager(law)) => law.fault(&self.elastic),
        })
    }

    /// Whether stress is proportional to strain: no plasticity.
    pub fn is_linear(&self) -> bool {
        self.plasticity.is_none()
    }

    /// Whether the consistent tangent is symmetric in every region: no plasticity, or associated flow without hardening
    /// (von Mises without a cap: with hardening too). Hardening by the norm of the plastic strain makes the tangent
    /// unsymmetric on edges and at apexes also where the flow is associated.
    pub fn symmetric_tangent(&self) -> bool {
        match &self.plasticity {
            None => true,
            Some(Plasticity::MohrCoulomb(law)) => {
                law.cohesion.is_constant() && law.friction == Hardening::Constant(law.dilation)
            }
            Some(Plasticity::DruckerPrager(law)) => {
                let von_mises = law.friction == Hardening::Constant(0.0) && law.tension.is_none();
                law.friction == Hardening::Constant(law.dilation) && (law.cohesion.is_constant() || von_mises)
            }
        }
    }

    /// The material with its strength divided by `factor` (above 0): `c / F`, `tan(phi) / F`, tension cut-off `/ F`. The
    /// dilation angle is kept, but never above the reduced friction angle. Elastic constants stay.
    /// Source: Griffiths and Lane, Géotechnique 49(3), 1999, equations 1 and 2.
    pub fn reduced(&self, factor: f64) -> Material {
        let cohesion = |c: &Hardening| c.map(|c| c / factor);
        let friction = |phi: &Hardening| phi.map(|phi| (phi.tan() / factor).atan());
        let plasticity = self.plasticity.as_ref().map(|plasticity| match plasticity {
            Plasticity::MohrCoulomb(law) => {
                let friction = friction(&law.friction);
                Plasticity::MohrCoulomb(MohrCoulomb {
                    cohesion: cohesion(&law.cohesion),
                    dilation: law.dilation.min(friction.range().0),
                    friction,
                    tension: law.tension.map(|t| t / factor),
                })
            }
            Plasticity::DruckerPrager(law) => {
                let friction = friction(&law.friction);
                Plasticity::DruckerPrager(DruckerPrager {
                    cohesion: cohesion(&law.cohesion),
                    dilation: law.dilation.min(friction.range().0),
                    friction,
                    cone: law.cone,
                    tension: law.tension.map(|t| t / factor),
                })
            }
        });
        Material { elastic: self.elastic, plasticity }
    }
}

impl From<MohrCoulomb> for Plasticity {
    fn from(law: MohrCoulomb) -> Self {
        Plasticity::MohrCoulomb(law)
    }
}

impl From<DruckerPrager> for Plasticity {
    fn from(law: DruckerPrager) -> Self {
        Plasticity::DruckerPrager(law)
    }
}

/// History of one Gauss point.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct PointState {
    /// Stress [Pa], `[xx, yy, zz, xy, yz, zx]`.
    pub stress: [f64; 6],
    /// Plastic strain [-], engineering shear.
    pub plastic_strain: [f64; 6],
    /// Accumulated equivalent plastic strain [-], `d kappa = sqrt(2/3 d eps_p : d eps_p)`.
    pub kappa: f64,
}

/// The part of the yield surface to which the trial stress returned. `s1 >= s2 >= s3` are principal stresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Region {
    /// Inside the yield surface.
    Elastic,
    /// Mohr–Coulomb: the plane of `s1` and `s3`.
    Plane,
    /// Mohr–Coulomb: the edge `s1 = s2` (triaxial compression).
    EdgeCompression,
    /// Mohr–Coulomb: the edge `s2 = s3` (triaxial extension).
    EdgeExtension,
    /// Mohr–Coulomb: `s1 = s2 = s3 = c cot(phi)`.
    Apex,
    /// Rankine cut-off: `s1 = tension`.
    TensionPlane,
    /// Rankine cut-off: `s1 = s2 = tension`.
    TensionEdge,
    /// Rankine cut-off: all three at `tension`.
    TensionCorner,
    /// The line where the Mohr–Coulomb plane meets the cut-off.
    PlaneTension,
    /// The point where the compression edge meets the cut-off: `s1 = s2 = tension`, `s3` from Mohr–Coulomb.
    EdgeCompressionTension,
    /// The point where the extension edge meets the cut-off: `s1 = tension`, `s2 = s3` from Mohr–Coulomb.
    EdgeExtensionTension,
    /// Drucker–Prager: the cone (von Mises: the cylinder).
    Cone,
    /// Drucker–Prager: the apex of the cone.
    ConeApex,
    /// Drucker–Prager: the cap, mean stress = `tension`.
    Cap,
    /// Drucker–Prager: the circle where the cone meets the cap.
    ConeCap,
}

impl Region {
    /// Whether the step had plastic flow.
    pub fn is_plastic(self) -> bool {
        self != Region::Elastic
    }
}

/// What [`update`] returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Stress and history at the end of the step.
    pub state: PointState,
    /// Where the step ended.
    pub region: Region,
    /// Consistent tangent [Pa], `d stress[i] / d strain[j]` with engineering shear; zeros where it was not asked for.
    pub tangent: [[f64; 6]; 6],
}

/// Why a step has no result. The old state is untouched; a smaller step may pass.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ReturnError {
    /// The trial stress or the return holds a number that is not finite.
    #[error("the stress at a material point is not finite")]
    NotFinite,
    /// The iteration for `kappa` stalled.
    #[error("the return to the yield surface did not converge (equivalent plastic strain {kappa})")]
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

/// Stress, history and, if `want_tangent`, the consistent tangent after a strain increment from an old, committed state.
///
/// `increment` [-] is the total increment of the step with engineering shear. The trial stress is
/// `old.stress + D increment`. Constants must be without [`Material::fault`].
///
/// # Errors
/// See [`ReturnError`]; perfect plasticity only fails on numbers that are not finite.
pub fn update(
    material: &Material,
    old: &PointState,
    increment: &[f64; 6],
    want_tangent: bool,
) -> Result<Response, ReturnError> {
    let step = material.elastic.stress(increment);
    let trial: [f64; 6] = std::array::from_fn(|k| old.stress[k] + step[k]);
    if !trial.iter().sum::<f64>().is_finite() {
        return Err(ReturnError::NotFinite);
    }
    match &material.plasticity {
        None => Ok(elastic_response(&material.elastic, old, &trial, want_tangent)),
        Some(Plasticity::MohrCoulomb(law)) => law.update(&material.elastic, old, &trial, want_tangent),
        Some(Plasticity::DruckerPrager(law)) => law.update(&material.elastic, old, &trial, want_tangent),
    }
}

/// Value of the yield function [Pa]: at or below 0 inside the surface. Mohr–Coulomb:
/// `max((s1 - s3)/2 + (s1 + s3)/2 sin(phi) - c cos(phi), s1 - tension)`. Drucker–Prager:
/// `max(sqrt(J2) + eta p - xi c, p - tension)`. Strength is that of `state.kappa`. Minus infinity without plasticity.
pub fn yield_function(material: &Material, state: &PointState) -> f64 {
    match &material.plasticity {
        None => f64::NEG_INFINITY,
        Some(Plasticity::MohrCoulomb(law)) => law.yield_function(&state.stress, state.kappa),
        Some(Plasticity::DruckerPrager(law)) => law.yield_function(&state.stress, state.kappa),
    }
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

/// A step that stayed inside the yield surface.
fn elastic_response(elastic: &Elastic, old: &PointState, trial: &[f64; 6], want_tangent: bool) -> Response {
    let tangent = if want_tangent { elastic.matrix() } else { [[0.0; 6]; 6] };
    Response { state: PointState { stress: *trial, ..*old }, region: Region::Elastic, tangent }
}

/// Faults that both criteria share: friction, dilation, cohesion, and tension cut-off.
fn strength_fault(
    cohesion: &Hardening,
    friction: &Hardening,
    dilation: f64,
    tension: Option<f64>,
) -> Option<Fault> {
    if let Some(fault) = friction.fault("friction angle", true).or_else(|| cohesion.fault("cohesion", false))
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
        return Some(("cohesion", c, "a value above 0 where the friction angle is 0"));
    }
    if !(dilation >= 0.0 && dilation <= phi) {
        return Some(("dilation angle", dilation, "between 0 and the smallest friction angle"));
    }
    if let Some(t) = tension {
        if !(t >= 0.0 && t.is_finite()) {
            return Some(("tension cut-off", t, "a finite number, 0 or above"));
        }
        let (c, phi) = (cohesion.at(0.0).0, friction.at(0.0).0);
        if t * phi.sin() > c * phi.cos() {
            return Some(("tension cut-off", t, "at most c cot(phi), where the apex lies"));
        }
    }
    None
}
