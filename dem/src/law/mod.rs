//! Laws of contact: detection yields a [`ContactGeometry`], a law turns it into a force; neither knows the other.
//!
//! A law is written once, over [`Real`]: the loops over many pairs ask it for four contacts at a time
//! ([`ContactLaw::evaluate`]), walls, boxes and measures for one ([`ContactLaw::evaluate_one`]). Both give the same bits.

pub mod adhesion;
pub mod hertz;
pub mod linear;
pub mod material;
pub mod restitution;
pub(crate) mod slide;

use self::material::{Material, PairOverride};
use crate::base::Vec3;
use crate::lanes::{Pack, Real, V3};
use serde::{Deserialize, Serialize};

/// Where and how two partners touch. "a" is the partner the force is computed for, "b" the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// The one point where the force acts on both [m].
    pub point: Vec3,
    /// Unit normal, from b to a.
    pub normal: Vec3,
    /// Overlap, positive in contact [m].
    pub overlap: f64,
    /// Effective radius 1/(1/R₁ + 1/R₂) [m].
    pub radius: f64,
}

/// Memory of one contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Tangential spring: displacement of a against b that still pulls back [m].
    pub spring: Vec3,
    /// Approach speed half a step before the last force [m/s]; [`FRESH`] before the first.
    pub rate: f64,
    /// Rolling spring (three components) and twisting spring: angles of a against b that still turn back, times the
    /// effective radius [m]. Zero where neither resistance is modelled.
    pub turn: [f64; 4],
}

/// Marks a history without a contact (finite, so that every format can hold it).
pub const FRESH: f64 = f64::MAX;

impl History {
    /// Memory of a contact that has not begun.
    pub const NONE: History = History { spring: Vec3::new(0.0, 0.0, 0.0), rate: FRESH, turn: [0.0; 4] };

    /// Whether a contact goes on.
    #[inline(always)]
    pub fn is_fresh(&self) -> bool {
        self.rate == FRESH
    }

    /// The same contact seen from the other partner. A twist has the same sense from both sides.
    pub(crate) fn turned(&self) -> History {
        let [x, y, z, twist] = self.turn;
        History { spring: -self.spring, rate: self.rate, turn: [-x, -y, -z, twist] }
    }
}

/// What a law answers for one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Force on a [N]; b takes the opposite.
    pub force: Vec3,
    /// Its normal part, pressure positive [N]; adhesion taken off.
    pub normal: f64,
    /// Moment of rolling and twisting resistance on a [N m]; b takes the opposite.
    pub moment: Vec3,
    /// Energy that dashpots took in this step [J].
    pub dashpot: f64,
    /// Energy that sliding, rolling and twisting took in this step [J].
    pub friction: f64,
}

/// Contacts as a law sees them, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct LawInput<R> {
    /// Effective mass m₁m₂/(m₁ + m₂) of the bodies [kg].
    pub mass: R,
    /// Effective radius [m].
    pub radius: R,
    /// Overlap [m].
    pub overlap: R,
    /// Unit normal from b to a.
    pub normal: V3<R>,
    /// Velocity of a relative to b at the contact point, half a step ago [m/s].
    pub velocity: V3<R>,
    /// Spin of a less that of b, half a step ago [rad/s].
    pub spin: V3<R>,
}

/// [`History`] in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Memory<R> {
    /// Tangential spring [m].
    pub spring: V3<R>,
    /// Approach speed before, or [`FRESH`] [m/s].
    pub rate: R,
    /// Rolling spring [m].
    pub roll: V3<R>,
    /// Twisting spring [m].
    pub twist: R,
}

/// [`ContactForce`] in lanes.
#[derive(Clone, Copy, Debug)]
pub struct LawOutput<R> {
    /// Force on a [N].
    pub force: V3<R>,
    /// Normal force [N].
    pub normal: R,
    /// Moment on a [N m].
    pub moment: V3<R>,
    /// Energy taken by dashpots [J].
    pub dashpot: R,
    /// Energy taken by sliding, rolling and twisting [J].
    pub friction: R,
}

/// Constants of a law, field by field, in lanes: all alike, or of four laws.
macro_rules! law_lanes {
    ($law:ident { $($field:ident),+ $(,)? }) => {
        #[inline(always)]
        fn splat<R: Real>(&self) -> $law<R> {
            $law { $($field: R::splat(self.$field)),+ }
        }

        #[inline(always)]
        fn mixed<R: Real>(laws: [&$law; 8], join: fn(&[f64; 8]) -> R) -> $law<R> {
            $law { $($field: join(&laws.map(|l| l.$field))),+ }
        }
    };
}
pub(crate) use law_lanes;

