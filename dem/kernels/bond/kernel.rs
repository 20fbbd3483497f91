//! Bond forces, scalar or SIMD.
//!
//! With d from b to a, L = |d|, n = d/L, lever arms lₐ + l_b = L, dt since the last step:
//!
//! * line of centres: rotated by the Rodrigues vector s = tan(α/2) about d′ × d, tan α = |d′ × d|/d′·d,
//!   d′ = d − v dt;
//! * stored vectors rotate with it, and about n by the mean angular velocity ω̄, tan(ω̄dt/2)·n;
//! * shear: u += [2 L s − 2 tan(dt/2)(lₐωₐ + l_bω_b)] × n̄, n̄ the mid-step normal;
//! * rotation: θ += (ωₐ − ω_b) dt;
//! * force on a: −n kₙ(L − L₀) − kₛ u, moment on a: −k_t (θ·n) n − k_b θ⊥;
//!
//! Failure, without dashpots: max(S₁, S₂) = 1 or S₁ + S₂ = 1, S₁ = s₀T + s₁|θ⊥|, S₂ = s₂|u| + s₃|θ·n| + s₄T.
//!
//! Theory manual: equations (2.11), (2.12) of `docs/theory/shapes.md`.

use crate::lanes::{Real, V3};

pub const LENGTH: usize = 0;
/// Lever arm difference [m].
pub const OFFSET: usize = 1;
/// Tension, shear, bending, twisting.
pub const STIFFNESS: usize = 2;
pub const DAMPING: usize = 6;
/// s₀ … s₄.
pub const LIMIT: usize = 10;
/// 1: sum criterion, 0: maximum.
pub const SUM: usize = 15;
pub const COUNT: usize = 16;

#[derive(Clone, Copy, Debug)]
pub struct Motion<R> {
    pub x: V3<R>,
    pub v: V3<R>,
    pub w: V3<R>,
}

/// Shear displacement [m] and relative rotation [rad] of a against b.
#[derive(Clone, Copy, Debug)]
pub struct BondHistory<R> {
    pub shear: V3<R>,
    pub turn: V3<R>,
}

#[derive(Clone, Copy, Debug)]
pub struct Frame<R> {
    pub normal: V3<R>,
    pub length: R,
    /// Separation rate [m/s].
    rate: R,
    /// lₐωₐ + l_bω_b [m/s].
    roll: V3<R>,
    arm_a: R,
    arm_b: R,
}

#[derive(Clone, Copy, Debug)]
pub struct Response<R> {
    /// Force on a.
    pub force: V3<R>,
    pub torque_a: V3<R>,
    pub torque_b: V3<R>,
    /// Utilisations S₁, S₂, and the governing value.
    pub tensile: R,
    pub shearing: R,
    pub share: R,
    /// Dashpot power at half-step-old velocities [W].
    pub power: R,
}

#[inline(always)]
pub fn update_frame<R: Real>(
    offset: R,
    a: &Motion<R>,
    b: &Motion<R>,
    memory: &mut BondHistory<R>,
    dt: R,
) -> Frame<R> {
    let half = R::splat(0.5);
    let one = R::splat(1.0);
    let d = a.x - b.x;
    let v = a.v - b.v;
    let square = d.norm2();
    let length = square.sqrt();
    let inverse_square = one / square;
    let inverse = length * inverse_square;
    let normal = d * inverse;
    let along = v.dot(d);

    // e = d′ × d / (2 d′·d).
    let strain = along * inverse_square * dt;
    let inverse_dot = inverse_square * (one + strain * (one + strain));
    let e = d.cross(v) * (half * dt * inverse_dot);
    let e2 = e.norm2();
    let swing = e * (one - e2 * (one - e2 * R::splat(2.0)));
    let mean = (a.w + b.w) * (half * dt);
    // 2 tan(ω̄dt/2)/ω̄dt.
    let mean2 = mean.norm2();
    let stretch = one + mean2 * (R::splat(1.0 / 12.0) + mean2 * R::splat(1.0 / 120.0));
    let twist = mean.dot(normal) * (half * stretch);
    let c = swing + normal * twist + normal.cross(swing) * twist;
    let c2 = c.norm2();
    let s = R::splat(2.0) * (one - c2 * (one - c2));
    let swing2 = swing.norm2();
    let middle = (normal - swing.cross(normal)) * (one - half * swing2 * (one - R::splat(0.75) * swing2));

    let (arm_a, arm_b) = ((length + offset) * half, (length - offset) * half);
    let roll = a.w * arm_a + b.w * arm_b;
    // Half of each increment before, half after the rotation.
    let slip = (swing * length - roll * (half * dt * stretch)).cross(middle);
    memory.shear = rotate(c, s, memory.shear + slip) + slip;
    let turn = (a.w - b.w) * (half * dt);
    memory.turn = rotate(c, s, memory.turn + turn) + turn;
    Frame { normal, length, rate: along * inverse, roll, arm_a, arm_b }
}

