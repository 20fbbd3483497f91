//! Motion of single spheres and of body centres.

use super::record::Part;
use crate::device::layout::Features;
use crate::device::tape::{self, Recorded, Results, input, truth, vector};
use crate::integrate::kick::{self, Push, Single};
use crate::lanes::{Real, V3};

pub(super) fn part(f: &Features) -> Part {
    let free = if f.damped { free::<true>() } else { free::<false>() };
    Part {
        frame: include_str!("motion.c"),
        formulas: vec![("FREE", free), ("SINGLE", single(f.held))],
        entries: &[],
    }
}

pub(super) fn books() -> Part {
    Part { frame: include_str!("held.c"), formulas: Vec::new(), entries: &[] }
}

/// Displacement in a step.
pub(super) fn moved(velocity: V3<Recorded>) -> V3<Recorded> {
    vector("x") + velocity * input("dt")
}

pub(super) fn pushed<const DAMPED: bool>() -> (V3<Recorded>, V3<Recorded>) {
    let (old, force, gravity) = (vector("v"), vector("s.force"), vector("g"));
    let (inverse_mass, step, damping) = (input("v.w"), input("kick"), input("damping"));
    let kicked = |v: Recorded, force: Recorded, gravity: Recorded| {
        kick::kick_free::<Recorded, DAMPED>(v, &Push { force, gravity, inverse_mass, step, damping })
    };
    let [x, y, z] = [
        kicked(old.x, force.x, gravity.x),
        kicked(old.y, force.y, gravity.y),
        kicked(old.z, force.z, gravity.z),
    ];
    (V3::new(x.0, y.0, z.0), V3::new(x.1, y.1, z.1))
}

/// Power of a local damping force over a kick, by component.
pub(super) fn power(load: V3<Recorded>, old: V3<Recorded>, new: V3<Recorded>) -> V3<Recorded> {
    let mean = (old + new) * input("0.5");
    V3::new(load.x * mean.x, load.y * mean.y, load.z * mean.z)
}

fn free<const DAMPED: bool>() -> String {
    tape::begin();
    let (old, turn, torque) = (vector("v"), vector("w"), vector("s.torque"));
    let (velocity, held) = pushed::<DAMPED>();
    let share = kick::turn_of_sphere(input("kick"), input("v.w"), input("x.w"));
    let turned = |w: Recorded, t: Recorded| {
        let stop = if DAMPED { kick::resist(t, w, input("damping")) } else { Recorded::zero() };
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
        let stop = V3::new(a.1, b.1, c.1);
        let (power, turning) = (power(held, old, velocity), power(stop, turn, spin));
        out.row("held", &[power, turning, held, stop, vector("x").cross(held)]);
    }
    out.text()
}

pub(super) fn alone() -> Single<Recorded> {
    let bit = |d: usize| truth(&format!("(int)(fixed >> {d} & 1u)"));
    let none = V3::zero();
    Single {
        velocity: vector("v"),
        spin: vector("w"),
        force: (vector("s.force"), none),
        torque: (vector("s.torque"), none),
        gravity: vector("g"),
        mass: input("constants.x"),
        inertia: input("constants.y"),
        fixed: [[bit(0), bit(1), bit(2)], [bit(3), bit(4), bit(5)]],
        damping: input("damping"),
    }
}

fn single(held: bool) -> String {
    tape::begin();
    let s = alone();
    let k = kick::kick_single(&s, input("kick"));
    let speed = k.velocity.norm2().sqrt();
    let mut out = Results::default();
    out.vector("(*nv)", k.velocity);
    out.vector("(*nx)", moved(k.velocity));
    out.vector("(*nw)", k.spin);
    out.number("*speed2", speed * speed);
    if held {
        let mean = (s.spin + k.spin) * input("0.5");
        let any = truth("((fixed & 56u) != 0)");
        let turn = ((k.spin - s.spin) * s.inertia - k.torque * input("kick")).only(any);
        single_held(&mut out, &s, &k, (mean, turn, turn.dot(mean)));
    }
    out.text()
}

/// Work of fixed motions and local damping of a body, in the order of `general` (`integrate/leapfrog.rs`).
pub(super) fn single_held(
    out: &mut Results,
    s: &Single<Recorded>,
    k: &kick::Kicked<Recorded>,
    (mean_spin, turn, work): (V3<Recorded>, V3<Recorded>, Recorded),
) {
    let (x, kick, half) = (vector("x"), input("kick"), input("0.5"));
    let mean = (s.velocity + k.velocity) * half;
    let any = truth("((fixed & 7u) != 0)");
    let hold = ((k.velocity - s.velocity) * s.mass - k.force * kick).only(any);
    let (impulse, torque) = (k.damping * kick, k.damping_torque * kick);
    let lost = -((k.damping.dot(mean) + k.damping_torque.dot(mean_spin)) * kick);
    out.number("held[0]", hold.dot(mean));
    out.number("held[7]", work);
    out.number("held[11]", lost);
    let rows =
        [(1, hold), (4, x.cross(hold)), (8, turn), (12, impulse), (15, x.cross(impulse)), (18, torque)];
    for (at, v) in rows {
        out.row(&format!("(held + {at})"), &[v]);
    }
}
