//! State of the integration points: what all laws have in common, and the values that a law keeps of its own.

use serde::{Deserialize, Serialize};
use std::ops::{Deref, DerefMut};

/// Stress and history of one integration point, as every law has them.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct PointState {
    /// Stress [Pa], `[xx, yy, zz, xy, yz, zx]`.
    pub stress: [f64; 6],
    /// Plastic strain [-], engineering shear.
    pub plastic_strain: [f64; 6],
    /// Accumulated equivalent plastic strain [-], `d kappa = sqrt(2/3 d eps_p : d eps_p)`.
    pub kappa: f64,
}

/// The state of one point as a law reads it.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// What all laws have.
    pub state: &'a PointState,
    /// The law's own values, in the order of [`super::ConstitutiveLaw::state_values`].
    pub values: &'a [f64],
}

impl<'a> From<&'a PointState> for Point<'a> {
    /// A point of a law without values of its own.
    fn from(state: &'a PointState) -> Point<'a> {
        Point { state, values: &[] }
    }
}

/// States of all integration points of a body; a part of a checkpoint.
///
/// Dereferences to the slice of the states. The values of the laws lie point by point; where those of an element begin
/// is known to [`crate::Model::values`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Points {
    states: Vec<PointState>,
    values: Vec<f64>,
}

impl Points {
    /// Points without stress and history; `values` is the number of the laws' own values of all points together.
    pub fn new(count: usize, values: usize) -> Points {
        Points { states: vec![PointState::default(); count], values: vec![0.0; values] }
    }

    /// The laws' own values of all points.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// States and values, to be written.
    pub fn split_mut(&mut self) -> (&mut [PointState], &mut [f64]) {
        (&mut self.states, &mut self.values)
    }

    /// Adds points without stress and history, or removes points from the end.
    pub fn resize(&mut self, count: usize, values: usize) {
        self.states.resize(count, PointState::default());
        self.values.resize(values, 0.0);
    }
}

impl Deref for Points {
    type Target = [PointState];

    fn deref(&self) -> &[PointState] {
        &self.states
    }
}

impl DerefMut for Points {
    fn deref_mut(&mut self) -> &mut [PointState] {
        &mut self.states
    }
}

impl<'a> IntoIterator for &'a Points {
    type Item = &'a PointState;
    type IntoIter = std::slice::Iter<'a, PointState>;

    fn into_iter(self) -> Self::IntoIter {
        self.states.iter()
    }
}

impl<'a> IntoIterator for &'a mut Points {
    type Item = &'a mut PointState;
    type IntoIter = std::slice::IterMut<'a, PointState>;

    fn into_iter(self) -> Self::IntoIter {
        self.states.iter_mut()
    }
}

/// The part of the yield surface to which the trial stress returned. `s1 >= s2 >= s3` are principal stresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
    /// A part of a yield surface that a law names itself.
    Named(&'static str),
}

impl Region {
    /// Whether the step had plastic flow.
    pub fn is_plastic(self) -> bool {
        self != Region::Elastic
    }
}
