//! Contacts of single spheres with planes.

use super::record::{Part, keep, memory};
use crate::contact::planes;
use crate::device::layout::EntryKind;
use crate::device::tape::{self, Recorded, Results, input, vector};
use crate::lanes::{Real, V3};
use crate::law::{ContactLaw, HistoryLanes};

pub(super) fn part<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> Part {
    Part {
        frame: include_str!("planes.c"),
        formulas: vec![("PLANE_TOUCHES", touches()), ("PLANE", forces::<L, ROLLING>(law))],
        entries: &[(EntryKind::Plane, "plane_contact")],
    }
}

/// Height of sphere centre `x` above plane `face`.
pub(super) fn height() -> Recorded {
    vector("x").dot(vector("face")) - input("face.w")
}

pub(super) fn touch() -> planes::PlaneContact<Recorded> {
    planes::PlaneContact {
        position: vector("x"),
        offset: V3::zero(),
        radius: input("x.w"),
        normal: vector("face"),
        height: height(),
        velocity: vector("v"),
        inverse_mass: input("v.w"),
        spin: vector("w"),
        wall: vector("motion"),
    }
}

fn touches() -> String {
    tape::begin();
    let mut out = Results::default();
    out.truth("on", height().lt(input("x.w")));
    out.text()
}

fn forces<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, on) = (law(), memory(), tape::RecordedMask::Known(true));
    let f = planes::forces::<L, Recorded, false, ROLLING>(&law, &touch(), &mut m, on, input("step"));
    results::<ROLLING>(&f, &m)
}

pub(super) fn results<const ROLLING: bool>(
    f: &planes::Forces<Recorded>,
    m: &HistoryLanes<Recorded>,
) -> String {
    let mut out = Results::default();
    out.vector("o->force", f.force);
    out.vector("o->torque_a", f.torque);
    keep::<ROLLING>(&mut out, m, f.dashpot, f.friction, f.deep);
    let [fx, fy, fz] = f.force.array();
    let [ax, ay, az] = f.about_origin.array();
    let zero = Recorded::zero();
    let names = [
        "wall[0].x",
        "wall[0].y",
        "wall[0].z",
        "wall[0].w",
        "wall[1].x",
        "wall[1].y",
        "wall[1].z",
        "wall[1].w",
    ];
    for (name, x) in names.into_iter().zip([f.power, fx, fy, fz, ax, ay, az, zero]) {
        out.number(name, x);
    }
    out.text()
}
