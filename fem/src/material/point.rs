//! State of the integration points.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::{Deref, DerefMut};

/// Stress and history common to all laws.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct PointState {
    /// Stress [Pa], `[xx, yy, zz, xy, yz, zx]`.
    pub stress: [f64; 6],
    /// Plastic strain [-], engineering shear.
    pub plastic_strain: [f64; 6],
    /// Accumulated equivalent plastic strain [-], `d kappa = sqrt(2/3 d eps_p : d eps_p)`.
    pub kappa: f64,
}

/// Time and position of an update, for laws that depend on them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UpdateContext {
    /// Time at the start of the step [s].
    pub time: f64,
    /// Step [s].
    pub time_step: f64,
    /// Element number of the input file; 0 without a mesh.
    pub element: u32,
    /// Integration point of the element, from 1; 0 without a mesh.
    pub point: u32,
}

/// State of one point.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Common state.
    pub state: &'a PointState,
    /// State values, ordered as [`super::ConstitutiveLaw::state_values`].
    pub values: &'a [f64],
    /// Time and position.
    pub context: UpdateContext,
}

impl<'a> Point<'a> {
    /// Point without time and position.
    #[inline]
    pub fn new(state: &'a PointState, values: &'a [f64]) -> Point<'a> {
        Point { state, values, context: UpdateContext::default() }
    }
}

impl<'a> From<&'a PointState> for Point<'a> {
    fn from(state: &'a PointState) -> Point<'a> {
        Point::new(state, &[])
    }
}

/// States of all integration points, stored in checkpoints; dereferences to the common states.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Points {
    states: Vec<PointState>,
    values: Vec<f64>,
}

impl Points {
    /// Unstressed points with `values` state values in total.
    pub fn new(count: usize, values: usize) -> Points {
        Points { states: vec![PointState::default(); count], values: vec![0.0; values] }
    }

    /// State values of all points.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Mutable states and state values.
    pub fn split_mut(&mut self) -> (&mut [PointState], &mut [f64]) {
        (&mut self.states, &mut self.values)
    }

    /// Resizes; new points are unstressed.
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

/// Region of the yield surface; principal stresses `s1 >= s2 >= s3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ReturnRegion {
    /// Elastic.
    Elastic,
    /// Mohr–Coulomb: plane of `s1` and `s3`.
    Plane,
    /// Mohr–Coulomb: edge `s1 = s2` (triaxial compression).
    EdgeCompression,
    /// Mohr–Coulomb: edge `s2 = s3` (triaxial extension).
    EdgeExtension,
    /// Mohr–Coulomb: `s1 = s2 = s3 = c cot(phi)`.
    Apex,
    /// Rankine cut-off: `s1 = tension`.
    TensionPlane,
    /// Rankine cut-off: `s1 = s2 = tension`.
    TensionEdge,
    /// Rankine cut-off: all three at `tension`.
    TensionCorner,
    /// Plane and cut-off.
    PlaneTension,
    /// Compression edge and cut-off: `s1 = s2 = tension`.
    EdgeCompressionTension,
    /// Extension edge and cut-off: `s1 = tension`, `s2 = s3`.
    EdgeExtensionTension,
    /// Drucker–Prager: cone (von Mises: cylinder).
    Cone,
    /// Drucker–Prager: apex.
    ConeApex,
    /// Drucker–Prager: cap, mean stress = `tension`.
    Cap,
    /// Drucker–Prager: cone and cap.
    ConeCap,
    /// Region named by its law.
    Named(&'static str),
}

impl fmt::Display for ReturnRegion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReturnRegion::Named(name) => f.write_str(name),
            other => write!(f, "{other:?}"),
        }
    }
}

impl ReturnRegion {
    /// Whether the step had plastic flow.
    pub fn is_plastic(self) -> bool {
        self != ReturnRegion::Elastic
    }
}
