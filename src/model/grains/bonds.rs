//! `[[bond]]` resolved: kinds of bonds, and rules that find the pairs in the bodies that a run starts with.

use super::{GrainsPart, check};
use crate::failure::Failure;
use crate::model::tables;
use crate::scene::bonds::{BondTable, CriterionName, Parallel, SpreadKind};
use crate::scene::units::vector;
use crate::scene::{Document, Scene, SceneError};
use std::collections::HashSet;
use trackbed_dem::bond::{
    Bond, BondDamping, BondInput, ContactPoint, Criterion, DirectBond, ParallelBond, ParallelStiffness,
    ShearStrength, Spread, factors, within_gap,
};
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, ModelInput, Vec3};

/// Bonds of a scene, one kind for each `[[bond]]`.
#[derive(Clone, Debug, Default)]
pub struct BondPart {
    /// Names of the kinds.
    pub names: Vec<String>,
    kinds: Vec<Bond>,
    rules: Vec<Rule>,
    /// Bonds that stones are made with: bodies and kind.
    stones: Vec<([usize; 2], usize)>,
}

/// Which bodies a table joins, and how strongly.
#[derive(Clone, Debug)]
struct Rule {
    between: Option<[u32; 2]>,
    source: Source,
    spread: Spread,
    seed: u64,
    together: bool,
    regions: Vec<Region>,
}

#[derive(Clone, Debug)]
enum Source {
    Gap(f64),
    Pairs(Vec<[usize; 2]>),
    /// The stones that name the table.
    Stones,
}

#[derive(Clone, Debug)]
struct Region {
    low: Vec3,
    high: Vec3,
    strength: f64,
    stiffness: f64,
}

impl BondPart {
    /// Whether the scene has bonds.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Whether stones are made with bonds.
    pub fn has_stones(&self) -> bool {
        !self.stones.is_empty()
    }

    /// Adds a bond within a stone.
    pub fn join_stone(&mut self, bodies: [usize; 2], kind: usize) {
        self.stones.push((bodies, kind));
    }

    /// Number of the `[[bond]]` with a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|n| n == name)
    }

    /// Adds the bonds of the run proper to an input, for its bodies.
    pub fn add_to(&self, input: &mut ModelInput) {
        input.bond_kinds.clone_from(&self.kinds);
        input.bonds = self.bonds(&input.bodies, &input.shapes);
    }

    /// Adds the bonds within stones to an input; they do not break.
    pub fn add_stones_to(&self, input: &mut ModelInput) {
        input.bond_kinds = self.kinds.iter().map(Bond::unbreakable).collect();
        input.bonds = self.stones.iter().map(|&([a, b], kind)| BondInput::new(a, b, kind)).collect();
    }

    /// All bonds, table by table. A pair joined by one table is left alone by those after it.
    pub fn bonds(&self, bodies: &[BodyInput], shapes: &[Shape]) -> Vec<BondInput> {
        let sphere = |b: usize| matches!(shapes[bodies[b].shape], Shape::Sphere { .. });
        let radius = |b: &BodyInput| match shapes[b.shape] {
            Shape::Sphere { radius } => radius * b.scale,
            _ => 0.0,
        };
        let mut seen = HashSet::new();
        let mut bonds = Vec::new();
        for (kind, rule) in self.rules.iter().enumerate() {
            let accept = |a: usize, b: usize| {
                let parts = [bodies[a].part, bodies[b].part];
                let match_groups = rule.between.is_none_or(|[p, q]| parts == [p, q] || parts == [q, p]);
                sphere(a) && sphere(b) && match_groups
            };
            let pairs: Vec<[usize; 2]> = match &rule.source {
                Source::Gap(gap) => {
                    let spheres: Vec<_> =
                        bodies.iter().map(|b| (b.position, radius(b).max(f64::MIN_POSITIVE))).collect();
                    within_gap(&spheres, *gap, accept)
                }
                Source::Pairs(pairs) => pairs.clone(),
                Source::Stones => {
                    self.stones.iter().filter(|(_, k)| *k == kind).map(|(pair, _)| *pair).collect()
                }
            };
            let pairs: Vec<_> =
                pairs.into_iter().filter(|[a, b]| seen.insert((*a.min(b), *a.max(b)))).collect();
            let tension = factors(rule.spread, rule.seed, 0, pairs.len());
            let shear = factors(rule.spread, rule.seed, u64::from(!rule.together), pairs.len());
            for (k, &[a, b]) in pairs.iter().enumerate() {
                let middle = (bodies[a].position + bodies[b].position) * 0.5;
                let mut bond =
                    BondInput { tension: tension[k], shear: shear[k], ..BondInput::new(a, b, kind) };
                for region in &rule.regions {
                    if (0..3).all(|d| middle[d] >= region.low[d] && middle[d] <= region.high[d]) {
                        bond.tension *= region.strength;
                        bond.shear *= region.strength;
                        bond.stiffness *= region.stiffness;
                    }
                }
                bonds.push(bond);
            }
        }
        bonds
    }
}

