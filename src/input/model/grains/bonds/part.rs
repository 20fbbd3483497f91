//! Bonds of a scene and their pairs.

use crate::scene::grains::Grains;
use crate::scene::{SceneError, Table};
use std::collections::HashSet;
use trackbed_dem::bond::{Bond, BondInput, Face, Spread, factors, within_gap};
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, ModelInput, Vec3};

/// Bonds, one type per `[[bond]]`.
#[derive(Clone, Debug, Default)]
pub struct BondPart {
    /// Names of the types.
    pub names: Vec<String>,
    kinds: Vec<Bond>,
    rules: Vec<Rule>,
    made: Vec<Made>,
}

#[derive(Clone, Copy, Debug)]
struct Made {
    bodies: [usize; 2],
    kind: usize,
    face: Option<Face>,
    length: Option<f64>,
}

/// Rule that bonds pairs, with strength variation.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Groups of the two bodies; any by default.
    pub between: Option<[u32; 2]>,
    /// Pairs.
    pub source: PairSource,
    /// Variation of strengths.
    pub spread: Spread,
    /// Seed of the variation.
    pub seed: u64,
    /// Whether tension and shear vary together.
    pub correlated: bool,
    /// Variation of stiffness, and its seed.
    pub stiffness: (Spread, u64),
    /// Boxes with weaker or stronger bonds.
    pub regions: Vec<BondRegion>,
}

/// Source of the pairs.
#[derive(Clone, Debug)]
pub enum PairSource {
    /// Bodies with at most this gap [m].
    Gap(f64),
    /// Given pairs.
    Pairs(Vec<[usize; 2]>),
    /// Bonds within bonded grains and sheets.
    Made,
}

/// Box with weaker or stronger bonds.
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

impl Made {
    fn bond(&self) -> BondInput {
        let [a, b] = self.bodies;
        BondInput { face: self.face, length: self.length, ..BondInput::new(a, b, self.kind) }
    }
}

impl BondPart {
    /// Whether the scene has bonds.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Whether bonded grains or sheets exist.
    pub fn has_made(&self) -> bool {
        !self.made.is_empty()
    }

    pub(super) fn add_kind(&mut self, name: &str, kind: Bond) {
        self.kinds.push(kind);
        self.names.push(name.to_string());
    }

    pub(super) fn add_rule(&mut self, rule: Rule) {
        self.rules.push(rule);
    }

    pub(super) fn makes(&self, kind: usize) -> bool {
        self.made.iter().any(|m| m.kind == kind)
    }

    pub(super) fn fills_faces(&self, kind: usize) -> bool {
        self.kinds[kind].fills_faces()
    }

    /// Adds a bond within a bonded grain.
    pub fn join_stone(&mut self, bodies: [usize; 2], kind: usize) {
        self.made.push(Made { bodies, kind, face: None, length: None });
    }

    /// Adds a bond that fills a face.
    pub fn join_face(&mut self, bodies: [usize; 2], kind: usize, face: Face) {
        self.made.push(Made { bodies, kind, face: Some(face), length: None });
    }

    /// Adds a bond of a net with its length without tension [m], which settling does not change.
    pub fn join_net(&mut self, bodies: [usize; 2], kind: usize, length: f64) {
        self.made.push(Made { bodies, kind, face: None, length: Some(length) });
    }

    /// Returns the `[[bond]]` index of a group. `faces`: bonds fill faces.
    pub fn of_group(&self, group: &Table<Grains>, name: &str, faces: bool) -> Result<usize, SceneError> {
        let of_kind = |kind: &usize| self.fills_faces(*kind) == faces;
        let known = || {
            let names: Vec<_> = (0..self.names.len()).filter(of_kind).map(|k| &*self.names[k]).collect();
            let kind = if faces { "with" } else { "without" };
            format!("the name of a [[bond]] {kind} `face`: {}", names.join(", "))
        };
        self.find(name).filter(of_kind).ok_or_else(|| group.error("bond", format!("\"{name}\""), known()))
    }

    /// Returns the index of a named `[[bond]]`.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|n| n == name)
    }

    /// Adds the bonds of the main stage to an input.
    pub fn add_to(&self, input: &mut ModelInput) {
        input.bond_kinds.clone_from(&self.kinds);
        input.bonds = self.bonds(&input.bodies, &input.shapes);
    }

    /// Adds unbreakable bonds within grains to an input.
    pub fn add_stones_to(&self, input: &mut ModelInput) {
        input.bond_kinds = self.kinds.iter().map(Bond::unbreakable).collect();
        input.bonds = self.made.iter().map(Made::bond).collect();
    }

    pub(super) fn gap(&self, kind: usize, bodies: &[BodyInput], shapes: &[Shape]) -> Option<(f64, f64)> {
        let PairSource::Gap(gap) = self.rules[kind].source else { return None };
        let radii = bodies.iter().filter_map(|b| match shapes[b.shape] {
            Shape::Sphere { radius } => Some(radius * b.scale),
            _ => None,
        });
        radii.reduce(f64::max).map(|largest| (gap, largest))
    }

    /// Only single spheres are bonded by gap.
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
            (PairSource::Made, _) => self.makes(kind),
        }
    }

    /// Returns all bonds, each pair by its first table.
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
            let plain = |[a, b]: [usize; 2]| BondInput::new(a, b, kind);
            let found: Vec<BondInput> = match &rule.source {
                PairSource::Gap(gap) => {
                    let spheres: Vec<_> =
                        bodies.iter().map(|b| (b.position, radius(b).max(f64::MIN_POSITIVE))).collect();
                    within_gap(&spheres, *gap, accept).into_iter().map(plain).collect()
                }
                PairSource::Pairs(pairs) => pairs.iter().copied().map(plain).collect(),
                PairSource::Made => self.made.iter().filter(|m| m.kind == kind).map(Made::bond).collect(),
            };
            let pairs: Vec<_> =
                found.into_iter().filter(|p| seen.insert((p.a.min(p.b), p.a.max(p.b)))).collect();
            let tension = factors(rule.spread, rule.seed, 0, pairs.len());
            let shear = factors(rule.spread, rule.seed, u64::from(!rule.correlated), pairs.len());
            // Streams 0 and 1 are used for strengths.
            let stiffness = factors(rule.stiffness.0, rule.stiffness.1, 2, pairs.len());
            for (k, pair) in pairs.into_iter().enumerate() {
                let middle = (bodies[pair.a].position + bodies[pair.b].position) * 0.5;
                let mut bond =
                    BondInput { tension: tension[k], shear: shear[k], stiffness: stiffness[k], ..pair };
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
