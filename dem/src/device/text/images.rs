//! Contacts across periodic borders.

use super::record::{Part, keep, memory};
use crate::contact::scalar::Moving;
use crate::device::layout::{EntryKind, Features};
use crate::device::tape::{self, Recorded, RecordedMask, Results, input, vector};
use crate::lanes::Real;
use crate::law::{ContactLaw, LawInput};
use crate::spatial::detect::Spheres;

pub(super) fn part<L: ContactLaw, const ROLLING: bool>(
    law: &impl Fn() -> L::Lanes<Recorded>,
    f: &Features,
) -> Part {
    Part {
        frame: include_str!("images.c"),
        formulas: vec![("IMAGES_TOUCH", touch()), ("IMAGES", forces::<L, ROLLING>(law, f.clumps))],
        entries: &[(EntryKind::Images, "image_contact")],
    }
}

/// First sphere, and image of the second.
fn spheres() -> Spheres<Recorded> {
    Spheres::new(vector("xa"), input("xa.w"), vector("xb") + vector("way"), input("xb.w"))
}

fn touch() -> String {
    tape::begin();
    let mut out = Results::default();
    out.truth("on", spheres().on());
    out.text()
}

fn forces<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>, clumps: bool) -> String {
    tape::begin();
    let (law, mut m, on) = (law(), memory(), RecordedMask::Known(true));
    let touch = spheres().touch();
    let body = |side: &str, point| Moving {
        velocity: vector(&format!("v{side}")),
        spin: vector(&format!("w{side}")),
        arm: point - vector(&format!("c{side}")),
        inverse_mass: input(format!("v{side}.w")),
    };
    let (a, b) = (body("a", touch.point), body("b", touch.point - vector("way")));
    let (velocity, spin) = a.against(&b);
    let law_input = LawInput {
        inverse_mass: a.inverse_mass + b.inverse_mass,
        radius: touch.radius,
        overlap: touch.overlap,
        normal: touch.normal,
        velocity,
        spin,
    };
    let f = L::acting::<Recorded, ROLLING>(&law, &law_input, &mut m, on, input("step"));
    let mut out = Results::default();
    out.vector("o->force", f.force);
    let (torque_a, torque_b) = if clumps || ROLLING {
        a.torques(&b, f.force, f.moment)
    } else {
        // Single spheres keep lever arms only.
        let moment = f.force.cross(touch.normal);
        (moment * -a.arm.dot(touch.normal), moment * b.arm.dot(touch.normal))
    };
    out.vector("o->torque_a", torque_a);
    out.vector("o->torque_b", torque_b);
    let deep = touch.overlap.gt(input("xa.w").min(input("xb.w")));
    keep::<ROLLING>(&mut out, &m, f.dashpot, f.friction, deep);
    out.vector("(*couple)", vector("way").cross(f.force) * input("step"));
    out.text()
}