/// Resolves the kinds of bonds, so that grains can name them.
pub(super) fn kinds(document: &Document, scene: &Scene) -> Result<BondPart, Failure> {
    let mut part = BondPart::default();
    for (i, table) in scene.bond.iter().enumerate() {
        if part.find(&table.name).is_some() {
            let key = format!("bond.{i}.name");
            return Err(document.error(&key, format!("\"{}\" again", table.name), "another name").into());
        }
        part.kinds.push(kind(document, i, table)?);
        part.names.push(table.name.clone());
    }
    Ok(part)
}

/// Resolves which grains are joined, when all of them are there.
pub(super) fn rules(document: &Document, scene: &Scene, part: &mut GrainsPart) -> Result<(), Failure> {
    if part.bonds.has_stones() {
        let settling = part.deposition.as_ref();
        for (key, present) in [
            ("deposition.level", settling.is_some_and(|d| d.level.is_some())),
            ("deposition.layers", settling.is_some_and(|d| d.layers > 1)),
        ] {
            if present {
                return Err(document.error(key, "a value", "no such key beside bonded stones").into());
            }
        }
    }
    for (i, table) in scene.bond.iter().enumerate() {
        let rule = rule(document, i, table, part)?;
        part.bonds.rules.push(rule);
    }
    Ok(())
}

fn kind(document: &Document, i: usize, table: &BondTable) -> Result<Bond, SceneError> {
    let key = |k: &str| format!("bond.{i}.{k}");
    let damping = match (table.damping, table.damping_coefficients) {
        (Some(f), None) => {
            check(document, &key("damping"), Some(f), |f| f >= 0.0, "0 or more")?;
            BondDamping::Fraction(f)
        }
        (None, Some(c)) => {
            for x in c {
                check(document, &key("damping_coefficients"), Some(x), |c| c >= 0.0, "0 or more each")?;
            }
            BondDamping::Coefficients(c)
        }
        (None, None) => BondDamping::None,
        _ => {
            let expected = "`damping` or `damping_coefficients`, not both";
            return Err(document.error(&key("damping"), "two kinds of damping", expected));
        }
    };
    let contact = table.contact;
    let criterion = |c| match c {
        CriterionName::Stress => Criterion::Stress,
        CriterionName::Sum => Criterion::Sum,
    };
    match (&table.parallel, &table.contact_point, &table.direct) {
        (Some(p), None, None) => {
            let bond = parallel(document, &key("parallel"), p)?;
            Ok(Bond::Parallel(ParallelBond { criterion: criterion(p.criterion), damping, contact, ..bond }))
        }
        (None, Some(p), None) => {
            let positive = |k: &str, x: Option<f64>| {
                check(document, &key(&format!("contact_point.{k}")), x, |x| x > 0.0, "above 0")
            };
            positive("normal_stiffness", Some(p.normal_stiffness.si))?;
            let shear = Some(p.shear_stiffness.si);
            check(document, &key("contact_point.shear_stiffness"), shear, |k| k >= 0.0, "0 or more")?;
            positive("tension_limit", p.tension_limit.map(|f| f.si))?;
            positive("shear_limit", p.shear_limit.map(|f| f.si))?;
            Ok(Bond::ContactPoint(ContactPoint {
                normal: p.normal_stiffness.si,
                shear: p.shear_stiffness.si,
                tension_limit: p.tension_limit.map_or(f64::INFINITY, |f| f.si),
                shear_limit: p.shear_limit.map_or(f64::INFINITY, |f| f.si),
                damping,
                contact,
            }))
        }
        (None, None, Some(d)) => {
            let stiffness = key("direct.stiffness");
            check(document, &stiffness, Some(d.stiffness[0]), |k| k > 0.0, "a first number above 0")?;
            for k in d.stiffness {
                check(document, &stiffness, Some(k), |k| k >= 0.0, "0 or more each")?;
            }
            for s in d.strength.iter().flatten() {
                check(document, &key("direct.strength"), Some(*s), |s| s > 0.0, "above 0 each")?;
            }
            Ok(Bond::Direct(DirectBond {
                stiffness: d.stiffness,
                strength: d.strength.unwrap_or([f64::INFINITY; 4]),
                criterion: criterion(d.criterion),
                damping,
                contact,
            }))
        }
        _ => Err(document.error(
            &format!("bond.{i}"),
            "another number of kinds",
            "exactly one of `parallel`, `contact_point` and `direct`",
        )),
    }
}

