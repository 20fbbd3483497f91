//! Interface of a pair type.

use super::side::{First, Second, Side};
use crate::base::Vec3;
use crate::law::{ContactGeometry, Laws};
use crate::pairs::list::Hint;

/// Shape pair geometry.
pub trait ShapePair: Sync {
    /// First partner, which receives the force.
    type First: First;
    /// Second partner.
    type Second: Second;

    /// Whether points share the pair's mass, for the law's damping ratio.
    const SHARED: bool = false;

    /// Whether all pairs of one body with one wall share it too.
    const JOINED: bool = false;

    /// Conservative test for distances below `reach` [m]; false for unsupported shapes.
    fn may_touch(&self, first: &View<'_, Self::First>, second: &View<'_, Self::Second>, reach: f64) -> bool;

    /// Finds contact points.
    fn contact_points(
        &self,
        first: &View<'_, Self::First>,
        second: &View<'_, Self::Second>,
        found: &mut Manifold,
    );

    /// [`ShapePair::contact_points`] with the previous hint, bitwise identical.
    fn contact_points_from_hint(
        &self,
        first: &View<'_, Self::First>,
        second: &View<'_, Self::Second>,
        _hint: &mut Hint,
        found: &mut Manifold,
    ) {
        self.contact_points(first, second, found);
    }
}

pub type View<'a, S> = <S as Side>::View<'a>;

/// Contact point of a pair.
#[derive(Clone, Copy, Debug)]
pub struct PairContactPoint {
    /// History key: first partner's feature in the upper 16 bits, second's in the lower.
    pub feature: u32,
    pub geometry: ContactGeometry,
    /// Factor on the law's force; negative against double counting.
    pub weight: f64,
    /// Edge length [m] of weight 1; zero for points, or edges with the point law.
    pub edge: f64,
    /// Overlap limit [m].
    pub bound: f64,
    /// Torque on the first partner per normal force [m].
    pub couple: Vec3,
    /// Materials of the law; equivalent contacts sharing the pair's mass ([`PairContactPoint::under`]).
    pub materials: [u32; 2],
    pub share: f64,
}

impl PairContactPoint {
    pub fn only(geometry: ContactGeometry, bound: f64) -> PairContactPoint {
        PairContactPoint::of(0, geometry, 1.0, bound)
    }

    pub fn of(feature: u32, geometry: ContactGeometry, weight: f64, bound: f64) -> PairContactPoint {
        let (couple, materials) = (Vec3::zeros(), [0; 2]);
        PairContactPoint { feature, geometry, weight, edge: 0.0, bound, couple, materials, share: 1.0 }
    }

    /// Selects the pair's law, or edge law (`law/line_contact.rs`).
    pub fn under(&mut self, laws: &Laws, materials: [u32; 2]) {
        let edges = laws.edges(materials).filter(|_| self.edge > 0.0);
        self.materials = edges.unwrap_or(materials);
        if edges.is_some() {
            self.weight *= self.edge;
        } else {
            self.edge = 0.0;
        }
    }
}

pub type Manifold = Vec<PairContactPoint>;

/// Smallest mass share, for barely touching edges.
const LEAST: f64 = 1e-9;

/// Distributes the pair's mass by stiffness.
pub(super) fn share(laws: &Laws, found: &mut [PairContactPoint]) {
    if found.iter().all(|t| t.edge == 0.0 && laws.edges(t.materials).is_none()) {
        let sum = found.iter().map(|t| t.weight).sum::<f64>().max(LEAST);
        return found.iter_mut().for_each(|t| t.share = sum);
    }
    let stiffness = |t: &PairContactPoint| {
        laws.stiffness(t.materials[0], t.materials[1], t.geometry.overlap, t.geometry.radius)
    };
    let sum: f64 = found.iter().map(|t| t.weight * stiffness(t)).sum();
    // Edge weights are lengths.
    let least = |t: &PairContactPoint| if t.edge > 0.0 { LEAST * t.edge } else { LEAST };
    found.iter_mut().for_each(|t| t.share = (sum / stiffness(t)).max(least(t)));
}

/// Contact of a measure.
pub struct Visited<'a> {
    pub body: u32,
    pub partner: crate::base::error::Partner,
    /// Partner to image [m].
    pub shift: Vec3,
    pub contact: ContactView<'a>,
}

pub struct ContactView<'a> {
    pub geometry: ContactGeometry,
    pub weight: f64,
    /// Velocity at the contact point, first minus second [m/s].
    pub velocity: Vec3,
    /// Sum of inverse masses [1/kg].
    pub inverse_mass: f64,
    pub history: &'a crate::law::History,
    /// Angular velocity, first minus second [rad/s].
    pub spin: Vec3,
    pub materials: [u32; 2],
    /// Friction coefficient, if not the materials'.
    pub friction: Option<f64>,
}
