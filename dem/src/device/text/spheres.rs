//! Contacts of single spheres.

use super::record::{Part, keep, memory};
use crate::contact::sphere_pair;
use crate::device::layout::EntryKind;
use crate::device::tape::{self, Recorded, Results, input, vector};
use crate::lanes::{Real, V3};
use crate::law::{ContactLaw, HistoryLanes};

pub(super) fn part<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> Part {
    Part {
        frame: include_str!("spheres.c"),
        formulas: vec![("SPHERES_TOUCH", touch()), ("SPHERES", forces::<L, ROLLING>(law))],
        entries: &[(EntryKind::Spheres, "sphere_contact")],
    }
}

/// Single spheres `xa`, `va`, `wa` and `xb`, `vb`, `wb`.
pub(super) fn pair() -> sphere_pair::Pair<Recorded> {
    let between = vector("xa") - vector("xb");
    let radius = input("xa.w");
    sphere_pair::Pair {
        between,
        distance2: between.norm2(),
        reach: radius + input("xb.w"),
        radius,
        velocity: vector("va") - vector("vb"),
        inverse_mass: input("va.w") + input("vb.w"),
        spins: (vector("wa"), vector("wb")),
        offsets: (V3::zero(), V3::zero()),
    }
}

fn touch() -> String {
    tape::begin();
    let p = pair();
    let mut out = Results::default();
    out.truth("on", p.distance2.lt(p.reach * p.reach));
    out.text()
}

fn forces<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, on) = (law(), memory(), tape::RecordedMask::Known(true));
    let f = sphere_pair::forces::<L, Recorded, false, ROLLING>(&law, &pair(), &mut m, on, input("step"));
    results::<ROLLING>(&f, &m)
}

pub(super) fn results<const ROLLING: bool>(
    f: &sphere_pair::Forces<Recorded>,
    m: &HistoryLanes<Recorded>,
) -> String {
    let mut out = Results::default();
    out.vector("o->force", f.force);
    out.vector("o->torque_a", f.torque_a);
    out.vector("o->torque_b", f.torque_b);
    keep::<ROLLING>(&mut out, m, f.dashpot, f.friction, f.deep);
    out.text()
}