fn parallel(document: &Document, table: &str, p: &Parallel) -> Result<ParallelBond, SceneError> {
    let key = |k: &str| format!("{table}.{k}");
    let positive = |k: &str, x: Option<f64>| check(document, &key(k), x, |x| x > 0.0, "above 0");
    positive("radius_factor", p.radius_factor)?;
    positive("young", p.young.map(|x| x.si))?;
    positive("stiffness_ratio", p.stiffness_ratio)?;
    positive("normal_stiffness", p.normal_stiffness)?;
    check(document, &key("shear_stiffness"), p.shear_stiffness, |k| k >= 0.0, "0 or more")?;
    positive("tensile_strength", p.tensile_strength.map(|x| x.si))?;
    positive("shear_strength", p.shear_strength.map(|x| x.si))?;
    let angle = p.friction_angle.map(|a| a.si);
    check(
        document,
        &key("friction_angle"),
        angle,
        |a| (0.0..std::f64::consts::FRAC_PI_2).contains(&a),
        "0 or more, below 90 deg",
    )?;
    check(document, &key("moment_factor"), p.moment_factor, |b| (0.0..=1.0).contains(&b), "0 to 1")?;
    let stiffness = match (p.young, p.stiffness_ratio, p.normal_stiffness, p.shear_stiffness) {
        (Some(young), ratio, None, None) => {
            ParallelStiffness::Modulus { young: young.si, ratio: ratio.unwrap_or(1.0) }
        }
        (None, None, Some(normal), Some(shear)) => ParallelStiffness::PerArea { normal, shear },
        _ => {
            let expected = "`young` (with `stiffness_ratio`), or `normal_stiffness` and `shear_stiffness`";
            return Err(document.error(&key("young"), "another set of stiffnesses", expected));
        }
    };
    let shear = p.shear_strength.map_or(f64::INFINITY, |s| s.si);
    let shear_strength = match angle {
        Some(a) if p.shear_strength.is_some() => {
            ShearStrength::MohrCoulomb { cohesion: shear, friction: a.tan() }
        }
        Some(_) => {
            return Err(document.error(&key("friction_angle"), "a value", "a `shear_strength` beside it"));
        }
        None => ShearStrength::Constant(shear),
    };
    Ok(ParallelBond {
        radius_factor: p.radius_factor.unwrap_or(1.0),
        stiffness,
        tensile_strength: p.tensile_strength.map_or(f64::INFINITY, |s| s.si),
        shear_strength,
        moment_factor: p.moment_factor.unwrap_or(1.0),
        criterion: Criterion::Stress,
        damping: BondDamping::None,
        contact: false,
    })
}

fn rule(document: &Document, i: usize, table: &BondTable, part: &GrainsPart) -> Result<Rule, Failure> {
    let key = |k: &str| format!("bond.{i}.{k}");
    let find = |name: &String| {
        let known = || format!("the name of a [[grains]]: {}", part.parts.join(", "));
        let found = part.parts.iter().position(|p| p == name);
        found.map(|p| p as u32).ok_or_else(|| document.error(&key("between"), format!("\"{name}\""), known()))
    };
    let between =
        table.between.as_ref().map(|[a, b]| Ok::<_, SceneError>([find(a)?, find(b)?])).transpose()?;
    let source = source(document, i, table, between.is_some(), part)?;
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
    part: &GrainsPart,
) -> Result<Source, Failure> {
    let key = |k: &str| format!("bond.{i}.{k}");
    let named = part.bonds.stones.iter().any(|(_, kind)| *kind == i);
    let source = match (&table.gap, &table.pairs) {
        (Some(gap), None) => {
            check(document, &key("gap"), Some(gap.si), |g| g >= 0.0, "0 or more")?;
            Source::Gap(gap.si)
        }
        (None, Some(file)) => {
            if part.deposition.as_ref().is_some_and(|d| d.level.is_some()) {
                let expected = "no such key beside deposition.level, which takes grains away";
                return Err(document.error(&key("pairs"), "a file", expected).into());
            }
            if between {
                return Err(document
                    .error(&key("between"), "two groups", "no such key beside `pairs`")
                    .into());
            }
            Source::Pairs(tables::pairs(&document.resolve(file), part.bodies.len())?)
        }
        (None, None) if named => {
            if between {
                let expected = "a `gap` beside it, or no such key for the bonds of stones";
                return Err(document.error(&key("between"), "two groups", expected).into());
            }
            Source::Stones
        }
        _ => {
            let expected = "one of `gap` and `pairs`, or a [[grains]] that names this bond";
            return Err(document.error(&key("gap"), "both or none of `gap` and `pairs`", expected).into());
        }
    };
    if named && !matches!(source, Source::Stones) {
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
fn regions(document: &Document, i: usize, table: &BondTable) -> Result<Vec<Region>, SceneError> {
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
        regions.push(Region { low, high, strength, stiffness });
    }
    Ok(regions)
}

/// Refuses rules that join nothing in the bodies that a run starts with.
pub fn check_joined(document: &Document, part: &BondPart, bonds: &[BondInput]) -> Result<(), SceneError> {
    for (kind, name) in part.names.iter().enumerate() {
        if !bonds.iter().any(|b| b.kind == kind) {
            let expected = "a bond that joins grains: a larger `gap`, or other groups";
            return Err(document.error(&format!("bond.{kind}"), format!("no pair for \"{name}\""), expected));
        }
    }
    Ok(())
}
