//! What a kind of pair says, and the contacts that it finds.

use super::side::{First, Second, Side};
use crate::base::Vec3;
use crate::law::{ContactGeometry, Laws};
use crate::pairs::list::Hint;

/// Which two shapes touch, and where.
pub(crate) trait PairKind: Sync {
    /// What the first partner is: its forces are those of the contact.
    type First: First;
    /// What the second partner is.
    type Second: Second;

    /// Whether the points of a pair share its mass by their weights: the pair then has the damping ratio of its law however many
    /// there are.
    const SHARED: bool = false;

    /// Whether they share it with those of pairs of the same first partner with other parts of the same wall.
    const JOINED: bool = false;

    /// Whether the two may be nearer than `reach` [m]: exact, or rather too often than too seldom. False for shapes that
    /// the kind is not for.
    fn near(&self, first: &View<'_, Self::First>, second: &View<'_, Self::Second>, reach: f64) -> bool;

    /// Finds where they touch.
    fn touches(&self, first: &View<'_, Self::First>, second: &View<'_, Self::Second>, found: &mut Touches);

    /// As [`PairKind::touches`], to the last bit, step after step: with a hint that it leaves for the next.
    fn touches_again(
        &self,
        first: &View<'_, Self::First>,
        second: &View<'_, Self::Second>,
        _hint: &mut Hint,
        found: &mut Touches,
    ) {
        self.touches(first, second, found);
    }
}

/// A partner where it is, as its side shows it.
pub(crate) type View<'a, S> = <S as Side>::View<'a>;

/// A point in which two partners touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    /// What touches: of the first partner in the upper 16 bits, of the second in the lower. Memory goes with it.
    pub feature: u32,
    pub geometry: ContactGeometry,
    /// Share of the law's force that acts here: one, but where one area is stood for by several points; less than zero where others count
    /// something twice.
    pub weight: f64,
    /// Of a length of edge: what has weight one [m]; zero for points, and where edges have the law of points.
    pub edge: f64,
    /// Overlap above which the contact has lost its meaning [m].
    pub bound: f64,
    /// Torque about the point on the first partner per unit of normal force [m].
    pub couple: Vec3,
    /// Materials whose law acts here, and contacts of its stiffness that carry the mass of the pair together: see [`Touch::under`].
    pub materials: [u32; 2],
    pub share: f64,
}

impl Touch {
    /// The only point of a pair.
    pub fn only(geometry: ContactGeometry, bound: f64) -> Touch {
        Touch::of(0, geometry, 1.0, bound)
    }

    /// A point of several.
    pub fn of(feature: u32, geometry: ContactGeometry, weight: f64, bound: f64) -> Touch {
        let (couple, materials) = (Vec3::zeros(), [0; 2]);
        Touch { feature, geometry, weight, edge: 0.0, bound, couple, materials, share: 1.0 }
    }

    /// Puts it under the law of two materials, or of their edges where those have one of their own (`law/edges.rs`).
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

/// The points in which a pair touches.
pub(crate) type Touches = Vec<Touch>;

/// Least number of contacts that carry the mass of a pair: so small where only ends of edges touch.
const LEAST: f64 = 1e-9;

/// Says how many contacts carry the mass of a pair together: by their weights where all have one stiffness.
pub(super) fn share(laws: &Laws, found: &mut [Touch]) {
    if found.iter().all(|t| t.edge == 0.0 && laws.edges(t.materials).is_none()) {
        let sum = found.iter().map(|t| t.weight).sum::<f64>().max(LEAST);
        return found.iter_mut().for_each(|t| t.share = sum);
    }
    let stiffness =
        |t: &Touch| laws.stiffness(t.materials[0], t.materials[1], t.geometry.overlap, t.geometry.radius);
    let sum: f64 = found.iter().map(|t| t.weight * stiffness(t)).sum();
    // Edges weigh by their length.
    let least = |t: &Touch| if t.edge > 0.0 { LEAST * t.edge } else { LEAST };
    found.iter_mut().for_each(|t| t.share = (sum / stiffness(t)).max(least(t)));
}

/// One contact as measures see it.
pub(crate) struct Visited<'a> {
    pub body: u32,
    pub partner: crate::base::error::Partner,
    /// From the partner to its touched image [m].
    pub shift: Vec3,
    pub contact: ContactNow<'a>,
}

/// What a law needs to know of a contact, whatever touches: a first partner, such as a body, and a second one.
pub(crate) struct ContactNow<'a> {
    pub geometry: ContactGeometry,
    /// Share of the law's force that acts here.
    pub weight: f64,
    /// Velocity of the first partner relative to the second at the contact point [m/s].
    pub velocity: Vec3,
    /// Sum of the inverse masses of both [1/kg].
    pub inverse_mass: f64,
    pub history: &'a crate::law::History,
    /// Spin of the first partner less that of the second [rad/s].
    pub spin: Vec3,
    /// Materials of the two.
    pub materials: [u32; 2],
    /// Coefficient of friction, where it is not that of the materials.
    pub friction: Option<f64>,
}
