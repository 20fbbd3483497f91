//! Wall triangle contacts, selected as in `contact/surface_contacts.rs`.

use super::record::{Part, keep, memory};
use crate::contact::patch_forces::{self, PatchContactInput};
use crate::contact::surface_contacts::{self, Gap};
use crate::device::layout::EntryKind;
use crate::device::tape::{self, Recorded, RecordedMask, Results, input, truth, vector};
use crate::lanes::quaternion::QuaternionLanes;
use crate::lanes::{Real, V3};
use crate::law::ContactLaw;
use crate::shape::triangle;
use crate::wall::state::WallPose;
use crate::wall::triangulated::{self as triangles, Level};

pub(super) fn part<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> Part {
    Part {
        frame: include_str!("patches.c"),
        formulas: vec![
            ("TO_LOCAL", to_local()),
            ("CLEARANCE", clearance()),
            ("FOOT", foot()),
            ("REGION", region()),
            ("ON_EDGE", on_edge()),
            ("TO_WORLD", to_world()),
            ("MEETS", meets()),
            ("RESTS", rests()),
            ("ONE_POINT", one_point()),
            ("WITHIN", within()),
            ("ALIKE", alike()),
            ("MAY_FOLLOW", may_follow()),
            ("SIDE", side()),
            ("PATCH_FORCE", force::<L, ROLLING>(law)),
        ],
        entries: &[(EntryKind::Walls, "wall_contacts")],
    }
}

fn three(array: &str, from: usize) -> V3<Recorded> {
    let at = |k: usize| input(format!("{array}[{}]", from + k));
    V3::new(at(0), at(1), at(2))
}

/// Wall pose, in the layout of `device/walls.rs`.
fn place() -> WallPose<Recorded> {
    WallPose {
        centre: three("u", 0),
        offset: three("u", 3),
        orientation: QuaternionLanes { v: three("u", 6), s: input("u[9]") },
        velocity: three("u", 10),
        spin: three("u", 13),
        turned: truth("(u[16] != 0.0)"),
    }
}

/// Planes of the triangle and of its edges.
fn planes() -> (Level<Recorded>, [Level<Recorded>; 3]) {
    let level = |from: usize| [0, 1, 2, 3].map(|k| input(format!("f[{}]", from + k)));
    (level(0), [level(4), level(8), level(12)])
}

fn to_local() -> String {
    tape::begin();
    let mut out = Results::default();
    out.vector("y", place().to_local(vector("x")));
    out.text()
}

fn clearance() -> String {
    tape::begin();
    let (plane, rims) = planes();
    let mut out = Results::default();
    out.number("clear", triangles::clearance(&plane, &rims, vector("y")));
    out.text()
}

fn foot() -> String {
    tape::begin();
    let (plane, rims) = planes();
    let y = vector("y");
    let mut out = Results::default();
    out.truth("inside", triangles::inside(&rims, y));
    out.vector("(*on)", triangles::foot(&plane, y));
    out.text()
}

fn region() -> String {
    tape::begin();
    let corner = |k: usize| three("f", 16 + 3 * k);
    let mut out = Results::default();
    out.number("code", triangle::region(corner(0), corner(1), corner(2), vector("y")));
    out.text()
}

fn on_edge() -> String {
    tape::begin();
    let mut out = Results::default();
    out.vector("on", triangles::on_edge(three("a", 0), three("b", 0), vector("y")));
    out.text()
}

fn to_world() -> String {
    tape::begin();
    let place = place();
    let point = place.to_world(vector("on"));
    let mut out = Results::default();
    out.vector("(*point)", point);
    out.vector("(*outward)", place.turn(three("f", 0)));
    out.vector("(*velocity)", place.velocity_at(point));
    out.text()
}

fn meets() -> String {
    tape::begin();
    let (radius, outward, straight) = (input("x.w"), vector("outward"), truth("straight"));
    let gap = Gap::new(vector("x") - vector("point"), outward, straight);
    let (normal, overlap) = gap.contact(outward, radius, straight, RecordedMask::Known(false));
    let mut out = Results::default();
    out.truth("near", gap.distance.lt(radius));
    out.vector("(*normal)", normal);
    out.number("*overlap", overlap);
    out.text()
}

fn rests() -> String {
    tape::begin();
    let rest = surface_contacts::rest(vector("x") - vector("point"), vector("outward"), input("x.w"));
    let mut out = Results::default();
    out.truth("stays", rest.stays);
    out.vector("(*normal)", rest.normal);
    out.number("*overlap", rest.overlap);
    out.number("*side", rest.side);
    out.text()
}

fn one_point() -> String {
    tape::begin();
    let mut out = Results::default();
    out.truth("same", surface_contacts::one_point(vector("a"), vector("b"), input("radius")));
    out.text()
}

fn within() -> String {
    tape::begin();
    let mut out = Results::default();
    out.truth("near", input("clear").le(surface_contacts::tolerance(input("radius"))));
    out.text()
}

fn alike() -> String {
    tape::begin();
    let mut out = Results::default();
    out.truth("same", surface_contacts::alike(vector("a"), vector("b")));
    out.text()
}

fn may_follow() -> String {
    tape::begin();
    let from = (vector("old_normal"), vector("old_point"));
    let (may, away) =
        surface_contacts::may_follow((vector("normal"), vector("point")), from, input("radius"));
    let mut out = Results::default();
    out.truth("may", may);
    out.number("*away", away);
    out.text()
}

fn side() -> String {
    tape::begin();
    let (normal, outward) = (vector("t.normal"), vector("t.outward"));
    let side = normal.dot(outward);
    let passed =
        surface_contacts::passed(normal, side, (vector("old_normal"), input("old_side"))) & !truth("fresh");
    let (radius, overlap) = (input("radius"), input("t.point.w"));
    let mut out = Results::default();
    out.number("side", side);
    out.truth("*deep", passed | overlap.gt(radius));
    out.text()
}

fn force<L: ContactLaw, const ROLLING: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, point) = (law(), memory(), vector("point"));
    let touch = PatchContactInput {
        arm: point - vector("x"),
        overlap: input("point.w"),
        radius: input("radius"),
        normal: vector("normal"),
        body: (vector("v"), vector("w")),
        wall: (vector("velocity"), three("u", 13)),
        inverse_mass: input("v.w") + input("u[18]"),
    };
    let on = RecordedMask::Known(true);
    let f = patch_forces::acting::<L, Recorded, ROLLING>(&law, &touch, &mut m, on, input("step"));
    let mut out = Results::default();
    out.vector("o->force", f.force);
    out.vector("o->torque_a", f.torque);
    keep::<ROLLING>(&mut out, &m, f.dashpot, f.friction, RecordedMask::Known(false));
    let centre = three("u", 0) + three("u", 3);
    let mut moment = (point - centre).cross(f.force);
    if ROLLING {
        moment = moment + f.moment;
    }
    out.vector("(*moment)", moment);
    out.text()
}
