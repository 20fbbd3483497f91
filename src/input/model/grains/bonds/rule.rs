//! Rules that select the initial bonded pairs.

use super::part::{BondPart, BondRegion, PairSource, Rule};
use crate::model::tables;
use crate::scene::bonds::{BondTable, SpreadKind};
use crate::scene::units::vector;
use crate::scene::{SceneError, Table};
use trackbed_dem::Vec3;
use trackbed_dem::bond::Spread;
use trackbed_io::failure::Failure;

/// Bodies that can be bonded.
pub struct Joinable<'a> {
    /// Bonds resolved so far.
    pub bonds: &'a BondPart,
    /// Index of the bond type.
    pub kind: usize,
    /// Names of the groups of grains.
    pub groups: &'a [String],
    /// Number of bodies.
    pub count: usize,
    /// Whether grains above a level are removed first.
    pub levelled: bool,
}

pub(super) fn rule(table: &Table<BondTable>, bodies: &Joinable<'_>) -> Result<Rule, Failure> {
    let find = |name: &String| {
        let known = || format!("the name of a [[grains]]: {}", bodies.groups.join(", "));
        let found = bodies.groups.iter().position(|p| p == name);
        found.map(|p| p as u32).ok_or_else(|| table.error("between", format!("\"{name}\""), known()))
    };
    let between =
        table.between.as_ref().map(|[a, b]| Ok::<_, SceneError>([find(a)?, find(b)?])).transpose()?;
    let source = source(table, between.is_some(), bodies)?;
    let spread = table.optional("spread", &table.spread);
    let spread = spread.map_or(Ok(Spread::Constant), |s| law(&s, s.kind, s.deviation, s.modulus))?;
    let stiffness = table.optional("stiffness_spread", &table.stiffness_spread);
    let stiffness_seed = stiffness.as_ref().and_then(|s| s.seed).unwrap_or(1);
    let stiffness = stiffness.map_or(Ok(Spread::Constant), |s| law(&s, s.kind, s.deviation, s.modulus))?;
    let regions = regions(table)?;
    let (seed, correlated) =
        table.spread.as_ref().map_or((1, false), |s| (s.seed.unwrap_or(1), s.correlated));
    let stiffness = (stiffness, stiffness_seed);
    Ok(Rule { between, source, spread, seed, correlated, stiffness, regions })
}

fn source(table: &Table<BondTable>, between: bool, bodies: &Joinable<'_>) -> Result<PairSource, Failure> {
    let named = bodies.bonds.makes(bodies.kind);
    let source = match (&table.gap, &table.pairs) {
        (Some(gap), None) => {
            table.check("gap", *gap, |g| g >= 0.0, "0 or more")?;
            PairSource::Gap(gap.si)
        }
        (None, Some(file)) => {
            if bodies.levelled {
                return Err(table.conflict("pairs", "deposition.level").into());
            }
            if between {
                return Err(table.conflict("between", "`pairs`").into());
            }
            PairSource::Pairs(tables::pairs(&table.locate(file), bodies.count)?)
        }
        (None, None) if named => {
            if between {
                return Err(table.no_effect("between", "`gap`").into());
            }
            PairSource::Made
        }
        (None, None) if bodies.bonds.fills_faces(bodies.kind) => {
            return Err(table.no_effect("face", "[[grains]] of `floes` with this `bond`").into());
        }
        (Some(_), Some(_)) => return Err(table.conflict("gap", "`pairs`").into()),
        (None, None) => {
            let expected = "`gap` or `pairs`, or [[grains]] with this `bond`";
            return Err(table.missing("gap", expected).into());
        }
    };
    if bodies.bonds.fills_faces(bodies.kind) && !matches!(source, PairSource::Made) {
        return Err(table.conflict("face", if table.gap.is_some() { "`gap`" } else { "`pairs`" }).into());
    }
    if named && !matches!(source, PairSource::Made) {
        let key = if table.gap.is_some() { "gap" } else { "pairs" };
        return Err(table.conflict(key, "[[grains]] with this `bond`").into());
    }
    Ok(source)
}

/// Returns the distribution of a table.
pub(in crate::model::grains) fn law<T>(
    table: &Table<T>,
    kind: SpreadKind,
    deviation: Option<f64>,
    modulus: Option<f64>,
) -> Result<Spread, SceneError> {
    match (kind, deviation, modulus) {
        (SpreadKind::Normal, Some(deviation), None) => {
            table.check("deviation", deviation, |d| d > 0.0 && d <= 10.0, "above 0, at most 10")?;
            Ok(Spread::Normal { deviation })
        }
        (SpreadKind::Weibull, None, Some(modulus)) => {
            table.check("modulus", modulus, |m| m > 0.05 && m <= 1e3, "above 0.05, at most 1000")?;
            Ok(Spread::Weibull { modulus })
        }
        _ => {
            let expected = "`deviation` for `normal`, `modulus` for `weibull`";
            Err(table.here("other keys", expected))
        }
    }
}

fn regions(table: &Table<BondTable>) -> Result<Vec<BondRegion>, SceneError> {
    let mut regions = Vec::new();
    for r in table.rows("region", &table.region) {
        let (low, high) = (Vec3::from(vector(&r.low)), Vec3::from(vector(&r.high)));
        if (0..3).any(|d| low[d] >= high[d]) {
            return Err(r.error("high", "a corner not above `low`", "low < high"));
        }
        r.check("strength", r.strength, |f| f > 0.0, "above 0")?;
        r.check("stiffness", r.stiffness, |f| f > 0.0, "above 0")?;
        let (strength, stiffness) = (r.strength.unwrap_or(1.0), r.stiffness.unwrap_or(1.0));
        regions.push(BondRegion { low, high, strength, stiffness });
    }
    Ok(regions)
}
