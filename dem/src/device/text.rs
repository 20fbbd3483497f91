//! The text of the kernels of a model: a frame of C (`frame.c`) around the engine's own formulas, recorded.

use super::layout::{self, Features};
use super::tape::{self, Recorded, Results, input, next, truth, vector};
use crate::bond::{debonded as loose, kernel};
use crate::contact::{planes, sphere_pair};
use crate::engine::model::Model;
use crate::integrate::kick::{self, Push, Single};
use crate::lanes::{Real, V3};
use crate::law::{ContactLaw, FRESH, Laws, Memory, PairTable, with_law};

/// The frame; lines that begin with `//@` are to be replaced.
const FRAME: &str = include_str!("frame.c");

/// What the text for a model is for.
pub(super) fn features(model: &Model) -> Features {
    let damped = model.damping != 0.0;
    let fixed = (0..model.body_count()).any(|k| model.body(k).fixed != 0);
    let law_width = with_law!(&model.laws, table => constants(table, 1).len());
    let bonds = !model.bonds.is_empty();
    Features { law_width, roll: model.laws.rolls(), damped, held: damped || fixed, bonds }
}

/// The text for the laws of a model.
pub(super) fn text(laws: &Laws, features: &Features) -> String {
    let Features { roll, damped, held, .. } = *features;
    let parts =
        with_law!(laws, table => if roll { contacts::<_, true>(table) } else { contacts::<_, false>(table) });
    let moves = [("FREE", if damped { free::<true>() } else { free::<false>() }), ("SINGLE", single(held))];
    let mut out = FRAME.to_string();
    let layout = layout::declarations(features, &tape::literal(FRESH));
    for (name, part) in parts.iter().chain(&moves).chain([&("LAYOUT", layout)]) {
        out = out.replace(&format!("//@{name}\n"), part);
    }
    out
}

/// Constants of the law of each pair of `materials`, in the order in which the text fetches them.
pub(super) fn constants<L: ContactLaw>(table: &PairTable<L>, materials: u32) -> Vec<f64> {
    let mut out = Vec::new();
    for a in 0..materials {
        for b in 0..materials {
            tape::begin();
            _ = L::mixed::<Recorded>([table.get(a, b); 8], tape::value);
            out.extend(tape::values());
        }
    }
    out
}

/// As [`constants`], of whatever laws a model has.
pub(super) fn law_constants(laws: &Laws, materials: u32) -> Vec<f64> {
    with_law!(laws, table => constants(table, materials))
}

fn memory() -> Memory<Recorded> {
    Memory { spring: vector("m"), rate: input("m.w"), roll: vector("r"), twist: input("r.w") }
}

/// The parts of the text that stand for contacts.
fn contacts<L: ContactLaw, const ROLL: bool>(table: &PairTable<L>) -> Vec<(&'static str, String)> {
    let law = || L::mixed::<Recorded>([table.get(0, 0); 8], next);
    vec![
        ("SPHERES_TOUCH", spheres_touch()),
        ("SPHERES", spheres::<L, ROLL>(&law)),
        ("LEFT", left::<L, ROLL>(&law)),
        ("PLANE_TOUCHES", plane_touches()),
        ("PLANE", plane::<L, ROLL>(&law)),
        ("BOND", bond()),
        ("DEBONDED_TOUCH", debonded_touch()),
        ("DEBONDED", debonded::<L, ROLL>(&law)),
    ]
}

