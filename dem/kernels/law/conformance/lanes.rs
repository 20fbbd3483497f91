//! SIMD lanes and single contacts: bitwise identical.

use super::own;
use super::{MASS, Path, law, plain};
use crate::base::Vec3;
use crate::lanes::{Kernel, Simd, SimdPack, V3, run};
use crate::law::material::LawName;
use crate::law::material::{Material, Pair, PairOverride};
use crate::law::table::{AnyLaw, COMBINATIONS, tangential_named};
use crate::law::{ContactGeometry, ContactLaw, History, HistoryLanes, LawInput, NO_CONTACT};

#[derive(Clone, Copy)]
struct Case<L> {
    law: L,
    geometry: ContactGeometry,
    velocity: Vec3,
    spin: Vec3,
    history: History,
    dt: f64,
}

/// Evaluates in lanes: lane count; force, moment, energies, history.
struct InLanes<'a, L, const ROLLING: bool>(&'a [Case<L>; 8]);

impl<L: ContactLaw, const ROLLING: bool> Kernel for InLanes<'_, L, ROLLING> {
    type Output = (usize, Vec<[u64; 8]>);

    #[inline(always)]
    fn run<R: SimdPack>(self) -> (usize, Vec<[u64; 8]>) {
        let cases = self.0;
        let of = |pick: fn(&Case<L>) -> f64| R::of(&cases.each_ref().map(pick));
        let vector = |pick: fn(&Case<L>) -> Vec3| {
            let v = cases.each_ref().map(pick);
            V3::new(R::of(&v.map(|v| v.x)), R::of(&v.map(|v| v.y)), R::of(&v.map(|v| v.z)))
        };
        let law = L::mixed(cases.each_ref().map(|c| &c.law), R::of);
        let touch = LawInput {
            inverse_mass: R::splat(1.0 / MASS),
            radius: of(|c| c.geometry.radius),
            overlap: of(|c| c.geometry.overlap),
            normal: vector(|c| c.geometry.normal),
            velocity: vector(|c| c.velocity),
            spin: vector(|c| c.spin),
        };
        let mut memory = HistoryLanes {
            spring: vector(|c| c.history.spring),
            rate: of(|c| c.history.rate),
            roll: vector(|c| Vec3::new(c.history.turn[0], c.history.turn[1], c.history.turn[2])),
            twist: of(|c| c.history.turn[3]),
        };
        let f = L::evaluate::<R, ROLLING>(&law, &touch, &mut memory, R::below(8), R::splat(cases[0].dt));
        let left = L::tangential_energy::<R, ROLLING>(&law, &memory);
        let numbers = [
            [f.force.x, f.force.y, f.force.z, f.normal, f.moment.x, f.moment.y, f.moment.z, f.dashpot],
            [
                f.friction,
                memory.spring.x,
                memory.spring.y,
                memory.spring.z,
                memory.rate,
                memory.twist,
                left,
                left,
            ],
        ];
        (R::LANES, numbers.as_flattened().iter().map(|n| bits(&n.numbers(), R::LANES)).collect())
    }
}

fn bits(numbers: &[f64; 8], lanes: usize) -> [u64; 8] {
    std::array::from_fn(|l| if l < lanes { (numbers[l] + 0.0).to_bits() } else { 0 })
}

fn alone<L: ContactLaw>(cases: &[Case<L>; 8], lanes: usize) -> Vec<[u64; 8]> {
    let each = cases.each_ref().map(|c| {
        let mut h = c.history;
        let f = c.law.evaluate_one(1.0 / MASS, &c.geometry, &c.velocity, &c.spin, &mut h, c.dt);
        let left = c.law.release(&mut h.clone());
        let ([x, y, z], [a, b, d]) = (f.force.into(), f.moment.into());
        let [s, t, u] = h.spring.into();
        [x, y, z, f.normal, a, b, d, f.dashpot, f.friction, s, t, u, h.rate, h.turn[3], left, left]
    });
    (0..16).map(|k| bits(&each.map(|numbers: [f64; 16]| numbers[k]), lanes)).collect()
}

fn cases<L: ContactLaw>(laws: impl Fn(usize) -> L, seed: usize) -> [Case<L>; 8] {
    std::array::from_fn(|l| {
        let law = laws(l);
        let path = Path { steps: 400, step_size: 5.0 + 30.0 * ((l + seed) % 3) as f64, ..Path::USUAL };
        let dt = 1e-5;
        let mut history = History::NONE;
        let stop = (37 * (l + 1) + 11 * seed) % 399;
        let mut moments = path.moments();
        for m in moments.by_ref().take(stop) {
            m.evaluate(&law, &mut history, dt);
        }
        if (l + seed).is_multiple_of(5) {
            history = History { rate: NO_CONTACT, ..History::NONE };
        }
        let m = moments.next().unwrap_or_else(|| path.moments().next().unwrap());
        Case { law, geometry: m.geometry, velocity: m.velocity, spin: m.spin, history, dt }
    })
}

fn compare<L: ContactLaw, const ROLLING: bool>(laws: impl Fn(usize) -> L) {
    for seed in 0..40 {
        let cases = cases(&laws, seed);
        for simd in Simd::all() {
            let (lanes, found) = run(simd, InLanes::<L, ROLLING>(&cases));
            assert_eq!(found, alone(&cases, lanes), "{simd:?}, seed {seed}");
        }
    }
}

pub fn lanes_match_scalar_contacts_bitwise<L: ContactLaw>(material: &Material) {
    compare::<L, true>(|_| law(material));
    compare::<L, false>(|_| plain(material, 0.5));
}

#[test]
fn mixed_laws_are_bitwise_identical() {
    let material = Material { stiffness: super::SOFT.stiffness, ..super::GLASS };
    let mixed = |l: usize| -> AnyLaw {
        let row = &COMBINATIONS[l % COMBINATIONS.len()];
        let exception = PairOverride {
            normal: Some(LawName(row.normal)),
            formula: own::of_row(row.normal),
            tangential: tangential_named(row.tangential),
            ..PairOverride::default()
        };
        AnyLaw::mix(&Pair { a: &material, b: &material, exception: Some(&exception) })
    };
    compare::<AnyLaw, false>(mixed);
    for (l, row) in COMBINATIONS.iter().enumerate() {
        assert_eq!(mixed(l).names(), [row.normal, row.tangential]);
    }
}
