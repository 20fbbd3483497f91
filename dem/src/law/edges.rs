//! Edges of dilated bodies beside corners after Hertz.
//!
//! A corner of radius r presses into a face as a sphere does. Every point of an edge presses by its own overlap δ(s) with
//! E*/4 per unit of length: F = E*/4 ∫ δ ds, which is linear in δ. Two edges of radius r that cross at right angles overlap by
//! δ − s²/(4 r) in the distance s from where they cross; summed up over both edges that is 4/3 E* √r δ^(3/2), Hertz's force of
//! crossing cylinders. An edge that lies on a face has E* L δ/4, where the half-space gives π E* L δ/Λ with Λ between 11 and 17 for L = 12 r
//! (`docs/guide/verification.md`).
//!
//! So edges are contacts after the linear law, between materials that are added to those of a model: with springs of E/(8(1 − ν²))
//! for a metre, and the tangential over normal stiffness 2(1 − ν)/(2 − ν) of Mindlin's circle. What contacts weigh is their length.
//!
//! [`Material::edge_factor`] π gives the line law π/4 E* L δ of Popov (Contact Mechanics and Friction, 2010, sec. 4.2).
//!
//! Limits: one point of an edge does not sink where another one presses. Edges side by side, which press from both, are twice as
//! stiff as one of them on a face; those that cross at an angle θ follow 1/sin θ, where elastic cylinders follow its root nearly.
//!
//! Theory manual: equation (2.8) of `docs/theory/shapes.md`.

use super::hertz::Hertz;
use super::material::{LawName, Material, Pair, PairOverride};
use super::normal::NormalLaw;
use super::table::combination;

/// Whether the contacts of a pair of materials follow Hertz's law.
pub(super) fn spread(pair: &Pair<'_>) -> bool {
    combination(pair).ok().flatten().is_some_and(|c| c.normal == Hertz::NAME)
}

/// Materials and exceptions, and behind them the same for edges.
pub(super) fn beside(
    materials: &[Material],
    exceptions: &[PairOverride],
) -> (Vec<Material>, Vec<PairOverride>) {
    let of_edges = materials.iter().map(|m| match m.young {
        None => *m,
        Some(young) => Material {
            stiffness: m.edge_factor * young / (8.0 * (1.0 - m.poisson * m.poisson)),
            tangential_ratio: 2.0 * (1.0 - m.poisson) / (2.0 - m.poisson),
            young: None,
            normal: None,
            ..*m
        },
    });
    let count = materials.len();
    let between_edges = exceptions.iter().map(|e| PairOverride {
        a: e.a + count,
        b: e.b + count,
        stiffness: None,
        normal: None,
        tangential: e.tangential.filter(|t| *t == LawName::NONE),
        ..*e
    });
    (
        materials.iter().copied().chain(of_edges).collect(),
        exceptions.iter().copied().chain(between_edges).collect(),
    )
}
