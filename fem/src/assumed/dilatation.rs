//! Projects the volumetric strain of an element on few terms against volumetric locking.
//!
//! Least squares on a constant (mean dilatation); the hex20 keeps linear functions. With these, wedge15
//! stresses oscillate and the pyramid13 locks. Constant stress gives unchanged nodal forces, so the patch
//! test is passed.
//!
//! Source: Hughes (1980) (B-bar); Simo, Taylor and Pister (1985) (variational form); de Souza Neto, Perić and
//! Owen (2008), section 15.1.
//!
//! Theory manual: equation (4.3) of `docs/theory/solid.md`.

use crate::element::ElementKind;
use crate::kinematics::ElementCoordinates;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// Volumetric strain of quadratic kinds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dilatation {
    /// At the integration points.
    #[default]
    Pointwise,
    /// Element mean; the hex20 adds its mean slope.
    Mean,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Terms {
    Constant,
    Linear,
}

/// Projection terms of a kind, if any. `bends`: a hex8 with modes, whose volumetric strain is linear.
pub(super) fn terms(kind: ElementKind, dilatation: Dilatation, bends: bool) -> Option<Terms> {
    if kind.is_linear() {
        return Some(if bends { Terms::Linear } else { Terms::Constant });
    }
    let linear = kind.properties().linear_dilatation;
    match dilatation {
        Dilatation::Pointwise => None,
        Dilatation::Mean => Some(if linear { Terms::Linear } else { Terms::Constant }),
    }
}

pub(super) struct Projection {
    mean: ElementCoordinates,
    slope: Option<([f64; 3], [ElementCoordinates; 3])>,
}

impl Projection {
    /// Projects gradients from position [m], gradients, volume [m³].
    pub fn new(
        terms: Terms,
        points: impl Iterator<Item = ([f64; 3], ElementCoordinates, f64)> + Clone,
    ) -> Projection {
        let (mut mean, mut volume, mut centre) = (ElementCoordinates::default(), 0.0, [0.0; 3]);
        for (place, g, part) in points.clone() {
            volume += part;
            for (mean, g) in mean.iter_mut().zip(&g) {
                for k in 0..3 {
                    mean[k] += part * g[k];
                }
            }
            (0..3).for_each(|k| centre[k] += part * place[k]);
        }
        mean.iter_mut().flatten().for_each(|m| *m /= volume);
        let mut projection = Projection { mean, slope: None };
        if terms == Terms::Linear {
            projection.slope = slope(points, centre.map(|c| c / volume));
        }
        projection
    }

    pub fn is_constant(&self) -> bool {
        self.slope.is_none()
    }

    /// Projected gradients at a position.
    pub fn at(&self, place: [f64; 3]) -> ElementCoordinates {
        let mut g = self.mean;
        if let Some((centre, slope)) = &self.slope {
            for (axis, slope) in slope.iter().enumerate() {
                let away = place[axis] - centre[axis];
                for (g, s) in g.iter_mut().zip(slope) {
                    (0..3).for_each(|k| g[k] += away * s[k]);
                }
            }
        }
        g
    }
}

/// Slopes of the least-squares fit about `centre`.
fn slope(
    points: impl Iterator<Item = ([f64; 3], ElementCoordinates, f64)>,
    centre: [f64; 3],
) -> Option<([f64; 3], [ElementCoordinates; 3])> {
    let (mut square, mut moments) = (Matrix3::<f64>::zeros(), [ElementCoordinates::default(); 3]);
    for (place, g, part) in points {
        let away: [f64; 3] = std::array::from_fn(|k| place[k] - centre[k]);
        for i in 0..3 {
            for j in 0..3 {
                square[(i, j)] += part * away[i] * away[j];
            }
            for (moment, g) in moments[i].iter_mut().zip(&g) {
                (0..3).for_each(|k| moment[k] += part * away[i] * g[k]);
            }
        }
    }
    // Invertible: the points of every rule span a volume.
    let inverse = square.try_inverse()?;
    let mut slope = [ElementCoordinates::default(); 3];
    for i in 0..3 {
        for j in 0..3 {
            for (s, m) in slope[i].iter_mut().zip(&moments[j]) {
                (0..3).for_each(|k| s[k] += inverse[(i, j)] * m[k]);
            }
        }
    }
    Some((centre, slope))
}
