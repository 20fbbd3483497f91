//! Clumps: member contacts and rotation.

use super::motion::{alone as single, moved, power, pushed, single_held};
use super::record::{Part, memory};
use super::{planes as plane, spheres};
use crate::contact::{planes, sphere_pair};
use crate::device::layout::{EntryKind, Features};
use crate::device::tape::{self, Recorded, RecordedMask, Results, input, vector};
use crate::integrate::kick;
use crate::integrate::rigid_rotation::{self, Rigid, RotatedBody};
use crate::integrate::rotation::{self, Midpoint};
use crate::lanes::quaternion::{QuaternionLanes, placed};
use crate::lanes::{Real, V3};
use crate::law::ContactLaw;

pub(super) fn contacts<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> Part {
    Part {
        frame: include_str!("clump_contacts.c"),
        formulas: vec![
            ("MEMBERS", members::<L, ROLLING>(law)),
            ("MEMBER_PLANE", member_plane::<L, ROLLING>(law)),
        ],
        entries: &[(EntryKind::Members, "member_contact"), (EntryKind::MemberPlane, "member_plane_contact")],
    }
}

pub(super) fn motion(f: &Features) -> Part {
    let (midpoint, iterate) = half_turn();
    let [kick, after] = if f.damped { rotate_in_group::<true>() } else { rotate_in_group::<false>() };
    Part {
        frame: include_str!("clumps.c"),
        formulas: vec![
            ("MIDPOINT", midpoint),
            ("ITERATE", iterate),
            ("AMONG_KICK", kick),
            ("AMONG", after),
            ("ALONE_KICK", alone_kick()),
            ("ALONE", alone(f.held)),
            ("ALONE_HELD", alone_held(f.held)),
            ("PLACE", place()),
        ],
        entries: &[],
    }
}

fn members<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, on) = (law(), memory(), RecordedMask::Known(true));
    let offsets = (vector("xa") - vector("ca"), vector("xb") - vector("cb"));
    let pair = sphere_pair::Pair { offsets, ..spheres::pair() };
    let f = sphere_pair::forces::<L, Recorded, true, ROLLING>(&law, &pair, &mut m, on, input("step"));
    spheres::results::<ROLLING>(&f, &m)
}

fn member_plane<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, on) = (law(), memory(), RecordedMask::Known(true));
    let touch = planes::PlaneContact { offset: vector("x") - vector("centre"), ..plane::touch() };
    let f = planes::forces::<L, Recorded, true, ROLLING>(&law, &touch, &mut m, on, input("step"));
    plane::results::<ROLLING>(&f, &m)
}

fn orientation(name: &str) -> QuaternionLanes<Recorded> {
    QuaternionLanes { v: vector(name), s: input(format!("{name}.w")) }
}

fn put(out: &mut Results, orientation: QuaternionLanes<Recorded>) {
    out.vector("(*nq)", orientation.v);
    out.number("(*nq).w", orientation.s);
}

/// Body before the kick.
fn rigid() -> Rigid<Recorded> {
    Rigid {
        orientation: orientation("q"),
        momentum: vector("l"),
        spin: vector("w"),
        inertia: vector("moments"),
    }
}

/// Initial value and one iteration of the rotation.
fn half_turn() -> (String, String) {
    tape::begin();
    let m = Midpoint::new(orientation("q"), vector("l"), vector("moments"), input("dt"));
    let mut begin = Results::default();
    begin.vector("start", m.start);
    begin.vector("half", m.half);
    begin.vector("c", m.guess());
    let begin = begin.text();
    tape::begin();
    let (next, more) = Midpoint { start: vector("start"), half: vector("half") }.iterate(vector("c"));
    let mut one = Results::default();
    one.vector("next", next);
    one.truth("more", more);
    (begin, one.text())
}

fn new() -> QuaternionLanes<Recorded> {
    rotation::turned(orientation("q"), vector("c"))
}

fn rotate_in_group<const DAMPED: bool>() -> [String; 2] {
    let torques = || {
        let (torque, spin, damping) = (vector("s.torque"), vector("w"), input("damping"));
        let stop = |torque, spin| kick::resist(torque, spin, damping);
        let stop = V3::new(stop(torque.x, spin.x), stop(torque.y, spin.y), stop(torque.z, spin.z));
        if DAMPED { (torque + stop, stop) } else { (torque, V3::zero()) }
    };
    tape::begin();
    let mut begin = Results::default();
    begin.vector("(*nl)", rigid_rotation::kicked(&rigid(), torques().0, input("kick")));
    let begin = begin.text();
    tape::begin();
    let (body, (torque, stop)) = (rigid(), torques());
    let sphere = !Recorded::zero().lt(input("moments.w"));
    let impulse = torque * input("kick");
    let turned = rigid_rotation::rotate_in_group::<Recorded, DAMPED>(
        &body,
        sphere,
        (impulse, stop),
        vector("(*nl)"),
        new(),
    );
    let (velocity, held) = pushed::<DAMPED>();
    let mut out = Results::default();
    out.vector("(*nv)", velocity);
    out.vector("(*nx)", moved(velocity));
    out.vector("(*nw)", turned.spin);
    put(&mut out, turned.orientation);
    out.number("*speed2", rigid_rotation::fastest2(velocity.norm2(), turned.spin, input("moments.w")));
    if DAMPED {
        let of_turn = V3::new(turned.power, Recorded::zero(), Recorded::zero());
        let power = power(held, vector("v"), velocity);
        out.row("held", &[power, of_turn, held, stop, vector("x").cross(held)]);
    }
    [begin, out.text()]
}

fn alone_kick() -> String {
    tape::begin();
    let k = kick::kick_single(&single(), input("kick"));
    let mut out = Results::default();
    out.vector("(*nl)", rigid_rotation::kicked(&rigid(), k.torque, input("kick")));
    out.text()
}

fn alone_results(
    k: &kick::Kicked<Recorded>,
    turned: &RotatedBody<Recorded>,
    fixed: Option<(V3<Recorded>, Recorded)>,
    held: bool,
) -> String {
    let mut out = Results::default();
    out.vector("(*nv)", k.velocity);
    out.vector("(*nx)", moved(k.velocity));
    out.vector("(*nw)", turned.spin);
    out.vector("(*nl)", turned.momentum);
    put(&mut out, turned.orientation);
    out.number("*speed2", rigid_rotation::fastest2(k.velocity.norm2(), turned.spin, input("moments.w")));
    if held {
        let (impulse, work) = fixed.unwrap_or((V3::zero(), Recorded::zero()));
        single_held(&mut out, &single(), k, (turned.mean, impulse, work));
    }
    out.text()
}

fn alone(held: bool) -> String {
    tape::begin();
    let k = kick::kick_single(&single(), input("kick"));
    let turned = rigid_rotation::rotate_single(&rigid(), vector("(*nl)"), new());
    alone_results(&k, &turned, None, held)
}

fn alone_held(held: bool) -> String {
    tape::begin();
    let k = kick::kick_single(&single(), input("kick"));
    let (turned, impulse, work) =
        rigid_rotation::rotate_prescribed(&rigid(), k.torque, vector("target"), input("kick"), input("dt"));
    alone_results(&k, &turned, Some((impulse, work)), held)
}

fn place() -> String {
    tape::begin();
    let mut out = Results::default();
    out.vector("sphere", placed(orientation("q").columns(), vector("x"), vector("local")));
    out.text()
}