/// A law of contact: constants of one pair of materials, and the force.
pub trait ContactLaw: Copy + Send + Sync {
    /// The constants in lanes.
    type Lanes<R: Real>: Copy;

    /// Mixes the constants of two materials.
    fn mix(a: &Material, b: &Material, exception: Option<&PairOverride>) -> Self;

    /// The same constants in every lane.
    fn splat<R: Real>(&self) -> Self::Lanes<R>;

    /// Constants of a law per lane (of as many as there are), put together by `join`.
    fn mixed<R: Real>(laws: [&Self; 8], join: fn(&[f64; 8]) -> R) -> Self::Lanes<R>;

    /// The forces of the contacts in the lanes `on`, over a step `dt` [s]. Advances their memory; what it does to the
    /// other lanes has no meaning. `ROLL`: with rolling and twisting resistance, and
    /// with adhesion.
    fn evaluate<R: Real, const ROLL: bool>(
        law: &Self::Lanes<R>,
        touch: &LawInput<R>,
        memory: &mut Memory<R>,
        on: R::Mask,
        dt: f64,
    ) -> LawOutput<R>;

    /// Energy stored in the normal spring, and in the tangential, rolling and twisting springs together [J].
    fn stored(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64);

    /// Force of the normal spring, adhesion taken off [N], and stiffness of the tangential spring [N/m].
    fn springs(&self, overlap: f64, radius: f64) -> (f64, f64);

    /// Energy that contacts which end leave in their tangential, rolling and twisting springs [J], given the effective
    /// radius [m] and the effective mass [kg].
    fn stored_in_springs<R: Real, const ROLL: bool>(law: &Self::Lanes<R>, memory: &Memory<R>) -> R;

    /// Largest normal stiffness [N/m] at an overlap [m], for the time step.
    fn stiffness(&self, overlap: f64, radius: f64) -> f64;

    /// Tangential over normal stiffness [-], both at one overlap.
    fn tangential_ratio(&self) -> f64;

    /// Damping ratio ζ of the contact [-].
    fn damping_ratio(&self) -> f64;

    /// Whether the contact resists rolling or twisting, or adheres.
    fn rolls(&self) -> bool;

    /// The force on one contact, given the effective mass m* = m₁m₂/(m₁ + m₂) of the bodies [kg], the velocity of a
    /// relative to b at the contact point and the spin of a less that of b, both half a step ago [m/s, rad/s], and
    /// the step [s]. Advances the contact's memory.
    #[inline(always)]
    fn evaluate_one(
        &self,
        mass: f64,
        geometry: &ContactGeometry,
        velocity: &Vec3,
        spin: &Vec3,
        history: &mut History,
        dt: f64,
    ) -> ContactForce {
        let touch = LawInput {
            mass,
            radius: geometry.radius,
            overlap: geometry.overlap,
            normal: V3::from_vec(&geometry.normal),
            velocity: V3::from_vec(velocity),
            spin: V3::from_vec(spin),
        };
        let [x, y, z, twist] = history.turn;
        let mut memory = Memory {
            spring: V3::from_vec(&history.spring),
            rate: history.rate,
            roll: V3::new(x, y, z),
            twist,
        };
        let law = self.splat::<f64>();
        let a = if self.rolls() {
            Self::evaluate::<f64, true>(&law, &touch, &mut memory, true, dt)
        } else {
            Self::evaluate::<f64, false>(&law, &touch, &mut memory, true, dt)
        };
        let Memory { spring, rate, roll, twist } = memory;
        *history = History { spring: spring.to_vec(), rate, turn: [roll.x, roll.y, roll.z, twist] };
        ContactForce {
            force: a.force.to_vec(),
            normal: a.normal,
            moment: a.moment.to_vec(),
            dashpot: a.dashpot,
            friction: a.friction,
        }
    }

    /// Ends a contact: forgets it, and returns the energy left in its tangential, rolling and twisting springs [J].
    #[inline(always)]
    fn release(&self, history: &mut History) -> f64 {
        let [x, y, z, twist] = history.turn;
        let memory = Memory {
            spring: V3::from_vec(&history.spring),
            rate: history.rate,
            roll: V3::new(x, y, z),
            twist,
        };
        *history = History::NONE;
        Self::stored_in_springs::<f64, true>(&self.splat(), &memory)
    }
}

/// The mixed constants of all pairs of materials.
#[derive(Clone, Debug)]
pub struct PairTable<L> {
    count: usize,
    pairs: Vec<L>,
}

