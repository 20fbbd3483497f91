//! Assumed strains against volumetric and shear locking.
//!
//! Strain `B̄ u`, force `∫ B̄^T s dV`, stiffness `∫ B̄^T D B̄ dV`; B̄ depends only on element shape and
//! Poisson's ratio.

pub mod dilatation;
pub mod modes;

pub use dilatation::Dilatation;

use crate::element::{ElementKind, IntegrationPoint, MAX_NODES};
use crate::kinematics::{ElementCoordinates, GradientProducts, add_gradient_products, spatial_gradients};
use dilatation::Projection;
use modes::{HEX8_TERMS, Internal};
use serde::{Deserialize, Serialize};

/// Assumed strains; linear kinds always use the mean volumetric strain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AssumedStrain {
    /// Volumetric strain of the quadratic kinds.
    pub dilatation: Dilatation,
    /// Whether the hex8 has incompatible modes.
    pub incompatible_modes: bool,
}

impl AssumedStrain {
    /// Whether elements of a kind have incompatible modes.
    pub fn has_modes(&self, kind: ElementKind) -> bool {
        self.incompatible_modes && kind.properties().incompatible_modes
    }
}

/// Gradients at a point of an element.
pub struct PointGradients {
    /// Gradients of shape functions, then of incompatible modes [1/m].
    pub gradients: ElementCoordinates,
    /// Projected volumetric gradients [1/m].
    pub dilatation: Option<ElementCoordinates>,
    /// det J [m³].
    pub determinant: f64,
}

/// Assumed strains of one element.
pub struct ElementStrains {
    kind: ElementKind,
    coordinates: ElementCoordinates,
    rule: &'static [IntegrationPoint],
    internal: Option<Internal>,
    projection: Option<Projection>,
}

impl ElementStrains {
    /// Builds the strains for nodes at `coordinates` [m]. `yields`: flow can be isochoric for any `poisson`.
    pub fn new(
        kind: ElementKind,
        coordinates: ElementCoordinates,
        rule: &'static [IntegrationPoint],
        assumed: AssumedStrain,
        poisson: f64,
        yields: bool,
    ) -> ElementStrains {
        let modes = assumed.has_modes(kind);
        let mut strains = ElementStrains { kind, coordinates, rule, internal: None, projection: None };
        strains.internal = modes.then(|| Internal::new(&coordinates));
        if let Some(terms) = dilatation::terms(kind, assumed.dilatation, modes && !yields) {
            let points = rule.iter().map(|p| {
                let (g, det) = strains.local(p.xi, &p.gradients);
                (strains.place(&p.shape), g, p.weight * det)
            });
            strains.projection = Some(Projection::new(terms, points));
        }
        if modes {
            let products = strains.products::<HEX8_TERMS>();
            let ratio = 2.0 * poisson / (1.0 - 2.0 * poisson);
            let stiffness = |a: usize, b: usize| strains.block(&products, ratio, 1.0, a, b);
            let amplitudes = modes::amplitudes(stiffness);
            strains.internal.iter_mut().for_each(|i| i.amplitudes = amplitudes);
        }
        strains
    }

    /// Number of nodes and incompatible modes.
    #[inline]
    pub fn terms(&self) -> usize {
        self.kind.node_count() + if self.internal.is_some() { modes::COUNT } else { 0 }
    }

    /// Incompatible modes.
    pub fn internal(&self) -> Option<&Internal> {
        self.internal.as_ref()
    }

    /// Whether the volumetric strain is constant in the element.
    pub fn has_mean_dilatation(&self) -> bool {
        self.projection.as_ref().is_some_and(Projection::is_constant)
    }

    /// Gradients at an integration point.
    pub fn at_point(&self, point: &IntegrationPoint) -> PointGradients {
        self.with(point.xi, &point.shape, &point.gradients)
    }

    /// Gradients at the natural point `xi`.
    pub fn at(&self, xi: [f64; 3]) -> PointGradients {
        self.with(xi, &self.kind.shape_functions(xi), &self.kind.gradients(xi))
    }

    fn with(&self, xi: [f64; 3], shape: &[f64; MAX_NODES], natural: &ElementCoordinates) -> PointGradients {
        let (gradients, determinant) = self.local(xi, natural);
        let dilatation = self.projection.as_ref().map(|p| p.at(self.place(shape)));
        PointGradients { gradients, dilatation, determinant }
    }

    fn local(&self, xi: [f64; 3], natural: &ElementCoordinates) -> (ElementCoordinates, f64) {
        let (mut gradients, determinant) = spatial_gradients(&self.coordinates, natural);
        if let Some(internal) = &self.internal {
            internal.add_gradients(xi, determinant, &mut gradients);
        }
        (gradients, determinant)
    }

    fn place(&self, shape: &[f64; MAX_NODES]) -> [f64; 3] {
        std::array::from_fn(|k| shape.iter().zip(&self.coordinates).map(|(n, x)| n * x[k]).sum())
    }

    /// Strain (engineering shear) of nodal displacements `u` [m].
    pub fn strain(&self, at: &PointGradients, u: &ElementCoordinates) -> [f64; 6] {
        let mut moved = *u;
        if let Some(internal) = &self.internal {
            internal.extend(&mut moved);
        }
        let mut strain = crate::kinematics::strain(&at.gradients, &moved);
        if let Some(volume) = &at.dilatation {
            let mut correction = 0.0;
            for a in 0..self.terms() {
                for k in 0..3 {
                    correction += (volume[a][k] - at.gradients[a][k]) * moved[a][k] / 3.0;
                }
            }
            strain[..3].iter_mut().for_each(|e| *e += correction);
        }
        strain
    }

    pub(crate) fn products<const N: usize>(&self) -> Products<N> {
        let mut sums = Products { all: [[[0.0; N]; N]; 6], volume: Vec::with_capacity(self.rule.len()) };
        for point in self.rule {
            let at = self.at_point(point);
            let volume = point.weight * at.determinant;
            add_gradient_products(&mut sums.all, &at.gradients, volume);
            sums.volume.push((at.dilatation.unwrap_or(at.gradients), volume));
        }
        sums
    }

    /// Block (a, b) of `∫ B̄^T D B̄ dV` [N/m], before elimination of the modes.
    pub(crate) fn block<const N: usize>(
        &self,
        products: &Products<N>,
        lambda: f64,
        mu: f64,
        a: usize,
        b: usize,
    ) -> [f64; 9] {
        let mut block = crate::kinematics::stiffness_block(&products.all, -2.0 / 3.0 * mu, mu, a, b);
        let bulk = lambda + 2.0 / 3.0 * mu;
        for (g, volume) in &products.volume {
            for i in 0..3 {
                for j in 0..3 {
                    block[3 * i + j] += bulk * volume * g[a][i] * g[b][j];
                }
            }
        }
        block
    }
}

pub(crate) struct Products<const N: usize> {
    all: GradientProducts<N>,
    volume: Vec<(ElementCoordinates, f64)>,
}
