//! Table of laws: combinations of normal and tangential law.

use super::any_law::combinations;
use super::composed::Composed;
use super::conical_damage::ConicalDamage;
use super::contact_law::ContactLaw;
use super::formula::{self, MEMORY, MODULUS, STIFFNESS};
use super::formula_law::FormulaLaw;
use super::hertz::Hertz;
use super::linear::Linear;
use super::material::{LawName, Material, Pair};
use super::mindlin::Mindlin;
use super::normal::NormalLaw;
use super::rough::{self, Rough};
use super::rough_mindlin::RoughMindlin;
use super::spring::Spring;
use super::tangential::TangentialLaw;
use super::walton_braun::WaltonBraun;

combinations! {
    Linear(Linear, Spring) = "linear spring-dashpot",
    Rough(Linear, Rough) = "linear spring-dashpot, rough",
    Hertz(Hertz, Mindlin) = "Hertz-Mindlin",
    WaltonBraun(WaltonBraun, Spring) = "Walton-Braun",
    Conical(ConicalDamage, RoughMindlin) = "Hertz-Mindlin with conical damage",
    Formula(FormulaLaw<MODULUS>, Mindlin) = "own law, Mindlin",
    FormulaStiffness(FormulaLaw<STIFFNESS>, Spring) = "own law, spring",
    FormulaMemory(FormulaLaw<MEMORY>, Spring) = "own law with memory, spring",
}

/// Linear law.
pub type LinearLaw = Composed<Linear, Spring>;
/// Linear law with pressure-dependent friction.
pub type RoughLaw = Composed<Linear, Rough>;
/// Hertz–Mindlin law.
pub type HertzLaw = Composed<Hertz, Mindlin>;
/// Hertz–Mindlin law, conical damage.
pub type ConicalLaw = Composed<ConicalDamage, RoughMindlin>;

/// Compatible normal and tangential law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawInfo {
    /// Normal law's scene name.
    pub normal: &'static str,
    /// Tangential law's scene name.
    pub tangential: &'static str,
    /// Title.
    pub title: &'static str,
    /// Normal law's required material keys.
    pub normal_keys: &'static [&'static str],
    /// Tangential law's required material keys.
    pub tangential_keys: &'static [&'static str],
    /// Whether a dashpot defines the restitution.
    pub dashpot: bool,
    /// Whether stiffness grows with the overlap.
    pub stiffens: bool,
}

impl LawInfo {
    const fn of<N: NormalLaw, T: TangentialLaw<N>>(title: &'static str) -> LawInfo {
        LawInfo {
            normal: N::NAME,
            tangential: T::NAME,
            title,
            normal_keys: N::KEYS,
            tangential_keys: T::KEYS,
            dashpot: N::DASHPOT,
            stiffens: N::STIFFENS,
        }
    }

    /// Whether a material key is used.
    pub fn uses(&self, key: &str) -> bool {
        self.normal_keys.contains(&key) || self.tangential_keys.contains(&key)
    }
}

pub(super) fn title([normal, tangential]: [&str; 2]) -> &'static str {
    let row = COMBINATIONS.iter().find(|c| c.normal == normal && c.tangential == tangential);
    row.map_or("a separate law", |c| c.title)
}

/// Whether a row has a name in scenes.
fn is_shipped(row: &LawInfo) -> bool {
    !formula::NAMES.contains(&row.normal)
}

/// Returns a normal law by name.
pub fn normal_named(name: &str) -> Option<LawName> {
    COMBINATIONS.iter().find(|c| c.normal == name && is_shipped(c)).map(|c| LawName(c.normal))
}

/// Returns a tangential law by name, or [`LawName::NONE`].
pub fn tangential_named(name: &str) -> Option<LawName> {
    let none = LawName::NONE.as_str();
    COMBINATIONS.iter().map(|c| c.tangential).chain([none]).find(|known| *known == name).map(LawName)
}

/// Normal laws.
pub fn normals() -> Vec<&'static str> {
    once(COMBINATIONS.iter().filter(|c| is_shipped(c)).map(|c| c.normal))
}

/// Tangential laws and [`LawName::NONE`].
pub fn tangentials() -> Vec<&'static str> {
    once(COMBINATIONS.iter().map(|c| c.tangential).chain([LawName::NONE.as_str()]))
}

/// Removes duplicates.
pub(super) fn once(texts: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    let mut out = Vec::new();
    texts.for_each(|t| {
        if !out.contains(&t) {
            out.push(t)
        }
    });
    out
}

/// Material pair without law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawSelectionError {
    /// Different normal laws.
    #[error("different normal laws, \"{0}\" and \"{1}\", and none for the pair")]
    Unlike(&'static str, &'static str),
    /// Incompatible laws.
    #[error("normal law \"{0}\" with tangential law \"{1}\", an unsupported combination")]
    NoSuch(&'static str, &'static str),
}

/// Row of a pair, `None` if both are rigid.
///
/// # Errors
/// [`LawSelectionError`] if ambiguous or incompatible.
pub(super) fn select_law(pair: &Pair<'_>) -> Result<Option<usize>, LawSelectionError> {
    let own = |m: &Material| {
        let implied = if m.corner_strength.is_finite() {
            Some(ConicalDamage::NAME)
        } else if m.young.is_some() {
            Some(Hertz::NAME)
        } else {
            m.stiffness.is_finite().then_some(Linear::NAME)
        };
        m.normal.map(|n| n.0).or(implied)
    };
    let (a, b) = (own(pair.a), own(pair.b));
    let given = pair.given(|e| e.normal).map(|n| n.0);
    let spring = pair.given(|e| e.stiffness).map(|_| Linear::NAME);
    let normal = match (given, a, b) {
        (Some(name), _, _) => name,
        (None, Some(Hertz::NAME), Some(ConicalDamage::NAME)) => ConicalDamage::NAME,
        (None, Some(ConicalDamage::NAME), Some(Hertz::NAME)) => ConicalDamage::NAME,
        (None, Some(a), Some(b)) if a != b => return Err(LawSelectionError::Unlike(a, b)),
        (None, a, b) => match a.or(b).or(spring) {
            Some(name) => name,
            None => return Ok(None),
        },
    };
    let rough = rough::asperities(pair, rough::NAME).filter(|_| normal == Linear::NAME).map(|_| rough::NAME);
    let tangential = pair.given(|e| e.tangential).filter(|t| *t != LawName::NONE).or(rough);
    let fits = |c: &LawInfo| c.normal == normal && tangential.is_none_or(|LawName(t)| c.tangential == t);
    match COMBINATIONS.iter().position(fits) {
        Some(k) => Ok(Some(k)),
        None => Err(LawSelectionError::NoSuch(normal, tangential.map_or("none", |t| t.0))),
    }
}

/// Returns the laws of a pair, `None` if both are rigid.
///
/// # Errors
/// [`LawSelectionError`] if ambiguous or incompatible.
pub fn combination(pair: &Pair<'_>) -> Result<Option<&'static LawInfo>, LawSelectionError> {
    Ok(select_law(pair)?.map(|k| &COMBINATIONS[k]))
}