/// Two single spheres with the names `xa`, `va`, `wa` and `xb`, `vb`, `wb`.
fn pair() -> sphere_pair::Pair<Recorded> {
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

fn spheres_touch() -> String {
    tape::begin();
    let p = pair();
    let mut out = Results::default();
    out.truth("on", p.distance2.lt(p.reach * p.reach));
    out.text()
}

/// Results that contacts of all kinds have.
fn keep<const ROLL: bool>(
    out: &mut Results,
    m: &Memory<Recorded>,
    dashpot: Recorded,
    friction: Recorded,
    deep: tape::Truth,
) {
    out.vector("o->memory", m.spring);
    out.number("o->memory.w", m.rate);
    if ROLL {
        out.vector("o->turn", m.roll);
        out.number("o->turn.w", m.twist);
    }
    out.number("o->dashpot", dashpot);
    out.number("o->friction", friction);
    out.truth("o->deep", deep);
}

fn spheres<L: ContactLaw, const ROLL: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, on) = (law(), memory(), tape::Truth::Known(true));
    let f = sphere_pair::forces::<L, Recorded, false, ROLL>(&law, &pair(), &mut m, on, input("step"));
    let mut out = Results::default();
    out.vector("o->force", f.force);
    out.vector("o->torque_a", f.torque_a);
    out.vector("o->torque_b", f.torque_b);
    keep::<ROLL>(&mut out, &m, f.dashpot, f.friction, f.deep);
    out.text()
}

fn left<L: ContactLaw, const ROLL: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let law = law();
    let mut out = Results::default();
    out.number("left", L::stored_in_springs::<Recorded, ROLL>(&law, &memory()));
    out.text()
}

/// How far the centre of a sphere `x` is above a plane `face`.
fn height() -> Recorded {
    vector("x").dot(vector("face")) - input("face.w")
}

fn plane_touches() -> String {
    tape::begin();
    let mut out = Results::default();
    out.truth("on", height().lt(input("x.w")));
    out.text()
}

fn plane<L: ContactLaw, const ROLL: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, on) = (law(), memory(), tape::Truth::Known(true));
    let touch = planes::Touch {
        position: vector("x"),
        offset: V3::zero(),
        radius: input("x.w"),
        normal: vector("face"),
        height: height(),
        velocity: vector("v"),
        inverse_mass: input("v.w"),
        spin: vector("w"),
        wall: vector("motion"),
    };
    let f = planes::forces::<L, Recorded, false, ROLL>(&law, &touch, &mut m, on, input("step"));
    let mut out = Results::default();
    out.vector("o->force", f.force);
    out.vector("o->torque_a", f.torque);
    keep::<ROLL>(&mut out, &m, f.dashpot, f.friction, f.deep);
    // Power and force, then the moment about the origin: in the order in which they are booked.
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

