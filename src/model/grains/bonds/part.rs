//! Bonds of a scene, and the pairs that they join.

use std::collections::HashSet;
use trackbed_dem::bond::{Bond, BondInput, Spread, factors, within_gap};
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
pub struct Rule {
    /// Groups of both bodies; none for any.
    pub between: Option<[u32; 2]>,
    /// Pairs.
    pub source: PairSource,
    /// How strengths vary from bond to bond.
    pub spread: Spread,
    /// Seed of the variation.
    pub seed: u64,
    /// Whether tension and shear vary together.
    pub together: bool,
    /// How stiffnesses vary, and the seed of that.
    pub stiffness: (Spread, u64),
    /// Boxes in which bonds are weaker or stronger.
    pub regions: Vec<BondRegion>,
}

/// Where the pairs of a rule come from.
#[derive(Clone, Debug)]
pub enum PairSource {
    /// Bodies whose gap is at most this [m].
    Gap(f64),
    /// Given pairs.
    Pairs(Vec<[usize; 2]>),
    /// The stones that name the table.
    Stones,
}

/// A box in which bonds are weaker or stronger.
#[derive(Clone, Debug)]
pub struct BondRegion {
    /// Lower corner [m].
    pub low: Vec3,
    /// Upper corner [m].
    pub high: Vec3,
    /// Factor of the strengths.
    pub strength: f64,
    /// Factor of the stiffness.
    pub stiffness: f64,
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

    /// Adds a kind of bond.
    pub(super) fn add_kind(&mut self, name: &str, kind: Bond) {
        self.kinds.push(kind);
        self.names.push(name.to_string());
    }

    /// Adds the rule of the kind of the same number.
    pub(super) fn add_rule(&mut self, rule: Rule) {
        self.rules.push(rule);
    }

    /// Whether stones are made with bonds of a kind.
    pub(super) fn in_stones(&self, kind: usize) -> bool {
        self.stones.iter().any(|(_, k)| *k == kind)
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

    /// Whether the rule of a kind can join any two of these bodies, wherever they come to lie: only single spheres are joined.
    pub(super) fn can_join(&self, kind: usize, bodies: &[BodyInput], shapes: &[Shape]) -> bool {
        let rule = &self.rules[kind];
        let spheres = |part: Option<u32>| {
            let sphere = |b: &&BodyInput| matches!(shapes[b.shape], Shape::Sphere { .. });
            bodies.iter().filter(sphere).filter(|b| part.is_none_or(|p| b.part == p)).take(2).count()
        };
        match (&rule.source, rule.between) {
            (PairSource::Gap(_), None) => spheres(None) > 1,
            (PairSource::Gap(_), Some([a, b])) if a == b => spheres(Some(a)) > 1,
            (PairSource::Gap(_), Some([a, b])) => spheres(Some(a)) > 0 && spheres(Some(b)) > 0,
            (PairSource::Pairs(pairs), _) => !pairs.is_empty(),
            (PairSource::Stones, _) => self.in_stones(kind),
        }
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
                PairSource::Gap(gap) => {
                    let spheres: Vec<_> =
                        bodies.iter().map(|b| (b.position, radius(b).max(f64::MIN_POSITIVE))).collect();
                    within_gap(&spheres, *gap, accept)
                }
                PairSource::Pairs(pairs) => pairs.clone(),
                PairSource::Stones => {
                    self.stones.iter().filter(|(_, k)| *k == kind).map(|(pair, _)| *pair).collect()
                }
            };
            let pairs: Vec<_> =
                pairs.into_iter().filter(|[a, b]| seen.insert((*a.min(b), *a.max(b)))).collect();
            let tension = factors(rule.spread, rule.seed, 0, pairs.len());
            let shear = factors(rule.spread, rule.seed, u64::from(!rule.together), pairs.len());
            // 0 and 1 are the strengths' random numbers.
            let stiffness = factors(rule.stiffness.0, rule.stiffness.1, 2, pairs.len());
            for (k, &[a, b]) in pairs.iter().enumerate() {
                let middle = (bodies[a].position + bodies[b].position) * 0.5;
                let mut bond = BondInput {
                    tension: tension[k],
                    shear: shear[k],
                    stiffness: stiffness[k],
                    ..BondInput::new(a, b, kind)
                };
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