/// Rotation by the Rodrigues vector c, s = 2/(1 + c²).
#[inline(always)]
fn rotate<R: Real>(c: V3<R>, s: R, y: V3<R>) -> V3<R> {
    let z = c.cross(y);
    y + (z + c.cross(z)) * s
}

#[inline(always)]
fn split<R: Real>(v: V3<R>, n: V3<R>) -> (R, V3<R>) {
    let along = v.dot(n);
    (along, v - n * along)
}

#[inline(always)]
pub fn respond<R: Real>(
    k: &[R; COUNT],
    a: &Motion<R>,
    b: &Motion<R>,
    frame: &Frame<R>,
    memory: &BondHistory<R>,
) -> Response<R> {
    let n = frame.normal;
    let tension = k[STIFFNESS] * (frame.length - k[LENGTH]);
    let (twist, bend) = split(memory.turn, n);
    let slip = a.v - b.v - n * frame.rate - frame.roll.cross(n);
    let (turning, bending) = split(a.w - b.w, n);

    let force =
        -(n * (tension + k[DAMPING] * frame.rate)) - memory.shear * k[STIFFNESS + 1] - slip * k[DAMPING + 1];
    let moment = -(n * (twist * k[STIFFNESS + 3] + turning * k[DAMPING + 3]))
        - bend * k[STIFFNESS + 2]
        - bending * k[DAMPING + 2];
    let lever = n.cross(force);

    let tensile = k[LIMIT] * tension + k[LIMIT + 1] * bend.norm2().sqrt();
    let shearing =
        k[LIMIT + 2] * memory.shear.norm2().sqrt() + k[LIMIT + 3] * twist.abs() + k[LIMIT + 4] * tension;
    let share = tensile.max(shearing) + k[SUM] * tensile.min(shearing);
    let power = k[DAMPING] * frame.rate * frame.rate
        + k[DAMPING + 1] * slip.norm2()
        + k[DAMPING + 2] * bending.norm2()
        + k[DAMPING + 3] * turning * turning;
    Response {
        force,
        torque_a: moment - lever * frame.arm_a,
        torque_b: -moment - lever * frame.arm_b,
        tensile,
        shearing,
        share,
        power,
    }
}

/// NaN counts as intact: the speed check then reports the body.
#[inline(always)]
pub fn holds<R: Real>(r: &Response<R>) -> R::Mask {
    !R::splat(1.0).le(r.share)
}

/// Elastic energy: tension, shear, bending, twisting [J].
#[inline(always)]
pub fn energy(k: &[f64; COUNT], frame: &Frame<f64>, memory: &BondHistory<f64>) -> f64 {
    let stretch = frame.length - k[LENGTH];
    let (twist, bend) = split(memory.turn, frame.normal);
    0.5 * (k[STIFFNESS] * stretch * stretch
        + k[STIFFNESS + 1] * memory.shear.norm2()
        + k[STIFFNESS + 2] * bend.norm2()
        + k[STIFFNESS + 3] * twist * twist)
}

/// Elastic energy at half step. `since`: time from the history's instant, ½ dt for the last step, −½ dt for
/// current positions.
pub fn half_step_energy(
    k: &[f64; COUNT],
    a: &Motion<f64>,
    b: &Motion<f64>,
    memory: &BondHistory<f64>,
    dt: f64,
    since: f64,
) -> f64 {
    let back = |m: &Motion<f64>| Motion { x: m.x - m.v * (0.5 * dt), ..*m };
    let mut memory = *memory;
    let frame = update_frame(k[OFFSET], &back(a), &back(b), &mut memory, since);
    energy(k, &frame, &memory)
}

#[cfg(test)]
#[path = "kernel_tests.rs"]
mod tests;
