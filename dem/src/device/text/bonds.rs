//! Bonds, and contacts of debonded pairs.

use super::record::{Part, keep, memory};
use crate::bond::{debonded as loose, kernel};
use crate::device::layout::EntryKind;
use crate::device::tape::{self, Recorded, Results, input, vector};
use crate::lanes::Real;
use crate::law::ContactLaw;

pub(super) fn part<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> Part {
    Part {
        frame: include_str!("bonds.c"),
        formulas: vec![
            ("BOND", bond()),
            ("DEBONDED_TOUCH", debonded_touch()),
            ("DEBONDED", debonded::<L, ROLLING>(law)),
        ],
        entries: &[(EntryKind::Bond, "bond"), (EntryKind::Debonded, "debonded_contact")],
    }
}

fn bond() -> String {
    tape::begin();
    let constants: [Recorded; kernel::COUNT] = std::array::from_fn(|c| input(format!("k[{c}]")));
    let motion = |side: &str| kernel::Motion {
        x: vector(&format!("x{side}")),
        v: vector(&format!("v{side}")),
        w: vector(&format!("w{side}")),
    };
    let (a, b) = (motion("a"), motion("b"));
    let mut memory = kernel::BondHistory { shear: vector("shear"), turn: vector("turn") };
    let frame = kernel::update_frame(constants[kernel::OFFSET], &a, &b, &mut memory, input("dt"));
    let r = kernel::respond(&constants, &a, &b, &frame, &memory);
    let holds = kernel::holds(&r);
    let mut out = Results::default();
    out.truth("holds", holds);
    out.vector("o->force", r.force.only(holds));
    out.vector("o->torque_a", r.torque_a.only(holds));
    out.vector("o->torque_b", r.torque_b.only(holds));
    out.number("o->dashpot", r.power.only(holds));
    out.vector("n[0]", memory.shear);
    out.vector("n[1]", memory.turn);
    out.text()
}

/// Spheres of a debonded pair.
fn parted() -> [loose::Sphere<Recorded>; 2] {
    ["a", "b"].map(|side| loose::Sphere {
        x: vector(&format!("x{side}")),
        radius: input(format!("x{side}.w")),
        v: vector(&format!("v{side}")),
        inverse_mass: input(format!("v{side}.w")),
        w: vector(&format!("w{side}")),
    })
}

fn debonded_touch() -> String {
    tape::begin();
    let [a, b] = parted();
    let beyond = loose::meet(&a, &b).overlap - input("reference");
    let mut out = Results::default();
    out.truth("on", !beyond.le(Recorded::zero()));
    out.text()
}

fn debonded<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, [a, b], reference) = (law(), memory(), parted(), input("reference"));
    let meeting = loose::meet(&a, &b);
    let on = tape::RecordedMask::Known(true);
    let f =
        loose::forces::<L, Recorded, ROLLING>(&law, (&a, &b), &meeting, reference, &mut m, on, input("step"));
    let mut out = Results::default();
    out.vector("o->force", f.force);
    out.vector("o->torque_a", f.torque_a);
    out.vector("o->torque_b", f.torque_b);
    let deep = meeting.overlap.gt(a.radius.min(b.radius));
    keep::<ROLLING>(&mut out, &m, f.dashpot, f.friction, deep);
    out.text()
}
