//! The volume strain of an element as its projection on a few terms.
//!
//! Under a rule with many points the volume strain of a quadratic element has more terms than an incompressible material
//! leaves degrees of freedom: the element locks. Its projection on the constant (mean dilatation) or on the linear
//! functions of place, by least squares over the volume, has few enough. The hex20 takes the linear functions, which keep its
//! order; with them the wedge15 still wavers in its stresses and the pyramid13 locks, so the others take the constant.
//!
//! Source: Hughes, Int. J. Numer. Methods Eng. 15 (1980) 1413-1418 (B-bar); Simo, Taylor and Pister, Comput. Methods Appl. Mech. Eng.
//! 51 (1985) 177-208 (its variational form); de Souza Neto, Perić and Owen, Computational Methods for Plasticity (2008),
//! section 15.1. A projection on terms that hold the constant keeps the mean of every gradient, so constant stress has
//! the nodal forces of the plain element and the patch test is passed where that passes it.
//!
//! Theory manual: equation (4.3) of `docs/theory/solid.md`.

use crate::element::ElementKind;
use crate::kinematics::ElementCoordinates;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// How quadratic kinds take their volume strain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dilatation {
    /// At the points of the rule.
    #[default]
    Pointwise,
    /// Its mean over the element, in the hex20 together with its mean slope.
    Mean,
}

/// Terms of a projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Terms {
    /// The constant.
    Constant,
    /// The linear functions of place.
    Linear,
}

/// Terms that the volume strain of a kind is projected on; none where it is taken at the points. `bends`: a hex8 whose modes give
/// it a linear volume strain.
pub(super) fn terms(kind: ElementKind, dilatation: Dilatation, bends: bool) -> Option<Terms> {
    if kind.is_linear() {
        return Some(if bends { Terms::Linear } else { Terms::Constant });
    }
    match (dilatation, kind) {
        (Dilatation::Pointwise, _) => None,
        (Dilatation::Mean, ElementKind::Hex20) => Some(Terms::Linear),
        (Dilatation::Mean, _) => Some(Terms::Constant),
    }
}

/// Gradients projected: for each term of the polynomial its coefficients.
pub(super) struct Projection {
    mean: ElementCoordinates,
    /// The mean place [m] and the slopes [1/m²] along the axes.
    slope: Option<([f64; 3], [ElementCoordinates; 3])>,
}

impl Projection {
    /// Projects the gradients of points, each a place [m], its gradients and its volume [m³].
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

    /// The projected gradients at a place.
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

/// Slopes of the least-squares fit about `centre`, where the linear terms are orthogonal to the constant.
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
    // The points of every rule span a volume, so the matrix can be inverted.
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
