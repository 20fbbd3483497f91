//! Normal law of formulas, interpreted in lanes and recorded for devices like every other law.
//!
//! Theory manual: section 1.12, `docs/theory/contacts.md`.

use super::constants::Constants;
use super::contact::NO_CONTACT;
use super::formula::{Formula, MEMORY, MODULUS, NAMES, Program, STIFFNESS, VARIABLES, Values, Variable};
use super::hertz;
use super::material::Pair;
use super::mindlin::CircularContact;
use super::normal::{ConstantStiffness, Expected, NormalInput, NormalLaw, Response};
use super::restitution::restitution;
use crate::lanes::Real;

/// Pair constants of an own law of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormulaLaw<const KIND: u8, R = f64> {
    formula: Option<&'static Formula>,
    stiffness: R,
    modulus: R,
    damping_ratio: R,
    restitution: R,
}

impl<const KIND: u8> Constants for FormulaLaw<KIND> {
    type Lanes<R: Real> = FormulaLaw<KIND, R>;

    const ZERO: Self =
        FormulaLaw { formula: None, stiffness: 0.0, modulus: 0.0, damping_ratio: 0.0, restitution: 0.0 };

    #[inline(always)]
    fn splat<R: Real>(&self) -> FormulaLaw<KIND, R> {
        FormulaLaw {
            formula: self.formula,
            stiffness: R::splat(self.stiffness),
            modulus: R::splat(self.modulus),
            damping_ratio: R::splat(self.damping_ratio),
            restitution: R::splat(self.restitution),
        }
    }

    #[inline(always)]
    fn mixed<R: Real>(all: [&Self; 8], join: fn(&[f64; 8]) -> R) -> FormulaLaw<KIND, R> {
        FormulaLaw {
            // A scene has one own law.
            formula: all.iter().find_map(|law| law.formula),
            stiffness: join(&all.map(|l| l.stiffness)),
            modulus: join(&all.map(|l| l.modulus)),
            damping_ratio: join(&all.map(|l| l.damping_ratio)),
            restitution: join(&all.map(|l| l.restitution)),
        }
    }
}

impl<const KIND: u8, R: Real> FormulaLaw<KIND, R> {
    #[inline(always)]
    fn values(&self, overlap: R, [before, largest]: [R; 2], radius: R) -> Values<R> {
        let mut values = [R::zero(); VARIABLES.len()];
        values[Variable::Overlap as usize] = overlap;
        values[Variable::Largest as usize] = largest;
        values[Variable::LargestBefore as usize] = before;
        values[Variable::Radius as usize] = radius;
        values[Variable::Stiffness as usize] = self.stiffness;
        values[Variable::Modulus as usize] = self.modulus;
        values[Variable::DampingRatio as usize] = self.damping_ratio;
        values[Variable::Restitution as usize] = self.restitution;
        values
    }
}

/// Values of formulas, zero if absent.
#[inline(always)]
fn results<R: Real, const RESULTS: usize>(program: Option<&Program>, values: &Values<R>) -> [R; RESULTS] {
    program.map_or([R::zero(); RESULTS], |p| p.evaluate(values))
}

/// Nodes and weights of Gauss's rule on [0, 1].
const GAUSS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_095],
    [0.230_765_344_947_158_5, 0.239_314_335_249_683_3],
    [0.5, 0.284_444_444_444_444_4],
    [0.769_234_655_052_841_5, 0.239_314_335_249_683_3],
    [0.953_089_922_969_332, 0.118_463_442_528_095],
];
/// Parts of the integral, equal in √d.
const PARTS: usize = 8;
/// Overlaps at which the largest stiffness is sought.
const SAMPLES: usize = 16;

impl<const KIND: u8> FormulaLaw<KIND> {
    fn largest(overlap: f64, remembered: f64) -> f64 {
        if KIND != MEMORY || remembered == NO_CONTACT { overlap } else { remembered.max(overlap) }
    }

    /// ∫ F dd of first loading [J].
    fn work(&self, overlap: f64, radius: f64) -> f64 {
        let mut sum = 0.0;
        for part in 0..PARTS {
            for [node, weight] in GAUSS {
                let root = (part as f64 + node) / PARTS as f64;
                let d = overlap * root * root;
                sum += self.force(d, radius, d) * 2.0 * overlap * root * weight / PARTS as f64;
            }
        }
        sum
    }

    /// Force and stiffness, of first loading or with the largest overlap fixed.
    fn gradient(&self, overlap: f64, radius: f64, largest: Option<f64>) -> (f64, f64) {
        let Some(formula) = self.formula else { return (0.0, 0.0) };
        let values = self.values(overlap, [overlap, largest.unwrap_or(overlap)], radius);
        let mut rates = [0.0; VARIABLES.len()];
        rates[Variable::Overlap as usize] = 1.0;
        rates[Variable::Largest as usize] = f64::from(u8::from(largest.is_none()));
        formula.force.derivative(&values, &rates)
    }
}