fn bond() -> String {
    tape::begin();
    let constants: [Recorded; kernel::COUNT] = std::array::from_fn(|c| input(format!("k[{c}]")));
    let motion = |side: &str| kernel::Motion {
        x: vector(&format!("x{side}")),
        v: vector(&format!("v{side}")),
        w: vector(&format!("w{side}")),
    };
    let (a, b) = (motion("a"), motion("b"));
    let mut memory = kernel::Memory { shear: vector("shear"), turn: vector("turn") };
    let frame = kernel::carry(constants[kernel::OFFSET], &a, &b, &mut memory, input("dt"));
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

/// The two spheres of a debonded pair.
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

fn debonded<L: ContactLaw, const ROLL: bool>(law: &impl Fn() -> L::Lanes<Recorded>) -> String {
    tape::begin();
    let (law, mut m, [a, b], reference) = (law(), memory(), parted(), input("reference"));
    let meeting = loose::meet(&a, &b);
    let on = tape::Truth::Known(true);
    let f =
        loose::forces::<L, Recorded, ROLL>(&law, (&a, &b), &meeting, reference, &mut m, on, input("step"));
    let mut out = Results::default();
    out.vector("o->force", f.force);
    out.vector("o->torque_a", f.torque_a);
    out.vector("o->torque_b", f.torque_b);
    let deep = meeting.overlap.gt(a.radius.min(b.radius));
    keep::<ROLL>(&mut out, &m, f.dashpot, f.friction, deep);
    out.text()
}

/// Where a velocity takes a body.
fn moved(velocity: V3<Recorded>) -> V3<Recorded> {
    vector("x") + velocity * input("dt")
}

fn free<const DAMPED: bool>() -> String {
    tape::begin();
    let (old, turn, force, torque, gravity) =
        (vector("v"), vector("w"), vector("s.force"), vector("s.torque"), vector("g"));
    let (inverse_mass, step, damping) = (input("v.w"), input("kick"), input("damping"));
    let kicked = |v: Recorded, force: Recorded, gravity: Recorded| {
        kick::kick_free::<Recorded, DAMPED>(v, &Push { force, gravity, inverse_mass, step, damping })
    };
    let [x, y, z] = [
        kicked(old.x, force.x, gravity.x),
        kicked(old.y, force.y, gravity.y),
        kicked(old.z, force.z, gravity.z),
    ];
    let velocity = V3::new(x.0, y.0, z.0);
    let share = kick::turn_of_sphere(step, inverse_mass, input("x.w"));
    let turned = |w: Recorded, t: Recorded| {
        let stop = if DAMPED { kick::resist(t, w, damping) } else { Recorded::zero() };
        (w + if DAMPED { t + stop } else { t } * share, stop)
    };
    let [a, b, c] = [turned(turn.x, torque.x), turned(turn.y, torque.y), turned(turn.z, torque.z)];
    let spin = V3::new(a.0, b.0, c.0);
    let mut out = Results::default();
    out.vector("(*nv)", velocity);
    out.vector("(*nx)", moved(velocity));
    out.vector("(*nw)", spin);
    out.number("*speed2", velocity.norm2());
    if DAMPED {
        let half = input("0.5");
        let (held, stop) = (V3::new(x.1, y.1, z.1), V3::new(a.1, b.1, c.1));
        let each = |p: V3<Recorded>, q: V3<Recorded>| V3::new(p.x * q.x, p.y * q.y, p.z * q.z);
        let power = each(held, (old + velocity) * half);
        let turning = each(stop, (turn + spin) * half);
        out.row("held", &[power, turning, held, stop, vector("x").cross(held)]);
    }
    out.text()
}

fn single(held: bool) -> String {
    tape::begin();
    let bit = |d: usize| truth(&format!("(int)(fixed >> {d} & 1u)"));
    let none = V3::zero();
    let s = Single {
        velocity: vector("v"),
        spin: vector("w"),
        force: (vector("s.force"), none),
        torque: (vector("s.torque"), none),
        gravity: vector("g"),
        mass: input("constants.x"),
        inertia: input("constants.y"),
        fixed: [[bit(0), bit(1), bit(2)], [bit(3), bit(4), bit(5)]],
        damping: input("damping"),
    };
    let k = kick::kick_single(&s, input("kick"));
    let speed = k.velocity.norm2().sqrt();
    let mut out = Results::default();
    out.vector("(*nv)", k.velocity);
    out.vector("(*nx)", moved(k.velocity));
    out.vector("(*nw)", k.spin);
    out.number("*speed2", speed * speed);
    if held {
        single_held(&mut out, &s, &k);
    }
    out.text()
}

/// What fixed motions and local damping of a single body are booked with, in the order of `general` (`integrate/leapfrog.rs`).
fn single_held(out: &mut Results, s: &Single<Recorded>, k: &kick::Kicked<Recorded>) {
    let (x, kick, half) = (vector("x"), input("kick"), input("0.5"));
    let (mean, mean_spin) = ((s.velocity + k.velocity) * half, (s.spin + k.spin) * half);
    let any = |bits: &str| truth(&format!("((fixed & {bits}) != 0)"));
    let hold = ((k.velocity - s.velocity) * s.mass - k.force * kick).only(any("7u"));
    let turn = ((k.spin - s.spin) * s.inertia - k.torque * kick).only(any("56u"));
    let (impulse, torque) = (k.damping * kick, k.damping_torque * kick);
    let lost = -((k.damping.dot(mean) + k.damping_torque.dot(mean_spin)) * kick);
    out.number("held[0]", hold.dot(mean));
    out.number("held[7]", turn.dot(mean_spin));
    out.number("held[11]", lost);
    let rows =
        [(1, hold), (4, x.cross(hold)), (8, turn), (12, impulse), (15, x.cross(impulse)), (18, torque)];
    for (at, v) in rows {
        out.row(&format!("(held + {at})"), &[v]);
    }
}
