//! Rules that find the pairs to be joined in the bodies that a run starts with.

use super::part::{BondPart, BondRegion, PairSource, Rule};
use crate::failure::Failure;
use crate::model::grains::check::check;
use crate::model::tables;
use crate::scene::bonds::{BondTable, SpreadKind};
use crate::scene::units::vector;
use crate::scene::{Document, SceneError};
use trackbed_dem::Vec3;
use trackbed_dem::bond::Spread;

/// What can be joined.
pub struct Joinable<'a> {
    /// The bonds so far.
    pub bonds: &'a BondPart,
    /// Names of the groups of grains.
    pub groups: &'a [String],
    /// Number of bodies.
    pub count: usize,
    /// Whether grains above a level are taken away before bonds are made.
    pub levelled: bool,
}

/// Which bodies table `i` joins, and how strongly.
pub(super) fn rule(
    document: &Document,
    i: usize,
    table: &BondTable,
    bodies: &Joinable<'_>,
) -> Result<Rule, Failure> {
    let key = |k: &str| format!("bond.{i}.{k}");
    let find = |name: &String| {
        let known = || format!("the name of a [[grains]]: {}", bodies.groups.join(", "));
        let found = bodies.groups.iter().position(|p| p == name);
        found.map(|p| p as u32).ok_or_else(|| document.error(&key("between"), format!("\"{name}\""), known()))
    };
    let between =
        table.between.as_ref().map(|[a, b]| Ok::<_, SceneError>([find(a)?, find(b)?])).transpose()?;
    let source = source(document, i, table, between.is_some(), bodies)?;
    let spread = spread(document, i, table)?;
    let regions = regions(document, i, table)?;
    let (seed, together) = table.spread.as_ref().map_or((1, false), |s| (s.seed.unwrap_or(1), s.together));
    Ok(Rule { between, source, spread, seed, together, regions })
}

/// Which pairs a table joins; `between` is whether it names two groups.
fn source(
    document: &Document,
    i: usize,
    table: &BondTable,
    between: bool,
    bodies: &Joinable<'_>,
) -> Result<PairSource, Failure> {
    let key = |k: &str| format!("bond.{i}.{k}");
    let named = bodies.bonds.in_stones(i);
    let source = match (&table.gap, &table.pairs) {
        (Some(gap), None) => {
            check(document, &key("gap"), Some(gap.si), |g| g >= 0.0, "0 or more")?;
            PairSource::Gap(gap.si)
        }
        (None, Some(file)) => {
            if bodies.levelled {
                let expected = "no such key beside deposition.level, which takes grains away";
                return Err(document.error(&key("pairs"), "a file", expected).into());
            }
            if between {
                return Err(document
                    .error(&key("between"), "two groups", "no such key beside `pairs`")
                    .into());
            }
            PairSource::Pairs(tables::pairs(&document.resolve(file), bodies.count)?)
        }
        (None, None) if named => {
            if between {
                let expected = "a `gap` beside it, or no such key for the bonds of stones";
                return Err(document.error(&key("between"), "two groups", expected).into());
            }
            PairSource::Stones
        }
        _ => {
            let expected = "one of `gap` and `pairs`, or a [[grains]] that names this bond";
            return Err(document.error(&key("gap"), "both or none of `gap` and `pairs`", expected).into());
        }
    };
    if named && !matches!(source, PairSource::Stones) {
        let expected = "no such key for a bond that stones are made with";
        return Err(document.error(&key("gap"), "a rule", expected).into());
    }
    Ok(source)
}

/// How strengths vary from bond to bond.
fn spread(document: &Document, i: usize, table: &BondTable) -> Result<Spread, SceneError> {
    let key = |k: &str| format!("bond.{i}.{k}");
    let Some(s) = &table.spread else { return Ok(Spread::Constant) };
    match (s.kind, s.deviation, s.modulus) {
        (SpreadKind::Normal, Some(deviation), None) => {
            let key = key("spread.deviation");
            check(document, &key, Some(deviation), |d| d > 0.0 && d <= 10.0, "above 0, at most 10")?;
            Ok(Spread::Normal { deviation })
        }
        (SpreadKind::Weibull, None, Some(modulus)) => {
            let key = key("spread.modulus");
            check(document, &key, Some(modulus), |m| m > 0.05 && m <= 1e3, "above 0.05, at most 1000")?;
            Ok(Spread::Weibull { modulus })
        }
        _ => {
            let expected = "`deviation` for `normal`, `modulus` for `weibull`";
            Err(document.error(&key("spread"), "other keys", expected))
        }
    }
}

/// Boxes in which bonds are weaker or stronger.
fn regions(document: &Document, i: usize, table: &BondTable) -> Result<Vec<BondRegion>, SceneError> {
    let mut regions = Vec::new();
    for (k, r) in table.region.iter().enumerate() {
        let key = |name: &str| format!("bond.{i}.region.{k}.{name}");
        let (low, high) = (Vec3::from(vector(&r.low)), Vec3::from(vector(&r.high)));
        if (0..3).any(|d| low[d] >= high[d]) {
            return Err(document.error(&key("high"), "a corner not above `low`", "low < high"));
        }
        check(document, &key("strength"), r.strength, |f| f > 0.0, "above 0")?;
        check(document, &key("stiffness"), r.stiffness, |f| f > 0.0, "above 0")?;
        let (strength, stiffness) = (r.strength.unwrap_or(1.0), r.stiffness.unwrap_or(1.0));
        regions.push(BondRegion { low, high, strength, stiffness });
    }
    Ok(regions)
}