impl<const KIND: u8> NormalLaw for FormulaLaw<KIND> {
    const NAME: &'static str = NAMES[KIND as usize];
    const SOURCE: &'static str = "contact: formulas of the scene";
    const KEYS: &'static [&'static str] =
        if KIND == MODULUS { &["young", "poisson"] } else { &["stiffness"] };
    const DASHPOT: bool = KIND != MEMORY;
    const REMEMBERS: bool = KIND == MEMORY;
    const JUMPS: bool = KIND == STIFFNESS;
    const STIFFENS: bool = true;

    fn mix(pair: &Pair<'_>, zeta: f64) -> Self {
        FormulaLaw {
            formula: pair.given(|e| e.formula).or(pair.a.formula).or(pair.b.formula),
            stiffness: if KIND == MODULUS { 0.0 } else { pair.stiffness() },
            modulus: if KIND == MODULUS { hertz::modulus(pair) } else { 0.0 },
            damping_ratio: zeta,
            restitution: pair.restitution(),
        }
    }

    #[inline(always)]
    fn respond<R: Real>(law: &FormulaLaw<KIND, R>, touch: &NormalInput<R>) -> Response<R> {
        let overlap = touch.overlap;
        let (mut before, mut largest) = (overlap, overlap);
        if KIND == MEMORY {
            before = R::select(touch.fresh, R::zero(), touch.remembered);
            largest = before.max(overlap);
        }
        let mut values = law.values(overlap, [before, largest], touch.radius);
        values[Variable::InverseMass as usize] = touch.inverse_mass;
        values[Variable::Step as usize] = touch.step;
        let [force, other] = law.formula.map_or([R::zero(); 2], |f| f.stepped(&values));
        let circle = (touch.radius * overlap).sqrt();
        let before = if KIND == MODULUS { (touch.radius * touch.overlap_before()).sqrt() } else { circle };
        Response {
            elastic: if KIND == MEMORY { force.max(R::zero()) } else { force },
            damping: if KIND == MEMORY { R::zero() } else { other },
            circle,
            circle_before: before,
            remembered: if KIND == MEMORY { largest } else { touch.remembered },
            lost: if KIND == MEMORY { other } else { R::zero() },
        }
    }

    #[inline(always)]
    fn force(&self, overlap: f64, radius: f64, remembered: f64) -> f64 {
        let largest = Self::largest(overlap, remembered);
        let [force] = results(self.formula.map(|f| &f.force), &self.values(overlap, [largest; 2], radius));
        if KIND == MEMORY { force.max(0.0) } else { force }
    }

    fn stored(&self, overlap: f64, radius: f64, remembered: f64) -> f64 {
        match self.formula.and_then(|f| f.energy.as_ref()) {
            None => self.work(overlap, radius),
            Some(energy) => {
                let largest = Self::largest(overlap, remembered);
                energy.evaluate::<f64, 1>(&self.values(overlap, [largest; 2], radius))[0]
            }
        }
    }

    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64) {
        self.gradient(overlap, radius, None)
    }

    fn stiffness(&self, overlap: f64, radius: f64) -> f64 {
        let at = |k: usize| {
            let d = overlap * k as f64 / SAMPLES as f64;
            let unloading = if KIND == MEMORY { self.gradient(d, radius, Some(overlap)).1 } else { 0.0 };
            self.gradient(d, radius, None).1.max(unloading)
        };
        (1..=SAMPLES).map(at).fold(0.0, f64::max)
    }

    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    fn loss(&self) -> f64 {
        if KIND == MEMORY {
            1.0 - self.restitution.powi(2)
        } else {
            1.0 - restitution(self.damping_ratio).powi(2)
        }
    }

    /// For the larger of an impact and rest under a column, of sizes from 0.1 mm to 10 m (cf. `hertz.rs`).
    fn expected_overlap(&self, e: &Expected) -> f64 {
        let of = |radius: f64| {
            let impact = 2.0 / 3.0 * std::f64::consts::PI * e.density * radius.powi(3) * e.speed * e.speed;
            let rest = 4.0 * e.density * e.gravity * e.height * radius * radius;
            let enough = |share: f64| {
                let d = share * radius;
                self.work(d, radius) >= impact && self.force(d, radius, d) >= rest
            };
            let (mut low, mut high) = (1e-9_f64, 1.0_f64);
            for _ in 0..60 {
                let middle = (low * high).sqrt();
                if enough(middle) { high = middle } else { low = middle }
            }
            high
        };
        (-4..=1).map(|k| of(libm::pow(10.0, f64::from(k)))).fold(0.0, f64::max)
    }
}

impl ConstantStiffness for FormulaLaw<STIFFNESS> {
    fn constant(&self) -> f64 {
        self.stiffness
    }
}

impl ConstantStiffness for FormulaLaw<MEMORY> {
    fn constant(&self) -> f64 {
        self.stiffness
    }
}

impl CircularContact for FormulaLaw<MODULUS> {}