impl<L: ContactLaw> PairTable<L> {
    /// Mixes every pair once. Of several exceptions for one pair the last holds.
    pub fn new(materials: &[Material], exceptions: &[PairOverride]) -> PairTable<L> {
        let mut pairs = Vec::with_capacity(materials.len() * materials.len());
        for (i, a) in materials.iter().enumerate() {
            for (j, b) in materials.iter().enumerate() {
                let exception = exceptions.iter().rfind(|e| (e.a, e.b) == (i, j) || (e.a, e.b) == (j, i));
                // In index order, so that (i, j) and (j, i) have the same bits.
                let (first, second) = if i <= j { (a, b) } else { (b, a) };
                pairs.push(L::mix(first, second, exception));
            }
        }
        PairTable { count: materials.len(), pairs }
    }

    /// Constants of materials `a` and `b`.
    #[inline(always)]
    pub fn get(&self, a: u32, b: u32) -> &L {
        &self.pairs[a as usize * self.count + b as usize]
    }

    /// Constants of a pair of materials per lane, given as numbers in lanes.
    #[inline(always)]
    pub(crate) fn lanes<R: Pack>(&self, a: R, b: R) -> L::Lanes<R> {
        let (a, b) = (a.numbers(), b.numbers());
        let mut laws = [&self.pairs[0]; 8];
        for l in 0..R::LANES {
            laws[l] = self.get(a[l] as u32, b[l] as u32);
        }
        L::mixed(laws, R::of)
    }

    /// Whether any pair resists rolling or twisting, or adheres.
    pub(crate) fn rolls(&self) -> bool {
        self.pairs.iter().any(L::rolls)
    }
}

/// 2xy/(x + y), also for infinite values.
pub(crate) fn harmonic(x: f64, y: f64) -> f64 {
    if x.is_infinite() {
        2.0 * y
    } else if y.is_infinite() {
        2.0 * x
    } else if x + y > 0.0 {
        2.0 * x * y / (x + y)
    } else {
        0.0
    }
}

/// The law of all contacts of a model.
#[derive(Clone, Debug)]
pub(crate) enum Laws {
    Linear(PairTable<linear::Linear>),
    Hertz(PairTable<hertz::Hertz>),
}

/// Runs an expression with the table of the law in use.
macro_rules! with_law {
    ($laws:expr, $table:ident => $body:expr) => {
        match $laws {
            $crate::law::Laws::Linear($table) => $body,
            $crate::law::Laws::Hertz($table) => $body,
        }
    };
}
pub(crate) use with_law;

impl Laws {
    /// Hertz's law where any material has a Young's modulus.
    pub fn new(materials: &[Material], exceptions: &[PairOverride]) -> Laws {
        if materials.iter().any(|m| m.young.is_some()) {
            Laws::Hertz(PairTable::new(materials, exceptions))
        } else {
            Laws::Linear(PairTable::new(materials, exceptions))
        }
    }

    pub fn stiffness(&self, a: u32, b: u32, overlap: f64, radius: f64) -> f64 {
        with_law!(self, t => t.get(a, b).stiffness(overlap, radius))
    }

    pub fn tangential_ratio(&self, a: u32, b: u32) -> f64 {
        with_law!(self, t => t.get(a, b).tangential_ratio())
    }

    pub fn damping_ratio(&self, a: u32, b: u32) -> f64 {
        with_law!(self, t => t.get(a, b).damping_ratio())
    }

    pub fn stored(&self, a: u32, b: u32, overlap: f64, radius: f64, history: &History) -> (f64, f64) {
        with_law!(self, t => t.get(a, b).stored(overlap, radius, history))
    }

    pub fn rolls(&self) -> bool {
        with_law!(self, t => t.rolls())
    }

    /// What the law is called.
    pub fn name(&self) -> &'static str {
        match self {
            Laws::Linear(_) => "linear spring-dashpot",
            Laws::Hertz(_) => "Hertz-Mindlin",
        }
    }

    /// Force of the normal spring over stiffness times overlap, at any overlap [-].
    pub fn force_share(&self) -> f64 {
        // Hertz's force grows with the power 3/2.
        if matches!(self, Laws::Hertz(_)) { 2.0 / 3.0 } else { 1.0 }
    }

    /// Whether any pair of one material of each list resists rolling or twisting, or adheres.
    pub fn rolls_among(&self, a: &[u32], b: &[u32]) -> bool {
        with_law!(self, t => a.iter().any(|&a| b.iter().any(|&b| t.get(a, b).rolls())))
    }
}
