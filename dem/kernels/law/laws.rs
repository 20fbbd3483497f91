//! Contact laws of all material pairs.

use super::contact::{History, Linearised};
use super::contact_law::ContactLaw;
use super::line_contact;
use super::material::{Material, Pair, PairOverride};
use super::normal::Expected;
use super::table::{AnyLaw, ConicalLaw, HertzLaw, LinearLaw, RoughLaw, Row, once, select_law, title};
use crate::lanes::SimdPack;

/// Mixed constants of all pairs.
#[derive(Clone, Debug)]
pub struct PairTable<L> {
    count: usize,
    pairs: Vec<L>,
    /// Pairs with separate edge laws.
    edged: Vec<bool>,
}

impl<L: ContactLaw> PairTable<L> {
    /// Mixes every pair; its last exception applies.
    pub fn new(materials: &[Material], exceptions: &[PairOverride]) -> PairTable<L> {
        let count = materials.len();
        let all = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
        let pairs = all.map(|(i, j)| L::mix(&Pair::of(materials, exceptions, i, j))).collect();
        PairTable { count, pairs, edged: Vec::new() }
    }

    /// Number of materials, excluding edge materials.
    #[inline(always)]
    fn own(&self) -> usize {
        if self.edged.is_empty() { self.count } else { self.count / 2 }
    }

    /// Materials of the edge law, if separate.
    #[inline(always)]
    pub fn edges(&self, [a, b]: [u32; 2]) -> Option<[u32; 2]> {
        let own = self.own() as u32;
        let has = !self.edged.is_empty() && a < own && b < own && self.edged[(a * own + b) as usize];
        has.then(|| [a + own, b + own])
    }

    /// Returns constants of `a` and `b`.
    #[inline(always)]
    pub fn get(&self, a: u32, b: u32) -> &L {
        &self.pairs[a as usize * self.count + b as usize]
    }

    #[inline(always)]
    pub fn lanes<R: SimdPack>(&self, a: R, b: R) -> L::Lanes<R> {
        let (a, b) = (a.numbers(), b.numbers());
        let mut laws = [&self.pairs[0]; 8];
        for l in 0..R::LANES {
            laws[l] = self.get(a[l] as u32, b[l] as u32);
        }
        L::mixed(laws, R::of)
    }

    pub fn rolls(&self) -> bool {
        self.pairs.iter().any(L::rolls)
    }

    /// Non-rigid pairs.
    fn in_use(&self) -> impl Iterator<Item = &L> {
        let own = self.own();
        let upper = (0..own).flat_map(move |i| (i..own).map(move |j| i * self.count + j));
        upper.map(|k| &self.pairs[k]).filter(|law| law.stiffness(1.0, 1.0).is_finite())
    }

    fn expected_overlap(&self, expected: &Expected) -> f64 {
        self.in_use().map(|law| law.expected_overlap(expected)).fold(0.0, f64::max)
    }

    fn titles(&self) -> Vec<&'static str> {
        once(self.in_use().map(|law| title(law.names())))
    }

    fn sources(&self) -> Vec<&'static str> {
        once(self.in_use().flat_map(L::sources))
    }
}

/// Laws of all contacts.
#[derive(Clone, Debug)]
pub struct Laws {
    /// Uniform laws have separate kernels.
    pub table: LawTable,
    /// The same laws for kernels of any law.
    pub any: PairTable<AnyLaw>,
}

#[derive(Clone, Debug)]
pub enum LawTable {
    Linear(PairTable<LinearLaw>),
    Rough(PairTable<RoughLaw>),
    Hertz(PairTable<HertzLaw>),
    Conical(PairTable<ConicalLaw>),
    AnyLaw(PairTable<AnyLaw>),
}

/// Evaluates with the table in use.
#[doc(hidden)]
#[macro_export]
macro_rules! with_law {
    ($laws:expr, $table:ident => $body:expr) => {
        match &$laws.table {
            $crate::law::LawTable::Linear($table) => $body,
            $crate::law::LawTable::Rough($table) => $body,
            $crate::law::LawTable::Hertz($table) => $body,
            $crate::law::LawTable::Conical($table) => $body,
            $crate::law::LawTable::AnyLaw($table) => $body,
        }
    };
}
pub use crate::with_law;

impl Laws {
    /// Requires [`super::check::laws`].
    pub fn new(materials: &[Material], exceptions: &[PairOverride]) -> Laws {
        let count = materials.len();
        let all = (0..count).flat_map(|i| (i..count).map(move |j| (i, j)));
        let rows = all.filter_map(|(i, j)| select_law(&Pair::of(materials, exceptions, i, j)).ok().flatten());
        let rows: std::collections::BTreeSet<usize> = rows.collect();
        let only = |own: &[Row]| rows.iter().all(|&r| own.iter().any(|&row| r == row as usize));
        let table = if only(&[Row::Linear]) {
            LawTable::Linear(PairTable::new(materials, exceptions))
        } else if only(&[Row::Linear, Row::Rough]) {
            // Bitwise linear for pairs without asperities.
            LawTable::Rough(PairTable::new(materials, exceptions))
        } else if only(&[Row::Hertz]) {
            LawTable::Hertz(PairTable::new(materials, exceptions))
        } else if only(&[Row::Hertz, Row::Conical]) {
            LawTable::Conical(PairTable::new(materials, exceptions))
        } else {
            LawTable::AnyLaw(PairTable::new(materials, exceptions))
        };
        Laws { table, any: PairTable::new(materials, exceptions) }
    }

