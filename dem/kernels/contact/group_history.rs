//! Contact history in lanes; law constants, dissipation.

use crate::lanes::vec4::Vec4;
use crate::lanes::{Real, Simd4, SimdPack, V3};
use crate::law::{ContactLaw, HistoryLanes, NO_CONTACT, PairTable};
use crate::pairs::groups::Springs;

/// Prefetch distance [groups], more than a page.
pub const FAR: usize = 32;

/// Groups for the lanes; a missing second one is the spare.
#[inline(always)]
pub fn side_by_side<'a, R: SimdPack, T>(list: &'a mut [T], spare: &'a mut T) -> (&'a mut T, &'a mut T) {
    let (first, rest) = list.split_at_mut(1);
    (&mut first[0], if R::GROUPS > 1 { &mut rest[0] } else { spare })
}

/// Law in lanes, uniform or mixed.
pub struct LawLanes<'a, L: ContactLaw, R: Real> {
    laws: &'a PairTable<L>,
    /// Set if one side has a single material.
    one: Option<L::Lanes<R>>,
}

impl<'a, L: ContactLaw, R: SimdPack> LawLanes<'a, L, R> {
    /// `a`, `b`: common material of each side, if any.
    #[inline(always)]
    pub fn new(laws: &'a PairTable<L>, a: Option<u32>, b: Option<u32>) -> LawLanes<'a, L, R> {
        LawLanes { laws, one: a.zip(b).map(|(a, b)| laws.get(a, b).splat()) }
    }

    #[inline(always)]
    pub fn of(&self, a: R, b: R) -> L::Lanes<R> {
        match self.one {
            Some(law) => law,
            None => self.laws.lanes(a, b),
        }
    }
}

/// Dissipation by lane.
pub struct Dissipation<Q> {
    pub dashpot: Q,
    pub friction: Q,
}

impl<Q: Simd4> Dissipation<Q> {
    #[inline(always)]
    pub fn new() -> Dissipation<Q> {
        Dissipation { dashpot: Q::zero(), friction: Q::zero() }
    }
}

#[inline(always)]
pub fn load_history<R: SimdPack, const ROLLING: bool>(
    springs: &(&mut Springs, &mut Springs),
    turns: &(&mut [Vec4; 4], &mut [Vec4; 4]),
) -> HistoryLanes<R> {
    let (p, q) = springs;
    let [x, y, z] = [0, 1, 2].map(|d| (&p.spring[d], &q.spring[d]));
    let spring = V3::new(R::join(x.0, x.1), R::join(y.0, y.1), R::join(z.0, z.1));
    let rate = R::join(&p.rate, &q.rate);
    if ROLLING {
        let [x, y, z, t] = [0, 1, 2, 3].map(|d| (&turns.0[d], &turns.1[d]));
        let roll = V3::new(R::join(x.0, x.1), R::join(y.0, y.1), R::join(z.0, z.1));
        HistoryLanes { spring, rate, roll, twist: R::join(t.0, t.1) }
    } else {
        HistoryLanes { spring, rate, roll: V3::zero(), twist: R::zero() }
    }
}

/// Writes history in lanes `on`, resets the others.
#[inline(always)]
pub fn store_history<R: SimdPack, const ROLLING: bool>(
    springs: &mut (&mut Springs, &mut Springs),
    turns: &mut (&mut [Vec4; 4], &mut [Vec4; 4]),
    memory: &HistoryLanes<R>,
    on: R::Mask,
) {
    let (p, q) = springs;
    let spring = memory.spring.only(on);
    spring.x.split(&mut p.spring[0], &mut q.spring[0]);
    spring.y.split(&mut p.spring[1], &mut q.spring[1]);
    spring.z.split(&mut p.spring[2], &mut q.spring[2]);
    R::select(on, memory.rate, R::splat(NO_CONTACT)).split(&mut p.rate, &mut q.rate);
    if ROLLING {
        let (p, q) = turns;
        let roll = memory.roll.only(on);
        roll.x.split(&mut p[0], &mut q[0]);
        roll.y.split(&mut p[1], &mut q[1]);
        roll.z.split(&mut p[2], &mut q[2]);
        memory.twist.only(on).split(&mut p[3], &mut q[3]);
    }
}

#[inline(always)]
pub fn four<R: Real>(v: V3<R>, last: R) -> [R; 4] {
    [v.x, v.y, v.z, last]
}

#[inline(always)]
pub fn records<R: SimdPack>(force: V3<R>, torque: V3<R>) -> [R::Vec4Pair; 8] {
    R::records(four(force, R::zero()), four(torque, R::zero()))
}
