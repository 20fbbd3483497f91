//! Edge contacts of dilated bodies whose corners follow Hertz's law.
//!
//! An edge contributes F = E*/4 ∫ δ ds. For two edges of radius r crossing at right angles this is Hertz's
//! force of crossing cylinders, 4/3 E* √r δ^(3/2).
//!
//! Tangential over normal stiffness 2(1 − ν)/(2 − ν) as Mindlin's circle. [`Material::edge_factor`] π gives
//! the line law π/4 E* L δ of Popov (Contact Mechanics and Friction, 2010, sec. 4.2).
//!
//! Limits: points of an edge do not interact.
//!
//! Theory manual: eq. (2.8), `docs/theory/shapes.md`.

use super::hertz::Hertz;
use super::material::{LawName, Material, Pair, PairOverride};
use super::normal::NormalLaw;
use super::table::combination;

pub(super) fn spread(pair: &Pair<'_>) -> bool {
    combination(pair).ok().flatten().is_some_and(|c| c.normal == Hertz::NAME)
}

/// Appends edge materials and exceptions.
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