    /// With separate edge laws for Hertz pairs (`line_contact.rs`).
    pub fn with_edges(materials: &[Material], exceptions: &[PairOverride]) -> Laws {
        let count = materials.len();
        let all = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
        let edged: Vec<bool> =
            all.map(|(i, j)| line_contact::spread(&Pair::of(materials, exceptions, i, j))).collect();
        if !edged.contains(&true) {
            return Laws::new(materials, exceptions);
        }
        let (materials, exceptions) = line_contact::beside(materials, exceptions);
        let mut laws = Laws::new(&materials, &exceptions);
        laws.any.edged.clone_from(&edged);
        match &mut laws.table {
            LawTable::Linear(t) => t.edged = edged,
            LawTable::Rough(t) => t.edged = edged,
            LawTable::Hertz(t) => t.edged = edged,
            LawTable::Conical(t) => t.edged = edged,
            LawTable::AnyLaw(t) => t.edged = edged,
        }
        laws
    }

    /// Materials of the edge law, if separate.
    #[inline(always)]
    pub fn edges(&self, materials: [u32; 2]) -> Option<[u32; 2]> {
        with_law!(self, t => t.edges(materials))
    }

    pub fn loading(&self, a: u32, b: u32, overlap: f64, radius: f64) -> (f64, f64) {
        with_law!(self, t => t.get(a, b).loading(overlap, radius))
    }

    pub fn stiffness(&self, a: u32, b: u32, overlap: f64, radius: f64) -> f64 {
        with_law!(self, t => t.get(a, b).stiffness(overlap, radius))
    }

    pub fn linearised(
        &self,
        [a, b]: [u32; 2],
        mass: f64,
        radius: f64,
        overlap: f64,
        history: &History,
    ) -> Linearised {
        with_law!(self, t => t.get(a, b).linearised(mass, radius, overlap, history))
    }

    pub fn rigid(&self, a: u32, b: u32) -> bool {
        self.stiffness(a, b, 1.0, 1.0).is_infinite()
    }

    pub fn tangential_ratio(&self, a: u32, b: u32) -> f64 {
        with_law!(self, t => t.get(a, b).tangential_ratio())
    }

    pub fn damping_ratio(&self, a: u32, b: u32) -> f64 {
        with_law!(self, t => t.get(a, b).damping_ratio())
    }

    pub fn loss(&self, a: u32, b: u32) -> f64 {
        with_law!(self, t => t.get(a, b).loss())
    }

    pub fn expected_overlap(&self, expected: &Expected) -> f64 {
        with_law!(self, t => t.expected_overlap(expected))
    }

    pub fn initial_state(&self, a: u32, b: u32, approach: f64) -> f64 {
        with_law!(self, t => t.get(a, b).initial_state(approach))
    }

    pub fn stored(&self, a: u32, b: u32, overlap: f64, radius: f64, history: &History) -> (f64, f64) {
        with_law!(self, t => t.get(a, b).stored(overlap, radius, history))
    }

    /// `friction` replaces the law's coefficient.
    pub fn friction_limit(
        &self,
        [a, b]: [u32; 2],
        friction: Option<f64>,
        overlap: f64,
        radius: f64,
        history: &History,
    ) -> (f64, f64) {
        with_law!(self, t => {
            let law = t.get(a, b);
            let law = friction.map_or(*law, |it| law.with_friction(it));
            law.friction_limit(overlap, radius, history)
        })
    }

    pub fn materials(&self) -> u32 {
        with_law!(self, t => t.count as u32)
    }

    pub fn rolls(&self) -> bool {
        with_law!(self, t => t.rolls())
    }

    pub fn rolls_among(&self, a: &[u32], b: &[u32]) -> bool {
        with_law!(self, t => a.iter().any(|&a| b.iter().any(|&b| t.get(a, b).rolls())))
    }

    pub fn title(&self) -> String {
        let titles = with_law!(self, t => t.titles());
        if titles.is_empty() { "no contacts".to_string() } else { titles.join(" and ") }
    }

    pub fn sources(&self) -> Vec<&'static str> {
        with_law!(self, t => t.sources())
    }
}

/// Sources of the laws in use.
pub fn sources(materials: &[Material], exceptions: &[PairOverride]) -> Vec<&'static str> {
    Laws::new(materials, exceptions).sources()
}
